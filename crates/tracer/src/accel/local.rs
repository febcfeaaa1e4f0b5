//! A ray in a mesh's frame, prepared for triangles.
//!
//! Space is sheared so that the ray runs along one axis: the one where its direction is greatest becomes the third
//! (Woop, Benthin, Wald 2013, "Watertight ray/triangle intersection", JCGT 2(1)).

use glam::Vec3;

/// The axes that become x, y and z, by the first of them; an even or odd order makes no difference to a two-sided test.
const AXES: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

/// A ray in a mesh's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalRay {
    pub(super) origin: Vec3,
    pub(super) direction: Vec3,
    /// Reciprocals of the direction's components; infinite where they are zero.
    pub(super) inverse: Vec3,
    /// The axis that becomes x.
    first: usize,
    /// The origin's coordinates along the axes that become x, y and z.
    pub(super) start: [f32; 3],
    /// Shears of x and y along z, and the length of z: t = z · scale.
    pub(super) shear: [f32; 2],
    pub(super) scale: f32,
    /// Number in the tree of the triangle that the ray leaves; [`NONE_LEFT`] where it leaves none.
    pub(super) left: u32,
}

/// No triangle's number.
pub(super) const NONE_LEFT: u32 = u32::MAX;

impl LocalRay {
    /// Prepares a ray.
    #[inline(always)]
    pub(crate) fn new(origin: Vec3, direction: Vec3) -> Self {
        let first = first_axis(direction);
        let ([ox, oy, oz], [dx, dy, dz]) = (origin.to_array(), direction.to_array());
        let (o, d) = ([ox, oy, oz, ox, oy], [dx, dy, dz, dx, dy]);
        let along = d[first + 2];
        Self {
            origin,
            direction,
            inverse: direction.recip(),
            first,
            start: [o[first], o[first + 1], o[first + 2]],
            shear: [d[first] / along, d[first + 1] / along],
            scale: 1.0 / along,
            left: NONE_LEFT,
        }
    }

    /// The same ray, which leaves a triangle, by its number in the tree, or [`NONE_LEFT`].
    #[inline(always)]
    pub(super) fn leaving(self, left: u32) -> Self {
        Self { left, ..self }
    }

    /// The axes that become x, y and z.
    #[inline(always)]
    pub(super) fn axes(&self) -> [usize; 3] {
        AXES[self.first.min(2)]
    }
}

/// The axis after the one where a direction is greatest. Without branches, which nobody could foresee.
#[inline(always)]
fn first_axis(direction: Vec3) -> usize {
    let [x, y, z] = direction.abs().to_array();
    let is_x = usize::from(x > y) & usize::from(x > z);
    let is_y = (1 - is_x) & usize::from(y > z);
    (is_x | is_y << 1).min(2)
}
