//! Sums over directions that stand for integrals.

use etendue_core::maths::f64::sin_cos;
use glam::{DVec3, Vec3};

/// A direction with its share of the integral.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Unit, lamp's frame.
    pub(super) direction: Vec3,
    /// The profile there.
    pub(super) value: f32,
    /// Solid angle that it stands for, sr.
    pub(super) weight_sr: f64,
    /// How far the directions it stands for may be from it, rad.
    pub(super) spacing_rad: f32,
}

impl Node {
    pub(super) fn flux(&self) -> f64 {
        f64::from(self.value) * self.weight_sr
    }
}

/// The two nodes and weights of Gauss and Legendre on [0, 1]: exact for cubics.
pub(super) const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Rings and sectors of [`cap`]: of the whole sphere, cells of 1.4° × 1.4° at the equator.
const RINGS: usize = 128;
const SECTORS: usize = 256;

/// Directions about +x whose cosine is at least 1 − `one_minus_cos`, each standing for the same solid angle.
pub(super) fn cap(one_minus_cos: f64, value: impl Fn(Vec3) -> f32) -> Vec<Node> {
    let weight_sr = core::f64::consts::TAU * one_minus_cos / (RINGS * SECTORS) as f64;
    let spacing_rad = 2.0 * weight_sr.sqrt() as f32;
    let cells = (0..RINGS).flat_map(|ring| (0..SECTORS).map(move |sector| (ring, sector)));
    let node = |(ring, sector): (usize, usize)| {
        let low = one_minus_cos * (ring as f64 + 0.5) / RINGS as f64;
        let (sin, cos) = sin_cos(core::f64::consts::TAU * (sector as f64 + 0.5) / SECTORS as f64);
        let aside = (low * (2.0 - low)).sqrt();
        let direction = DVec3::new(1.0 - low, aside * cos, aside * sin).as_vec3();
        Node { direction, value: value(direction), weight_sr, spacing_rad }
    };
    cells.map(node).collect()
}
