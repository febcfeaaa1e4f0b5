//! Line distortion: how far rows and columns bow, and how much higher the picture is at its sides.

use crate::Estimate;
use crate::target::Node;
use glam::DVec2;

/// The bow of a row or column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineBow {
    /// Whether it is a row (horizontal), or a column.
    pub is_row: bool,
    /// Its number.
    pub index: usize,
    /// The largest distance of its points from the chord through its ends, in the picture's heights; positive where it bows
    /// towards the centre (pincushion), negative away from it (barrel).
    pub bow: f64,
}

/// Every row and column of at least five points.
pub(super) fn bows(nodes: &[Node], size: [usize; 2], centre: DVec2, height_px: f64) -> Vec<LineBow> {
    let line = |axis: usize, index: usize| {
        let points: Vec<DVec2> = nodes.iter().filter(|n| n.index[axis] == index).map(|n| n.at).collect();
        let bow = bow(&points, centre)? / height_px;
        Some(LineBow { is_row: axis == 1, index, bow })
    };
    let rows = (0..size[1]).filter_map(|i| line(1, i));
    rows.chain((0..size[0]).filter_map(|i| line(0, i))).collect()
}

/// The distance of the first row that reaches from side to side from the last such, at the sides (mean) over that in the middle,
/// less 1: positive for a pincushion. The mean of both sides has no tilt of the chart in it, to first order.
pub(super) fn picture_height(nodes: &[Node], [columns, rows]: [usize; 2]) -> Option<Estimate> {
    let row = |index: usize| {
        let points: Vec<&Node> = nodes.iter().filter(|n| n.index[1] == index).collect();
        let column = |i: usize| points.iter().find(|n| n.index[0] == i).copied();
        Some([column(0)?, column(columns / 2)?, column(columns.checked_sub(1)?)?])
    };
    let whole: Vec<[&Node; 3]> = (0..rows).filter_map(row).collect();
    let (first, last) = (whole.first()?, whole.last()?);
    let [left, middle, right] = [0, 1, 2].map(|i| (last[i].at - first[i].at).length());
    let variance = |i: usize| [first, last].iter().map(|r| r[i].uncertainty_px * r[i].uncertainty_px).sum::<f64>();
    let ratio = 0.5 * (left + right) / middle;
    let relative = (0.25 * (variance(0) + variance(2)) + ratio * ratio * variance(1)).sqrt() / middle;
    (whole.len() > 1 && middle > 0.0).then(|| Estimate::new(ratio - 1.0, relative))
}

/// px; `None` of fewer than five points.
fn bow(points: &[DVec2], centre: DVec2) -> Option<f64> {
    const LEAST: usize = 5;
    let (first, last) = (points.first()?, points.last()?);
    let along = (*last - *first).try_normalize().filter(|_| points.len() >= LEAST)?;
    let offset = |p: &DVec2| along.perp_dot(*p - *first);
    let largest = points.iter().map(offset).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let side = offset(&centre);
    Some(if largest * side >= 0.0 { largest.abs() } else { -largest.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_bows_to_the_centre_is_a_pincushion_s() {
        let arc = |sign: f64| -> Vec<Node> {
            let at = |i: usize| {
                DVec2::new(i as f64 * 10.0, 20.0 + sign * (16.0 - (i as f64 - 4.0) * (i as f64 - 4.0)) / 4.0)
            };
            (0..9).map(|i| Node { index: [i, 0], at: at(i), uncertainty_px: 0.0 }).collect()
        };
        let bow = |sign| bows(&arc(sign), [9, 1], DVec2::new(40.0, 100.0), 200.0)[0].bow;
        assert!((bow(1.0) - 0.02).abs() < 1e-12 && (bow(-1.0) + 0.02).abs() < 1e-12);
    }
}
