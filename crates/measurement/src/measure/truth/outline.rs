//! Squares in and beside outlines, picture coordinates.

use etendue_charts::shape::{bounds, centroid};
use glam::DVec2;

/// Places along each side of an outline's bounds at which the search begins, and the step that ends it, px.
const LATTICE: usize = 16;
const EXACT_PX: f64 = 0.02;

/// The largest upright square within an outline: its middle and half its side.
pub(crate) fn largest_square(outline: &[DVec2]) -> (DVec2, f64) {
    let (low, high) = bounds(outline);
    let cell = (high - low) / LATTICE as f64;
    let places = (0..LATTICE * LATTICE).map(|i| DVec2::new((i % LATTICE) as f64, (i / LATTICE) as f64) + 0.5);
    let starts = std::iter::once(centroid(outline)).chain(places.map(|at| low + at * cell));
    let more = |a: (DVec2, f64), b: (DVec2, f64)| if b.1 > a.1 { b } else { a };
    let at = |place: DVec2| (place, half_side(outline, place));
    let mut best = starts.map(at).fold((low, 0.0), more);
    let mut step = cell.max_element();
    while step > EXACT_PX {
        let around = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|way| at(best.0 + step * way));
        let better = around.into_iter().fold(best, more);
        if better.1 > best.1 {
            best = better;
        } else {
            step *= 0.5;
        }
    }
    best
}

/// Half the side of the largest square about a place within an outline; 0 outside.
fn half_side(outline: &[DVec2], place: DVec2) -> f64 {
    let sides = || outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| (*a - place, *b - place));
    // Sides that a ray to the right crosses: an odd number from within.
    let crosses = |(a, b): &(DVec2, DVec2)| (a.y > 0.0) != (b.y > 0.0) && a.x + (b.x - a.x) * a.y / (a.y - b.y) > 0.0;
    let within = sides().filter(crosses).count() % 2 == 1;
    if within { sides().map(|(a, b)| reach(a, b)).fold(f64::INFINITY, f64::min) } else { 0.0 }
}

/// The least of max(|x|, |y|) on a side: at one of its ends or on a diagonal.
fn reach(a: DVec2, b: DVec2) -> f64 {
    let run = b - a;
    let on = |numerator: f64, denominator: f64| (numerator / denominator).clamp(0.0, 1.0);
    let shares = [0.0, 1.0, on(a.x - a.y, run.y - run.x), on(-a.x - a.y, run.x + run.y)];
    let far = |t: f64| (a + t * run).abs().max_element();
    shares.into_iter().filter(|t| t.is_finite()).map(far).fold(f64::INFINITY, f64::min)
}

/// Squares beside a round opening, midway to its neighbours in the four directions, clear of both by a third of what lies between.
pub(crate) fn beside(outline: &[DVec2], opening: f64, pitch: f64) -> Vec<(DVec2, f64)> {
    let (low, high) = bounds(outline);
    let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
    let away = reach * pitch / opening;
    let half = (away - reach).min_element() * 2.0 / 3.0;
    [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|way| (middle + away * way, half)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_fill_their_outlines() {
        let tilted = [DVec2::new(10.0, 0.0), DVec2::new(20.0, 10.0), DVec2::new(10.0, 20.0), DVec2::new(0.0, 10.0)];
        let (middle, half) = largest_square(&tilted);
        // In a square on its corner of half diagonal 10: half a side of 5.
        assert!((half - 5.0).abs() < 1e-9 && (middle - 10.0).length() < 0.1, "{middle} {half}");
        let corner = [[0.0, 0.0], [30.0, 0.0], [30.0, 8.0], [8.0, 8.0], [8.0, 30.0], [0.0, 30.0]].map(DVec2::from);
        let (middle, half) = largest_square(&corner);
        assert!((half - 4.0).abs() < 0.05 && half_side(&corner, DVec2::splat(20.0)) == 0.0, "{middle} {half}");
    }

    #[test]
    fn white_lies_between_traps() {
        let trap = [[90.0, 100.0], [100.0, 90.0], [110.0, 100.0], [100.0, 110.0]].map(DVec2::from);
        let whites = beside(&trap, 20.0, 80.0);
        // Traps of radius 10 at steps of 80: 40 away, 30 from either opening.
        assert_eq!(whites[0], (DVec2::new(140.0, 100.0), 20.0));
    }
}
