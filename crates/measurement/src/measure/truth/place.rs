//! Positions of a chart's ground truth in an image: patches and spokes, squares inside and next to outlines, and the orientation
//! of the chart.
//!
//! Detects whether an image shows a chart as its camera sees it, or mirrored, turned, or another chart.
//!
//! The criterion is the rank correlation (Spearman 1904) of the patches' readings with their luminances, which is independent of
//! the tone curve. If the positions of the ground truth give less than 0.9, and those of a mirrored or turned image 0.9 or more,
//! the image is one of these. If they give less than 0.6, and none of those is better, it shows something else. (With half of the
//! patches saturated the correlation is 0.87.) Fewer than four patches, or readings that are all equal, give no result.

use etendue_charts::shape::{bounds, centroid};
use etendue_metrology::sfr::Strip;
use glam::DVec2;

use super::Readings;

/// A patch in the image.
#[derive(Clone, Debug)]
pub(crate) struct PatchPlace {
    pub name: String,
    /// Left column, top row, width, height, of the image.
    pub at: [usize; 4],
    /// Its luminance, cd/m².
    pub luminance_cd_m2: f64,
    /// CIE XYZ, with Y = 1 for the perfect diffuser.
    pub xyz: [f64; 3],
}

/// A star in the image: its centre, and the edges of its ground and of itself.
pub(crate) struct StarPlace {
    pub centre_px: [f64; 2],
    pub cycles: u32,
    pub inner_px: f64,
    pub outer_px: f64,
}

/// A light trap and the white around it.
pub(crate) struct TrapPlace {
    pub trap: [usize; 4],
    pub whites: Vec<[usize; 4]>,
}

/// An edge of a star with its neighbours.
pub(crate) struct Spoke {
    pub strip: Strip,
    pub star: StarCentre,
}

/// A star: its index, and its centre in the image.
#[derive(Clone, Copy, PartialEq)]
pub(crate) struct StarCentre {
    pub index: [usize; 2],
    pub centre_px: [f64; 2],
}

/// An edge and the region in which to search for it.
pub(crate) struct EdgeRegion {
    /// Left column, top row, width, height, of the image.
    pub at: [usize; 4],
    pub spoke: Option<Spoke>,
}

/// Starting positions of the search along each side of an outline's bounds, and the step that ends it, px.
const LATTICE: usize = 16;
const EXACT_PX: f64 = 0.02;

/// The largest upright square inside an outline: its centre and half its side.
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
        let around = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|direction| at(best.0 + step * direction));
        let better = around.into_iter().fold(best, more);
        if better.1 > best.1 {
            best = better;
        } else {
            step *= 0.5;
        }
    }
    best
}

/// Half the side of the largest square around a position inside an outline; 0 outside.
fn half_side(outline: &[DVec2], place: DVec2) -> f64 {
    let sides = || outline.iter().zip(outline.iter().cycle().skip(1)).map(|(a, b)| (*a - place, *b - place));
    // Sides that a ray to the right crosses: an odd number if the point is inside.
    let crosses = |(a, b): &(DVec2, DVec2)| (a.y > 0.0) != (b.y > 0.0) && a.x + (b.x - a.x) * a.y / (a.y - b.y) > 0.0;
    let within = sides().filter(crosses).count() % 2 == 1;
    if within { sides().map(|(a, b)| reach(a, b)).fold(f64::INFINITY, f64::min) } else { 0.0 }
}

/// Minimum of max(|x|, |y|) on a side: at one of its ends or on a diagonal.
fn reach(a: DVec2, b: DVec2) -> f64 {
    let run = b - a;
    let on = |numerator: f64, denominator: f64| (numerator / denominator).clamp(0.0, 1.0);
    let limits = [0.0, 1.0, on(a.x - a.y, run.y - run.x), on(-a.x - a.y, run.x + run.y)];
    let far = |t: f64| (a + t * run).abs().max_element();
    limits.into_iter().filter(|t| t.is_finite()).map(far).fold(f64::INFINITY, f64::min)
}

/// Squares next to a round opening, midway to its neighbours in the four directions, clear of both by a third of the gap.
pub(crate) fn squares_beside(outline: &[DVec2], opening: f64, pitch: f64) -> Vec<(DVec2, f64)> {
    let (low, high) = bounds(outline);
    let (middle, reach) = (0.5 * (low + high), 0.5 * (high - low));
    let away = reach * pitch / opening;
    let half = (away - reach).min_element() * 2.0 / 3.0;
    [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y].map(|direction| (middle + away * direction, half)).to_vec()
}

/// Minimum rank correlation of an agreement, and maximum of another chart.
const MIN_RANK_CORRELATION: f64 = 0.9;
const MAX_OTHER_CORRELATION: f64 = 0.6;
/// Minimum number of patches for a result.
const MIN_PATCHES: usize = 4;

/// Position of a part of the image in a mirrored or turned image, both of one size.
type RegionTransform = fn([usize; 4], (usize, usize)) -> [usize; 4];

/// Transformation of an image, as text, and its remedy. Those that exchange columns and rows apply to square images only; others
/// no longer have their size.
const UPRIGHT: [(&str, RegionTransform); 3] = [
    ("mirrored left to right", |[x, y, w, h], (width, _)| [width - x - w, y, w, h]),
    ("mirrored top to bottom", |[x, y, w, h], (_, height)| [x, height - y - h, w, h]),
    ("rotated by 180°", |[x, y, w, h], (width, height)| [width - x - w, height - y - h, w, h]),
];
const SQUARE: [(&str, RegionTransform); 4] = [
    ("rotated by 90° clockwise", |[x, y, w, h], (width, _)| [width - y - h, x, h, w]),
    ("rotated by 90° anticlockwise", |[x, y, w, h], (_, height)| [y, height - x - w, h, w]),
    ("mirrored about its diagonal", |[x, y, w, h], _| [y, x, h, w]),
    ("mirrored about its other diagonal", |[x, y, w, h], (width, height)| [width - y - h, height - x - w, h, w]),
];

/// Error of an image of these patches; `None` if it is correct or cannot be decided.
pub(super) fn orientation_error(patches: &[PatchPlace], readings: &Readings) -> Option<String> {
    if patches.len() < MIN_PATCHES {
        return None;
    }
    let size = readings.picture_px;
    let agreement = |turned: &dyn Fn([usize; 4]) -> [usize; 4]| {
        let mean = |patch: &PatchPlace| {
            let part = readings.part(turned(patch.at), "a patch").ok()?;
            Some(part.samples().iter().map(|s| f64::from(*s)).sum::<f64>() / part.samples().len() as f64)
        };
        let means: Vec<f64> = patches.iter().map(mean).collect::<Option<_>>()?;
        correlation(&ranks(&means), &ranks(&patches.iter().map(|p| p.luminance_cd_m2).collect::<Vec<_>>()))
    };
    let own = agreement(&|at| at)?;
    if own >= MIN_RANK_CORRELATION {
        return None;
    }
    let square = if size.0 == size.1 { &SQUARE[..] } else { &[] };
    let others = UPRIGHT
        .iter()
        .chain(square)
        .filter_map(|(words, transform)| Some((words, agreement(&|at| transform(at, size))?)));
    let best = others.reduce(|a, b| if b.1 > a.1 { b } else { a });
    match best {
        Some((words, other)) if other >= MIN_RANK_CORRELATION => Some(format!(
            "is {words}: only then do its readings increase with the luminances of the chart's ground truth; give the image as captured"
        )),
        _ if own < MAX_OTHER_CORRELATION => Some(
            "does not show this chart: its readings at the patches do not increase with the luminances of the chart's ground \
             truth; give the image of this chart"
                .to_owned(),
        ),
        _ => None,
    }
}

/// Ranks; equal values have their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let below = |v: f64| values.iter().filter(|other| **other < v).count() as f64;
    let ties = |v: f64| values.iter().filter(|other| **other == v).count() as f64;
    values.iter().map(|v| below(*v) + 0.5 * (ties(*v) - 1.0)).collect()
}

/// `None` if one of them is constant or not a number.
fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let sum = |f: &dyn Fn(f64, f64) -> f64| a.iter().zip(b).map(|(x, y)| f(x - mean_a, y - mean_b)).sum::<f64>();
    let (aa, bb, ab) = (sum(&|x, _| x * x), sum(&|_, y| y * y), sum(&|x, y| x * y));
    (aa > 0.0 && bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_fill_their_outlines() {
        let tilted = [DVec2::new(10.0, 0.0), DVec2::new(20.0, 10.0), DVec2::new(10.0, 20.0), DVec2::new(0.0, 10.0)];
        let (middle, half) = largest_square(&tilted);
        // A square on its corner with half diagonal 10: half a side of 5.
        assert!((half - 5.0).abs() < 1e-9 && (middle - 10.0).length() < 0.1, "{middle} {half}");
        let corner = [[0.0, 0.0], [30.0, 0.0], [30.0, 8.0], [8.0, 8.0], [8.0, 30.0], [0.0, 30.0]].map(DVec2::from);
        let (middle, half) = largest_square(&corner);
        assert!((half - 4.0).abs() < 0.05 && half_side(&corner, DVec2::splat(20.0)) == 0.0, "{middle} {half}");
    }

    #[test]
    fn white_lies_between_traps() {
        let trap = [[90.0, 100.0], [100.0, 90.0], [110.0, 100.0], [100.0, 110.0]].map(DVec2::from);
        let whites = squares_beside(&trap, 20.0, 80.0);
        // Traps of radius 10 at steps of 80: 40 away, 30 from either opening.
        assert_eq!(whites[0], (DVec2::new(140.0, 100.0), 20.0));
    }

    #[test]
    fn ranks_of_equal_values_are_their_mean() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 0.0]), [2.5, 1.0, 2.5, 0.0]);
        assert_eq!(correlation(&[0.0, 1.0, 2.0], &[4.0, 2.0, 0.0]), Some(-1.0));
        assert_eq!(correlation(&[1.0, 1.0], &[0.0, 1.0]), None);
    }

    /// A pixel and its position in each turned image: the texts name the transformation of the images.
    #[test]
    fn places_are_those_of_the_turned_picture() {
        let at = |words: &str| {
            let all = UPRIGHT.iter().chain(&SQUARE).find(|(other, _)| *other == words).expect("known");
            (all.1)([1, 2, 3, 4], (20, 20))
        };
        assert_eq!(at("mirrored left to right"), [16, 2, 3, 4]);
        // Clockwise: the top row becomes the last column.
        assert_eq!(at("rotated by 90° clockwise"), [14, 1, 4, 3]);
        assert_eq!(at("rotated by 90° anticlockwise"), [2, 16, 4, 3]);
    }
}
