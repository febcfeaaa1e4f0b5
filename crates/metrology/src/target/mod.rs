//! Detection of charts of points in an image.
//!
//! | chart | points | accuracy in a sharp image | file |
//! | --- | --- | --- | --- |
//! | checkerboard | inner corners | 0.02 px | `checkerboard.rs`, on `chess.rs`, `crossing.rs` |
//! | dots: discs, dark or bright | centroids | 0.01 px | `dots.rs`, on `threshold.rs`, `centroid.rs` |
//!
//! Both are arranged in rows and columns (`lattice.rs`), robust to perspective and strong distortion. Points and their numbers
//! come only from the image: neither the chart's size nor the lens is needed. The image should be linear in light (a display
//! encoding shifts the edges of dots, not the corners of squares).
//!
//! A staggered grid of discs is a square grid rotated by 45°: its steps are the distances of nearest neighbours.
//!
//! Three missing dots determine the orientation of a chart of dots (`grid.rs`).
//!
//! Limitations: no charts that number their points (a partly visible grid is detected, but not its position on the chart), no
//! rings.

mod centroid;
mod checkerboard;
mod chess;
mod crossing;
mod dots;
mod error;
mod grid;
mod lattice;
mod threshold;

use crate::Image;
use error::MIN_GRID_POINTS;

pub use error::TargetError;
pub use grid::{Grid, Node, Orientation};

/// Kinds of charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Dark and bright squares; its points are the corners of four.
    Checkerboard,
    /// A square grid of discs.
    Dots,
}

/// Description of the chart to detect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TargetQuery {
    /// The kind; `None` for the one with more points.
    pub target: Option<Target>,
    /// Columns and rows of points of the chart, in either order; an image may show fewer, not more.
    pub size: Option<[usize; 2]>,
}

/// Minimum median distance of neighbours. Smaller regular patterns (screens, prints, pins of circuits) are not charts, and such a
/// small chart cannot be measured to hundredths of a pixel.
const MIN_STEP_PX: f64 = 10.0;

/// Detects the chart's points.
///
/// # Errors
/// If there is no such chart.
pub fn find(image: &Image, query: TargetQuery) -> Result<Grid, TargetError> {
    let ((grid, outside), name) = match query.target {
        Some(Target::Checkerboard) => (checkerboard::find(image), "checkerboard"),
        Some(Target::Dots) => (dots::find(image), "grid of dots"),
        None => (either(image), "checkerboard or grid of dots"),
    };
    let grid = checked(grid, query.size, name)?;
    // A third of a chart that its rows do not reach is not a separate chart; nor is a smaller grid next to a complete chart of the
    // stated size.
    let complete =
        query.size.is_some_and(|[columns, rows]| grid.nodes.len() == columns * rows && outside < grid.nodes.len());
    let is_second_chart = outside >= MIN_GRID_POINTS && 3 * outside > grid.nodes.len() && !complete;
    if is_second_chart { Err(TargetError::Several { points: [grid.nodes.len(), outside] }) } else { Ok(grid) }
}

/// The chart with more points; the other is the second one if it is a chart of its own, elsewhere in the image.
fn either(image: &Image) -> (Grid, usize) {
    let (board, dots) = (checkerboard::find(image), dots::find(image));
    let board_first = board.0.nodes.len() >= dots.0.nodes.len();
    let ((grid, outside), (other, _)) = if board_first { (board, dots) } else { (dots, board) };
    let is_separate = !overlap(&grid, &other) && checked(other.clone(), None, "").is_ok();
    (grid, outside.max(if is_separate { other.nodes.len() } else { 0 }))
}

/// True if the bounding rectangles of two grids overlap.
fn overlap(a: &Grid, b: &Grid) -> bool {
    let bounds = |grid: &Grid| {
        let ends = (glam::DVec2::INFINITY, glam::DVec2::NEG_INFINITY);
        grid.nodes.iter().fold(ends, |(low, high), n| (low.min(n.at), high.max(n.at)))
    };
    let ((low, high), (other_low, other_high)) = (bounds(a), bounds(b));
    low.cmple(other_high).all() && other_low.cmple(high).all()
}

fn checked(grid: Grid, stated: Option<[usize; 2]>, target_name: &'static str) -> Result<Grid, TargetError> {
    let min_points = stated.map_or(MIN_GRID_POINTS, |[a, b]| MIN_GRID_POINTS.min(a * b / 2).max(4));
    let best = grid.nodes.len();
    if best < min_points || grid.size.iter().any(|n| *n < 2) {
        return Err(TargetError::None { pattern: target_name, best, least: min_points });
    }
    if grid.filled() < 0.9 {
        return Err(TargetError::Gaps { points: best, size: grid.size });
    }
    let step_px = grid.step_px();
    if step_px < MIN_STEP_PX {
        return Err(TargetError::Small { step_px, least_px: MIN_STEP_PX });
    }
    let larger = |stated: [usize; 2]| grid.size[0] > stated[0] || grid.size[1] > stated[1];
    match stated {
        Some([a, b]) if larger([a, b]) && larger([b, a]) => {
            Err(TargetError::Larger { actual: grid.size, stated: [a, b] })
        }
        _ => Ok(grid),
    }
}
