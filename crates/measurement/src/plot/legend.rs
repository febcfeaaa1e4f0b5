//! Where a plot's legend stands: in a corner that nothing is drawn in, else below the plot.

use super::figure::Plot;
use super::layout::{BOTTOM, HEIGHT, LEFT, RIGHT, TOP, WIDTH};

/// Height of a row of the legend, and how far it stands off the axes and everything drawn.
pub(super) const ROW: f64 = 18.0;
const MARGIN: f64 = 8.0;

/// Where the legend stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Legend {
    pub(super) left: f64,
    pub(super) top: f64,
    width: f64,
    pub(super) height: f64,
    pub(super) is_below: bool,
}

impl Legend {
    /// Under the axis, where it is in nobody's way.
    pub(super) fn below(plot: &Plot) -> Self {
        let named = || plot.series.iter().filter(|s| !s.name.is_empty());
        let longest = named().map(|s| s.name.chars().count()).max().unwrap_or(0);
        let (width, height) = (28.0 + 7.2 * longest as f64, ROW * named().count() as f64 + MARGIN);
        Self { left: LEFT, top: HEIGHT - MARGIN, width, height, is_below: true }
    }

    /// In the first corner within the axes that nothing is drawn in; `None` where there is none.
    pub(super) fn in_a_corner(self, drawn: &[(f64, f64)]) -> Option<Self> {
        let (left, right) = (LEFT + MARGIN, WIDTH - RIGHT - MARGIN - self.width);
        let (top, bottom) = (TOP + MARGIN, HEIGHT - BOTTOM - MARGIN - self.height);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        let corners = corners.map(|(left, top)| Self { left, top, is_below: false, ..self });
        corners
            .into_iter()
            .find(|corner| right >= left && bottom >= top && !drawn.iter().any(|(x, y)| corner.holds(*x, *y)))
    }

    pub(super) fn holds(&self, x: f64, y: f64) -> bool {
        let within = |at: f64, from: f64, size: f64| at > from - MARGIN && at < from + size + MARGIN;
        within(x, self.left, self.width) && within(y, self.top, self.height)
    }
}
