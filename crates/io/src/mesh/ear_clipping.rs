//! Triangulation of polygons by ear clipping (Meisters 1975, "Polygons have ears"): a corner that can be cut off is removed until three are left.
//!
//! A corner can be cut off if the triangle of it and its neighbours contains no other corner. A corner that is blocked by another one is tested again when that
//! one is removed; otherwise only the neighbours of a removed corner are. With the corners in a tree of bounding boxes, typical outlines take about n log n steps.
//! Coinciding corners (bridges to holes, outlines that touch themselves) block each other if an edge of one leads into the triangle of the other.

use std::collections::{BTreeMap, BTreeSet};
use std::{cmp::Ordering, rc::Rc};

pub(super) type Point2 = [f64; 2];

/// Twice the signed area of a triangle, positive counter-clockwise.
pub(super) fn turn(a: Point2, b: Point2, c: Point2) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Maximum corners per leaf.
const LEAF: usize = 8;

/// Binary tree of boxes over points that supports removal.
pub(super) struct CornerTree<'p> {
    points: &'p [Point2],
    /// Points in the order of leaves.
    order: Vec<usize>,
    /// Position of each point in `order`.
    place: Vec<usize>,
    is_left: Vec<bool>,
    /// The root at 1, the children of `n` at 2n and 2n + 1.
    boxes: Vec<Bounds>,
}

#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Point2,
    high: Point2,
}

impl Bounds {
    const EMPTY: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn around(self, other: Self) -> Self {
        let pick = |choose: fn(f64, f64) -> f64, a: Point2, b: Point2| [choose(a[0], b[0]), choose(a[1], b[1])];
        Self { low: pick(f64::min, self.low, other.low), high: pick(f64::max, self.high, other.high) }
    }

    /// Returns true if every point of the box is to the right of the line from `a` to `b`. The rounding of [`turn`] keeps the order of points, so no point of
    /// the box is to the left by it.
    fn is_right_of(&self, a: Point2, b: Point2) -> bool {
        let x = if b[1] >= a[1] { self.low[0] } else { self.high[0] };
        let y = if b[0] >= a[0] { self.high[1] } else { self.low[1] };
        turn(a, b, [x, y]) < 0.0
    }
}

impl<'p> CornerTree<'p> {
    pub(super) fn new(points: &'p [Point2]) -> Self {
        let leaves = points.len().div_ceil(LEAF).next_power_of_two();
        let mut tree = Self {
            points,
            order: (0..points.len()).collect(),
            place: vec![0; points.len()],
            is_left: vec![true; points.len()],
            boxes: vec![Bounds::EMPTY; 2 * leaves],
        };
        tree.split(0, leaves);
        for (place, point) in tree.order.iter().enumerate() {
            tree.place[*point] = place;
        }
        (0..leaves).for_each(|leaf| tree.boxes[leaves + leaf] = tree.bounds_of(leaf));
        (1..leaves).rev().for_each(|node| tree.join(node));
        tree
    }

    fn leaves(&self) -> usize {
        self.boxes.len() / 2
    }

    /// Position in `order` at which the points of a leaf begin.
    fn start(&self, leaf: usize) -> usize {
        leaf * self.order.len() / self.leaves()
    }

    /// Orders the points of the leaves `from..to`, so that a leaf contains points close to each other: splits at the median along the longer axis.
    fn split(&mut self, from: usize, to: usize) {
        if to - from < 2 {
            return;
        }
        let middle = usize::midpoint(from, to);
        let (first, nth, last) = (self.start(from), self.start(middle), self.start(to));
        let points = self.points;
        let range = &mut self.order[first..last];
        let bounds = range.iter().fold(Bounds::EMPTY, |b, &i| b.around(Bounds { low: points[i], high: points[i] }));
        let axis = usize::from(bounds.high[1] - bounds.low[1] > bounds.high[0] - bounds.low[0]);
        if nth < last {
            range.select_nth_unstable_by(nth - first, |&i, &j| {
                points[i][axis].total_cmp(&points[j][axis]).then(i.cmp(&j))
            });
        }
        self.split(from, middle);
        self.split(middle, to);
    }

    fn bounds_of(&self, leaf: usize) -> Bounds {
        let left = self.order[self.start(leaf)..self.start(leaf + 1)].iter().filter(|i| self.is_left[**i]);
        left.fold(Bounds::EMPTY, |b, &i| b.around(Bounds { low: self.points[i], high: self.points[i] }))
    }

    fn join(&mut self, node: usize) {
        self.boxes[node] = self.boxes[2 * node].around(self.boxes[2 * node + 1]);
    }

    /// Leaf that holds a point.
    fn leaf_of(&self, point: usize) -> usize {
        let (place, leaves) = (self.place[point], self.leaves());
        let near = place * leaves / self.order.len();
        (near..leaves).find(|leaf| place < self.start(leaf + 1)).unwrap_or(leaves - 1)
    }

    /// Removes a point.
    pub(super) fn remove(&mut self, point: usize) {
        self.is_left[point] = false;
        let leaf = self.leaf_of(point);
        let mut node = self.leaves() + leaf;
        self.boxes[node] = self.bounds_of(leaf);
        while node > 1 {
            node /= 2;
            self.join(node);
        }
    }

    /// Remaining point in the closed counter-clockwise triangle of three others that coincides with none of them.
    pub(super) fn inside(&self, corners: [usize; 3]) -> Option<usize> {
        let triangle = corners.map(|i| self.points[i]);
        let [a, b, c] = triangle;
        let mut nodes = vec![1];
        while let Some(node) = nodes.pop() {
            let bounds = &self.boxes[node];
            let is_empty = bounds.low[0] > bounds.high[0];
            if is_empty || bounds.is_right_of(a, b) || bounds.is_right_of(b, c) || bounds.is_right_of(c, a) {
                continue;
            }
            if node < self.leaves() {
                nodes.extend([2 * node, 2 * node + 1]);
            } else if let Some(corner) = self.inside_leaf(node - self.leaves(), triangle) {
                return Some(corner);
            }
        }
        None
    }

    fn inside_leaf(&self, leaf: usize, [a, b, c]: [Point2; 3]) -> Option<usize> {
        let holds =
            |p: Point2| ![a, b, c].contains(&p) && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
        let mut points = self.order[self.start(leaf)..self.start(leaf + 1)].iter().copied();
        points.find(|&i| self.is_left[i] && holds(self.points[i]))
    }
}

/// Triangles of a counter-clockwise polygon whose edges do not cross; `None` if several corners remain and none can be cut off.
pub(super) fn clip_ears(flat: &[Point2]) -> Option<Vec<[usize; 3]>> {
    let n = flat.len();
    let mut outline = PolygonOutline {
        flat,
        before: (0..n).map(|i| (i + n - 1) % n).collect(),
        after: (0..n).map(|i| (i + 1) % n).collect(),
        tree: CornerTree::new(flat),
        is_left: vec![true; n],
        ears: BTreeSet::new(),
        waiting: vec![BlockedCorners::default(); n],
        twins: twins(flat),
    };
    (0..n).for_each(|corner| outline.look_at(corner));
    let mut triangles = Vec::with_capacity(n - 2);
    for _ in 3..n {
        triangles.push(outline.clip()?);
    }
    let left: Vec<usize> = (0..n).filter(|&corner| outline.is_left[corner]).collect();
    triangles.push([left[0], left[1], left[2]]);
    Some(triangles)
}

/// Remaining outline of a polygon.
struct PolygonOutline<'p> {
    flat: &'p [Point2],
    before: Vec<usize>,
    after: Vec<usize>,
    tree: CornerTree<'p>,
    is_left: Vec<bool>,
    /// Corners that can be cut off. Those between two coinciding corners are removed first, as an outline that touches itself has no inside there.
    ears: BTreeSet<(bool, usize)>,
    /// For each corner, the corners that it blocks.
    waiting: Vec<BlockedCorners>,
    /// For each corner that coincides with others, the group of them.
    twins: BTreeMap<usize, Rc<[usize]>>,
}

/// Corners blocked by one corner.
#[derive(Clone, Debug, Default)]
struct BlockedCorners {
    /// Blocked by its position.
    place: Vec<usize>,
    /// Blocked by the direction of its edges; they coincide with it.
    edges: Vec<usize>,
}

/// Groups of coinciding corners, for each of them.
fn twins(flat: &[Point2]) -> BTreeMap<usize, Rc<[usize]>> {
    let mut order: Vec<usize> = (0..flat.len()).collect();
    let by_place = |&i: &usize, &j: &usize| flat[i].partial_cmp(&flat[j]).unwrap_or(Ordering::Equal).then(i.cmp(&j));
    order.sort_by(by_place);
    let groups = order.chunk_by(|&i, &j| flat[i] == flat[j]).filter(|group| group.len() > 1);
    let of_each = |group: &[usize]| {
        let shared: Rc<[usize]> = group.into();
        group.iter().map(|&corner| (corner, shared.clone())).collect::<Vec<_>>()
    };
    groups.flat_map(of_each).collect()
}

impl PolygonOutline<'_> {
    /// Cuts the first ear off.
    fn clip(&mut self) -> Option<[usize; 3]> {
        let (_, tip) = self.ears.pop_first()?;
        let (before, after) = (self.before[tip], self.after[tip]);
        self.is_left[tip] = false;
        self.tree.remove(tip);
        (self.after[before], self.before[after]) = (after, before);
        let BlockedCorners { place, edges } = std::mem::take(&mut self.waiting[tip]);
        let neighbours = [before, after].map(|corner| std::mem::take(&mut self.waiting[corner].edges));
        let changed = place.into_iter().chain(edges).chain(neighbours.concat()).chain([before, after]);
        changed.for_each(|corner| self.look_at(corner));
        Some([before, tip, after])
    }

    /// Tests whether a corner can be cut off: it turns left or is straight, and none of the other corners lies in its triangle. A straight corner gives a
    /// triangle of zero area and leaves the outline unchanged.
    fn look_at(&mut self, tip: usize) {
        let corners @ [before, _, after] = [self.before[tip], tip, self.after[tip]];
        self.ears.remove(&(false, tip));
        self.ears.remove(&(true, tip));
        if !self.is_left[tip] || turn(self.flat[before], self.flat[tip], self.flat[after]) < 0.0 {
            return;
        }
        if let Some(other) = self.tree.inside(corners) {
            self.waiting[other].place.push(tip);
        } else if let Some(twin) = self.leads_inside(corners) {
            self.waiting[twin].edges.push(tip);
        } else {
            self.ears.insert((self.flat[before] != self.flat[after], tip));
        }
    }

    /// Corner at the position of `tip` from which an edge leads into the triangle.
    fn leads_inside(&self, [before, tip, after]: [usize; 3]) -> Option<usize> {
        let [a, b, c] = [before, tip, after].map(|corner| self.flat[corner]);
        let enters = |end: usize| turn(a, b, self.flat[end]) > 0.0 && turn(b, c, self.flat[end]) > 0.0;
        let twins = self.twins.get(&tip).filter(|_| turn(a, b, c) > 0.0)?;
        let mut others = twins.iter().copied().filter(|&twin| twin != tip && self.is_left[twin]);
        others.find(|&twin| enters(self.before[twin]) || enters(self.after[twin]))
    }
}
