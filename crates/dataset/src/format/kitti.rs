//! KITTI's object benchmark (Geiger, Lenz, Urtasun 2012), one folder per camera: `kitti/CAMERA/training` with `image_2`, `calib` and `label_2`, and the splits
//! in `kitti/CAMERA/ImageSets`. If the camera is the left one of a rectified pair (`disparity_to`), `image_3` holds the right one's images.
//!
//! Frames are numbered over all samples: sample × frames per sample + index of the frame. Pixel coordinates are KITTI's, with pixel centres at whole numbers:
//! half a pixel less than the raster's. A label is an object with at least one visible pixel whose class has a type of KITTI.
//!
//! | column | is |
//! | --- | --- |
//! | type | from the class's name, or from `kitti_types` |
//! | truncated | fraction of the amodal box outside the image; 1 if parts of the object have no image |
//! | occluded | 0: at least 95 % of the part in the image is visible, 1: at least half, 2: less |
//! | alpha | `rotation_y` less the direction of the object's centre, rad |
//! | bbox | box of the whole object within the image, clipped to pixel centres |
//! | dimensions, location, rotation_y | smallest box about the object's 3D box with its height along the camera's y: height, width, length (m), bottom centre (m), and rotation of the object's x axis about y, rad |
//!
//! Not written: a laser scanner and an inertial sensor. `Tr_velo_to_cam` places a scanner at the camera, x forward, y left, z up; no scans are written.

use core::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use etendue::{Error, OutputFolder};
use etendue_core::maths::f64::atan2;
use glam::{DQuat, DVec3};

use crate::record::{ImageRecord, ObjectRecord, SampleRecord, SolidRecord};
use crate::records::{FormatWriter, Records, write};
use crate::{draw::Split, picture::SampleImage, set::Set};

pub(super) struct Kitti;

/// Types by the lower-case names of classes.
const TYPES: [(&str, &str); 10] = [
    ("car", "Car"),
    ("van", "Van"),
    ("truck", "Truck"),
    ("pedestrian", "Pedestrian"),
    ("person", "Pedestrian"),
    ("person-sitting", "Person_sitting"),
    ("cyclist", "Cyclist"),
    ("rider", "Cyclist"),
    ("tram", "Tram"),
    ("misc", "Misc"),
];

impl FormatWriter for Kitti {
    fn write_image(&self, set: &Set, image: &SampleImage<'_>, folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, _) = image.sample;
        let (record, number) = (&image.record, number(set, sample, image.record.frame));
        write(folder, &format!("{}/image_2/{number}.png", root(&record.camera)), &image.bytes)?;
        for (left, _) in set.pairs.iter().filter(|(_, right)| *right == record.camera) {
            write(folder, &format!("{}/image_3/{number}.png", root(left)), &image.bytes)?;
        }
        write(folder, &format!("{}/label_2/{number}.txt", root(&record.camera)), labels(set, record).as_bytes())
    }

    fn sample(&self, set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        for image in &record.pictures {
            let right = set.pairs.iter().find(|(left, _)| *left == image.camera).map(|(_, right)| right);
            let is_other = |other: &&ImageRecord| Some(&other.camera) == right && other.frame == image.frame;
            let right = record.pictures.iter().find(is_other);
            let number = number(set, record.sample, image.frame);
            let name = format!("{}/calib/{number}.txt", root(&image.camera));
            write(folder, &name, calibration(image, right).as_bytes())?;
        }
        Ok(())
    }

    fn finish(&self, set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        let mut lists = Split::ALL.map(|_| String::new());
        for record in records.each() {
            let record = record.map_err(Error::run)?;
            for frame in set.frames.clone() {
                let list = &mut lists[record.split as usize];
                let _ = writeln!(list, "{}", number(set, record.sample, frame));
            }
        }
        for camera in &set.cameras {
            for (split, list) in Split::ALL.iter().zip(&lists) {
                write(folder, &format!("kitti/{camera}/ImageSets/{}.txt", split.name()), list.as_bytes())?;
            }
        }
        Ok(())
    }
}

fn number(set: &Set, sample: u32, frame: u32) -> String {
    format!("{:06}", u64::from(sample) * set.frame_count() + u64::from(frame - set.frames.start))
}

/// Folder of a camera.
fn root(camera: &str) -> String {
    format!("kitti/{camera}/training")
}

/// Lines of a calibration: the cameras 0 and 2 of KITTI are this one, 1 and 3 the right one of its pair, or this one if it has none.
fn calibration(image: &ImageRecord, right: Option<&ImageRecord>) -> String {
    let projections = [projection(image, image), projection(right.unwrap_or(image), image)];
    let mut text = String::new();
    for camera in 0..4 {
        let _ = writeln!(text, "P{camera}: {}", numbers(&projections[camera % 2]));
    }
    let _ = writeln!(text, "R0_rect: {}", numbers(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]));
    let scanner = [0.0, -1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0];
    let _ = writeln!(text, "Tr_velo_to_cam: {}", numbers(&scanner));
    let same = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let _ = writeln!(text, "Tr_imu_to_velo: {}", numbers(&same));
    text
}

/// Projection from points in the frame of the camera `from` to pixels of a camera of the same orientation.
fn projection(image: &ImageRecord, from: &ImageRecord) -> [f64; 12] {
    let [fx, skew, cx, fy, cy] = image.camera_matrix_px.expect("checked for all cameras of the format");
    let [w, x, y, z] = from.pose.rotation_wxyz;
    let to_right_m = DVec3::from_array(image.pose.position_m) - DVec3::from_array(from.pose.position_m);
    let base_m = (DQuat::from_xyzw(x, y, z, w).inverse() * to_right_m).x;
    [fx, skew, cx - 0.5, 0.0 - fx * base_m, 0.0, fy, cy - 0.5, 0.0, 0.0, 0.0, 1.0, 0.0]
}

fn numbers(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!("{number:.12e}")).collect::<Vec<_>>().join(" ")
}

fn labels(set: &Set, image: &ImageRecord) -> String {
    let mut text = String::new();
    for (object, _, _) in image.visible() {
        if let Some(kind) = kind(set, object.class.as_deref()) {
            let _ = writeln!(text, "{}", label(&kind, object, image));
        }
    }
    text
}

/// Type of a class; `None` if KITTI has none.
fn kind(set: &Set, class: Option<&str>) -> Option<String> {
    let class = class?;
    let stated = set.variations.as_ref().map_or(&[][..], |variations| &variations.kitti_types);
    if let Some((_, kind)) = stated.iter().find(|(known, _)| known.value == class) {
        return Some(kind.value.clone());
    }
    let name = class.to_lowercase().replace([' ', '_'], "-");
    TYPES.iter().find(|(known, _)| *known == name).map(|(_, kind)| (*kind).to_owned())
}

fn label(kind: &str, object: &ObjectRecord, image: &ImageRecord) -> String {
    let truncated = if object.is_cut { 1.0 } else { object.truncated_fraction.unwrap_or(1.0) };
    let occluded = match object.visible_fraction {
        fraction if fraction >= 0.95 => 0,
        fraction if fraction >= 0.5 => 1,
        _ => 2,
    };
    let [left, top, right, bottom] = object.amodal_box_in_picture_px.or(object.visible_box_px).unwrap_or_default();
    let column = |x: f64| (x - 0.5).clamp(0.0, image.width_px as f64 - 1.0);
    let row = |y: f64| (y - 0.5).clamp(0.0, image.height_px as f64 - 1.0);
    let solid = UprightBox::enclosing(&object.box_3d);
    let [x, y, z] = solid.bottom_m.to_array();
    let alpha = wrapped(solid.rotation_y_rad - atan2(x, z));
    format!(
        "{kind} {truncated:.2} {occluded} {alpha:.6} {:.2} {:.2} {:.2} {:.2} {:.6} {:.6} {:.6} {x:.6} {y:.6} {z:.6} {:.6}",
        column(left),
        row(top),
        column(right),
        row(bottom),
        solid.height_m,
        solid.width_m,
        solid.length_m,
        solid.rotation_y_rad,
    )
}

/// Angle wrapped to −π to π.
fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}

/// Box with its height along the camera's y.
struct UprightBox {
    height_m: f64,
    width_m: f64,
    length_m: f64,
    /// Bottom centre in the camera's frame.
    bottom_m: DVec3,
    rotation_y_rad: f64,
}

impl UprightBox {
    /// Returns the smallest such box about a 3D box, rotated about the camera's y like the box's x axis; if that is vertical, like its y axis.
    fn enclosing(solid: &SolidRecord) -> Self {
        let [w, x, y, z] = solid.camera.rotation_wxyz;
        let rotation = DQuat::from_xyzw(x, y, z, w);
        let ahead = [DVec3::X, DVec3::Y].map(|axis| rotation * axis);
        let level = |axis: DVec3| DVec3::new(axis.x, 0.0, axis.z).try_normalize();
        // Within a millionth of the vertical, rounding decides the direction of an axis.
        let is_level = DVec3::new(ahead[0].x, 0.0, ahead[0].z).length() > 1e-6;
        let along = level(ahead[usize::from(!is_level)]).unwrap_or(DVec3::X);
        let across = DVec3::new(-along.z, 0.0, along.x);
        let centre = DVec3::from_array(solid.camera.centre_m);
        let half = DVec3::from_array(solid.size_m) / 2.0;
        let extent = |axis: DVec3| {
            let sides = [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z];
            2.0 * sides.iter().map(|side| (rotation * *side).dot(axis).abs()).sum::<f64>()
        };
        let height_m = extent(DVec3::Y);
        Self {
            height_m,
            width_m: extent(across),
            length_m: extent(along),
            bottom_m: centre + DVec3::Y * (height_m / 2.0),
            rotation_y_rad: atan2(-along.z, along.x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::BoxPose;

    /// Box of 4 m × 2 m × 1 m with this rotation in the camera's frame.
    fn upright(rotation: DQuat) -> UprightBox {
        let [x, y, z, w] = rotation.to_array();
        let stance = BoxPose { centre_m: [1.0, 0.5, 10.0], rotation_wxyz: [w, x, y, z] };
        UprightBox::enclosing(&SolidRecord { size_m: [4.0, 2.0, 1.0], camera: stance, world: stance })
    }

    #[test]
    fn a_level_box_keeps_its_size_and_its_turn() {
        // z up is −y of the camera; then rotated about the camera's y.
        let level = DQuat::from_rotation_x(PI / 2.0);
        for turn in [-3.0, -1.0, 0.0, 0.4, 2.5] {
            let upright_box = upright(DQuat::from_rotation_y(turn) * level);
            let sizes = [upright_box.length_m, upright_box.width_m, upright_box.height_m];
            assert!(sizes.iter().zip([4.0, 2.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{sizes:?}");
            assert!((upright_box.rotation_y_rad - turn).abs() < 1e-12, "{turn}: {}", upright_box.rotation_y_rad);
            assert!((upright_box.bottom_m - DVec3::new(1.0, 1.0, 10.0)).length() < 1e-12);
        }
    }

    #[test]
    fn a_tilted_box_is_within_the_upright_one() {
        let upright_box = upright(DQuat::from_rotation_z(0.3) * DQuat::from_rotation_x(PI / 2.0));
        // Height of a bar of 4 m that rises by 0.3 rad, 1 m thick.
        let (sin, cos) = etendue_core::maths::f64::sin_cos(0.3);
        let height = 4.0 * sin + cos;
        assert!((upright_box.height_m - height).abs() < 1e-12, "{}", upright_box.height_m);
    }
}
