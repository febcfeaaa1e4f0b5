//! Flow, disparity and boxes: from requested to delivered products.

use super::context::{Context, ErrorCode};
use crate::plan::{Annotations, CameraPlan, CorrespondenceFormat, DisparityProduct};
use etendue_optics::Lens;
use etendue_scene::Description;
use etendue_scene::record::Output;
use etendue_scene::record::output::CorrespondenceFormat as FormatRecord;
use glam::{DVec2, DVec3};

/// Maximum vertical distance (px) of a point from its row in the other camera of a rectified pair.
const ROW_TOLERANCE_PX: f64 = 1e-3;

/// Products of a camera, except disparity, for which all cameras must be known.
pub(super) fn annotations(output: &Output) -> Annotations {
    Annotations {
        optical_flow: output.optical_flow.as_ref().map(|key| format(key.value)),
        scene_flow: output.scene_flow.as_ref().is_some_and(|key| key.value),
        disparity: None,
        boxes: output.boxes.as_ref().is_some_and(|key| key.value),
        tracks: output.tracks.as_ref().is_some_and(|key| key.value),
        cryptomatte: output.cryptomatte.as_ref().is_some_and(|key| key.value),
    }
}

fn format(record: FormatRecord) -> CorrespondenceFormat {
    match record {
        FormatRecord::Exr => CorrespondenceFormat::Exr,
        FormatRecord::Middlebury => CorrespondenceFormat::Middlebury,
        FormatRecord::Kitti => CorrespondenceFormat::Kitti,
    }
}

/// Finds the right cameras of disparities, and refuses products without another frame or without a rectified partner.
pub(super) fn resolve(description: &Description, cameras: &mut [CameraPlan], context: &mut Context<'_>) {
    for place in 0..cameras.len() {
        let Some(setup) = description.cameras.get(cameras[place].index as usize) else { continue };
        check_frames(&setup.output, &cameras[place], context);
        cameras[place].products.annotations.disparity = disparity(&setup.output, &cameras[place], cameras, context);
    }
}

fn check_frames(output: &Output, camera: &CameraPlan, context: &mut Context<'_>) {
    if camera.timing.period_s.is_some() || !camera.products.annotations.needs_neighbours() {
        return;
    }
    let keys = [
        output.optical_flow.as_ref().map(|key| ("optical_flow", &key.place)),
        output.scene_flow.as_ref().filter(|key| key.value).map(|key| ("scene_flow", &key.place)),
    ];
    for (name, place) in keys.into_iter().flatten() {
        let problem = format!("\"{name}\" requires the previous and the next frame, but no frame rate is stated");
        context.error(
            ErrorCode::UnavailableOutput,
            place,
            problem,
            "add [sequence] with \"frame_rate_hz\" to the job, or remove the key",
        );
    }
}

fn disparity(
    output: &Output,
    left: &CameraPlan,
    cameras: &[CameraPlan],
    context: &mut Context<'_>,
) -> Option<DisparityProduct> {
    let Some(key) = &output.disparity_to else {
        if let Some(format) = &output.disparity_format {
            let problem = "\"disparity_format\" has no effect without \"disparity_to\"";
            context.error_without_effect(
                ErrorCode::NoEffect,
                "disparity_format",
                &format.place,
                None,
                problem,
                "name the right camera, or remove the key",
            );
        }
        return None;
    };
    let right_camera = cameras.iter().find(|camera| camera.name == key.value && camera.index != left.index);
    let Some(right) = right_camera else {
        let others: Vec<&str> = cameras.iter().filter(|c| c.index != left.index).map(|c| c.name.as_str()).collect();
        let remedy = match others.is_empty() {
            true => "add a second camera to the job, or remove the key".to_owned(),
            false => format!("give one of {}", others.join(", ")),
        };
        context.error(
            ErrorCode::UnknownName,
            &key.place,
            format!("there is no other camera \"{}\"", key.value),
            remedy,
        );
        return None;
    };
    if let Some(problem) = not_rectified(left, right) {
        let remedy = format!(
            "give both cameras the same lens without distortion and the same rotation, and place \"{}\" exactly to the \
             right (+x of the camera), or remove the key",
            right.name
        );
        context.error(ErrorCode::UnavailableOutput, &key.place, problem, remedy);
        return None;
    }
    let format = output.disparity_format.as_ref().map_or(CorrespondenceFormat::Exr, |key| format(key.value));
    Some(DisparityProduct { right: right.index, format })
}

/// Describes why two views are not rectified at some time: in frame 0 or, for cameras that move independently, at their keys and half-way between.
fn not_rectified(left: &CameraPlan, right: &CameraPlan) -> Option<String> {
    let mut times_s = left.comparison_times_s(right);
    if left.fixed_pair(right).is_some() {
        times_s.truncate(1);
    }
    let first_s = times_s[0];
    times_s.into_iter().find_map(|time_s| {
        let when = if time_s == first_s { String::new() } else { format!("at {time_s} s ") };
        not_rectified_at(left, right, time_s).map(|why| format!("{when}{why}"))
    })
}

/// Describes why two views are not rectified at a time: points of the left one's pixels, near and far, are not seen on the same rows, or not farther left.
fn not_rectified_at(left: &CameraPlan, right: &CameraPlan, time_s: f64) -> Option<String> {
    let (from, to) = (left.path.at(time_s), right.path.at(time_s));
    let base_m = from.point_to_camera(to.position_m);
    if base_m.x <= 0.0 {
        return Some(format!("camera \"{}\" is not to the right of \"{}\"", right.name, left.name));
    }
    let bent = [left, right].into_iter().find(|camera| {
        matches!(camera.body.lens, Lens::Telecentric(_))
            || camera.body.front.as_ref().is_some_and(|f| f.optic().is_some())
    });
    if let Some(camera) = bent {
        return Some(format!(
            "the rays of camera \"{}\" do not meet in one point, so rows do not correspond",
            camera.name
        ));
    }
    let raster = &left.body.raster;
    let size = DVec2::new(raster.width() as f64, raster.height() as f64);
    for (column, row) in (0..25).map(|i| (f64::from(i % 5), f64::from(i / 5))) {
        let at_px = DVec2::new(column, row) / 4.0 * size;
        let Some(direction) = left.body.lens.direction(raster.sensor_mm(at_px)) else { continue };
        for distance_m in [4.0, 40.0, 4000.0].map(|times| times * base_m.x) {
            let point_m = from.position_m + from.direction_to_world(direction * distance_m);
            let right_px: Option<DVec2> =
                right.body.lens.project(to.point_to_camera(point_m)).map(|mm| right.body.raster.raster_px(mm));
            let off_px = right_px.map_or(f64::INFINITY, |px| (px.y - at_px.y).abs());
            if off_px > ROW_TOLERANCE_PX {
                return Some(difference_in_height(left, right, at_px, point_m, right_px));
            }
        }
    }
    None
}

fn difference_in_height(
    left: &CameraPlan,
    right: &CameraPlan,
    at_px: DVec2,
    point_m: DVec3,
    right_px: Option<DVec2>,
) -> String {
    let there = right_px.map_or_else(|| "not imaged".to_owned(), |pixel| format!("at y = {:.3} px", pixel.y));
    format!(
        "the views of \"{}\" and \"{}\" are not rectified: the point {point_m:.3} m is at y = {:.3} px in the first, \
         {there} in the second",
        left.name, right.name, at_px.y
    )
}
