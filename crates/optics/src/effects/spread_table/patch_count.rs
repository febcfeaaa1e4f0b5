//! How many patches functions over the field need.

use etendue_projection::Raster;
use glam::{DMat2, DVec2};

/// The most across, where nothing is said.
const MOST: usize = 11;
/// By how much second moments midway between patches may be off: of their sum, and px².
const RELATIVE: f64 = 0.005;
const ABSOLUTE_PX2: f64 = 0.005;

/// As few patches as keep second moments (mm², by the place on the sensor, mm) between them; odd numbers, so that one stands in the middle.
pub(super) fn patches_needed(picture: &Raster, moments: impl Fn(DVec2) -> DMat2) -> [usize; 2] {
    let mut counts = (1..=MOST).step_by(2).map(|across| [across, down(across, picture)]);
    let kept = |counts: &[usize; 2]| keeps_moments(*counts, picture, &moments);
    counts.find(kept).unwrap_or([MOST, down(MOST, picture)])
}

/// Whether the mean of neighbours' second moments is near that of the place midway between them.
fn keeps_moments([across, down]: [usize; 2], picture: &Raster, moments: impl Fn(DVec2) -> DMat2) -> bool {
    let size = DVec2::new(picture.width() as f64, picture.height() as f64);
    if across == 1 {
        let here = moments(picture.sensor_mm(0.5 * size));
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|corner| picture.sensor_mm(size * corner));
        return corners.into_iter().all(|corner| is_near(moments(corner), here, picture));
    }
    // Halves of the steps from patch to patch.
    let at = |x: usize, y: usize| {
        let share = |index: usize, count: usize| if count > 1 { index as f64 / (2 * (count - 1)) as f64 } else { 0.5 };
        picture.sensor_mm(size * DVec2::new(share(x, across), share(y, down)))
    };
    (0..2 * across - 1).all(|x| {
        (0..2 * down - 1).all(|y| {
            let sides = |index: usize| if index % 2 == 1 { [index - 1, index + 1] } else { [index, index] };
            let around = sides(x).into_iter().flat_map(|x| sides(y).map(|y| moments(at(x, y))));
            let mean = around.fold(DMat2::ZERO, |sum, moments| sum + moments * 0.25);
            is_near(moments(at(x, y)), mean, picture)
        })
    })
}

fn is_near(wanted: DMat2, found: DMat2, picture: &Raster) -> bool {
    let off = found - wanted;
    let pixel_mm = picture.pitch_mm().min_element();
    let most = RELATIVE * (wanted.x_axis.x + wanted.y_axis.y) + ABSOLUTE_PX2 * pixel_mm * pixel_mm;
    off.to_cols_array().into_iter().all(|v| v.abs() <= most)
}

/// Patches down for so many across: about square, an odd number.
fn down(across: usize, picture: &Raster) -> usize {
    let aspect = picture.height() as f64 * picture.pitch_mm().y / (picture.width() as f64 * picture.pitch_mm().x);
    let half = 0.5 * (across - 1) as f64 * aspect;
    1 + 2 * (half.ceil() as usize).min((MOST - 1) / 2)
}
