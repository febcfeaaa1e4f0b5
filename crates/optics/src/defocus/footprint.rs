//! The footprint of a pixel's defocus blur: the outline of the real pupil, in pixels, by field point and distance.
//!
//! A ray of the sensor point s leaves the front of the lens at o in the direction ω. It meets the plane at the distance d (perpendicular to the axis;
//! to the chief ray beyond 78°). From the centre of the pupil that point is seen in the direction ω (n − o/d)/ω_z + o/d, hence at another pixel than
//! s. The offset from s to that pixel is linear in 1/d up to (o/d)², so two distances determine it: the distance in focus and the most defocused
//! distance of the scene. Bisection between an open and a closed pupil sample finds rays through the edge of the open pupil; they form the outline.
//! Their light is spread uniformly inside. This holds for every lens: a disc for the thin lens, a cat's eye with clipping apertures, a shift where
//! the pupil moves over the field.
//!
//! Outlines are traced on a lattice over the image at 587.56 nm and interpolated. Left out: caustics within the blur (rings of spherical aberration,
//! coma), separate outlines per colour, the pupil's own cos⁴ variation, central obscurations.

use core::f64::consts::PI;

use etendue_core::maths::f64::{atan2, sin};
use glam::{DVec2, DVec3};

use super::PinholeView;
use crate::{lens::Lens, overlap::PRINCIPAL_NM};

/// Vertices of an outline.
pub(super) const VERTICES: usize = 48;
/// Nodes of the lattice along each axis.
const NODES: usize = 9;
/// Side of the grid of pupil samples used to locate the open part.
const GRID: usize = 16;
/// Bisection steps between an open and a closed sample.
const HALVINGS: usize = 20;
/// Number of planes tried, each at half the defocus of the one before.
const LEVERS: usize = 16;
/// Cosine to the axis below which a direction uses a plane perpendicular to itself.
const ACROSS_AXIS: f64 = 0.2;
/// Shifts below this count as zero, px.
const STILL_PX: f64 = 0.02;

/// The vertices of a footprint, px.
pub(super) type Polygon = [DVec2; VERTICES];

/// Offsets from a field point to where its rays meet the scene: `anchor` in focus, and the change per 1/m of defocus.
#[derive(Clone, Debug)]
struct Outline {
    anchor: Polygon,
    slope: Polygon,
}

/// The footprints of an image.
#[derive(Clone, Debug)]
pub(super) struct Footprints {
    /// Inverse distance in focus, 1/m.
    focus_per_m: f64,
    step_px: DVec2,
    nodes: Vec<Outline>,
    /// Maximum length of an anchor and of a slope.
    longest: [f64; 2],
    /// Maximum diameter added by 1/m of defocus, px.
    spread_px: f64,
    /// True if all outlines are centred on their field points.
    centred: bool,
}

impl Footprints {
    /// The footprints of objects in a view between two inverse distances; `None` if everything is sharp.
    pub(super) fn new(view: &PinholeView<'_>, inverse_range_per_m: [f64; 2]) -> Option<Self> {
        if view.lens.entrance_pupil_radius_m() == 0.0 {
            return None;
        }
        let focus_per_m = view.lens.focus_distance_m().map_or(0.0, f64::recip);
        let [far, near] = inverse_range_per_m;
        let other_per_m = if near - focus_per_m > focus_per_m - far { near } else { far };
        if other_per_m == focus_per_m {
            return None;
        }
        let size = DVec2::new(view.width() as f64, view.height() as f64);
        let step_px = size / (NODES - 1) as f64;
        let tracer = Tracer { view, focus_per_m, other_per_m };
        let node = |i: usize| tracer.outline(DVec2::new((i % NODES) as f64, (i / NODES) as f64) * step_px);
        let nodes = filled(&(0..NODES * NODES).map(node).collect::<Vec<_>>())?;
        Some(Self::from_nodes(nodes, step_px, focus_per_m, inverse_range_per_m))
    }

    fn from_nodes(nodes: Vec<Outline>, step_px: DVec2, focus_per_m: f64, range_per_m: [f64; 2]) -> Self {
        let longest = |of: fn(&Outline) -> &Polygon| {
            nodes.iter().flat_map(of).fold(0.0, |longest: f64, v| longest.max(v.length()))
        };
        let across =
            |o: &Outline| (0..VERTICES / 2).map(|k| o.slope[k].distance(o.slope[k + VERTICES / 2])).fold(0.0, f64::max);
        let extreme = range_per_m.map(|w| (w - focus_per_m).abs()).into_iter().fold(0.0, f64::max);
        let still = |o: &Outline| middle(&o.anchor).length() + extreme * middle(&o.slope).length() < STILL_PX;
        Self {
            focus_per_m,
            step_px,
            longest: [longest(|o| &o.anchor), longest(|o| &o.slope)],
            spread_px: nodes.iter().map(across).fold(0.0, f64::max),
            centred: nodes.iter().all(still),
            nodes,
        }
    }

    /// The maximum reach of a footprint at this inverse distance, px.
    pub(super) fn reach_px(&self, inverse_per_m: f64) -> f64 {
        self.longest[0] + (inverse_per_m - self.focus_per_m).abs() * self.longest[1]
    }

    /// Maximum diameter added by 1/m of defocus, px.
    pub(super) fn spread_px(&self) -> f64 {
        self.spread_px
    }

    /// True if the light of everything at this inverse distance stays within its pixel.
    pub(super) fn within_pixel(&self, inverse_per_m: f64) -> bool {
        self.centred && self.reach_px(inverse_per_m) < 0.5
    }

    /// The pixel offsets from a scene point seen at `px` to where its light lands.
    pub(super) fn outline_at(&self, px: DVec2, inverse_per_m: f64) -> Polygon {
        let place = (px / self.step_px).clamp(DVec2::ZERO, DVec2::splat((NODES - 1) as f64 - 1e-9));
        let cell = place.floor();
        let t = place - cell;
        let first = cell.y as usize * NODES + cell.x as usize;
        let corners = [
            (first, (1.0 - t.x) * (1.0 - t.y)),
            (first + 1, t.x * (1.0 - t.y)),
            (first + NODES, (1.0 - t.x) * t.y),
            (first + NODES + 1, t.x * t.y),
        ];
        let defocus = inverse_per_m - self.focus_per_m;
        let mut polygon = [DVec2::ZERO; VERTICES];
        for (node, weight) in corners {
            let outline = &self.nodes[node];
            for (to, (anchor, slope)) in polygon.iter_mut().zip(outline.anchor.iter().zip(&outline.slope)) {
                *to -= (*anchor + *slope * defocus) * weight;
            }
        }
        polygon
    }
}

/// The area of a polygon, px².
pub(super) fn area(polygon: &Polygon) -> f64 {
    (0..VERTICES).map(|k| 0.5 * polygon[k].perp_dot(polygon[(k + 1) % VERTICES])).sum::<f64>().abs()
}

/// The centre of a polygon's bounding box.
pub(super) fn middle(polygon: &Polygon) -> DVec2 {
    let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    0.5 * (low + high)
}

/// Fills nodes without light with the outline of the nearest lit node; `None` if no node is lit.
fn filled(nodes: &[Option<Outline>]) -> Option<Vec<Outline>> {
    let apart = |i: usize, j: usize| (i % NODES).abs_diff(j % NODES).pow(2) + (i / NODES).abs_diff(j / NODES).pow(2);
    let nearest = |i: usize| {
        let lit = (0..nodes.len()).filter(|j| nodes[*j].is_some());
        nodes[lit.min_by_key(|j| apart(i, *j))?].clone()
    };
    (0..nodes.len()).map(nearest).collect()
}

/// Traces outlines.
struct Tracer<'a> {
    view: &'a PinholeView<'a>,
    focus_per_m: f64,
    other_per_m: f64,
}

impl Tracer<'_> {
    /// The outline of a field point, px of the view.
    fn outline(&self, px: DVec2) -> Option<Outline> {
        let sensor_mm = self.view.raster.sensor_mm(px - self.view.margin_px as f64);
        let edge = self.edge(sensor_mm)?;
        let (mut anchor, mut slope) = ([DVec2::ZERO; VERTICES], [DVec2::ZERO; VERTICES]);
        for (k, pupil) in edge.into_iter().enumerate() {
            (anchor[k], slope[k]) = self.line(sensor_mm, pupil)?;
        }
        Some(Outline { anchor: unclipped(anchor), slope: unclipped(slope) })
    }

    /// The in-focus offset of the ray of a pupil sample, and the change per 1/m. Offsets are linear in 1/d, so a nearer plane serves where the most
    /// defocused distance leads beyond the field of the lens.
    fn line(&self, sensor_mm: DVec2, pupil: DVec2) -> Option<(DVec2, DVec2)> {
        let mut lever_per_m = self.other_per_m - self.focus_per_m;
        for _ in 0..LEVERS {
            if let Some([sharp, other]) = self.steps_px(sensor_mm, pupil, self.focus_per_m + lever_per_m) {
                return Some((sharp, (other - sharp) / lever_per_m));
            }
            lever_per_m *= 0.5;
        }
        None
    }

    /// Pupil samples just inside the edge of the open part.
    fn edge(&self, sensor_mm: DVec2) -> Option<[DVec2; VERTICES]> {
        let open = |pupil: DVec2| self.view.lens.unobscured_ray(sensor_mm, pupil, PRINCIPAL_NM).is_some();
        let cell = |i: usize| (DVec2::new((i % GRID) as f64, (i / GRID) as f64) + 0.5) / GRID as f64;
        let open_points: Vec<DVec2> = (0..GRID * GRID).map(cell).filter(|pupil| open(*pupil)).collect();
        let mean = open_points.iter().copied().sum::<DVec2>() / open_points.len() as f64;
        let apart = |p: &DVec2| p.distance_squared(mean);
        let centre = open_points.iter().copied().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        let turn = self.turn(sensor_mm);
        Some(core::array::from_fn(|k| {
            let edge_place = around((k as f64 / VERTICES as f64 - turn).rem_euclid(1.0));
            let on_way = |t: f64| centre + (edge_place - centre) * t;
            if open(edge_place) {
                return edge_place;
            }
            let halved = (0..HALVINGS).fold([0.0, 1.0], |[inside, outside], _| {
                let half = 0.5 * (inside + outside);
                if open(on_way(half)) { [half, outside] } else { [inside, half] }
            });
            on_way(halved[0])
        }))
    }

    /// Rotation, in turns, of the pupil samples of a field point against the image. A prescription samples its pupil in the meridian's frame; the
    /// vertices keep the directions of the image, so that those of neighbouring nodes correspond.
    fn turn(&self, sensor_mm: DVec2) -> f64 {
        let turn = |outward: DVec2| {
            let outward = outward.normalize_or(DVec2::X);
            atan2(outward.y, outward.x) / (2.0 * PI)
        };
        match self.view.lens {
            Lens::Prescription(lens) => turn(sensor_mm * -lens.prescription().inversion()),
            Lens::RayTransfer(_) => turn(-sensor_mm),
            Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) | Lens::Calibrated(_) | Lens::Telecentric(_) => 0.0,
        }
    }

    /// Offsets (px) to where the ray of a pupil sample meets the planes at the focus distance and at another distance.
    fn steps_px(&self, sensor_mm: DVec2, pupil: DVec2, other_per_m: f64) -> Option<[DVec2; 2]> {
        let lens = self.view.lens;
        let ahead = lens.direction(sensor_mm)?.normalize();
        let ray = lens.unobscured_ray(sensor_mm, pupil, PRINCIPAL_NM)?;
        let across = if ahead.z > ACROSS_AXIS { DVec3::Z } else { ahead };
        let step = |inverse_per_m: f64| {
            let origin = ray.origin_m * inverse_per_m;
            let along = (ahead - origin).dot(across) / ray.direction.dot(across);
            Some((lens.project(origin + ray.direction * along)? - sensor_mm) / self.view.raster.pitch_mm())
        };
        Some([step(self.focus_per_m)?, step(other_per_m)?])
    }
}

/// A point of the unit square's border, at `turn` in [0, 1) around it; half a turn on is the opposite point. It lies inside by the width of rounding.
fn around(turn: f64) -> DVec2 {
    let t = 4.0 * turn;
    let along = t - t.floor();
    let p = match t as usize {
        0 => DVec2::new(along, 0.0),
        1 => DVec2::new(1.0, along),
        2 => DVec2::new(1.0 - along, 1.0),
        _ => DVec2::new(0.0, 1.0 - along),
    };
    p.clamp(DVec2::splat(1e-9), DVec2::splat(1.0 - 1e-9))
}

/// Scales the polygon to the area of the round outline whose points are its vertices.
fn unclipped(polygon: Polygon) -> Polygon {
    let turn = 2.0 * PI / VERTICES as f64;
    let growth = (turn / sin(turn)).sqrt();
    let centre = polygon.iter().copied().sum::<DVec2>() / VERTICES as f64;
    polygon.map(|v| centre + (v - centre) * growth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lens::PrescriptionLens;
    use crate::prescription::{Focus, Prescription, PrescriptionParameters, published};
    use etendue_core::plane::{Plane, SpectralCube};
    use etendue_core::wavelength::Bands;
    use etendue_projection::Raster;

    /// Areas of the footprints of a lens at f/8, focused at 2 m, of objects at `distance_m`, at the centre of the image and off it, divided by the
    /// area of the circle of confusion.
    fn areas(name: &str, radius_mm: f64, distance_m: f32) -> Vec<f64> {
        let surfaces = published::named(name).expect("published").surfaces();
        let focus = Focus::Sensor { distance_m: 2.0 };
        let lens = Prescription::new(PrescriptionParameters {
            f_number: Some(8.0),
            ..PrescriptionParameters::new(surfaces, focus)
        });
        let lens = Lens::prescription(PrescriptionLens::new(lens.expect("a lens"), None, radius_mm).expect("lit"));
        let raster = Raster::centred(72, 48, radius_mm / 43.3).expect("a raster");
        let radiance = SpectralCube::new(72, 48, Bands::covering(500.0, 600.0, 100.0).expect("a band"));
        let distance = Plane::filled(72, 48, distance_m);
        let view = PinholeView::new(&lens, &raster, 0, &radiance, &distance).expect("fits");
        let inverse = 1.0 / f64::from(distance_m);
        let footprints = Footprints::new(&view, [inverse, inverse]).expect("blurred");
        let step = |i: i32| DVec2::new(36.0, 24.0) + DVec2::new(0.9, 0.7) * f64::from(i);
        let circle_px = lens.circle_of_confusion_mm(f64::from(distance_m)) / raster.pitch_mm().x;
        let disc = 0.25 * PI * circle_px * circle_px;
        (-10..=10).map(|i| area(&footprints.outline_at(step(i), inverse)) / disc).collect()
    }

    /// The meridian turns quickly about the axis; the blur does not. Aberrations at f/8 change it by less than a tenth.
    #[test]
    fn the_blur_of_a_prescription_does_not_shrink_beside_the_axis() {
        let actual = areas("double-gauss", 21.6, 0.5);
        assert!(actual.iter().all(|a| (a - 1.0).abs() < 0.1 && (a / actual[10] - 1.0).abs() < 0.03), "{actual:?}");
    }

    /// Rays to a very near object lead beyond the field of the lens; the blur is limited to that.
    #[test]
    fn a_near_thing_does_not_switch_the_blur_off() {
        let actual = areas("telephoto", 6.3, 0.12);
        assert!(actual.iter().all(|a| (a - 1.0).abs() < 0.1), "{actual:?}");
    }
}
