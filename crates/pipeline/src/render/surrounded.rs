//! Whether a camera stands inside a solid object, where it sees the inside of its surface alone.

use crate::plan::{CameraPlan, Plan};
use crate::render::exposure::{FilmExposure, Shot};
use etendue_core::Ray;
use glam::Vec3;

/// The name of the object that a camera stands in at the first frame's beginning; `None` where it sees anything else, a surface from outside, or through
/// one. Fourteen directions are looked along: those of the faces and corners of a cube.
pub(crate) fn surrounding_object<'p>(plan: &'p Plan, camera: &CameraPlan) -> Option<&'p str> {
    let exposure = FilmExposure::of(camera, Shot::default());
    let view = plan.world.render_space_for_few(exposure.origin_m(), exposure.interval());
    let (mut object, mut is_inside) = (None, true);
    for direction in directions() {
        let ray = Ray::new(Vec3::ZERO, direction, 0.0);
        let point = view.closest(&ray).map(|hit| view.surface(&ray, &hit));
        let behind = point.filter(|point| {
            point.geometric_normal.dot(direction) > 0.0
                && !plan.material_table.lets_pass(point.material)
                && plan.material_table.solid(point.material).is_none()
                && object.is_none_or(|object| object == point.instance)
        });
        is_inside &= behind.is_some();
        object = behind.map(|point| point.instance);
        if !is_inside {
            return None;
        }
    }
    let instance = plan.world.instances().get(object? as usize)?;
    let identity = plan.identities.get((instance.instance_id as usize).checked_sub(1)?)?;
    Some(&identity.name)
}

fn directions() -> impl Iterator<Item = Vec3> {
    let side = [-1.0_f32, 1.0];
    let faces = side.into_iter().flat_map(|s| [Vec3::X * s, Vec3::Y * s, Vec3::Z * s]);
    // Off the diagonals, which meet edges of boxes about the camera.
    let corner = move |i: usize| Vec3::new(side[i & 1], 0.9 * side[i >> 1 & 1], 0.8 * side[i >> 2]).normalize();
    faces.map(|face| (face + Vec3::new(0.011, 0.007, 0.013)).normalize()).chain((0..8).map(corner))
}
