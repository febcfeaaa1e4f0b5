//! Rising angles of a grid, degrees, and where a value lies among them.

/// How far beyond the outermost angles rounding may take one of f32 that was made from a direction.
pub(super) const EDGE_DEG: f32 = 1e-4;

/// Rising numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    nodes: Vec<f32>,
    /// For each of equal steps from the first to the last number, the interval in which the step begins.
    guide: Vec<u16>,
    steps_per_unit: f32,
}

/// Between node `low` and the next, `t` of the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Between {
    pub(super) low: usize,
    pub(super) t: f32,
}

impl Axis {
    /// `None` where there are none or too many, one is not finite, or they do not rise.
    pub(super) fn new(nodes: Vec<f32>) -> Option<Self> {
        let rise = nodes.windows(2).all(|w| w[0] < w[1]) && nodes.iter().all(|n| n.is_finite());
        if nodes.is_empty() || nodes.len() > usize::from(u16::MAX) || !rise {
            return None;
        }
        let range = nodes[nodes.len() - 1] - nodes[0];
        let steps_per_unit = if range > 0.0 { (nodes.len() - 1) as f32 / range } else { 0.0 };
        let guide = (0..nodes.len()).map(|step| begin(&nodes, step)).collect();
        Some(Self { nodes, guide, steps_per_unit })
    }

    pub(super) fn nodes(&self) -> &[f32] {
        &self.nodes
    }

    /// Where `x` lies; `None` outside. A single number is everywhere.
    pub(super) fn find(&self, x: f32) -> Option<Between> {
        let last = self.nodes.len() - 1;
        if last == 0 {
            return Some(Between { low: 0, t: 0.0 });
        }
        let (first, end) = (self.nodes[0], self.nodes[last]);
        let inside = (first - EDGE_DEG..=end + EDGE_DEG).contains(&x);
        inside.then(|| self.interval(x.clamp(first, end), last))
    }

    fn interval(&self, x: f32, last: usize) -> Between {
        let step = ((x - self.nodes[0]) * self.steps_per_unit) as usize;
        let mut low = usize::from(self.guide[step.min(last)]).min(last - 1);
        while low > 0 && self.nodes[low] > x {
            low -= 1;
        }
        while low + 1 < last && self.nodes[low + 1] <= x {
            low += 1;
        }
        Between { low, t: (x - self.nodes[low]) / (self.nodes[low + 1] - self.nodes[low]) }
    }
}

/// The interval in which step `step` of as many as there are numbers begins.
fn begin(nodes: &[f32], step: usize) -> u16 {
    let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
    let x = first + (last - first) * step as f32 / (nodes.len() - 1).max(1) as f32;
    nodes.partition_point(|n| *n <= x).saturating_sub(1) as u16
}

impl Between {
    /// Linear between two values.
    pub(super) fn mix(self, low: f32, high: f32) -> f32 {
        low + self.t * (high - low)
    }
}
