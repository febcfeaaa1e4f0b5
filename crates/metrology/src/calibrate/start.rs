//! The first guess: a focal length and the poses that go with it.

use super::pose::Pose;
use super::problem::Bundle;
use crate::fit::Problem;
use etendue_core::maths::f64::exp2;
use etendue_projection::CameraMatrix;

/// All numbers; `None` where no focal length sees the charts.
pub(super) fn guess(bundle: &Bundle<'_>) -> Option<Vec<f64>> {
    // From a sixteenth of the picture's longer side to sixteen of them, by steps of an eighth of an octave.
    const OCTAVES: i32 = 4;
    const STEPS: i32 = 8;
    let longer = bundle.size_px[0].max(bundle.size_px[1]) as f64;
    let scanned = (-OCTAVES * STEPS..=OCTAVES * STEPS).map(|i| longer * exp2(f64::from(i) / f64::from(STEPS)));
    let focals: Vec<f64> = bundle.options.focal_px.map_or_else(|| scanned.collect(), |f| vec![f]);
    let tried = focals.into_iter().filter_map(|f| guess_at(bundle, f));
    let best = tried.fold(None, |best: Option<(f64, Vec<f64>)>, tried| match best {
        Some(best) if best.0 <= tried.0 => Some(best),
        _ => Some(tried),
    });
    best.map(|(_, numbers)| numbers)
}

/// The sum of squared distances and the numbers at a focal length.
fn guess_at(bundle: &Bundle<'_>, focal_px: f64) -> Option<(f64, Vec<f64>)> {
    let principal = bundle.principal();
    let matrix = CameraMatrix { fx: focal_px, fy: focal_px, skew: 0.0, cx: principal.x, cy: principal.y };
    let mut numbers = bundle.numbers(matrix, &bundle.family.first());
    let camera = bundle.calibration(&numbers)?;
    for view in bundle.views {
        let seen = view.points.iter().map(|p| Some((p.chart, camera.unproject(p.at)?)));
        // Beyond the guess's field nothing is known yet.
        let known: Vec<_> = seen.flatten().collect();
        if 2 * known.len() < view.points.len() {
            return None;
        }
        let pose = Pose::direct(&known)?;
        numbers.extend(pose.numbers());
    }
    let placed = bundle.state(&numbers)?;
    let all = (0..bundle.blocks()).map(|v| bundle.residuals(&placed, v));
    let squares: f64 = all.collect::<Option<Vec<_>>>()?.iter().flatten().map(|r| r * r).sum();
    squares.is_finite().then_some((squares, numbers))
}
