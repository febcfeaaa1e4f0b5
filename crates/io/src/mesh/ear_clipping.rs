//! Ear clipping (Meisters 1975, "Polygons have ears"): the first corner that can be cut off is, until three are left.
//!
//! A corner that cannot be cut off for another one in its triangle waits for that one to go; what else could change is
//! only the corners beside one that is cut off. With the corners in a tree of boxes the whole takes about n log n steps
//! on outlines as they are drawn. Corners that coincide (bridges to holes, outlines that touch themselves) block each
//! other where an edge of one leads into the triangle of the other.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::corner_tree::CornerTree;
use super::plane::{Point, turn};

/// Triangles of a counter-clockwise polygon whose edges do not cross; `None` where none of several corners can be cut off.
pub(super) fn clip_ears(flat: &[Point]) -> Option<Vec<[usize; 3]>> {
    let n = flat.len();
    let mut outline = Outline {
        flat,
        before: (0..n).map(|i| (i + n - 1) % n).collect(),
        after: (0..n).map(|i| (i + 1) % n).collect(),
        tree: CornerTree::new(flat),
        is_left: vec![true; n],
        ears: BTreeSet::new(),
        waiting: vec![Waiting::default(); n],
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

/// What is left of a polygon.
struct Outline<'p> {
    flat: &'p [Point],
    before: Vec<usize>,
    after: Vec<usize>,
    tree: CornerTree<'p>,
    is_left: Vec<bool>,
    /// Corners that can be cut off, before all others those between two that coincide: what is left of an outline that
    /// touches itself has nothing inside there.
    ears: BTreeSet<(bool, usize)>,
    /// For each corner, those that cannot be cut off for it.
    waiting: Vec<Waiting>,
    /// For each corner that coincides with others, those and it.
    twins: BTreeMap<usize, Rc<[usize]>>,
}

/// Corners that cannot be cut off for one corner.
#[derive(Clone, Debug, Default)]
struct Waiting {
    /// For where it stands.
    place: Vec<usize>,
    /// For where its edges lead; they coincide with it.
    edges: Vec<usize>,
}

/// The corners that coincide, for each of them.
fn twins(flat: &[Point]) -> BTreeMap<usize, Rc<[usize]>> {
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

impl Outline<'_> {
    /// Cuts the first ear off.
    fn clip(&mut self) -> Option<[usize; 3]> {
        let (_, tip) = self.ears.pop_first()?;
        let (before, after) = (self.before[tip], self.after[tip]);
        self.is_left[tip] = false;
        self.tree.remove(tip);
        (self.after[before], self.before[after]) = (after, before);
        let Waiting { place, edges } = std::mem::take(&mut self.waiting[tip]);
        let beside = [before, after].map(|corner| std::mem::take(&mut self.waiting[corner].edges));
        let changed = place.into_iter().chain(edges).chain(beside.concat()).chain([before, after]);
        changed.for_each(|corner| self.look_at(corner));
        Some([before, tip, after])
    }

    /// Whether a corner can be cut off: it turns left or is straight, and none of the other corners lies in its
    /// triangle. A straight corner gives a triangle of no area and leaves the outline unchanged.
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

    /// A corner where `tip` stands, from which an edge leads into the triangle.
    fn leads_inside(&self, [before, tip, after]: [usize; 3]) -> Option<usize> {
        let [a, b, c] = [before, tip, after].map(|corner| self.flat[corner]);
        let enters = |end: usize| turn(a, b, self.flat[end]) > 0.0 && turn(b, c, self.flat[end]) > 0.0;
        let twins = self.twins.get(&tip).filter(|_| turn(a, b, c) > 0.0)?;
        let mut others = twins.iter().copied().filter(|&twin| twin != tip && self.is_left[twin]);
        others.find(|&twin| enters(self.before[twin]) || enters(self.after[twin]))
    }
}
