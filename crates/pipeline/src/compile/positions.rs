//! World coordinates of the ground truth, which are 32-bit floats: said where they lose more than a millimetre.

use super::context::Context;
use crate::plan::CameraPlan;

/// Rounding from which on it is said, m.
const NOTICED_M: f64 = 1e-3;

/// Says what the positions of cameras far from the world's origin lose.
pub(super) fn remark(cameras: &[CameraPlan], context: &mut Context<'_>) {
    for camera in cameras.iter().filter(|c| c.products.ground_truth && !c.products.camera_space_position) {
        let farthest = camera.path.at(camera.timing.frame_start_s(0)).position_m.abs().max_element();
        let rounding = f64::from(f32::EPSILON) * 0.5 * farthest;
        if rounding > NOTICED_M {
            context.remark_on(format!("camera \"{}\"", camera.name), format!(
                "positions of the ground truth are 32-bit floats, {farthest:.0} m from the world's origin \
                 rounded by up to {rounding:.1e} m; depth, distance and normals are not: ask for \"camera_space_position\" and add the \
                 side-car's pose"
            ));
        }
    }
}
