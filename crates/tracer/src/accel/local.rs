//! A ray in a mesh's frame, prepared for triangles.
//!
//! Space is sheared so that the ray runs along one axis: the one where its direction is greatest becomes the third
//! (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection", JCGT 2(1)).

use glam::{DVec3, Vec3};

/// A ray in a mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalRay {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// The axes that become x, y and z; an even or odd order makes no difference to a two-sided test.
    pub(super) axes: [usize; 3],
    /// Shears of x and y along z, and the length of z: t = z · scale.
    pub(super) shear: [f32; 2],
    pub(super) scale: f32,
}

impl LocalRay {
    /// Rounds a ray to f32 and prepares it.
    #[inline(always)]
    pub(crate) fn new(origin: DVec3, direction: DVec3) -> Self {
        let (origin, direction) = (origin.as_vec3(), direction.as_vec3());
        let d = direction.to_array();
        let [x, y, z] = [d[0].abs(), d[1].abs(), d[2].abs()];
        let axes = if x > y && x > z {
            [1, 2, 0]
        } else if y > z {
            [2, 0, 1]
        } else {
            [0, 1, 2]
        };
        let along = d[axes[2]];
        Self { origin, direction, axes, shear: [d[axes[0]] / along, d[axes[1]] / along], scale: 1.0 / along }
    }
}
