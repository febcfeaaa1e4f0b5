//! From the picture to where a camera without distortion would see the same.

use super::DistortionError;
use crate::disc::centroid_shift;
use crate::fit::PolynomialMap;
use crate::target::{Grid, Node};
use glam::{DMat2, DVec2};

/// Highest degree of the polynomial, and points that each of its coefficients needs.
const DEGREES: [usize; 4] = [9, 7, 5, 3];
const POINTS_EACH: f64 = 1.6;
/// Points of the least degree.
const LEAST: usize = 16;

/// The degree that so many points bear.
fn degree(points: usize) -> Result<usize, DistortionError> {
    let bears = |degree: &usize| POINTS_EACH * PolynomialMap::count(*degree) as f64 <= points as f64;
    DEGREES.into_iter().find(bears).ok_or(DistortionError::Few { points, least: LEAST })
}

fn chart(node: &Node) -> DVec2 {
    DVec2::new(node.index[0] as f64, node.index[1] as f64)
}

/// The grid's points with each disc's centre where its centroid was.
pub(super) fn without_shifts(grid: &Grid) -> Result<Vec<Node>, DistortionError> {
    const ROUNDS: usize = 3;
    let mut nodes = grid.nodes.clone();
    let degree = degree(nodes.len())?;
    let Some(radius) = grid.disc_radius_steps else { return Ok(nodes) };
    for _ in 0..ROUNDS {
        let pairs: Vec<_> = nodes.iter().map(|n| [chart(n), n.at]).collect();
        let map = PolynomialMap::fitted(degree, &pairs)?;
        for (node, seen) in nodes.iter_mut().zip(&grid.nodes) {
            let shift = centroid_shift(|p| Some(map.image(p)), chart(node), radius);
            node.at = seen.at - shift.unwrap_or(DVec2::ZERO);
        }
    }
    Ok(nodes)
}

/// The polynomial from the picture to the chart (in steps of the grid), and the homography that meets it at the centre.
#[derive(Clone, Debug)]
pub struct Ideal {
    map: PolynomialMap,
    centre: DVec2,
    /// The chart's point at the centre, steps.
    origin: DVec2,
    /// Its slope there, steps per px, and its inverse.
    slope: DMat2,
    inverse: DMat2,
    /// The homography: chart = origin + slope d/(1 + tilt · d), d the ideal place less the centre.
    tilt: DVec2,
}

impl Ideal {
    pub(super) fn of(nodes: &[Node], centre: DVec2) -> Result<Self, DistortionError> {
        let pairs: Vec<_> = nodes.iter().map(|n| [n.at, chart(n)]).collect();
        let map = PolynomialMap::fitted(degree(nodes.len())?, &pairs)?;
        let jet = map.jet(centre);
        let inverse = jet.slope.inverse();
        let covered = nodes.iter().any(|n| (chart(n) - jet.value).length() < 1.5);
        if !(covered && inverse.is_finite()) {
            return Err(DistortionError::Centre { centre_px: centre.to_array() });
        }
        // A homography's curvature, in px: −2 tₓ eₓ, −(tₓ e_y + t_y eₓ), −2 t_y e_y; the nearest to the polynomial's.
        let [xx, xy, yy] = jet.curvature.map(|c| inverse * c);
        let tilt = DVec2::new(-(xx.x + xy.y) / 3.0, -(yy.y + xy.x) / 3.0);
        Ok(Self { map, centre, origin: jet.value, slope: jet.slope, inverse, tilt })
    }

    /// The centre, px.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        self.centre
    }

    /// The polynomial's degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.map.degree()
    }

    /// Standard deviation of a point about the polynomial, px at the centre's scale.
    #[must_use]
    pub fn sigma_px(&self) -> f64 {
        self.map.sigma * self.step_px()
    }

    /// The length of a step of the chart at the centre, px: the root of its cell's area.
    #[must_use]
    pub fn step_px(&self) -> f64 {
        self.inverse.determinant().abs().sqrt()
    }

    /// The chart's point that is seen at a place, steps.
    #[must_use]
    pub fn chart(&self, at: DVec2) -> DVec2 {
        self.map.image(at)
    }

    /// Where what is seen at a place would be seen without distortion, px.
    #[must_use]
    pub fn place(&self, at: DVec2) -> DVec2 {
        let v = self.inverse * (self.map.image(at) - self.origin);
        self.centre + v / (1.0 - self.tilt.dot(v))
    }

    /// How the ideal distance's logarithm at a place depends on the coefficients of the chart's x and y.
    pub(super) fn log_distance_rows(&self, at: DVec2) -> [Vec<f64>; 2] {
        // ln |ideal| = ln |v| − ln(1 − tilt · v), and dv = inverse (d chart − d origin − d slope v).
        let v = self.inverse * (self.map.image(at) - self.origin);
        let stretch = 1.0 / (1.0 - self.tilt.dot(v));
        let (there, here) = (self.map.row(at), self.map.row(self.centre));
        let slope = self.map.slope_row(self.centre, v);
        let moved = there.iter().zip(&here).zip(&slope).map(|((t, h), s)| t - h - s).collect();
        let mut terms = vec![(v / v.length_squared() + stretch * self.tilt, moved)];
        // v · d tilt, the tilt being a third of the curvature's parts.
        let levers = [DVec2::new(v.x, 0.0), DVec2::new(v.y, v.x), DVec2::new(0.0, v.y)];
        terms.extend(levers.map(|lever| -stretch / 3.0 * lever).into_iter().zip(self.curvature_rows()));
        let levers: Vec<DVec2> = terms.iter().map(|(lever, _)| self.inverse.transpose() * *lever).collect();
        let sum =
            |c: usize, k: usize| levers.iter().zip(&terms).map(|(lever, (_, row))| lever[c] * row[k]).sum::<f64>();
        [0, 1].map(|c| (0..there.len()).map(|k| sum(c, k)).collect())
    }

    /// How slope · curvature in px at the centre (∂²/∂x², ∂²/∂x∂y, ∂²/∂y²) depends on the coefficients of a coordinate.
    fn curvature_rows(&self) -> [Vec<f64>; 3] {
        let px = self.map.jet(self.centre).curvature.map(|c| self.inverse * c);
        let rows = self.map.curvature_rows(self.centre);
        let less = |(row, px): (Vec<f64>, DVec2)| {
            let slope = self.map.slope_row(self.centre, px);
            row.iter().zip(&slope).map(|(r, s)| r - s).collect()
        };
        let mut rows = rows.into_iter().zip(px).map(less);
        std::array::from_fn(|_| rows.next().expect("three"))
    }

    pub(super) fn variance(&self, row: &[f64]) -> f64 {
        self.map.variance(row)
    }

    /// Steps per px along x and y at the centre.
    #[must_use]
    pub fn slope(&self) -> DMat2 {
        self.slope
    }
}
