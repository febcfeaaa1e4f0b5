//! Distortion, lateral colour and raster by resampling a stored radiance image.
//!
//! A pixel of the sensor image is cut into n × n cells, with n = 2 or as many as keep a cell at most two stored pixels wide. Each cell is read from
//! the view that shows its centre. Its footprint is the upright rectangle of the cell's own second moments there (for a cell with edges a and b:
//! √(a_x² + b_x²) wide and √(a_y² + b_y²) high). The cell's radiance is the mean of the stored image over that rectangle, whose pixels count as
//! uniform. Weights sum to one, so a uniform radiance stays uniform.
//!
//! Blur: the pixel box of the sensor image, widened by that of the stored image. Where both grids have one pitch this is exactly linear interpolation
//! of the stored pixels (the identity where the grids coincide: then nothing is blurred); where the stored image is finer it tends to the exact pixel
//! mean. Views overlap by a few pixels, so the radiance is as continuous across the edges of a cube as within a face.
//!
//! A pixel is the mean of its lit cells; a pixel without one is dark. With lateral colour every band is resampled by the chief rays of its own
//! centre.

use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::{Quantity, Radiance};
use etendue_core::wavelength::Bands;
use etendue_projection::Raster;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::irradiance::{check_plane, check_size};
use super::survey::{ChiefRaySource, REACH, Survey};
use super::view::{Face, View};
use super::{covering::serves, projection::PupilProjection};
use crate::{error::OpticsError, lens::Lens};

/// Minimum and maximum number of cells per pixel along each axis.
const CELLS: (usize, usize) = (2, 64);
/// Maximum width of a cell, stored pixels.
const CELL_PX: f64 = 2.0;
/// The minimum side of a cell's footprint, stored pixels: two such cells make the box of a linear interpolation.
const MIN_PX: f64 = 0.5;

/// The map from a stored radiance image to the sensor image of a lens and a raster, with a margin about it.
#[derive(Clone, Debug)]
pub struct Resampling<'a> {
    stored: PupilProjection,
    lens: &'a Lens,
    /// The sensor image with its margin.
    raster: Raster,
    /// Cells per pixel along each axis.
    cells: usize,
}

/// The fraction of one stored pixel in a pixel of the sensor image.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tap {
    index: usize,
    weight: f64,
}

/// The directions at the corners of a row of cells: above and below.
type Corners<'a> = [&'a [Option<DVec3>]; 2];

impl<'a> Resampling<'a> {
    /// Creates a resampling of images of geometry `stored` into the raster of the sensor image with `margin_px` more columns and rows on all sides.
    ///
    /// # Errors
    /// If the sensor image needs directions that the stored image does not hold, or the lens cannot image it.
    pub fn new(
        stored: PupilProjection,
        lens: &'a Lens,
        raster: &Raster,
        margin_px: [usize; 2],
        bands: Bands,
    ) -> Result<Self, OpticsError> {
        serves(lens)?;
        lens.check(raster)?;
        let raster = raster.widened(margin_px);
        let survey = Survey::new(lens, &raster, bands.range());
        check_covers(&stored, &survey)?;
        let widest = survey
            .samples
            .iter()
            .filter_map(|sample| sample.sides_tan(stored.view(sample.direction)?.face()).map(|[a, b]| a.max(b)));
        let widest_px = widest.fold(0.0, f64::max) / stored.pitch_tan();
        let cells = ((widest_px / CELL_PX).ceil() as usize).clamp(CELLS.0, CELLS.1);
        Ok(Self { stored, lens, raster, cells })
    }

    /// The pixels of the result: those of the sensor image and of its margin.
    #[must_use]
    pub fn raster(&self) -> &Raster {
        &self.raster
    }

    /// The radiance image in the raster of the sensor image.
    ///
    /// # Errors
    /// If the image's size is not that of its geometry, or directions are missing.
    pub fn apply(&self, radiance: &SpectralCube<Radiance>) -> Result<SpectralCube<Radiance>, OpticsError> {
        check_size(radiance, self.stored.width(), self.stored.height())?;
        let bands = radiance.bands();
        let planes = self.apply_to_bands(radiance.planes(), |i| bands.centre_nm(i))?;
        Ok(SpectralCube::from_planes(bands, planes).expect("one plane per band, all of the raster's size"))
    }

    /// Some bands of a radiance image in the raster of the sensor image, each of the wavelength at its centre, nm; equal to [`apply`](Self::apply).
    ///
    /// # Errors
    /// If a band's size is not that of the geometry, or directions are missing.
    pub fn apply_to_bands(
        &self,
        radiance: &[Plane<Radiance>],
        centre_nm: impl Fn(usize) -> f64,
    ) -> Result<Vec<Plane<Radiance>>, OpticsError> {
        radiance.iter().try_for_each(|band| check_plane(band, self.stored.width(), self.stored.height()))?;
        let empty = |_: &Plane<Radiance>| Plane::new(self.raster.width(), self.raster.height());
        let mut result: Vec<Plane<Radiance>> = radiance.iter().map(empty).collect();
        let reach_mm = self.raster.max_radius_mm() * REACH;
        if !self.lens.spreads_colours() {
            let aim = ChiefRaySource::principal(self.lens, reach_mm);
            self.apply_to(&aim, radiance, &mut result)?;
            return Ok(result);
        }
        for (i, (from, to)) in radiance.iter().zip(&mut result).enumerate() {
            let aim = ChiefRaySource::new(self.lens, reach_mm, centre_nm(i));
            self.apply_to(&aim, core::slice::from_ref(from), core::slice::from_mut(to))?;
        }
        Ok(result)
    }

    /// A stored plane in the raster of the sensor image: each pixel is the stored one nearest to its centre's chief ray (587.56 nm), never averaged.
    /// `nothing` where there is no ray.
    ///
    /// # Errors
    /// If the plane's size is not that of the geometry.
    pub fn nearest<Q: Quantity>(&self, plane: &Plane<Q>, nothing: Q::Sample) -> Result<Plane<Q>, OpticsError> {
        check_plane(plane, self.stored.width(), self.stored.height())?;
        let aim = ChiefRaySource::principal(self.lens, self.raster.max_radius_mm() * REACH);
        let mut result = Plane::filled(self.raster.width(), self.raster.height(), nothing);
        for y in 0..self.raster.height() {
            for x in 0..self.raster.width() {
                if let Some(index) = self.nearest_index(&aim, DVec2::new(x as f64, y as f64) + 0.5) {
                    result.set(x, y, plane.samples()[index]);
                }
            }
        }
        Ok(result)
    }

    /// Resamples planes by the chief rays of one wavelength, rows independently of each other.
    fn apply_to(
        &self,
        aim: &ChiefRaySource<'_>,
        from: &[Plane<Radiance>],
        to: &mut [Plane<Radiance>],
    ) -> Result<(), OpticsError> {
        let width = self.raster.width();
        let rows = (0..self.raster.height()).into_par_iter().map(|y| self.row(aim, y, from));
        let rows: Vec<Vec<f32>> = rows.collect::<Result<_, _>>()?;
        for (i, plane) in to.iter_mut().enumerate() {
            for (to, row) in plane.samples_mut().chunks_exact_mut(width).zip(&rows) {
                to.copy_from_slice(&row[i * width..(i + 1) * width]);
            }
        }
        Ok(())
    }

    /// A row of the sensor image in all planes, plane after plane.
    fn row(&self, aim: &ChiefRaySource<'_>, y: usize, from: &[Plane<Radiance>]) -> Result<Vec<f32>, OpticsError> {
        let (n, width) = (self.cells, self.raster.width());
        let lines: Vec<Vec<Option<DVec3>>> = (0..=n).map(|i| self.corner_row(aim, y * n + i)).collect();
        let mut row = vec![0.0; from.len() * width];
        let mut taps = Vec::new();
        for x in 0..width {
            taps.clear();
            let mut count = 0;
            for pair in lines.windows(2) {
                count += self.add_cells([&pair[0], &pair[1]], x * n, &mut taps)?;
            }
            if count == 0 {
                taps.extend(self.single_tap(aim, DVec2::new(x as f64, y as f64) + 0.5));
                count = taps.len();
            }
            let fraction = 1.0 / count.max(1) as f64;
            for (i, plane) in from.iter().enumerate() {
                row[i * width + x] = weighted(plane, &taps, fraction);
            }
        }
        Ok(row)
    }

    /// Directions at the corners of the cells along the line `index` cells below the top.
    fn corner_row(&self, aim: &ChiefRaySource<'_>, index: usize) -> Vec<Option<DVec3>> {
        let side = 1.0 / self.cells as f64;
        let at = |i: usize| aim.direction(self.raster.sensor_mm(DVec2::new(i as f64, index as f64) * side));
        (0..=self.raster.width() * self.cells).map(at).collect()
    }

    /// Adds the stored pixels of one row of a pixel's cells, from the cell `first` on; the weights of each cell sum to one. Returns the number of lit
    /// cells.
    fn add_cells(&self, rows: Corners<'_>, first: usize, taps: &mut Vec<Tap>) -> Result<usize, OpticsError> {
        let mut count = 0;
        for i in first..first + self.cells {
            let [above, below] = rows;
            if let [Some(a), Some(b), Some(c), Some(d)] = [above[i], above[i + 1], below[i], below[i + 1]] {
                self.add_cell([a, b, c, d], taps)?;
                count += 1;
            }
        }
        Ok(count)
    }

    fn add_cell(&self, corners: [DVec3; 4], taps: &mut Vec<Tap>) -> Result<(), OpticsError> {
        let middle: DVec3 = corners.into_iter().sum();
        let view = self.stored.view(middle);
        let view = view.ok_or(OpticsError::MissingView { view: Face::towards(middle).name() })?;
        if let Some([low, high]) = footprint(view, corners, middle) {
            self.rectangle_taps(view, low, high, taps);
        }
        Ok(())
    }

    /// Adds the stored pixels of a view under a rectangle, their weights summing to one.
    fn rectangle_taps(&self, view: &View, low: DVec2, high: DVec2, taps: &mut Vec<Tap>) {
        let scale = 1.0 / ((high.x - low.x) * (high.y - low.y));
        let ([x0, y0], [width, height]) = (view.first(), view.size());
        for (j, tall) in overlaps(low.y, high.y, y0, height) {
            for (i, wide) in overlaps(low.x, high.x, x0, width) {
                taps.push(Tap { index: j * self.stored.width() + i, weight: wide * tall * scale });
            }
        }
    }

    /// The stored pixel for a pixel at the edge of the image circle whose centre is lit but none of whose cells is.
    fn single_tap(&self, aim: &ChiefRaySource<'_>, raster_px: DVec2) -> Option<Tap> {
        self.nearest_index(aim, raster_px).map(|index| Tap { index, weight: 1.0 })
    }

    fn nearest_index(&self, aim: &ChiefRaySource<'_>, raster_px: DVec2) -> Option<usize> {
        let direction = aim.direction(self.raster.sensor_mm(raster_px))?;
        let view = self.stored.view(direction)?;
        let px = view.px(direction)?;
        let [low, high] = view.bounds();
        let px = px.floor().clamp(low, high - 1.0);
        Some(px.y as usize * self.stored.width() + px.x as usize)
    }
}

/// Refuses a sensor image that needs directions outside the stored image.
fn check_covers(stored: &PupilProjection, survey: &Survey) -> Result<(), OpticsError> {
    let mut worst: Option<(f64, OpticsError)> = None;
    for sample in &survey.samples {
        let Err(error) = stored.check_holds(sample.direction) else { continue };
        let missing_rad =
            if let OpticsError::MissingDirections { missing_rad, .. } = &error { *missing_rad } else { 0.0 };
        if worst.as_ref().is_none_or(|(maximum, _)| missing_rad > *maximum) {
            worst = Some((missing_rad, error));
        }
    }
    worst.map_or(Ok(()), |(_, error)| Err(error))
}

/// The upright rectangle (px of the stored image) of a cell in a view that shows its centre: its second moments about it.
fn footprint(view: &View, corners: [DVec3; 4], middle: DVec3) -> Option<[DVec2; 2]> {
    let middle = view.px(middle)?;
    let [a, b, c, d] = corners.map(|corner| view.px(corner));
    let (centre, size) = if let [Some(a), Some(b), Some(c), Some(d)] = [a, b, c, d] {
        let (across, down) = (0.5 * ((b - a) + (d - c)), 0.5 * ((c - a) + (d - b)));
        let moment = |x: f64, y: f64| (x * x + y * y).sqrt().max(MIN_PX);
        (0.25 * ((a + d) + (b + c)), DVec2::new(moment(across.x, down.x), moment(across.y, down.y)))
    } else {
        // A cell of a right angle or more.
        (middle, DVec2::splat(MIN_PX))
    };
    Some([centre - 0.5 * size, centre + 0.5 * size])
}

/// The pixels from `first` on, `count` of them, that the interval [low, high] touches, with the length in each. Edge pixels stand for what lies
/// beyond (rounding only: the sensor image lies inside).
fn overlaps(low: f64, high: f64, first: usize, count: usize) -> impl Iterator<Item = (usize, f64)> {
    let index = move |p: f64| (p.floor().max(first as f64) as usize).min(first + count - 1);
    let (start, end) = (index(low), index(high));
    (start..=end).map(move |i| {
        let from = if i == start { low } else { i as f64 };
        let to = if i == end { high } else { (i + 1) as f64 };
        (i, to - from)
    })
}

fn weighted(plane: &Plane<Radiance>, taps: &[Tap], fraction: f64) -> f32 {
    let samples = plane.samples();
    (taps.iter().map(|tap| f64::from(samples[tap.index]) * tap.weight).sum::<f64>() * fraction) as f32
}
