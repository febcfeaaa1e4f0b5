//! Lateral chromatic displacement after ISO 19084:2015.
//!
//! The points of a chart are detected in each channel separately. The displacement of a point is its position in red, or blue,
//! less its position in green (vector, px). It has a radial part (positive: farther from the centre than green) and a tangential
//! part (positive: turned from x towards y) about the image centre. Points are matched to the nearest within half a step.
//!
//! Means are taken over rings of a tenth of the half diagonal. Their standard uncertainty is the larger of two: the scatter
//! within the ring after a shift and a scale of the whole channel are removed, or the points' own uncertainties. The mean of all
//! points is the channel's overall shift, which rings about the centre do not show; for a chart that is symmetric about the
//! centre, it is independent of a difference in scale. The largest displacement is the maximum of many noisy lengths, hence
//! biased upwards, and has no stated uncertainty.
//!
//! Perspective shifts of disc centroids are equal in all channels to second order, and not corrected.

use glam::DVec2;

use crate::{Estimate, target::Grid};

/// The displacement at a point of the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Displacement {
    /// Position in green, px.
    pub at: DVec2,
    /// Position in the other channel less that in green, px.
    pub by: DVec2,
    /// Direction from the image centre to the point.
    pub outwards: DVec2,
    /// Radial part, px.
    pub radial: f64,
    /// Tangential part, px.
    pub tangential: f64,
    /// Distance from the centre, in half diagonals.
    pub field: f64,
    /// Standard uncertainty of a coordinate of `by`, px.
    pub uncertainty_px: f64,
}

/// Means over a ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Mean field of its points, in half diagonals.
    pub field: f64,
    /// Mean radial displacement, px.
    pub radial: Estimate,
    /// Mean tangential displacement, px.
    pub tangential: Estimate,
    /// Number of points.
    pub points: usize,
}

/// Displacements of a channel relative to green, about the image centre.
#[must_use]
pub fn displacements(green: &Grid, other: &Grid, size_px: [usize; 2]) -> Vec<Displacement> {
    let size = DVec2::new(size_px[0] as f64, size_px[1] as f64);
    let (centre, half_diagonal) = (0.5 * size, 0.5 * size.length());
    let at = |node: &crate::target::Node| {
        let nearest = other.nearest(node.at)?;
        let by = nearest.at - node.at;
        (by.length() < 0.5 * step(green, node)?).then_some(())?;
        let from = node.at - centre;
        let outwards = from.normalize_or_zero();
        Some(Displacement {
            at: node.at,
            by,
            outwards,
            radial: outwards.dot(by),
            tangential: outwards.perp_dot(by),
            field: from.length() / half_diagonal,
            uncertainty_px: etendue_core::maths::f64::hypot(node.uncertainty_px, nearest.uncertainty_px),
        })
    };
    green.nodes.iter().filter_map(at).collect()
}

/// Length of the shortest step to a neighbour, px.
fn step(grid: &Grid, node: &crate::target::Node) -> Option<f64> {
    let [i, j] = node.index;
    let neighbours = [[i + 1, j], [i.wrapping_sub(1), j], [i, j + 1], [i, j.wrapping_sub(1)]];
    neighbours.iter().filter_map(|index| Some((grid.node(*index)?.at - node.at).length())).min_by(f64::total_cmp)
}

/// Rings of a tenth of the half diagonal with at least three points.
#[must_use]
pub fn rings(displacements: &[Displacement]) -> Vec<Ring> {
    const RINGS: i32 = 10;
    let rest = rest(displacements);
    let ring = |i: i32| {
        let within = |d: &Displacement| (d.field * f64::from(RINGS)).floor() == f64::from(i);
        let (points, rest): (Vec<&Displacement>, Vec<&Displacement>) =
            displacements.iter().zip(&rest).filter(|(d, _)| within(d)).unzip();
        (points.len() >= 3).then(|| Ring {
            field: points.iter().map(|d| d.field).sum::<f64>() / points.len() as f64,
            radial: mean(&points, &rest, |d| d.radial),
            tangential: mean(&points, &rest, |d| d.tangential),
            points: points.len(),
        })
    };
    (0..RINGS).filter_map(ring).collect()
}

/// The mean displacement along x and along y, px; `None` for fewer than three points.
#[must_use]
pub fn shift(displacements: &[Displacement]) -> Option<[Estimate; 2]> {
    let (points, rest) = (displacements.iter().collect::<Vec<_>>(), rest(displacements));
    let rest: Vec<&Displacement> = rest.iter().collect();
    (points.len() >= 3).then(|| [mean(&points, &rest, |d| d.by.x), mean(&points, &rest, |d| d.by.y)])
}

/// Displacements less their least-squares fit of a shift and a scale: the scatter from point to point.
fn rest(displacements: &[Displacement]) -> Vec<Displacement> {
    let count = displacements.len().max(1) as f64;
    let mean = |component: fn(&Displacement) -> DVec2| displacements.iter().map(component).sum::<DVec2>() / count;
    let (at, by) = (mean(|d| d.at), mean(|d| d.by));
    let sum = |f: &dyn Fn(&Displacement) -> f64| displacements.iter().map(f).sum::<f64>();
    let scale = sum(&|d| (d.at - at).dot(d.by - by)) / sum(&|d| (d.at - at).length_squared()).max(f64::MIN_POSITIVE);
    let less = |d: &Displacement| {
        let left = d.by - by - scale * (d.at - at);
        Displacement { by: left, radial: d.outwards.dot(left), tangential: d.outwards.perp_dot(left), ..*d }
    };
    displacements.iter().map(less).collect()
}

/// Mean of a part of the displacements, with the larger of two uncertainties: the scatter of the residuals or the points' own
/// uncertainties.
fn mean(points: &[&Displacement], rest: &[&Displacement], part: fn(&Displacement) -> f64) -> Estimate {
    let count = points.len() as f64;
    let own = points.iter().map(|d| d.uncertainty_px * d.uncertainty_px).sum::<f64>() / count;
    let average = |list: &[&Displacement]| list.iter().map(|d| part(d)).sum::<f64>() / count;
    let left = average(rest);
    let scatter = rest.iter().map(|d| (part(d) - left) * (part(d) - left)).sum::<f64>() / (count - 1.0);
    Estimate::new(average(points), (scatter.max(own) / count).sqrt())
}
