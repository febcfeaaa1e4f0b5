//! Landing positions of the rays of a point: the spot of its bundle, and those of other bundles that pass the lens.
//!
//! Rays fill each bundle uniformly in light, clipped at its edge. The number of rows doubles until root-mean-square radius and centroid converge; the
//! last change is reported as their error. Coating losses are ignored.

use glam::DVec2;

use super::beam::Beam;
use super::bundles::{Bundle, bundles};
use super::quadrature::{Area, BundleNode};

/// Rows of the first quadrature, and the maximum number of doublings.
const ROWS: usize = 12;
const DOUBLINGS: usize = 5;
/// Convergence limit of a spot: relative to its radius, or mm.
const RELATIVE: f64 = 1e-5;
const ABSOLUTE_MM: f64 = 1e-10;

/// Spot of the rays of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Root-mean-square distance from the centroid, mm.
    pub rms_mm: f64,
    /// Estimated error of [`Self::rms_mm`], mm: the change by the last doubling of rays.
    pub rms_error_mm: f64,
    /// Largest distance from the centroid, mm.
    pub radius_mm: f64,
    /// The centroid's distance from the axis, mm; negative on the side of the axis opposite to the field point.
    pub centroid_mm: f64,
    /// Estimated error of [`Self::centroid_mm`], mm.
    pub centroid_error_mm: f64,
}

/// Light of a point through a part of the lens other than that of the principal ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherBundle {
    /// Its light relative to that of the spot.
    pub light: f64,
    pub spot: Spot,
}

/// Light and spot of a bundle.
#[derive(Clone, Copy, Debug)]
pub(super) struct BundleSpot {
    light: f64,
    pub(super) spot: Spot,
}

/// The bundles of a point, with the index of the principal ray's.
pub(super) struct Pupil {
    list: Vec<Bundle>,
    main: usize,
}

impl Pupil {
    /// `None` if no ray passes.
    pub(super) fn new(beam: &Beam<'_>) -> Option<Self> {
        let list = bundles(beam.bounds(), &|q| beam.filling(q));
        let distance = |bundle: &Bundle| bundle.distance(DVec2::ZERO);
        let main = (0..list.len()).min_by(|a, b| distance(&list[*a]).total_cmp(&distance(&list[*b])))?;
        Some(Self { list, main })
    }

    /// The principal ray's bundle, also at a wavelength near that of the search.
    pub(super) fn principal_spot(&self, beam: &Beam<'_>) -> Option<BundleSpot> {
        self.converged(beam, self.main)
    }

    /// The other bundles, the brightest first.
    pub(super) fn other_bundles(&self, beam: &Beam<'_>, main: &BundleSpot) -> Vec<OtherBundle> {
        let lit = (0..self.list.len()).filter(|i| *i != self.main).filter_map(|i| self.converged(beam, i));
        let mut others: Vec<_> =
            lit.map(|BundleSpot { light, spot }| OtherBundle { light: light / main.light, spot }).collect();
        others.sort_by(|a, b| b.light.total_cmp(&a.light));
        others
    }

    fn converged(&self, beam: &Beam<'_>, own: usize) -> Option<BundleSpot> {
        let mut area = Area::new(&self.list, own, |q| beam.filling(q));
        let (mut rows, mut nodes) = (ROWS, area.nodes(ROWS));
        let mut last = spot_of_nodes(beam, &nodes)?;
        for _ in 0..DOUBLINGS {
            rows *= 2;
            nodes = area.nodes(rows);
            let Some(mut next) = spot_of_nodes(beam, &nodes) else { break };
            next.spot.rms_error_mm = (next.spot.rms_mm - last.spot.rms_mm).abs();
            next.spot.centroid_error_mm = (next.spot.centroid_mm - last.spot.centroid_mm).abs();
            let settled = RELATIVE * next.spot.rms_mm + ABSOLUTE_MM;
            last = next;
            if last.spot.rms_error_mm.max(last.spot.centroid_error_mm) <= settled {
                break;
            }
        }
        last.spot.radius_mm = farthest(beam, &area, rows, &nodes, last.spot.centroid_mm);
        Some(last)
    }
}

/// Largest distance from the centroid, mm: of the rays, and of the edge about the farthest of them.
fn farthest<F>(beam: &Beam<'_>, area: &Area<'_, F>, rows: usize, nodes: &[BundleNode], centroid_mm: f64) -> f64
where
    F: Fn(DVec2) -> Option<f64>,
{
    let distance = |q: DVec2| beam.sensor_point(q).map_or(0.0, |p| (p - DVec2::new(centroid_mm, 0.0)).length());
    let maximum = nodes.iter().max_by(|a, b| distance(a.q).total_cmp(&distance(b.q)));
    maximum.map_or(0.0, |node| area.highest(node.q, rows, distance))
}

/// The spot of a set of rays; a single set gives no error estimate.
fn spot_of_nodes(beam: &Beam<'_>, nodes: &[BundleNode]) -> Option<BundleSpot> {
    let rays: Vec<(DVec2, f64)> =
        nodes.iter().filter_map(|node| Some((beam.sensor_point(node.q)?, node.area * beam.light(node.q)))).collect();
    let light: f64 = rays.iter().map(|(_, weight)| weight).sum();
    let centroid_mm = rays.iter().map(|(p, weight)| p.x * weight).sum::<f64>() / light;
    let square = |p: &DVec2| (*p - DVec2::new(centroid_mm, 0.0)).length_squared();
    let rms_mm = (rays.iter().map(|(p, weight)| square(p) * weight).sum::<f64>() / light).sqrt();
    let unknown = f64::INFINITY;
    let spot = Spot { rms_mm, rms_error_mm: unknown, radius_mm: unknown, centroid_mm, centroid_error_mm: unknown };
    (light > 0.0).then_some(BundleSpot { light, spot })
}
