//! Eight clusters at once.
//!
//! A cluster of intensity I (W·sr⁻¹·nm⁻¹) within a sphere of radius r about c, its light within the half angle θ_o of an
//! axis and, falling by the cosine, θ_e beyond. Seen from a receiver at the distance d under the half angle θ_u
//! (sin θ_u = r/d), θ from the axis and θ_i from the receiver's normal, it counts
//!
//! I · cos max(θ − θ_o − θ_u, 0) · cos max(θ_i − θ_u, 0) / max(d², r²/2),
//!
//! nothing where the first angle exceeds θ_e or the second a right angle, and the cosines are 1 from inside the sphere.
//! A single point thus counts its irradiance.

use super::bounds::LightBounds;
use crate::lights::Receiver;
use glam::Vec3;

/// Children of a node.
pub(super) const LANES: usize = 8;

type Lanes = [f32; LANES];

/// Eight children, component by component. Lanes without a child have no intensity.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct Node {
    centre: [Lanes; 3],
    radius2: Lanes,
    intensity: Lanes,
    axis: [Lanes; 3],
    cos_o: Lanes,
    sin_o: Lanes,
    cos_e: Lanes,
    children: [u32; LANES],
    /// By bits: which children are nodes, and which are lamps without extent.
    nodes: u8,
    lamps: u8,
}

/// A node or a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child {
    pub(super) index: u32,
    pub(super) is_node: bool,
}

/// Cosine that light beyond the axis' own cone keeps at least, within θ_e.
const DIM: f32 = 0.02;

/// What rounding may do to a cosine here; nothing is taken for dark or below the horizon that is not so by this much.
const MARGIN: f32 = 1e-4;

/// Share of r² that d² is not taken below: a receiver among the lights is near to one of them.
const INSIDE: f32 = 0.5;

impl Node {
    pub(super) fn set(&mut self, lane: usize, bounds: &LightBounds, child: Child, per_scale: f64) {
        let centre = bounds.centre();
        for axis in 0..3 {
            self.centre[axis][lane] = centre[axis];
            self.axis[axis][lane] = bounds.axis[axis];
        }
        let (sin_o, cos_o) = etendue_core::maths::f32::sin_cos(bounds.theta_o);
        self.radius2[lane] = bounds.radius * bounds.radius;
        self.intensity[lane] = (bounds.intensity * per_scale) as f32;
        (self.sin_o[lane], self.cos_o[lane]) = (sin_o, cos_o);
        self.cos_e[lane] = etendue_core::maths::f32::cos(bounds.theta_e);
        self.children[lane] = child.index;
        self.nodes |= u8::from(child.is_node) << lane;
        self.lamps |= u8::from(bounds.is_lamp && !child.is_node) << lane;
    }

    pub(super) fn child(&self, lane: usize) -> Child {
        Child { index: self.children[lane], is_node: self.nodes >> lane & 1 == 1 }
    }

    pub(super) fn is_lamp(&self, lane: usize) -> bool {
        self.lamps >> lane & 1 == 1
    }

    /// Whether a child is as good as a point from `position`.
    pub(super) fn is_far(&self, lane: usize, position: Vec3) -> bool {
        (self.centre_of(lane) - position).length_squared() > 4.0 * self.radius2[lane]
    }

    fn centre_of(&self, lane: usize) -> Vec3 {
        Vec3::new(self.centre[0][lane], self.centre[1][lane], self.centre[2][lane])
    }

    /// What each child counts for a receiver. Without branches, so that lanes go side by side.
    pub(super) fn weights(&self, receiver: &Receiver) -> Lanes {
        let (p, n) = (receiver.position, receiver.normal);
        let from_everywhere = n == Vec3::ZERO;
        core::array::from_fn(|i| {
            let way = [self.centre[0][i] - p.x, self.centre[1][i] - p.y, self.centre[2][i] - p.z];
            let d2 = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
            let per_d = 1.0 / d2.max(f32::MIN_POSITIVE).sqrt();
            let sin2_u = (self.radius2[i] * per_d * per_d).min(1.0);
            let (sin_u, cos_u) = (sin2_u.sqrt(), (1.0 - sin2_u).sqrt());
            let inside = d2 <= self.radius2[i];

            let along = way[0] * self.axis[0][i] + way[1] * self.axis[1][i] + way[2] * self.axis[2][i];
            let cos = (-along * per_d).clamp(-1.0, 1.0);
            let (sin_1, cos_1) = less((1.0 - cos * cos).sqrt(), cos, self.sin_o[i], self.cos_o[i]);
            let (_, cos_2) = less(sin_1, cos_1, sin_u, cos_u);
            let emits = if cos_2 >= self.cos_e[i] - MARGIN { cos_2.max(DIM) } else { 0.0 };

            let cos_i = ((way[0] * n.x + way[1] * n.y + way[2] * n.z) * per_d).clamp(-1.0, 1.0);
            let (_, cos_3) = less((1.0 - cos_i * cos_i).sqrt(), cos_i, sin_u, cos_u);
            let receives = if from_everywhere { 1.0 } else { (cos_3 + MARGIN).max(0.0) };

            let seen = if inside { 1.0 } else { emits * receives };
            self.intensity[i] * seen / d2.max(INSIDE * self.radius2[i]).max(f32::MIN_POSITIVE)
        })
    }
}

/// Sine and cosine of max(a − b, 0), for angles of 0…π given by theirs.
fn less(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> (f32, f32) {
    let within = cos_a > cos_b;
    let sin = if within { 0.0 } else { sin_a * cos_b - cos_a * sin_b };
    let cos = if within { 1.0 } else { cos_a * cos_b + sin_a * sin_b };
    (sin, cos)
}
