//! The clear sky of Hosek and Wilkie as surroundings.
//!
//! Above the horizon a direction at the angle θ from the zenith and γ from the sun has, in each of eleven bands, L = L̄ · gradient(cos θ) · (glow(γ) + rise
//! · √cos θ), not below zero (`etendue_spectra::sky`, which also describes the conversion of bands to wavelengths). The two functions are
//! stored as tables, linear between nodes of √cos θ and of √sin(γ/2). In these variables they are smooth, with the finest steps at the horizon and at
//! the sun. The error against the model is below 1e-3.
//!
//! Below the horizon lies diffuse, endless ground, as in the model: its radiance is albedo · E/π everywhere, with E the irradiance of level ground by
//! sky and sun. An image without a ground thus does not end in black. The ground is hit by chance and never sampled: no direction of it is better
//! than the surface's own.
//!
//! Directions of the sky are sampled by a grid of equal steps in azimuth from the sun and in elevation, a cell by its mean radiance (440–640 nm) and
//! solid angle; each cell has a positive probability.

use core::f32::consts::{FRAC_PI_2, TAU};

use etendue_core::maths::f32::{asin, atan2, sin_cos};
use etendue_core::{Spectral, Wavelengths, distribution::Distribution2, maths};
use etendue_spectra::Spectrum;
use etendue_spectra::sky::{BANDS, FIRST_NM, STEP_NM, SkyModel};
use glam::{DVec3, Vec2, Vec3};

use super::LightSample;
use super::patches::{EnvironmentCell, patches};

/// Intervals of the tables.
const STEPS: usize = 4096;

/// Cells of the grid for the sampling of directions.
const COLUMNS: usize = 256;
const ROWS: usize = 128;

/// Bands whose mean weights directions: 440 to 640 nm.
const WEIGHTED_BANDS: core::ops::RangeInclusive<usize> = 3..=8;

/// Height and width of a cell, rad.
const CELL: (f64, f64) = (core::f64::consts::FRAC_PI_2 / ROWS as f64, core::f64::consts::TAU / COLUMNS as f64);

/// Minimum weight of a cell, as a fraction of the mean weight.
const FLOOR: f64 = 1e-3;

/// One value for each band.
type Bands = [f32; BANDS];

/// The sky above an endless ground. Its `Debug` text leaves out the tables, which follow from the printed values.
#[derive(Clone)]
pub struct SkyEnvironment {
    /// Origin of γ: the sun, or the point of the horizon above a sun that is below it.
    glow: Vec3,
    azimuth_turns: f32,
    gradient: Vec<Bands>,
    around: Vec<Bands>,
    rise: Bands,
    /// Factor on the outermost bands at wavelengths beyond them, 1 between.
    beyond: Spectrum,
    ground: Spectrum,
    irradiance: Spectrum,
    distribution: Distribution2,
    /// Fraction of bright patches in its light.
    pub(super) patches: f64,
}

impl core::fmt::Debug for SkyEnvironment {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("SkyEnvironment")
            .field("glow", &self.glow)
            .field("irradiance", &self.irradiance)
            .field("ground", &self.ground)
            .finish_non_exhaustive()
    }
}

impl SkyEnvironment {
    /// The sky of a model whose sun stands at an azimuth (rad, anticlockwise from +x seen from above), over ground of a diffuse `albedo`
    /// that receives from the sun alone the spectral irradiance `sun_on_ground` (W·m⁻²·nm⁻¹). `None` if the sky is black.
    #[must_use]
    pub fn new(model: &SkyModel, azimuth_rad: f64, albedo: f64, sun_on_ground: &Spectrum) -> Option<Self> {
        let irradiance = model.horizontal_irradiance();
        let fraction = albedo / core::f64::consts::PI;
        let ground =
            Spectrum::from_fn(|nm| fraction * f64::from(irradiance.at(nm as f32) + sun_on_ground.at(nm as f32)));
        let emission = towards(azimuth_rad, model.glow_elevation_rad());
        let [gradient, around] = tables(model);
        let weights = weights(model);
        let cells = weights
            .iter()
            .enumerate()
            .map(|(k, weight)| EnvironmentCell { weight: f64::from(*weight), solid_angle: solid_angle(k / COLUMNS) });
        Some(Self {
            glow: emission.as_vec3(),
            azimuth_turns: (azimuth_rad / core::f64::consts::TAU).rem_euclid(1.0) as f32,
            gradient,
            around,
            rise: model.bands().map(|b| (b.rise(1.0) * b.scale()) as f32),
            beyond: Spectrum::from_fn(|nm| SkyModel::mix(nm).weights.iter().sum()),
            ground,
            irradiance,
            patches: patches(cells),
            distribution: Distribution2::new(COLUMNS, &weights)?,
        })
    }

    /// Spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) from the unit `direction` (away from the viewer).
    #[must_use]
    pub fn radiance<const N: usize>(&self, direction: Vec3, wavelengths: &Wavelengths<N>) -> Spectral<N> {
        if direction.z < 0.0 {
            return self.ground.sample(wavelengths);
        }
        let root = direction.z.min(1.0).sqrt();
        // sin(γ/2), half the chord; without loss near the sun.
        let around = (0.5 * (direction - self.glow).length()).min(1.0).sqrt();
        let (gradient, around) = (TablePosition::new(root), TablePosition::new(around));
        let band = |b: usize| gradient.read(&self.gradient, b) * (around.read(&self.around, b) + self.rise[b] * root);
        Spectral(wavelengths.nm.map(|nm| {
            let x = ((nm - FIRST_NM as f32) * (1.0 / STEP_NM as f32)).clamp(0.0, (BANDS - 1) as f32);
            let low = (x as i32 as usize).min(BANDS - 2);
            let (below, above) = (band(low).max(0.0), band(low + 1).max(0.0));
            self.beyond.at(nm) * (below + (x - low as f32) * (above - below))
        }))
    }

    /// Spectral irradiance of level ground by the sky, W·m⁻²·nm⁻¹.
    #[must_use]
    pub fn irradiance(&self) -> &Spectrum {
        &self.irradiance
    }

    pub(super) fn mean_irradiance(&self, low_nm: f64, high_nm: f64) -> f64 {
        self.irradiance.band_mean(low_nm, high_nm)
    }

    /// Density with which [`SkyEnvironment::sample`] returns the unit `direction`, 1/sr.
    pub(super) fn pdf(&self, direction: Vec3) -> f32 {
        let cos = (direction.x * direction.x + direction.y * direction.y).sqrt();
        if direction.z < 0.0 || cos <= 0.0 {
            return 0.0;
        }
        let turns = atan2(direction.y, direction.x) / TAU - self.azimuth_turns;
        let place = Vec2::new(turns - turns.floor(), asin(direction.z.min(1.0)) / FRAC_PI_2).min(ONE_BELOW);
        self.distribution.pdf(place) / (TAU * FRAC_PI_2 * cos)
    }

    pub(super) fn sample<const N: usize>(&self, u: Vec2, wavelengths: &Wavelengths<N>) -> Option<LightSample<N>> {
        let (place, by_area) = self.distribution.sample(u);
        let (sin_a, cos_a) = sin_cos((place.x + self.azimuth_turns) * TAU);
        let (sin_e, cos_e) = sin_cos(place.y * FRAC_PI_2);
        let direction = Vec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
        let pdf = by_area / (TAU * FRAC_PI_2 * cos_e);
        LightSample::from_environment(direction, self.radiance(direction, wavelengths), pdf)
    }
}

const ONE_BELOW: Vec2 = Vec2::splat(1.0 - 0.5 * f32::EPSILON);

fn towards(azimuth_rad: f64, elevation_rad: f64) -> DVec3 {
    let ((sin_a, cos_a), (sin_e, cos_e)) = (maths::f64::sin_cos(azimuth_rad), maths::f64::sin_cos(elevation_rad));
    DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e)
}

/// A place in a table over [0, 1].
struct TablePosition {
    node: usize,
    t: f32,
}

impl TablePosition {
    fn new(x: f32) -> Self {
        let x = x * STEPS as f32;
        let node = (x as i32 as usize).min(STEPS - 1);
        Self { node, t: x - node as f32 }
    }

    fn read(&self, table: &[Bands], band: usize) -> f32 {
        let (low, high) = (table[self.node][band], table[self.node + 1][band]);
        low + self.t * (high - low)
    }
}

/// Gradients over √cos θ, and glows times scale over √sin(γ/2).
fn tables(model: &SkyModel) -> [Vec<Bands>; 2] {
    let node = |i: usize| i as f64 / STEPS as f64;
    let gradient = |x: f64| model.bands().map(|b| b.gradient(x * x) as f32);
    // cos γ = 1 − 2 sin²(γ/2).
    let around = |x: f64| model.bands().map(|b| (b.scale() * b.glow(1.0 - 2.0 * x * x * x * x)) as f32);
    [(0..=STEPS).map(|i| gradient(node(i))).collect(), (0..=STEPS).map(|i| around(node(i))).collect()]
}

/// Mean radiance of each cell, over its corners and middle, times the cell's solid angle.
fn weights(model: &SkyModel) -> Vec<f32> {
    let (height, width) = CELL;
    let emission = towards(0.0, model.glow_elevation_rad());
    let actual = |row: f64, column: f64| {
        let direction = towards(column * width, (row * height).min(core::f64::consts::FRAC_PI_2));
        let bands = model.band_radiances(direction.z.clamp(0.0, 1.0), direction.dot(emission).clamp(-1.0, 1.0));
        bands[WEIGHTED_BANDS].iter().sum::<f64>()
    };
    let corners: Vec<f64> =
        (0..=ROWS).flat_map(|j| (0..=COLUMNS).map(move |i| (j, i))).map(|(j, i)| actual(j as f64, i as f64)).collect();
    let cell = |j: usize, i: usize| {
        let at = |j: usize, i: usize| corners[j * (COLUMNS + 1) + i];
        let middle = actual(j as f64 + 0.5, i as f64 + 0.5);
        0.125 * (at(j, i) + at(j, i + 1) + at(j + 1, i) + at(j + 1, i + 1)) + 0.5 * middle
    };
    let means: Vec<f64> = (0..ROWS).flat_map(|j| (0..COLUMNS).map(move |i| (j, i))).map(|(j, i)| cell(j, i)).collect();
    let floor = FLOOR * means.iter().sum::<f64>() / means.len() as f64;
    let weight = |(k, mean): (usize, &f64)| ((mean + floor) * solid_angle(k / COLUMNS) * 1e6) as f32;
    means.iter().enumerate().map(weight).collect()
}

/// Solid angle of a cell of row `j`, in units of the whole sphere.
fn solid_angle(j: usize) -> f64 {
    let (height, _) = CELL;
    (maths::f64::sin((j + 1) as f64 * height) - maths::f64::sin(j as f64 * height)) / (2.0 * COLUMNS as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_core::warp::uniform_sphere;

    const WAVELENGTHS: Wavelengths<4> = Wavelengths { nm: [310.0, 450.0, 610.0, 900.0], pdf: [1.0; 4] };

    fn sky(turbidity: f64, elevation_deg: f64) -> (SkyModel, SkyEnvironment) {
        let model = SkyModel::new(turbidity, 0.3, elevation_deg.to_radians()).expect("a sky");
        let sky = SkyEnvironment::new(&model, 0.7, 0.3, &Spectrum::constant(0.5)).expect("light");
        (model, sky)
    }

    /// A lattice of two dimensions (golden ratio).
    fn lattice(n: u32) -> impl Iterator<Item = Vec2> {
        (0..n).map(move |i| Vec2::new((i as f32 + 0.5) / n as f32, (0.618_034 * (f64::from(i) + 0.5)).fract() as f32))
    }

    #[test]
    fn tables_are_the_model() {
        for (turbidity, elevation_deg) in [(1.0, 2.0), (3.0, 40.0), (10.0, 89.0), (2.0, -4.0)] {
            let (model, sky) = sky(turbidity, elevation_deg);
            let emission = towards(0.7, model.glow_elevation_rad());
            let near =
                (0..50).map(|i| (emission + 1e-3 * f64::from(i) * DVec3::new(0.3, 0.1, 1.0)).normalize().as_vec3());
            for direction in lattice(2000).map(uniform_sphere).chain(near).filter(|d| d.z >= 0.0) {
                let cos_sun = direction.as_dvec3().dot(emission).clamp(-1.0, 1.0);
                let exact = model.radiance(f64::from(direction.z), cos_sun);
                let actual = sky.radiance(direction, &WAVELENGTHS);
                for (nm, actual) in WAVELENGTHS.nm.iter().zip(actual.0) {
                    let exact = exact.at(*nm);
                    // Errors are those of the terms where gradient and glow nearly cancel (low over the horizon).
                    assert!((actual - exact).abs() <= 1e-3 * exact + 2e-5, "{direction} {nm}: {actual} {exact}");
                }
            }
        }
    }

    #[test]
    fn samples_give_the_irradiance_and_the_densities_that_are_reported() {
        for (turbidity, elevation_deg) in [(2.0, 5.0), (4.0, 60.0)] {
            let (model, sky) = sky(turbidity, elevation_deg);
            let (n, mut sums, mut apart, mut fraction) = (1 << 15, [0.0; 4], 0, 0.0);
            for u in lattice(n) {
                let sample = sky.sample(u, &WAVELENGTHS).expect("light");
                let pdf = sky.pdf(sample.direction);
                apart += usize::from((pdf - sample.pdf).abs() > 1e-3 * sample.pdf);
                let cos = f64::from(sample.direction.z);
                (0..4).for_each(|k| sums[k] += f64::from(sample.radiance[k]) * cos / f64::from(sample.pdf));
                fraction += f64::from(sky.pdf(uniform_sphere(u))) * 4.0 * core::f64::consts::PI;
            }
            // Only on the borders of cells may rounding give the neighbour's density.
            assert!(apart < 200, "{apart} of {n} densities differ");
            assert!((fraction / f64::from(n) - 1.0).abs() < 5e-3, "{}", fraction / f64::from(n));
            let expected = model.horizontal_irradiance();
            for (nm, sum) in WAVELENGTHS.nm.iter().zip(sums) {
                let ratio = sum / f64::from(n) / f64::from(expected.at(*nm));
                // The lattice's error, and the model's own quadrature.
                assert!((ratio - 1.0).abs() < 5e-3, "{nm}: {ratio}");
            }
        }
    }

    #[test]
    fn the_ground_throws_back_its_share() {
        let (model, sky) = sky(3.0, 30.0);
        let actual = sky.radiance(Vec3::new(0.6, 0.0, -0.8), &WAVELENGTHS)[1];
        let expected = 0.3 / core::f32::consts::PI * (model.horizontal_irradiance().at(450.0) + 0.5);
        assert!((actual / expected - 1.0).abs() < 1e-5 && sky.pdf(Vec3::NEG_Z) == 0.0);
    }
}
