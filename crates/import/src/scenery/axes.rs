//! From the axes of another program's world to ours.

use glam::{DMat3, DVec3};

/// From another program's world to ours, of a camera's axes there (columns: right, up, ahead, as its picture has them): upwards goes the axis nearest
/// to the camera's up, forward the one after it (x, y, z, x), and the picture is not mirrored.
pub(crate) fn to_ours(camera: DMat3) -> DMat3 {
    let up = camera.y_axis;
    let size = up.abs();
    let axis = if size.z >= size.x && size.z >= size.y { 2 } else { usize::from(size.y >= size.x) };
    let unit = |i: usize| DVec3::from_array(std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let (ahead, up) = (unit((axis + 1) % 3), unit(axis) * up[axis].signum());
    // Right, up, ahead is left-handed in a right-handed world.
    let left = up.cross(ahead) * if camera.determinant() > 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(ahead, left, up).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_handed_world_is_turned_and_a_left_handed_one_mirrored() {
        // Looks along −z with y upwards, as in most right-handed scenes: right is x.
        let right_handed = to_ours(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::NEG_Z));
        assert_eq!(right_handed * DVec3::Z, DVec3::X);
        assert_eq!(right_handed * DVec3::X, DVec3::Y);
        assert_eq!(right_handed * DVec3::Y, DVec3::Z);
        // Looks along z, right is x: left-handed.
        let left_handed = to_ours(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::Z));
        assert_eq!(left_handed * DVec3::Z, DVec3::X);
        assert_eq!(left_handed * DVec3::X, DVec3::NEG_Y);
    }
}
