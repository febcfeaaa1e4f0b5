//! The points of a chart as detected in an image.
//!
//! Orientation of a chart of dots, from its three missing dots:
//!
//! One is the first mark, one is three steps from it along one direction of the grid, and one two steps from it along the other:
//! as printed, these are to the right and below (`etendue chart dots`). In rotated images both are rotated; in mirrored ones
//! their handedness changes. A dot is missing if its four neighbours exist and it does not. More or fewer than three such gaps,
//! or three in another arrangement, are not marks: charts without marks have no orientation.

use glam::DVec2;

use super::lattice::PointMap;

/// A point of a chart: its column and row, and its position in the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Column and row, from 0.
    pub index: [usize; 2],
    /// Raster coordinates, px.
    pub at: DVec2,
    /// Standard uncertainty of each coordinate due to image noise, px.
    pub uncertainty_px: f64,
}

/// Points of a square grid. Columns count to the right in the image, rows down, from the first visible one: the position of a
/// partly visible grid on its chart is not known.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// The points, row by row.
    pub nodes: Vec<Node>,
    /// Columns and rows between the first and the last point.
    pub size: [usize; 2],
    /// Radius of discs over the step, both on the chart.
    pub disc_radius_steps: Option<f64>,
}

impl Grid {
    /// The point at a column and row.
    #[must_use]
    pub fn node(&self, index: [usize; 2]) -> Option<&Node> {
        let key = |n: &Node| [n.index[1], n.index[0]];
        self.nodes.binary_search_by_key(&[index[1], index[0]], key).ok().map(|i| &self.nodes[i])
    }

    /// The median distance of neighbours in a row or a column, px; 0 if there are none.
    #[must_use]
    pub fn step_px(&self) -> f64 {
        let step_lengths = |n: &Node| {
            let [i, j] = n.index;
            [[i + 1, j], [i, j + 1]].map(|index| self.node(index).map(|other| (other.at - n.at).length()))
        };
        let mut steps: Vec<f64> = self.nodes.iter().flat_map(step_lengths).flatten().collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(0.0)
    }

    /// Mean positions of the points that all of several grids of one chart in one image contain: points are matched to the nearest
    /// within half a step. The uncertainties are treated as independent.
    ///
    /// # Panics
    /// Without a grid.
    #[must_use]
    pub fn mean(grids: &[Self]) -> Self {
        let [first, others @ ..] = grids else { panic!("at least one grid") };
        let reach = 0.5 * first.step_px();
        let mean = |node: &Node| {
            let nearest =
                others.iter().map(|other| other.nearest(node.at).filter(|n| (n.at - node.at).length() < reach));
            let all: Vec<&Node> = std::iter::once(Some(node)).chain(nearest).collect::<Option<_>>()?;
            let count = all.len() as f64;
            let squares: f64 = all.iter().map(|n| n.uncertainty_px * n.uncertainty_px).sum();
            let at = all.iter().map(|n| n.at).sum::<DVec2>() / count;
            Some(Node { at, uncertainty_px: squares.sqrt() / count, ..*node })
        };
        let nodes = first.nodes.iter().filter_map(mean).collect();
        Self { nodes, ..*first }
    }

    /// The point nearest to a position.
    #[must_use]
    pub fn nearest(&self, at: DVec2) -> Option<&Node> {
        let from = |n: &&Node| (n.at - at).length_squared();
        self.nodes.iter().min_by(|a, b| from(a).total_cmp(&from(b)))
    }

    /// The fraction of positions between the first and the last point of each row, and of each column (whichever is less), that
    /// have a point: 1 for a grid without gaps, even if it is cut by the image, or staggered.
    #[must_use]
    pub fn filled(&self) -> f64 {
        let spans = |axis: usize| {
            let mut ends = vec![None::<[usize; 2]>; self.size[1 - axis]];
            for node in &self.nodes {
                let (line, at) = (&mut ends[node.index[1 - axis]], node.index[axis]);
                *line = Some(line.map_or([at; 2], |[first, last]| [first.min(at), last.max(at)]));
            }
            ends.iter().flatten().map(|[first, last]| last - first + 1).sum::<usize>()
        };
        self.nodes.len() as f64 / spans(0).max(spans(1)).max(1) as f64
    }

    /// The grid of a lattice of points, rotated so that columns run to the right and rows down.
    pub(super) fn from_places(places: &PointMap, points: &[DVec2], uncertainties_px: &[f64]) -> Self {
        let to_upright = upright(places, points);
        let upright_places: Vec<([i32; 2], usize)> = places.iter().map(|(place, i)| (to_upright(*place), *i)).collect();
        let low = [0, 1].map(|a| upright_places.iter().map(|(p, _)| p[a]).min().unwrap_or(0));
        let high = [0, 1].map(|a| upright_places.iter().map(|(p, _)| p[a]).max().unwrap_or(0));
        let node = |(place, i): &([i32; 2], usize)| Node {
            index: [0, 1].map(|a| (place[a] - low[a]) as usize),
            at: points[*i],
            uncertainty_px: uncertainties_px[*i],
        };
        let mut nodes: Vec<Node> = upright_places.iter().map(node).collect();
        nodes.sort_by_key(|n| [n.index[1], n.index[0]]);
        Self { nodes, size: [0, 1].map(|a| (high[a] - low[a] + 1) as usize), disc_radius_steps: None }
    }
}

/// The exchange of axes and signs after which columns run most to the right, and rows down.
fn upright(places: &PointMap, points: &[DVec2]) -> impl Fn([i32; 2]) -> [i32; 2] {
    let mean_step = |axis: usize| {
        let steps = places.iter().filter_map(|(place, i)| {
            let mut next = *place;
            next[axis] += 1;
            Some(points[*places.get(&next)?] - points[*i])
        });
        steps.sum::<DVec2>()
    };
    let [a, b] = [mean_step(0), mean_step(1)];
    let fraction = |v: DVec2| v.x.abs() / v.length().max(f64::MIN_POSITIVE);
    let (column, right, row, down) = if fraction(a) >= fraction(b) { (0, a, 1, b) } else { (1, b, 0, a) };
    let right_sign = if right.x < 0.0 { -1 } else { 1 };
    // A captured image is not mirrored: rows run in the direction of the columns, turned clockwise as seen.
    let down_sign = if (f64::from(right_sign) * right).perp_dot(down) < 0.0 { -1 } else { 1 };
    move |place| [right_sign * place[column], down_sign * place[row]]
}

/// Steps from the first mark to the others.
const LEGS: [i64; 2] = [3, 2];

/// Orientation of a chart in an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    /// Number of clockwise quarter turns in the image: 0 to 3. For a mirrored image, after it was mirrored left to right.
    pub quarters: u8,
    /// True if it is mirrored.
    pub mirrored: bool,
}

impl Grid {
    /// Orientation of the chart; `None` if its marks are not visible.
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
        // To the right as printed, to the left if mirrored; then clockwise with y down.
        let turned = if mirrored { [-long[0], -long[1]] } else { long };
        let quarters = [[1, 0], [0, 1], [-1, 0], [0, -1]].iter().position(|direction| *direction == turned)? as u8;
        Some(Orientation { quarters, mirrored })
    }

    /// Positions without a point between four with one.
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
    use glam::DVec2;

    use super::super::Node;
    use super::*;

    /// A grid of 12 × 10 without the marks, with each position mapped to another.
    fn chart_with_gaps(size: [usize; 2], gaps: &[[usize; 2]], moved: impl Fn([usize; 2]) -> [usize; 2]) -> Grid {
        let mut nodes: Vec<Node> = (0..120)
            .map(|i| [i % 12, i / 12])
            .filter(|at| !gaps.contains(at))
            .map(|at| Node { index: moved(at), at: DVec2::ZERO, uncertainty_px: 0.0 })
            .collect();
        nodes.sort_by_key(|n| [n.index[1], n.index[0]]);
        Grid { nodes, size, disc_radius_steps: None }
    }

    #[test]
    fn marks_determine_the_orientation_of_a_chart() {
        let marks = [[3, 4], [6, 4], [3, 6]];
        let orientation_of =
            |size, moved: fn([usize; 2]) -> [usize; 2]| chart_with_gaps(size, &marks, moved).orientation();
        let orientation = |quarters, mirrored| Some(Orientation { quarters, mirrored });
        assert_eq!(orientation_of([12, 10], |at| at), orientation(0, false));
        assert_eq!(orientation_of([10, 12], |[x, y]| [9 - y, x]), orientation(1, false));
        assert_eq!(orientation_of([12, 10], |[x, y]| [11 - x, 9 - y]), orientation(2, false));
        assert_eq!(orientation_of([10, 12], |[x, y]| [y, 11 - x]), orientation(3, false));
        assert_eq!(orientation_of([12, 10], |[x, y]| [11 - x, y]), orientation(0, true));
        assert_eq!(orientation_of([12, 10], |[x, y]| [x, 9 - y]), orientation(2, true));
        assert!(orientation_of([10, 12], |[x, y]| [y, x]).is_some_and(|o| o.mirrored));
    }

    #[test]
    fn other_gaps_are_no_marks() {
        let orientation = |gaps: &[[usize; 2]]| chart_with_gaps([12, 10], gaps, |at| at).orientation();
        assert_eq!(orientation(&[]), None);
        assert_eq!(orientation(&[[3, 4], [6, 4]]), None);
        assert_eq!(orientation(&[[3, 4], [6, 4], [3, 7]]), None);
        assert_eq!(orientation(&[[3, 4], [6, 4], [3, 6], [8, 8]]), None);
        assert_eq!(orientation(&[[3, 4], [6, 4], [1, 4]]), None);
    }
}
