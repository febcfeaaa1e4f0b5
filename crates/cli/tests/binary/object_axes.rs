//! Boxes are aligned with the axes of their object, x forward and z up, for any axes of its mesh file.

use crate::support::{etendue, text};
use etendue_core::maths::f64::sin_cos;
use glam::{DMat3, DVec3};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Length, width and height of a car, m.
pub(crate) const SIZE_M: DVec3 = DVec3::new(2.8, 1.5, 1.3);
/// Axes of a file that point forward and up: z up, y up as in every glTF, and less common ones.
pub(crate) const AXES: [(&str, &str); 5] = [("x", "z"), ("z", "y"), ("-z", "y"), ("-x", "y"), ("y", "-z")];

fn axis(name: &str) -> DVec3 {
    let vector = match name.trim_start_matches('-') {
        "x" => DVec3::X,
        "y" => DVec3::Y,
        _ => DVec3::Z,
    };
    if name.starts_with('-') { -vector } else { vector }
}

/// The car as a file with these axes; its origin is on the ground.
pub(crate) fn obj(forward: &str, up: &str) -> String {
    let (forward, up) = (axis(forward), axis(up));
    let to_file = DMat3::from_cols(forward, up.cross(forward), up);
    let corner = |i: u32| DVec3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from)) - DVec3::new(0.5, 0.5, 0.0);
    let vertex = |v: DVec3| format!("v {} {} {}\n", v.x, v.y, v.z);
    let vertices: String = (0..8).map(|i| vertex(to_file * (corner(i) * SIZE_M))).collect();
    vertices + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n"
}

/// A camera that looks along x at the car, which is turned about the vertical by `turn_deg`.
pub(crate) fn job(forward: &str, up: &str, turn_deg: f64) -> String {
    format!(
        "format = 1\n[sequence]\nframe_rate_hz = 10\n[[cameras]]\nname = \"front\"\nposition_m = [0, 0, 1.5]\nlook_at_m = [10, 0, 1.5]\n\
         lens = {{ type = \"pinhole\", focal_length_mm = 4, f_number = 4 }}\n\
         sensor = {{ width_px = 80, height_px = 48, pixel_pitch_um = 48, exposure_s = 0.001, dark_current_e_s = 0, cfa = \"mono\", \
         quantum_efficiency = 0.5, full_well_e = 60000, read_noise_e = 3, gain_dn_per_e = 0.06, black_level_dn = 64, bits = 12 }}\n\
         isp = {{ exposure_gain = 1 }}\n\
         [render]\nspp = 1\nreplicates = 1\nintegrator = \"flat\"\n[output]\nboxes = true\n[scene]\nclasses = {{ car = 26 }}\n\
         environment = {{ type = \"uniform\", luminance_cd_m2 = 1000, illuminant = \"D65\" }}\n\
         [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[scene.meshes]]\nname = \"car\"\nfile = \"car.obj\"\nup_axis = \"{up}\"\nforward_axis = \"{forward}\"\n\
         [[scene.objects]]\nname = \"car\"\nmesh = \"car\"\nclass = \"car\"\nmaterial = \"grey\"\nposition_m = [10, 2, 0]\n\
         rotation_deg = [{turn_deg}, 0, 0]\n"
    )
}

/// Numbers of a KITTI label after its type.
pub(crate) fn label(folder: &Path) -> Vec<f64> {
    let file = folder.join("kitti/front/training/label_2/000000.txt");
    let text = fs::read_to_string(file).expect("a label");
    text.split_whitespace().skip(1).map(|word| word.parse().expect("a number")).collect()
}

pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|number| number.as_f64().expect("a number")).collect()
}

pub(crate) fn assert_near(actual: &[f64], expected: &[f64], case: &str) {
    let is_near = actual.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(actual.len() == expected.len() && is_near, "{case}: {actual:?}, expected {expected:?}");
}

#[test]
fn boxes_do_not_depend_on_the_axes_of_the_file() {
    for (forward, up) in AXES {
        for turn_deg in [0.0_f64, 40.0] {
            let place = tempfile::tempdir().expect("a folder");
            let case = format!("forward {forward}, up {up}, turned by {turn_deg}°");
            fs::write(place.path().join("car.obj"), obj(forward, up)).expect("written");
            let file = place.path().join("job.toml");
            fs::write(&file, job(forward, up, turn_deg)).expect("written");
            let out = place.path().join("set");
            etendue(["dataset", &text(&file), "-o", &text(&out), "--format", "kitti", "--samples", "0..1"]).ok();
            // Height, width, length; the middle of the bottom, x right, y down, z forward; the rotation about y of the forward axis from x.
            let heading = (-90.0 - turn_deg).to_radians();
            assert_near(&label(&out)[7..14], &[1.3, 1.5, 2.8, -2.0, 1.5, 10.0, heading], &case);

            let rendered = place.path().join("out");
            etendue(["render", &text(&file), "-o", &text(&rendered)]).ok();
            let boxes = fs::read(rendered.join("front/boxes.json")).expect("boxes");
            let boxes: Value = serde_json::from_slice(&boxes).expect("JSON");
            let solid = &boxes["objects"][0]["box_3d"];
            assert_near(&numbers(&solid["size_m"]), &SIZE_M.to_array(), &case);
            let (sin, cos) = sin_cos(turn_deg.to_radians() / 2.0);
            let expected = [cos, 0.0, 0.0, sin];
            assert_near(&numbers(&solid["world"]["rotation_wxyz"]), &expected, &case);
        }
    }
}

/// A car next to the camera, 1.7 m to its right, that leaves the image to the right: its label covers the part within the image.
#[test]
fn a_car_beside_the_camera_is_cut_at_the_border_of_the_picture() {
    let place = tempfile::tempdir().expect("a folder");
    let car = "shape = { type = \"box\", size_m = [4.5, 1.8, 1.5] }\nclass = \"car\"\nmaterial = \"grey\"\nposition_m = [2.8, -2.6, 0.75]\n";
    let (before, _) =
        job("x", "z", 0.0).split_once("[[scene.meshes]]").map(|(a, b)| (a.to_owned(), b.to_owned())).expect("a mesh");
    let before = before
        .replace(
            "width_px = 80, height_px = 48, pixel_pitch_um = 48",
            "width_px = 200, height_px = 120, pixel_pitch_um = 20",
        )
        .replace(
            "position_m = [0, 0, 1.5]\nlook_at_m = [10, 0, 1.5]",
            "position_m = [0, 0, 1.2]\nrotation_deg = [0, 0, 0]",
        );
    let file = place.path().join("job.toml");
    fs::write(&file, format!("{before}[[scene.objects]]\nname = \"car\"\n{car}")).expect("written");
    let out = place.path().join("set");
    etendue(["dataset", &text(&file), "-o", &text(&out), "--format", "kitti", "--samples", "0..1"]).ok();
    // 200 px of focal length about (100, 60): the near upper edge, 1.7 m to the right and 0.3 m above, meets the border at a depth of 3.4 m. The
    // image's left edge is that of the far end, 5.05 m ahead. Coordinates are those of pixel centres, and the last of the image are 199 and 119.
    let left = 100.0 + 200.0 * 1.7 / 5.05 - 0.5;
    let top = 60.0 - 200.0 * 0.3 / 3.4 - 0.5;
    let actual = &label(&out)[3..7];
    assert!(actual.iter().zip([left, top, 199.0, 119.0]).all(|(a, b)| (a - b).abs() < 0.0051), "{actual:?}");
}
