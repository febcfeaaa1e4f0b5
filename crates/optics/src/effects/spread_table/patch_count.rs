//! How many patches functions over the field need.

use etendue_projection::Raster;
use glam::{DMat2, DVec2};

/// Where a function's light lies about its point, mm and mm².
#[derive(Clone, Copy)]
pub(super) struct Shape {
    pub(super) centroid: DVec2,
    pub(super) moments: DMat2,
}

/// The most across, where nothing is said.
const MOST: usize = 11;
/// By how much second moments midway between patches may be off: of their sum, and px².
const RELATIVE: f64 = 0.005;
const ABSOLUTE_PX2: f64 = 0.005;
/// And the centroid: of the root of that sum, and px.
const RELATIVE_CENTROID: f64 = 0.01;
const CENTROID_PX: f64 = 0.01;

/// As few patches as keep centroid and second moments (by the place on the sensor, mm) between them, odd numbers, so that one stands in the middle; and
/// whether the most do.
pub(super) fn patches_needed(picture: &Raster, shape: impl Fn(DVec2) -> Shape) -> ([usize; 2], bool) {
    let mut counts = (1..=MOST).step_by(2).map(|across| [across, down(across, picture)]);
    let kept = |counts: &[usize; 2]| keeps_shapes(*counts, picture, &shape);
    counts.find(kept).map_or(([MOST, down(MOST, picture)], false), |counts| (counts, true))
}

/// Whether centroids and second moments at patches and midway between them are near those of the mean of the nearest patches.
pub(super) fn keeps_shapes([across, down]: [usize; 2], picture: &Raster, shape: impl Fn(DVec2) -> Shape) -> bool {
    let size = DVec2::new(picture.width() as f64, picture.height() as f64);
    let at = |x: f64, y: f64| shape(picture.sensor_mm(size * DVec2::new(x, y)));
    let rows = stations(down);
    stations(across).into_iter().all(|(x, columns)| {
        rows.iter().all(|(y, rows)| {
            let around = columns.iter().flat_map(|x| rows.iter().map(|y| at(*x, *y)));
            let none = Shape { centroid: DVec2::ZERO, moments: DMat2::ZERO };
            let mean = around.fold(none, |sum, one| Shape {
                centroid: sum.centroid + one.centroid * 0.25,
                moments: sum.moments + one.moments * 0.25,
            });
            is_near(&at(x, *y), &mean, picture)
        })
    })
}

/// Places along an axis, as shares of its length, each with the two patches that its pixels are between: those of patches and midway between them; of a single one,
/// which holds from edge to edge, the edges and the middle.
fn stations(count: usize) -> Vec<(f64, [f64; 2])> {
    if count == 1 {
        return [0.0, 0.5, 1.0].map(|place| (place, [0.5; 2])).to_vec();
    }
    let share = |half_steps: usize| half_steps as f64 / (2 * (count - 1)) as f64;
    (0..2 * count - 1).map(|i| (share(i), [i - i % 2, i + i % 2].map(share))).collect()
}

fn is_near(wanted: &Shape, found: &Shape, picture: &Raster) -> bool {
    let off = found.moments - wanted.moments;
    let pixel_mm = picture.pitch_mm().min_element();
    let trace = wanted.moments.x_axis.x + wanted.moments.y_axis.y;
    let most = RELATIVE * trace + ABSOLUTE_PX2 * pixel_mm * pixel_mm;
    let aside = (found.centroid - wanted.centroid).length();
    let is_in_place = aside <= RELATIVE_CENTROID * trace.sqrt() + CENTROID_PX * pixel_mm;
    is_in_place && off.to_cols_array().into_iter().all(|v| v.abs() <= most)
}

/// Patches down for so many across: about square, an odd number.
fn down(across: usize, picture: &Raster) -> usize {
    let aspect = picture.height() as f64 * picture.pitch_mm().y / (picture.width() as f64 * picture.pitch_mm().x);
    let half = 0.5 * (across - 1) as f64 * aspect;
    1 + 2 * (half.ceil() as usize).min((MOST - 1) / 2)
}
