//! Computes the irradiance of ghosts from the irradiance of an image.

use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::{Bands, maths::f64::sin, quantity::Irradiance};
use etendue_projection::Raster;
use glam::DVec2;
use rayon::prelude::*;

use super::source::{GhostSource, SourceImage};
use super::splat::{Level, SplattedLight, splat_footprints};
use super::{GhostSettings, mirrored, response::Response};
use crate::{error::OpticsError, lens::PrescriptionLens, overlap::PRINCIPAL_NM, prescription::ghost::GhostPair};

/// Rings between which the field is tabulated.
const RINGS: usize = 256;
/// Step, in rings, of the tabulated étendue.
const ETENDUE_STEP: usize = 4;
/// A height or wavelength with less than this fraction of the best one's light is no source: dividing by it would amplify noise.
const MIN_LIGHT_FRACTION: f64 = 1e-3;
/// Sources processed at a time, to bound memory.
const BATCH: usize = 8;

/// The ghosts of an image behind a lens: irradiance in the same raster. The raster may be larger than the sensor, to include light from outside the
/// image.
///
/// # Errors
/// If the irradiance does not have the raster's size.
pub fn layer(
    irradiance: &SpectralCube<Irradiance>,
    lens: &PrescriptionLens,
    raster: &Raster,
    settings: GhostSettings,
) -> Result<SpectralCube<Irradiance>, OpticsError> {
    let (got_width, got_height) = (irradiance.width(), irradiance.height());
    let (width, height) = (raster.width(), raster.height());
    if (got_width, got_height) != (width, height) {
        return Err(OpticsError::Size { got_width, got_height, width, height });
    }
    let field = FieldTable::new(lens, raster);
    let bands = irradiance.bands();
    let image = SourceImage {
        planes: irradiance.planes(),
        pixel_factor: field.pixel_factors(raster),
        band_factor: band_factors(lens, bands),
    };
    let visible_light = |source: GhostSource| {
        let at_mm = raster.sensor_mm(source.at_px);
        let angle = field.angle(at_mm.length());
        DistantSource {
            angle,
            outward: at_mm.normalize_or(DVec2::X),
            spectrum: source.spectrum,
            fraction: source.fraction,
        }
    };
    let sources: Vec<DistantSource> = image.sources().into_iter().map(visible_light).collect();
    Ok(Scattering::new(lens, raster, settings, bands, &sources, field.max_angle()).layer(&sources))
}

/// A source at infinity.
struct DistantSource {
    /// Angle from the axis, rad.
    angle: f64,
    /// Direction in the image, from the axis towards the source's image.
    outward: DVec2,
    spectrum: Vec<f32>,
    fraction: f64,
}

/// The ghost of a source by a pair of surfaces.
struct GhostSplat<'a> {
    source: &'a DistantSource,
    pair: usize,
    light: SplattedLight,
}

/// A lens's ghosts, prepared for accumulation.
struct Scattering<'a> {
    lens: &'a PrescriptionLens,
    raster: &'a Raster,
    settings: GhostSettings,
    bands: Bands,
    response: Response,
    levels: Vec<Level>,
    /// By pair: reflectance of its surfaces by band, over that at the tabulated wavelengths.
    colours: Vec<PairColour>,
}

impl<'a> Scattering<'a> {
    fn new(
        lens: &'a PrescriptionLens,
        raster: &'a Raster,
        settings: GhostSettings,
        bands: Bands,
        sources: &[DistantSource],
        max_angle: f64,
    ) -> Self {
        let angles: Vec<f64> = sources.iter().map(|source| source.angle).collect();
        let range_nm = [bands.low_nm(), bands.high_nm()];
        let response = Response::new(lens, settings, range_nm, max_angle, &angles);
        let colours =
            response.pairs.iter().map(|pair| PairColour::new(lens, *pair, &response.knots_nm, bands)).collect();
        Self { lens, raster, settings, bands, response, levels: Level::all(raster), colours }
    }

    fn layer(&self, sources: &[DistantSource]) -> SpectralCube<Irradiance> {
        let mut canvas: Vec<Vec<Vec<f32>>> =
            (0..self.bands.count()).map(|_| vec![Vec::new(); self.levels.len()]).collect();
        for batch in sources.chunks(BATCH) {
            let jobs: Vec<_> =
                batch.iter().flat_map(|s| (0..self.response.pairs.len()).map(move |pair| (s, pair))).collect();
            let splats: Vec<_> = jobs.into_par_iter().filter_map(|(source, pair)| self.splat(source, pair)).collect();
            canvas.par_iter_mut().enumerate().for_each(|(band, levels)| {
                splats.iter().for_each(|splat| self.add(levels, band, splat));
            });
        }
        let planes = canvas.par_iter().map(|levels| self.image_plane(levels)).collect();
        SpectralCube::from_planes(self.bands, planes).expect("one plane per band, all of the raster's size")
    }

    fn splat<'s>(&self, source: &'s DistantSource, pair: usize) -> Option<GhostSplat<'s>> {
        let footprints = self.response.at(source.angle, pair)?;
        let light = splat_footprints(&footprints, source.outward, source.fraction, &self.levels)?;
        Some(GhostSplat { source, pair, light })
    }

    /// Adds a ghost to the levels of a band.
    fn add(&self, levels: &mut [Vec<f32>], band: usize, splat: &GhostSplat<'_>) {
        let GhostSplat { source, pair, light: splatted } = splat;
        let rear = self.response.pairs[*pair].rear;
        let filtered = self.lens.filtered(self.bands.centre_nm(band), splatted.cosine);
        // Light reflected by the sensor passes the filter before it all three times.
        let passes = if rear == self.lens.prescription().surfaces().len() { 3 } else { 1 };
        let strength = f64::from(source.spectrum[band])
            * mirrored(self.lens, rear, self.settings)
            * (0..passes).map(|_| filtered).product::<f64>();
        let at = &self.levels[splatted.level];
        let plane = &mut levels[splatted.level];
        plane.resize(at.columns * at.rows, 0.0);
        for (knot, fraction) in self.colours[*pair].band_factors(band) {
            let factor = (strength * fraction) as f32;
            for (j, row) in splatted.light[knot].chunks_exact(splatted.columns).enumerate() {
                let first = (splatted.from[1] + j) * at.columns + splatted.from[0];
                let to = &mut plane[first..first + splatted.columns];
                to.iter_mut().zip(row).for_each(|(sum, light)| *sum += factor * light);
            }
        }
    }

    /// The sum of all levels, interpolated between the centres of their cells.
    fn image_plane(&self, levels: &[Vec<f32>]) -> Plane<Irradiance> {
        let (width, height) = (self.raster.width(), self.raster.height());
        let mut plane = Plane::new(width, height);
        for (at, cells) in self.levels.iter().zip(levels).filter(|(_, cells)| !cells.is_empty()) {
            let columns: Vec<_> = (0..width).map(|x| at.pixel(x)).collect();
            for (y, row) in plane.samples_mut().chunks_exact_mut(width).enumerate() {
                let (j, v) = at.pixel(y);
                let [above, below] = [j, j + 1].map(|j| &cells[j * at.columns..(j + 1) * at.columns]);
                for (sum, (i, u)) in row.iter_mut().zip(&columns) {
                    let along = |row: &[f32]| row[*i] + u * (row[i + 1] - row[*i]);
                    let (a, b) = (along(above), along(below));
                    *sum += a + v * (b - a);
                }
            }
        }
        plane
    }
}

/// The reflectance of a pair's surfaces at each band, over that at the tabulated wavelengths.
struct PairColour {
    /// By band: the tabulated wavelength below, and factors of it and of the next.
    bands: Vec<(usize, [f64; 2])>,
}

impl PairColour {
    fn new(lens: &PrescriptionLens, pair: GhostPair, knots_nm: &[f64], bands: Bands) -> Self {
        let reflected = |nm: f64| lens.prescription().ghost_colour(pair, nm);
        let knots: Vec<f64> = knots_nm.iter().map(|nm| reflected(*nm)).collect();
        let of_band = |i: usize| {
            let nm = bands.centre_nm(i);
            let below = knots_nm.partition_point(|knot| *knot <= nm).saturating_sub(1);
            let next = (below + 1).min(knots.len() - 1);
            let width = knots_nm[next] - knots_nm[below];
            let fraction = if width > 0.0 { (nm - knots_nm[below]) / width } else { 0.0 };
            let over = |knot: f64| if knot > 0.0 { reflected(nm) / knot } else { 0.0 };
            (below, [(1.0 - fraction) * over(knots[below]), fraction * over(knots[next])])
        };
        Self { bands: (0..bands.count()).map(of_band).collect() }
    }

    /// Tabulated wavelengths and their factors.
    fn band_factors(&self, band: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let (below, fractions) = self.bands[band];
        [(below, fractions[0]), (below + 1, fractions[1])].into_iter().filter(|(_, fraction)| *fraction > 0.0)
    }
}

/// Field angle, solid angle and étendue by height on the sensor.
struct FieldTable {
    step_mm: f64,
    angles: Vec<f64>,
    /// sr per sr·mm²: of the ring above each height.
    factors: Vec<f64>,
}

impl FieldTable {
    fn new(lens: &PrescriptionLens, raster: &Raster) -> Self {
        let step_mm = raster.max_radius_mm().min(lens.lit_radius_mm()) / RINGS as f64;
        let angles: Vec<f64> = (0..=RINGS).map_while(|i| lens.field_angle(step_mm * i as f64)).collect();
        let coarse: Vec<f64> = (0..=RINGS / ETENDUE_STEP)
            .into_par_iter()
            .map(|i| lens.projected_solid_angle_sr(DVec2::new(step_mm * (i * ETENDUE_STEP) as f64, 0.0)))
            .collect();
        let factor = |i: usize| {
            let place = (i as f64 + 0.5) / ETENDUE_STEP as f64;
            let etendue = between(&coarse, place);
            let [inner, outer] = [i as f64, i as f64 + 1.0].map(|i| i * step_mm);
            // 2π (cos a − cos b) over π (outer² − inner²).
            let [a, b] = [angles[i], angles[i + 1]];
            let sr_per_mm2 = 4.0 * sin(0.5 * (a + b)) * sin(0.5 * (b - a)) / (outer * outer - inner * inner);
            if etendue > MIN_LIGHT_FRACTION * coarse[0] { sr_per_mm2 / etendue } else { 0.0 }
        };
        let factors = (0..angles.len().saturating_sub(1)).map(factor).collect();
        Self { step_mm, angles, factors }
    }

    /// Solid angle of each pixel over the étendue at its position; 0 beyond the light.
    fn pixel_factors(&self, raster: &Raster) -> Vec<f64> {
        let pitch = raster.pitch_mm();
        let factor = |i: usize| {
            let centre = DVec2::new((i % raster.width()) as f64 + 0.5, (i / raster.width()) as f64 + 0.5);
            let place = raster.sensor_mm(centre).length() / self.step_mm;
            if place as usize >= self.factors.len() {
                return 0.0;
            }
            pitch.x * pitch.y * between(&self.factors, (place - 0.5).max(0.0))
        };
        (0..raster.width() * raster.height()).map(factor).collect()
    }

    fn angle(&self, height_mm: f64) -> f64 {
        between(&self.angles, height_mm / self.step_mm)
    }

    fn max_angle(&self) -> f64 {
        self.angles.last().copied().unwrap_or(0.0)
    }
}

/// Linear interpolation in a uniformly spaced table, held beyond its end.
fn between(table: &[f64], place: f64) -> f64 {
    let last = table.len().saturating_sub(1);
    let i = (place as usize).min(last);
    let next = (i + 1).min(last);
    let fraction = (place - i as f64).clamp(0.0, 1.0);
    if table.is_empty() { 0.0 } else { table[i] + fraction * (table[next] - table[i]) }
}

/// By band: the inverse of the lens's axial transmittance relative to 587.56 nm, the wavelength of the étendue.
fn band_factors(lens: &PrescriptionLens, bands: Bands) -> Vec<f64> {
    let passes = |nm: f64| lens.prescription().axial_transmittance(nm) * lens.filtered(nm, 1.0);
    let through: Vec<f64> = (0..bands.count()).map(|i| passes(bands.centre_nm(i))).collect();
    let maximum = through.iter().copied().fold(0.0, f64::max);
    let principal = passes(PRINCIPAL_NM);
    through.into_iter().map(|t| if t > MIN_LIGHT_FRACTION * maximum { principal / t } else { 0.0 }).collect()
}
