//! Which way a chart of dots is seen, by the three dots that are left out of it.
//!
//! One, one three steps from it along one direction of the grid, and one two steps from it along the other: as the chart is printed these are to the right and below
//! (`etendue chart dots`). Turned pictures turn both; in mirrored ones they change their hand. A dot is missing where its four neighbours are there and it is not; more or fewer than three
//! such gaps, or three in another form, are no marks: charts without them say nothing.

use super::Grid;

/// Steps from the first mark to the others.
const LEGS: [i64; 2] = [3, 2];

/// How a picture shows a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// By how many quarters of a turn, clockwise in the picture: 0 to 3. Of a mirrored picture, after it was mirrored left to right.
    pub quarters: u8,
    /// Whether it is mirrored.
    pub mirrored: bool,
}

impl Grid {
    /// Which way the chart is seen; `None` where its marks are not.
    #[must_use]
    pub fn orientation(&self) -> Option<Orientation> {
        let gaps = self.gaps();
        let [_, _, _] = gaps[..] else { return None };
        let leg = |from: [i64; 2], steps: i64| {
            gaps.iter().find_map(|gap| {
                let [x, y] = [gap[0] - from[0], gap[1] - from[1]];
                (x * y == 0 && x.abs() + y.abs() == steps).then_some([x.signum(), y.signum()])
            })
        };
        let legs = |from: &[i64; 2]| Some([leg(*from, LEGS[0])?, leg(*from, LEGS[1])?]);
        let [long, short] = gaps.iter().find_map(legs)?;
        let hand = long[0] * short[1] - long[1] * short[0];
        if hand == 0 {
            return None;
        }
        let mirrored = hand < 0;
        // To the right as printed, to the left where mirrored; then clockwise with y down.
        let turned = if mirrored { [-long[0], -long[1]] } else { long };
        let quarters = [[1, 0], [0, 1], [-1, 0], [0, -1]].iter().position(|way| *way == turned)? as u8;
        Some(Orientation { quarters, mirrored })
    }

    /// Places without a point between four that have one.
    fn gaps(&self) -> Vec<[i64; 2]> {
        let inside = |axis: usize| 1..self.size[axis].saturating_sub(1);
        let around = |[x, y]: [usize; 2]| [[x - 1, y], [x + 1, y], [x, y - 1], [x, y + 1]];
        let is_gap =
            |at: &[usize; 2]| self.node(*at).is_none() && around(*at).iter().all(|near| self.node(*near).is_some());
        let places = inside(1).flat_map(|y| inside(0).map(move |x| [x, y]));
        places.filter(is_gap).map(|at| at.map(|i| i as i64)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::Node;
    use glam::DVec2;

    /// A grid of 12 × 10 without the marks, each place moved to another.
    fn seen(size: [usize; 2], gaps: &[[usize; 2]], moved: impl Fn([usize; 2]) -> [usize; 2]) -> Grid {
        let mut nodes: Vec<Node> = (0..120)
            .map(|i| [i % 12, i / 12])
            .filter(|at| !gaps.contains(at))
            .map(|at| Node { index: moved(at), at: DVec2::ZERO, uncertainty_px: 0.0 })
            .collect();
        nodes.sort_by_key(|n| [n.index[1], n.index[0]]);
        Grid { nodes, size, disc_radius_steps: None }
    }

    #[test]
    fn marks_tell_how_a_chart_is_seen() {
        let marks = [[3, 4], [6, 4], [3, 6]];
        let of = |size, moved: fn([usize; 2]) -> [usize; 2]| seen(size, &marks, moved).orientation();
        let told = |quarters, mirrored| Some(Orientation { quarters, mirrored });
        assert_eq!(of([12, 10], |at| at), told(0, false));
        assert_eq!(of([10, 12], |[x, y]| [9 - y, x]), told(1, false));
        assert_eq!(of([12, 10], |[x, y]| [11 - x, 9 - y]), told(2, false));
        assert_eq!(of([10, 12], |[x, y]| [y, 11 - x]), told(3, false));
        assert_eq!(of([12, 10], |[x, y]| [11 - x, y]), told(0, true));
        assert_eq!(of([12, 10], |[x, y]| [x, 9 - y]), told(2, true));
        assert!(of([10, 12], |[x, y]| [y, x]).is_some_and(|o| o.mirrored));
    }

    #[test]
    fn other_gaps_are_no_marks() {
        let of = |gaps: &[[usize; 2]]| seen([12, 10], gaps, |at| at).orientation();
        assert_eq!(of(&[]), None);
        assert_eq!(of(&[[3, 4], [6, 4]]), None);
        assert_eq!(of(&[[3, 4], [6, 4], [3, 7]]), None);
        assert_eq!(of(&[[3, 4], [6, 4], [3, 6], [8, 8]]), None);
        assert_eq!(of(&[[3, 4], [6, 4], [1, 4]]), None);
    }
}
