//! Where depth is known, and where it jumps.

use super::settings::DepthSettings;
use crate::Image;

pub(super) fn known(depth: f64) -> bool {
    depth.is_finite() && depth > 0.0
}

/// Whether each pixel lies at an edge of the truth; sky beside something is an edge, too.
pub(super) fn edges(truth: &Image, settings: &DepthSettings) -> Vec<bool> {
    let (width, height) = (truth.width(), truth.height());
    let at = |x: usize, y: usize| f64::from(truth.at(x, y));
    let sky = |depth: f64| depth == f64::INFINITY;
    let jump = |a: f64, b: f64| match (known(a), known(b)) {
        (true, true) => (a - b).abs() > settings.edge_ratio * a.min(b),
        (true, false) => sky(b),
        (false, true) => sky(a),
        _ => false,
    };
    let mut edges = vec![false; width * height];
    let mut mark = |x: usize, y: usize| {
        let reach = settings.edge_px;
        for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
            edges[row * width + x.saturating_sub(reach)..row * width + (x + reach + 1).min(width)].fill(true);
        }
    };
    for y in 0..height {
        for x in 0..width {
            let right = x + 1 < width && jump(at(x, y), at(x + 1, y));
            let below = y + 1 < height && jump(at(x, y), at(x, y + 1));
            if right || below {
                mark(x, y);
            }
            if right {
                mark(x + 1, y);
            }
            if below {
                mark(x, y + 1);
            }
        }
    }
    edges
}
