//! A node's eight clusters, weighted for a receiver.
//!
//! A cluster has the intensity I (W·sr⁻¹·nm⁻¹) within a sphere of radius r about c. Its light lies within the half angle θ_o of an axis and, falling
//! by the cosine, θ_e beyond. It is seen from a receiver at the distance d under the half angle θ_u (sin θ_u = r/d), θ from the axis and θ_i from the
//! receiver's normal. Its weight is
//!
//! I · cos max(θ − θ_o − θ_u, 0) · cos max(θ_i − θ_u, 0) / max(d², r²/4),
//!
//! and zero if the first angle exceeds θ_e or the second a right angle. The cosines are 1 from inside the sphere. The weight of a single point is
//! thus its irradiance. For a glossy receiver the last cosine increases by the light that its lobes reflect from there (`lights/gloss.rs`).

use glam::Vec3;

use super::bounds::LightBounds;
use crate::lights::gloss::{DirectionCone, FourValues, at_least, at_most, each};
use crate::lights::{LightSampleContext, ReceiverGloss};

/// Children of a node.
pub(super) const LANES: usize = 8;

/// One number for each of a node's children.
pub(super) type NodeLanes = [f32; LANES];

/// Eight children, component by component. Lanes without a child have no intensity.
#[derive(Clone, Debug, Default)]
#[repr(align(32))]
pub(super) struct LightNode {
    centre: [NodeLanes; 3],
    radius2: NodeLanes,
    intensity: NodeLanes,
    axis: [NodeLanes; 3],
    cos_o: NodeLanes,
    sin_o: NodeLanes,
    cos_e: NodeLanes,
    children: [u32; LANES],
    used: u8,
    /// Bit masks: children that are nodes, and children that are lamps.
    nodes: u8,
    lamps: u8,
}

/// A node or a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LightChild {
    pub(super) index: u32,
    pub(super) is_node: bool,
}

/// Minimum cosine of light beyond the axis' own cone, within θ_e.
const MIN_EMISSION_COS: f32 = 0.02;

/// Margin for the rounding of a cosine: a cluster counts as dark or below the horizon only by more than this.
const MARGIN: f32 = 1e-4;

/// Minimum of d² as a fraction of r²: a receiver among the lights is near to one of them.
const MIN_DISTANCE2_RATIO: f32 = 0.25;

impl LightNode {
    pub(super) fn set(&mut self, lane: usize, bounds: &LightBounds, child: LightChild, per_scale: f64) {
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
        self.used = self.used.max(lane as u8 + 1);
        self.nodes |= u8::from(child.is_node) << lane;
        self.lamps |= u8::from(bounds.is_lamp && !child.is_node) << lane;
    }

    pub(super) fn child(&self, lane: usize) -> LightChild {
        LightChild { index: self.children[lane], is_node: self.nodes >> lane & 1 == 1 }
    }

    pub(super) fn is_lamp(&self, lane: usize) -> bool {
        self.lamps >> lane & 1 == 1
    }

    /// True if a child is more than a point.
    pub(super) fn has_extent(&self, lane: usize) -> bool {
        self.radius2[lane] > 0.0
    }

    /// True if a child can be treated as a point from `position`.
    pub(super) fn is_far(&self, lane: usize, position: Vec3) -> bool {
        (self.centre_of(lane) - position).length_squared() > 4.0 * self.radius2[lane]
    }

    /// Maximum weights of the children for a receiver with the weights `weights`, if all light of a child came from the place in it that
    /// the lobes favour most.
    pub(super) fn max_weights(
        &self,
        lane: usize,
        weights: &GlossyWeights,
        receiver: &LightSampleContext,
        gloss: &ReceiverGloss,
    ) -> f32 {
        let to_light = self.centre_of(lane) - receiver.position;
        let (distance2, radius2) = (to_light.length_squared(), self.radius2[lane]);
        // From inside, the light may come from everywhere.
        let cone = (distance2 > radius2)
            .then(|| DirectionCone { axis: to_light / distance2.sqrt(), sin: (radius2 / distance2).sqrt() });
        weights.diffuse[lane] + weights.facing[lane] * gloss.max_relative(cone)
    }

    fn centre_of(&self, lane: usize) -> Vec3 {
        Vec3::new(self.centre[0][lane], self.centre[1][lane], self.centre[2][lane])
    }

    /// The weight of each child for a receiver: four children at a time, the second four if there are any.
    pub(super) fn weights(&self, receiver: &LightSampleContext) -> NodeLanes {
        let mut weights = [0.0; LANES];
        self.fill(receiver, |from, reached| weights[from..from + 4].copy_from_slice(&reached.plain()));
        weights
    }

    /// The weight of each child for a receiver of this gloss, and for a diffuse one.
    pub(super) fn glossy_weights(&self, receiver: &LightSampleContext, gloss: &ReceiverGloss) -> GlossyWeights {
        let mut weights = GlossyWeights::default();
        self.fill(receiver, |from, reached| {
            weights.diffuse[from..from + 4].copy_from_slice(&reached.plain());
            weights.with_gloss[from..from + 4].copy_from_slice(&reached.gloss_weight(gloss));
            weights.facing[from..from + 4].copy_from_slice(&reached.facing_weight());
        });
        weights
    }

    #[inline(always)]
    fn fill(&self, receiver: &LightSampleContext, mut keep: impl FnMut(usize, VisibleClusters)) {
        keep(0, self.four(0, receiver));
        if self.used > 4 {
            keep(4, self.four(4, receiver));
        }
    }

    /// Four children as seen by the receiver, from lane `from` on. In small steps without branches, each over all four, so that the
    /// compiler vectorises them.
    #[inline(always)]
    fn four(&self, from: usize, receiver: &LightSampleContext) -> VisibleClusters {
        let (p, n) = (receiver.position, receiver.normal);
        // 1 if light counts from everywhere; the cosine then does not count.
        let everywhere = if n == Vec3::ZERO { 1.0 } else { 0.0 };
        let lanes = |of: &NodeLanes| -> FourValues { each(|i| of[from + i]) };
        let (radius2, sin_o, cos_o) = (lanes(&self.radius2), lanes(&self.sin_o), lanes(&self.cos_o));
        let (x, y, z) = (lanes(&self.centre[0]), lanes(&self.centre[1]), lanes(&self.centre[2]));
        let (x, y, z) = (each(|i| x[i] - p.x), each(|i| y[i] - p.y), each(|i| z[i] - p.z));
        let d2 = each(|i| x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
        let per_d = each(|i| 1.0 / at_least(d2[i], f32::MIN_POSITIVE).sqrt());
        let sin2_u = each(|i| at_most(radius2[i] * per_d[i] * per_d[i], 1.0));
        let subtended = SinCos { sin: each(|i| sin2_u[i].sqrt()), cos: each(|i| (1.0 - sin2_u[i]).sqrt()) };

        let axis = [lanes(&self.axis[0]), lanes(&self.axis[1]), lanes(&self.axis[2])];
        let along = each(|i| x[i] * axis[0][i] + y[i] * axis[1][i] + z[i] * axis[2][i]);
        let cos = each(|i| at_most(at_least(-along[i] * per_d[i], -1.0), 1.0));
        let sin = each(|i| (1.0 - cos[i] * cos[i]).sqrt());
        let cos_2 = less(less(SinCos { sin, cos }, SinCos { sin: sin_o, cos: cos_o }), subtended).cos;
        let cos_e = lanes(&self.cos_e);
        let emits = each(|i| if cos_2[i] >= cos_e[i] - MARGIN { at_least(cos_2[i], MIN_EMISSION_COS) } else { 0.0 });

        let cos_i = each(|i| at_most(at_least((x[i] * n.x + y[i] * n.y + z[i] * n.z) * per_d[i], -1.0), 1.0));
        let sin_i = each(|i| (1.0 - cos_i[i] * cos_i[i]).sqrt());
        let cos_3 = less(SinCos { sin: sin_i, cos: cos_i }, subtended).cos;
        let receives = each(|i| at_least(at_least(cos_3[i] + MARGIN, 0.0), everywhere));

        let far2 = each(|i| at_least(at_least(d2[i], MIN_DISTANCE2_RATIO * radius2[i]), f32::MIN_POSITIVE));
        VisibleClusters {
            directions: [each(|i| x[i] * per_d[i]), each(|i| y[i] * per_d[i]), each(|i| z[i] * per_d[i])],
            sin_u: subtended.sin,
            is_inside: core::array::from_fn(|i| d2[i] <= radius2[i]),
            emits,
            receives,
            intensity: each(|i| self.intensity[from + i]),
            far2,
        }
    }
}

/// Four clusters as seen by a receiver.
struct VisibleClusters {
    /// Unit, towards them.
    directions: [FourValues; 3],
    sin_u: FourValues,
    /// True if the receiver is within the cluster's sphere.
    is_inside: [bool; 4],
    emits: FourValues,
    receives: FourValues,
    intensity: FourValues,
    /// Squared distance, m²; slightly more from inside or near by.
    far2: FourValues,
}

impl VisibleClusters {
    /// Weight for a diffuse receiver.
    #[inline(always)]
    fn plain(&self) -> FourValues {
        self.counted([0.0; 4])
    }

    /// Weight for a glossy receiver.
    #[inline(always)]
    fn gloss_weight(&self, gloss: &ReceiverGloss) -> FourValues {
        self.counted(gloss.relative_four(self.directions, self.sin_u))
    }

    /// Weight for a receiver that faces it.
    #[inline(always)]
    fn facing_weight(&self) -> FourValues {
        let emitted = each(|i| if self.is_inside[i] { 1.0 } else { self.emits[i] });
        each(|i| self.intensity[i] * emitted[i] / self.far2[i])
    }

    #[inline(always)]
    fn counted(&self, gloss: FourValues) -> FourValues {
        let scattered = each(|i| if self.receives[i] > 0.0 { self.receives[i] + gloss[i] } else { 0.0 });
        let emitted = each(|i| if self.is_inside[i] { 1.0 + gloss[i] } else { self.emits[i] * scattered[i] });
        each(|i| self.intensity[i] * emitted[i] / self.far2[i])
    }
}

/// Weights of eight children for a glossy receiver, for a diffuse one in its place, and for one that faces them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GlossyWeights {
    pub(super) with_gloss: NodeLanes,
    pub(super) diffuse: NodeLanes,
    pub(super) facing: NodeLanes,
}

/// Sines and cosines of four angles of 0…π.
#[derive(Clone, Copy)]
struct SinCos {
    sin: FourValues,
    cos: FourValues,
}

/// Sines and cosines of max(a − b, 0).
#[inline(always)]
fn less(a: SinCos, b: SinCos) -> SinCos {
    let sin = each(|i| if a.cos[i] > b.cos[i] { 0.0 } else { a.sin[i] * b.cos[i] - a.cos[i] * b.sin[i] });
    let cos = each(|i| if a.cos[i] > b.cos[i] { 1.0 } else { a.cos[i] * b.cos[i] + a.sin[i] * b.sin[i] });
    SinCos { sin, cos }
}
