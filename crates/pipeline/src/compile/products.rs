//! `[output]`: products.

use super::context::{Context, ErrorCode};
use crate::plan::raw_colour::RawColour;
use crate::plan::rectified::RectifiedCamera;
use crate::plan::{CameraBody, Products, default_raw_format};
use etendue_core::RawFormat;
use etendue_scene::Placed;
use etendue_scene::record::Output;
use etendue_scene::record::output::DepthScale;

/// Products of a camera: those that it requests, and by default those that its sensor permits.
pub(super) fn products(output: &Output, body: &CameraBody, context: &mut Context<'_>) -> Products {
    let electronics = body.sensor.is_some();
    let flag = |key: &Option<Placed<bool>>, default: bool| key.as_ref().map_or(default, |v| v.value);
    for (key, name) in
        [(&output.electrons, "electrons"), (&output.raw, "raw"), (&output.signal_breakdown, "signal_breakdown")]
    {
        need(key, electronics, name, "the sensor has no electronics", "add them to [sensor]", context);
    }
    let ghosts = body.effects.ghosts().is_some();
    need(&output.ghosts, ghosts, "ghosts", "the camera models none", "add ghosts = true to its [effects]", context);
    let truth = flag(&output.ground_truth, true);
    need(
        &output.camera_space_position,
        truth,
        "camera_space_position",
        "\"ground_truth\", to which it belongs, is not",
        "request \"ground_truth\"",
        context,
    );
    let development = body.development.is_some();
    need(&output.picture, development, "picture", "the camera has no [isp]", "add it", context);
    let boxes = flag(&output.boxes, false);
    need(&output.tracks, boxes, "tracks", "\"boxes\", from which they are made, is not", "add boxes = true", context);
    let depth_png = flag(&output.depth_png, false);
    if let (Some(scale), false) = (&output.depth_png_scale, depth_png) {
        let place = match scale {
            DepthScale::PerMetre(number) => &number.place,
            DepthScale::Named(name) => &name.place,
        };
        let problem = "\"depth_png_scale\" has no effect without depth_png = true";
        let cause = output.depth_png.as_ref().map(|key| &key.place);
        context.error_without_effect(
            ErrorCode::NoEffect,
            "depth_png_scale",
            place,
            cause,
            problem,
            "add it, or remove the scale",
        );
    }
    let products = Products {
        radiance: flag(&output.radiance, !electronics),
        irradiance: flag(&output.irradiance, false),
        ghosts: flag(&output.ghosts, false),
        variance: flag(&output.variance, false),
        sampling: flag(&output.sampling, false),
        electrons: flag(&output.electrons, false),
        raw: flag(&output.raw, electronics),
        raw_format: raw_format(output, body, context),
        signal_breakdown: flag(&output.signal_breakdown, false),
        picture: flag(&output.picture, development),
        ground_truth: flag(&output.ground_truth, true),
        camera_space_position: flag(&output.camera_space_position, false),
        weather: flag(&output.weather, false),
        cover: false,
        depth_png_per_m: depth_png.then(|| output.depth_png_scale.as_ref().map_or(256.0, |s| s.per_metre())),
        rays: flag(&output.rays, false),
        undistorted: None,
        video: output.video.is_some(),
        annotations: super::annotations::annotations(output),
        calibration_files: flag(&output.calibration_files, false),
    };
    note_undefined_depth(&products, body, context);
    let products = Products { undistorted: undistorted(output, &products, body, context), ..products };
    if products.is_empty() {
        context.error(
            ErrorCode::Empty,
            &output.place,
            "the camera delivers nothing",
            "request at least one product in [output]",
        );
    }
    products
}

/// Notes where depth along the axis is undefined, and the alternative.
fn note_undefined_depth(products: &Products, body: &CameraBody, context: &mut Context<'_>) {
    let writes_depth = products.ground_truth && !products.camera_space_position || products.depth_png_per_m.is_some();
    if writes_depth && body.depth_has_gaps() {
        context.note(
            "depth along the axis is NaN (0 in depth.png) where the camera looks sideways, backwards or at a mirror; \
             use distance.Z along the directions of rays = true, or the signed z of camera_space_position = true"
                .to_owned(),
        );
    }
}

/// Scale of the rectified camera, if one is requested and possible.
fn undistorted(output: &Output, products: &Products, body: &CameraBody, context: &mut Context<'_>) -> Option<f64> {
    let scale = &output.undistorted_scale;
    let Some(key) = output.undistorted.as_ref().filter(|key| key.value) else {
        if let Some(scale) = scale {
            let problem = "\"undistorted_scale\" has no effect without undistorted = true";
            let cause = output.undistorted.as_ref().map(|key| &key.place);
            context.error_without_effect(
                ErrorCode::NoEffect,
                "undistorted_scale",
                &scale.place,
                cause,
                problem,
                "add it, or remove the scale",
            );
        }
        return None;
    };
    if !(products.ground_truth || products.rays || products.picture) {
        let problem = "\"undistorted\" has no effect without \"ground_truth\", \"rays\" or \"picture\", to which it \
                       adds undistorted images";
        context.error(ErrorCode::NoEffect, &key.place, problem, "request one of them, or remove the key");
    }
    let layout = body.sensor.as_ref().map(|sensor| sensor.parameters().read_out.layout);
    if products.picture && layout.is_some_and(|l| !l.is_whole()) {
        let problem = "images of a region, or with binned or skipped pixels, have no undistorted images";
        context.error(
            ErrorCode::NotModelled,
            &key.place,
            problem,
            "remove the key, or \"roi_px\", \"binning\" and \"skipping\" of the sensor",
        );
    }
    let scale = scale.as_ref().map_or(1.0, |scale| scale.value);
    context.accept(&key.place, RectifiedCamera::new(body, scale)).map(|_| scale)
}

/// File format of the raw; refuses a format that cannot hold it.
fn raw_format(output: &Output, body: &CameraBody, context: &mut Context<'_>) -> RawFormat {
    let usual = default_raw_format(body.sensor.as_ref());
    let Some(key) = &output.raw_format else { return usual };
    if body.sensor.is_none() || output.raw.as_ref().is_some_and(|raw| !raw.value) {
        let cause = output.raw.as_ref().map(|raw| &raw.place);
        let problem = "\"raw_format\" has no effect without raw";
        context.error_without_effect(
            ErrorCode::NoEffect,
            "raw_format",
            &key.place,
            cause,
            problem,
            "request \"raw\", or remove it",
        );
    }
    let format = key.value;
    if format == RawFormat::Png && usual != RawFormat::Png {
        context.error(
            ErrorCode::UnsupportedOutput,
            &key.place,
            "the digital numbers have more than 16 bits, which PNG cannot store",
            "give \"tiff\"",
        );
    }
    if format == RawFormat::Dng
        && let Some(sensor) = body.sensor.as_ref().filter(|s| RawColour::new(s).is_none())
    {
        let names: Vec<&str> = sensor.parameters().channels.iter().map(|c| c.name.as_str()).collect();
        let problem =
            format!("a DNG contains one channel, or red, green and blue, but a sensor has {}", names.join(", "));
        context.error(ErrorCode::UnsupportedOutput, &key.place, problem, "give \"png\" or \"tiff\"");
    }
    if format == RawFormat::Dng && body.sensor.as_ref().is_some_and(|s| s.parameters().hdr.companding.is_some()) {
        let problem = "the digital numbers are companded, but raw readers interpret those of a DNG as linear";
        context.error(
            ErrorCode::UnsupportedOutput,
            &key.place,
            problem,
            "give \"png\" or \"tiff\", or remove \"companding\"",
        );
    }
    format
}

fn need(
    key: &Option<Placed<bool>>,
    possible: bool,
    name: &str,
    absent_reason: &str,
    remedy: &str,
    context: &mut Context<'_>,
) {
    if let Some(key) = key
        && key.value
        && !possible
    {
        context.error(
            ErrorCode::UnavailableOutput,
            &key.place,
            format!("\"{name}\" is requested, but {absent_reason}"),
            format!("{remedy}, or remove the key"),
        );
    }
}
