//! Checkerboards: the corners of four squares.
//!
//! Candidates come from [`chess`], in the image and in copies of half, a quarter and an eighth of its size (in which defocused
//! corners look sharp). They are refined ([`chess::refine_corner`]), linked if the line between two has a dark and a bright side along
//! its whole length, and grown to a lattice. The copy with the most corners is used, and each corner is refined in the image
//! itself by a model of it ([`crossing`]), over a disc of 0.4 of the distance to its nearest neighbour, 3 to 12 px.

use etendue_stats::upper_median;
use glam::DVec2;
use rayon::prelude::*;

use super::crossing::{self, Corner};
use super::lattice::{self, PointCells, PointMap};
use super::{Grid, MIN_GRID_POINTS, chess};
use crate::Image;

/// Radius of the window, relative to the distance to the nearest neighbour, and its limits, px.
const WINDOW: f64 = 0.4;
const WINDOW_PX: [f64; 2] = [3.0, 12.0];

/// The largest board of an image, of any size, and the number of points of the second largest.
pub(super) fn find(image: &Image) -> (Grid, usize) {
    const COPIES: usize = 4;
    let mut best = ((PointMap::new(), 0), Vec::new());
    let mut copy = image.clone();
    for level in 0..COPIES {
        let scale = f64::from(1_u32 << level);
        let (places, points) = board(&copy);
        if places.0.len() > best.0.0.len() {
            best = (places, points.iter().map(|p| *p * scale).collect());
        }
        copy = halved(&copy);
    }
    let ((places, outside), mut points) = best;
    let refined = refine(image, &places, &points);
    let connected = without_stragglers(places.into_iter().filter(|(_, i)| refined[*i].is_some()).collect());
    points.iter_mut().zip(&refined).for_each(|(p, r)| *p = r.map_or(*p, |r| r.at));
    let uncertainties: Vec<f64> = refined.iter().map(|r| r.map_or(f64::INFINITY, |r| r.uncertainty_px)).collect();
    (Grid::from_places(&connected, &points, &uncertainties), outside)
}

/// Removes outer rows and columns with one point, or less than a fifth of the longest: false corners beyond the board, where its
/// border meets the surroundings.
fn without_stragglers(mut places: PointMap) -> PointMap {
    const MAX_LENGTH_RATIO: usize = 5;
    loop {
        let sparse_line = (0..2).find_map(|axis| {
            let count = |line: i32| places.keys().filter(|p| p[axis] == line).count();
            let lines = || places.keys().map(|p| p[axis]);
            let (low, high) = (lines().min()?, lines().max()?);
            let longest = (low..=high).map(count).max()?;
            let few = |line: &i32| count(*line) < 2.max(longest.div_ceil(MAX_LENGTH_RATIO));
            [low, high].into_iter().find(|line| longest > 1 && few(line)).map(|line| (axis, line))
        });
        match sparse_line {
            Some((axis, line)) => places.retain(|p, _| p[axis] != line),
            None => return places,
        }
    }
}

fn board(image: &Image) -> ((PointMap, usize), Vec<DVec2>) {
    // Less contrast than a twentieth of the image's is not a square of a board.
    let min_response = 0.05 * contrast(image);
    let rough = chess::candidates(image, min_response);
    let radius = chess::RING_PX as f64;
    let points: Vec<DVec2> = rough
        .iter()
        .filter_map(|[x, y]| chess::refine_corner(image, DVec2::new(*x as f64 + 0.5, *y as f64 + 0.5), radius, 3.0))
        .collect();
    let points = single(points);
    let linked = |a: usize, b: usize| is_edge(image, points[a], points[b], min_response);
    let places = lattice::largest(&points, MIN_GRID_POINTS, &linked);
    (places, points)
}

/// Removes duplicate points.
fn single(points: Vec<DVec2>) -> Vec<DVec2> {
    let neighbours = PointCells::new(&points);
    let first = |i: &usize| neighbours.within(points[*i], 1.5).iter().all(|j| j >= i);
    (0..points.len()).filter(first).map(|i| points[i]).collect()
}

/// The difference of the image's 2nd and 98th percentile, over every 7th pixel.
fn contrast(image: &Image) -> f32 {
    let mut values: Vec<f32> = image.samples().iter().step_by(7).copied().collect();
    if values.len() < 2 {
        return 0.0;
    }
    let (low, high) = (values.len() / 50, values.len() - 1 - values.len() / 50);
    let high = *values.select_nth_unstable_by(high, f32::total_cmp).1;
    let low = *values.select_nth_unstable_by(low, f32::total_cmp).1;
    high - low
}

/// True if the line from a to b has a bright and a dark side, the same along its whole length.
fn is_edge(image: &Image, a: DVec2, b: DVec2, min_response: f32) -> bool {
    let along = b - a;
    let side_offset = along.perp() * 0.15;
    let difference =
        |t: f64| Some(sample(image, a + along * t + side_offset)? - sample(image, a + along * t - side_offset)?);
    let all: Option<Vec<f32>> = [0.25, 0.5, 0.75].into_iter().map(difference).collect();
    all.is_some_and(|d| d.iter().all(|d| *d > 0.5 * min_response) || d.iter().all(|d| *d < -0.5 * min_response))
}

/// The pixel at a position; `None` outside.
fn sample(image: &Image, at: DVec2) -> Option<f32> {
    let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < image.width() as f64 && at.y < image.height() as f64;
    inside.then(|| image.at(at.x as usize, at.y as usize))
}

/// Refines each placed point in the image itself; `None` if that fails. If the disc extends beyond a narrow outer square, or
/// there is no corner, the uncertainty is an outlier: half the radius is tried, and remaining outliers are dropped.
fn refine(image: &Image, places: &PointMap, points: &[DVec2]) -> Vec<Option<Corner>> {
    const OUTLIER_FACTOR: f64 = 3.0;
    const GOOD_PX: f64 = 0.05;
    let placed: Vec<([i32; 2], usize)> = places.iter().map(|(place, i)| (*place, *i)).collect();
    let corners = |window: f64| {
        let find = |(place, i): &([i32; 2], usize)| corner(image, places, points, *place, *i, window);
        placed.par_iter().map(find).collect::<Vec<_>>()
    };
    let wide = corners(WINDOW);
    let typical = upper_median(wide.iter().flatten().map(|c| c.uncertainty_px)).unwrap_or(0.0);
    let is_outlier = |c: &Option<Corner>, factor: f64| {
        c.is_none_or(|c| c.uncertainty_px > factor * (OUTLIER_FACTOR * typical).max(GOOD_PX))
    };
    let mut refined = vec![None; points.len()];
    for ((place, i), wide) in placed.iter().zip(wide) {
        let narrow = || corner(image, places, points, *place, *i, 0.5 * WINDOW).filter(|c| !is_outlier(&Some(*c), 2.0));
        refined[*i] = if is_outlier(&wide, 1.0) { narrow() } else { wide };
    }
    refined
}

fn corner(
    image: &Image,
    places: &PointMap,
    points: &[DVec2],
    place: [i32; 2],
    i: usize,
    window: f64,
) -> Option<Corner> {
    let step = |x: i32, y: i32| {
        let other = places.get(&[place[0] + x, place[1] + y])?;
        Some((points[*other] - points[i]) * f64::from(x + y))
    };
    let across = [step(1, 0), step(-1, 0)];
    let down = [step(0, 1), step(0, -1)];
    let all = || across.iter().chain(&down).flatten();
    let nearest = all().map(|s| s.length()).fold(f64::INFINITY, f64::min);
    let radius = (window * nearest).clamp(WINDOW_PX[0], WINDOW_PX[1]);
    let mean = |steps: [Option<DVec2>; 2]| match steps {
        [Some(a), Some(b)] => Some(0.5 * (a + b)),
        [a, b] => a.or(b),
    };
    let rough = chess::refine_corner(image, points[i], radius, radius)?;
    crossing::fit_corner(image, rough, [mean(across)?, mean(down)?], radius)
}

/// Half the size, by means of four pixels; an odd last row or column is omitted.
fn halved(image: &Image) -> Image {
    let (width, height) = (image.width() / 2, image.height() / 2);
    let samples = image.samples();
    let mut half = Vec::with_capacity(width * height);
    for y in 0..height {
        let row = |dy: usize| &samples[(2 * y + dy) * image.width()..][..2 * width];
        let pairs = row(0).chunks_exact(2).zip(row(1).chunks_exact(2));
        half.extend(pairs.map(|(a, b)| 0.25 * (a[0] + a[1] + b[0] + b[1])));
    }
    Image::from_samples(width, height, half).unwrap_or_else(|| Image::new(0, 0))
}
