//! Cameras inside a solid object, which see only the inside of its surface.

use crate::plan::{CameraPlan, Plan};
use crate::render::exposure::{FilmExposure, FrameCapture};
use etendue_core::Ray;
use glam::Vec3;

/// Name of the object that contains a camera at the start of the first frame; `None` if the camera sees anything else: a surface from outside, or through
/// one. Tests fourteen directions: those of the faces and corners of a cube.
pub(crate) fn surrounding_object<'p>(plan: &'p Plan, camera: &CameraPlan) -> Option<&'p str> {
    let exposure = FilmExposure::new(camera, FrameCapture::default());
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
    plan.identity(instance.instance_id).map(|identity| identity.name.as_str())
}

fn directions() -> impl Iterator<Item = Vec3> {
    let side = [-1.0_f32, 1.0];
    let faces = side.into_iter().flat_map(|s| [Vec3::X * s, Vec3::Y * s, Vec3::Z * s]);
    // Off the diagonals, which hit edges of boxes around the camera.
    let corner = move |i: usize| Vec3::new(side[i & 1], 0.9 * side[i >> 1 & 1], 0.8 * side[i >> 2]).normalize();
    faces.map(|face| (face + Vec3::new(0.011, 0.007, 0.013)).normalize()).chain((0..8).map(corner))
}

#[cfg(test)]
mod tests {
    use crate::render::test_scenes::{PINHOLE, plan};

    fn warnings(lens: &str, objects: &str) -> String {
        plan(lens, &format!("{objects}\n[scene.environment]\ntype = \"uniform\"\nradiance_w_m2_sr_nm = 1\n"))
            .warnings()
            .join("\n")
    }

    fn object(shape: &str, keys: &str) -> String {
        format!("[[scene.objects]]\nname = \"it\"\nmaterial = \"grey\"\nshape = {{ {shape} }}\n{keys}\n")
    }

    #[test]
    fn cameras_inside_objects_are_warned_of() {
        let inside = "camera eye: it is inside the object it";
        assert!(
            warnings(PINHOLE, &object("type = \"box\", size_m = [4, 2, 2]", "position_m = [1, 0, 0]")).contains(inside)
        );
        assert!(warnings(PINHOLE, &object("type = \"sphere\", radius_m = 2", "")).contains(inside));
        let outside = warnings(PINHOLE, &object("type = \"box\", size_m = [4, 2, 2]", "position_m = [9, 0, 0]"));
        assert_eq!(outside, "");
    }

    #[test]
    fn implausible_sizes_and_fields_are_warned_of() {
        let car = |size: &str| {
            let keys = "class = \"car\"\nposition_m = [900, 0, 0]\n[scene.classes]\ncar = 1";
            warnings(PINHOLE, &object(&format!("type = \"box\", size_m = {size}"), keys))
        };
        assert_eq!(car("[4.5, 1.8, 1.5]"), "");
        assert!(car("[450, 180, 150]").contains("check the scale of its mesh"));
        assert!(car("[0.0045, 0.0018, 0.0015]").contains("check the scale of its mesh"));
        assert!(car("[1.8, 1.5, 4.5]").contains("check up_axis"));
        let distant = object("type = \"sphere\", radius_m = 1", "position_m = [9, 0, 0]");
        for lens in ["focal_length_mm = 0.05", "focal_length_mm = 6000"] {
            let actual = warnings(&format!("type = \"pinhole\", {lens}, f_number = 2"), &distant);
            assert!(actual.contains("the field of view is"), "{lens}: {actual}");
        }
    }
}
