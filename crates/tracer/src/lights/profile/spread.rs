//! Data of a profile for the selection of lamps: amount of light, and its cone.

use etendue_core::{maths, maths::f64::sin_cos};
use glam::{DVec3, Vec3};

/// Flux, peak and bounding cone of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::lights) struct DirectionalExtent {
    /// ∫ value dΩ.
    pub(in crate::lights) flux_sr: f64,
    /// Maximum value.
    pub(in crate::lights) peak: f64,
    /// Mean direction of the light, unit.
    pub(in crate::lights) axis: Vec3,
    /// Half angle about `axis` that holds nine tenths of the flux, rad.
    pub(in crate::lights) core_rad: f32,
    /// Half angle about `axis` beyond which there is no light, rad.
    pub(in crate::lights) reach_rad: f32,
}

/// Fraction of the flux within the core.
const CORE: f64 = 0.9;

impl DirectionalExtent {
    /// The spread of a profile of value 1 everywhere.
    pub(super) const EVERYWHERE: Self = Self {
        flux_sr: 4.0 * core::f64::consts::PI,
        peak: 1.0,
        axis: Vec3::X,
        core_rad: core::f32::consts::PI,
        reach_rad: core::f32::consts::PI,
    };

    /// The spread of the distribution that `nodes` sum up.
    pub(super) fn from_nodes(nodes: &[ProfileNode]) -> Self {
        let flux_sr: f64 = nodes.iter().map(ProfileNode::flux).sum();
        let peak = nodes.iter().map(|n| f64::from(n.value)).fold(0.0, f64::max);
        let mean: DVec3 = nodes.iter().map(|n| n.direction.as_dvec3() * n.flux()).sum();
        // A mean that is short compared with its terms is rounding: the light is isotropic.
        let axis = if mean.length() > 1e-6 * flux_sr { mean.normalize().as_vec3() } else { Vec3::X };
        let (core_rad, reach_rad) = half_angles(nodes, axis, flux_sr);
        Self { flux_sr, peak, axis, core_rad, reach_rad }
    }
}

/// Core and reach about `axis`, by steps of half a degree; the reach with a margin for directions between nodes.
fn half_angles(nodes: &[ProfileNode], axis: Vec3, flux_sr: f64) -> (f32, f32) {
    const STEPS: usize = 360;
    let mut shells = [0.0; STEPS];
    let mut reach = 0.0_f32;
    for node in nodes.iter().filter(|n| n.value > 0.0) {
        // By the chord, which keeps the digits of small angles.
        let angle = 2.0 * maths::f32::asin((0.5 * axis.distance(node.direction)).min(1.0));
        shells[((angle.to_degrees() * 2.0) as usize).min(STEPS - 1)] += node.flux();
        reach = reach.max(angle + node.spacing_rad);
    }
    let mut sum = 0.0;
    let within = |shell: &f64| {
        sum += shell;
        sum >= CORE * flux_sr
    };
    let steps = shells.iter().position(within).unwrap_or(STEPS - 1) + 1;
    let reach = reach.min(core::f32::consts::PI);
    ((0.5 * steps as f32).to_radians().min(reach), reach)
}

/// A direction with its part of the integral.
#[derive(Clone, Copy, Debug)]
pub(super) struct ProfileNode {
    /// Unit vector in the lamp's frame.
    pub(super) direction: Vec3,
    /// Value of the profile there.
    pub(super) value: f32,
    /// Solid angle that it represents, sr.
    pub(super) weight_sr: f64,
    /// Maximum angle between it and the directions that it represents, rad.
    pub(super) spacing_rad: f32,
}

impl ProfileNode {
    pub(super) fn flux(&self) -> f64 {
        f64::from(self.value) * self.weight_sr
    }
}

/// The two nodes and weights of Gauss and Legendre on [0, 1]: exact for cubics.
pub(super) const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Rings and sectors of [`cap`]: of the whole sphere, cells of 1.4° × 1.4° at the equator.
const RINGS: usize = 128;
const SECTORS: usize = 256;

/// Directions about +x whose cosine is at least 1 − `one_minus_cos`, each representing the same solid angle.
pub(super) fn cap(one_minus_cos: f64, value: impl Fn(Vec3) -> f32) -> Vec<ProfileNode> {
    let weight_sr = core::f64::consts::TAU * one_minus_cos / (RINGS * SECTORS) as f64;
    let spacing_rad = 2.0 * weight_sr.sqrt() as f32;
    let cells = (0..RINGS).flat_map(|ring| (0..SECTORS).map(move |sector| (ring, sector)));
    let node = |(ring, sector): (usize, usize)| {
        let low = one_minus_cos * (ring as f64 + 0.5) / RINGS as f64;
        let (sin, cos) = sin_cos(core::f64::consts::TAU * (sector as f64 + 0.5) / SECTORS as f64);
        let aside = (low * (2.0 - low)).sqrt();
        let direction = DVec3::new(1.0 - low, aside * cos, aside * sin).as_vec3();
        ProfileNode { direction, value: value(direction), weight_sr, spacing_rad }
    };
    cells.map(node).collect()
}
