//! Metadata of every result: the side-car and the facts in EXR headers.

mod frame;

use frame::pose_rows;
pub(crate) use frame::{
    add_time, check_seal, own_frame, raw_frame, state_of, time_facts, with_seal, with_state, without_state,
};

use etendue_io::Provenance;
use etendue_optics::{Cube, Face, PupilProjection, View, Window};
use etendue_pipeline::plan::{CameraPlan, Plan, Route, Settings, TimeDependence};
use etendue_pipeline::rectified::RectifiedCamera;
use etendue_plan_report::camera_facts::{RASTER, depth_of_field, effects, mirror, optics, sensor};
use glam::DVec2;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Facts in which a radiance image states its geometry for `expose`: pitch and axis of one rectilinear view, or the faces of a cube and the stored part of
/// each.
const PITCH_TAN: &str = "pupil_pitch_tan";
const PRINCIPAL_X_PX: &str = "pupil_principal_x_px";
const PRINCIPAL_Y_PX: &str = "pupil_principal_y_px";
const FACE_PX: &str = "pupil_face_px";
const VIEWS: &str = "pupil_views";

/// Facts of time-dependent light: its exposure time, and the time of the stated pose.
pub(crate) const EXPOSURE_S: &str = "exposure_s";

const THROUGH_LENS: &str = "through the lens, pixel centres at +0.5, x right, y down; pose: camera x right, y down, \
                            z forward, origin at the centre of the entrance pupil, to world x forward, y left, z up, m";
const AT_PUPIL: &str = "rectilinear from the centre of the entrance pupil: direction = ((x - principal_x) * pitch_tan, \
                        (y - principal_y) * pitch_tan, 1), pixel centres at +0.5, x right, y down";

const AT_PUPIL_CUBE: &str = "up to six perspective views from the centre of the entrance pupil; pupil_views: of each \
                             face: its first column and row in this image, its columns and rows, the column and row of \
                             the face's own grid of pupil_face_px x pupil_face_px that come first; tangent = (index + \
                             0.5) * 2 / pupil_face_px - 1; right, down, ahead: front x y z, right -z y x, left z y -x, \
                             top x z -y, bottom x -z y, back -x y -z";

const UNDISTORTED: &str = "rectilinear from the centre of the entrance pupil: direction = ((x - cx) / fx, (y - cy) / fy, 1), pixel \
                           centres at +0.5, x right, y down";

/// The program's version.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Facts of a camera's results of a frame; of the first frame if all have the same light.
pub(crate) fn provenance(plan: &Plan, camera: &CameraPlan, frame: u32) -> Provenance {
    let settings = &camera.settings;
    let frame = if camera.time == TimeDependence::None { 0 } else { frame };
    Provenance {
        plan_hash: plan.hash_text(),
        seed: settings.seed,
        version: VERSION.to_owned(),
        camera: camera.name.clone(),
        frame: frame.into(),
        time_s: camera.timing.frame_start(frame).seconds(),
        geometry: THROUGH_LENS.to_owned(),
        camera_to_world: Some(pose_rows(&camera.path.at(middle_s(camera, frame)))),
        further: further_facts(settings).chain(passes_fact(camera)).chain(exposure_facts(camera, frame)).collect(),
    }
}

/// Samples of every pixel, or the rule that determines them.
fn spp(settings: &Settings) -> Value {
    match settings.adaptive {
        None => settings.spp.into(),
        Some(limit) => json!({ "noise_threshold": limit.threshold, "least": limit.min_spp, "most": settings.spp }),
    }
}

/// The passes of the samples.
fn passes(camera: &CameraPlan) -> Option<Vec<f64>> {
    camera.passes.as_ref().map(|passes| passes.list().iter().map(|pass| pass.number()).collect())
}

fn further_facts(settings: &Settings) -> impl Iterator<Item = (String, String)> {
    let uniform_keys = [
        ("spp", settings.spp.to_string()),
        ("replicates", settings.replicates.to_string()),
        ("correlated_block_px", settings.blocks.len_px().to_string()),
    ];
    let limited = settings
        .adaptive
        .map(|limit| [("noise_threshold", limit.threshold.to_string()), ("min_spp", limit.min_spp.to_string())]);
    uniform_keys.into_iter().chain(limited.into_iter().flatten()).map(|(name, value)| (name.to_owned(), value))
}

/// The passes of the samples, as in the key `passes`.
fn passes_fact(camera: &CameraPlan) -> Option<(String, String)> {
    camera.passes.as_ref().map(|passes| ("passes".to_owned(), passes.text()))
}

/// Exposure of time-dependent light.
fn exposure_facts(camera: &CameraPlan, frame: u32) -> Vec<(String, String)> {
    if camera.time == TimeDependence::None {
        return Vec::new();
    }
    let timing = &camera.timing;
    let starts = time_facts(timing, "time", timing.frame_start(frame));
    let poses = time_facts(timing, "pose_time", timing.frame_middle(frame));
    let texts = starts.into_iter().filter(|(name, _)| name == "time").chain(poses);
    let text = |value: Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let exposure = (EXPOSURE_S.to_owned(), camera.body.exposure.exposure_s.to_string());
    std::iter::once(exposure).chain(texts.map(|(name, value)| (name, text(value)))).collect()
}

/// Middle of a frame's first exposure, s: the time of its pose.
fn middle_s(camera: &CameraPlan, frame: u32) -> f64 {
    camera.timing.capture(frame, 0).middle_s()
}

/// Facts of a radiance image; at the pupil with its own geometry.
pub(crate) fn radiance_provenance(facts: Provenance, camera: &CameraPlan) -> Provenance {
    match &camera.settings.route {
        Route::Lens => facts,
        Route::Pupil(projection) => at_pupil(facts, projection, camera.index),
    }
}

/// Facts of a rectified camera's results.
pub(crate) fn undistorted_provenance(mut facts: Provenance, rectified: &RectifiedCamera) -> Provenance {
    UNDISTORTED.clone_into(&mut facts.geometry);
    let matrix = rectified.matrix;
    let numbers = [("fx_px", matrix.fx), ("fy_px", matrix.fy), ("cx_px", matrix.cx), ("cy_px", matrix.cy)];
    facts.further.extend(numbers.map(|(name, number)| (name.to_owned(), number.to_string())));
    facts
}

/// Side-car entry of a rectified camera.
pub(crate) fn undistorted(rectified: &RectifiedCamera) -> Value {
    json!({
        "camera_matrix": rectified.matrix.rows(),
        "camera_matrix_convention": RASTER,
        "camera_matrix_opencv": rectified.matrix.to_opencv().rows(),
        "width_px": rectified.body().raster.width(),
        "height_px": rectified.body().raster.height(),
        "ground_truth": "traced along the undistorted camera's own rays from the centre of the entrance pupil",
        "picture": "the camera's, resampled linearly in linear light; black outside the camera's field of view",
    })
}

/// Facts of the results of another camera made from a stored radiance image.
pub(crate) fn exposed_provenance(source: &Provenance, camera: &str, seed: u64) -> Provenance {
    let pupil = [PITCH_TAN, PRINCIPAL_X_PX, PRINCIPAL_Y_PX, FACE_PX, VIEWS];
    let further = source.further.iter().filter(|(name, _)| !pupil.contains(&name.as_str()));
    let mut further: BTreeMap<String, String> = further.map(|(name, text)| (name.clone(), text.clone())).collect();
    further.insert("radiance_camera".to_owned(), source.camera.clone());
    further.insert("radiance_seed".to_owned(), source.seed.to_string());
    Provenance {
        seed,
        version: VERSION.to_owned(),
        camera: camera.to_owned(),
        geometry: THROUGH_LENS.to_owned(),
        further,
        ..source.clone()
    }
}

fn at_pupil(mut facts: Provenance, projection: &PupilProjection, camera: u32) -> Provenance {
    let geometry = match projection {
        PupilProjection::Rectilinear(view) => {
            AT_PUPIL.clone_into(&mut facts.geometry);
            let principal = view.principal_px();
            let numbers =
                [(PITCH_TAN, projection.pitch_tan()), (PRINCIPAL_X_PX, principal.x), (PRINCIPAL_Y_PX, principal.y)];
            numbers.map(|(name, number)| (name, number.to_string())).to_vec()
        }
        PupilProjection::Cube(cube) => {
            AT_PUPIL_CUBE.clone_into(&mut facts.geometry);
            vec![(FACE_PX, cube.face_px().to_string()), (VIEWS, views_text(cube))]
        }
    };
    facts.further.extend(geometry.into_iter().map(|(name, text)| (name.to_owned(), text)));
    facts.further.insert("camera_index".to_owned(), camera.to_string());
    facts
}

/// Stored part of a cube's faces: "front 0 0 808 808 -4 -4; …".
fn views_text(cube: &Cube) -> String {
    let view = |(view, window): (&Option<View>, Option<Window>)| {
        let (view, Window { left, top, width, height }) = (view.as_ref()?, window?);
        let [x, y] = view.first();
        Some(format!("{} {x} {y} {width} {height} {left} {top}", view.face().name()))
    };
    let texts: Vec<String> = cube.views().iter().zip(cube.windows()).filter_map(view).collect();
    texts.join("; ")
}

/// Geometry stated by a radiance image of `width` × `height` pixels; `None` if it states none.
pub(crate) fn pupil_geometry(
    facts: &Provenance,
    width: usize,
    height: usize,
) -> Option<Result<PupilProjection, String>> {
    let number = |name: &str| facts.further.get(name)?.parse::<f64>().ok();
    if let Some(views) = facts.further.get(VIEWS) {
        let face_px = facts.further.get(FACE_PX).and_then(|text| text.parse().ok());
        let cube = face_px
            .and_then(|face_px| stated_cube(face_px, views))
            .filter(|c| (c.width(), c.height()) == (width, height));
        let message = || format!("its geometry, {VIEWS} = \"{views}\", was not written by etendue");
        return Some(cube.map(PupilProjection::Cube).ok_or_else(message));
    }
    let principal = DVec2::new(number(PRINCIPAL_X_PX)?, number(PRINCIPAL_Y_PX)?);
    let view = PupilProjection::rectilinear(width, height, number(PITCH_TAN)?, principal);
    Some(view.map_err(|error| error.to_string()))
}

/// The cube of [`views_text`]; `None` if the text describes no cube.
fn stated_cube(face_px: usize, text: &str) -> Option<Cube> {
    let mut windows = [None; 6];
    for view in text.split("; ") {
        let words: Vec<&str> = view.split(' ').collect();
        let [name, _, _, width, height, left, top] = words.as_slice() else { return None };
        let face = Face::ALL.iter().position(|face| face.name() == *name)?;
        let window = Window {
            left: left.parse().ok()?,
            top: top.parse().ok()?,
            width: width.parse().ok()?,
            height: height.parse().ok()?,
        };
        windows[face] = Some(window);
    }
    Cube::new(face_px, windows).ok().filter(|cube| views_text(cube) == text)
}

/// Side-car of a rendered camera; `first` is the first frame.
pub(crate) fn sidecar(plan: &Plan, camera: &CameraPlan, first: u32, files: &BTreeMap<String, Value>) -> Value {
    let first = if camera.time == TimeDependence::None { 0 } else { first };
    let settings = &camera.settings;
    let mut facts = json!({
        "program": "etendue",
        "version": VERSION,
        "plan_hash": plan.hash_text(),
        "seed": settings.seed,
        "camera": camera.name,
        "camera_index": camera.index,
        "light": { "camera": camera.light.camera, "camera_index": camera.light.index },
        "pose": {
            "camera_to_world": pose_rows(&camera.path.at(middle_s(camera, first))),
            "convention": "camera x right, y down, z forward (OpenCV), origin at the centre of the entrance pupil; \
                           world x forward, y left, z up; m",
        },
        "optics": optics(&camera.body),
        "effects": effects(&camera.body),
        "sensor": sensor(&camera.body),
        "sampling": sampling(camera),
        "frame_period_s": camera.timing.period_s,
        "files": files,
        "ground_truth": {
            "ray.ID": "0: no ray passes the lens; 1: the principal ray; 2: that ray is clipped, the ray through the \
                       centroid of the unobstructed pupil is used",
            "depth.Z": "m along the optical axis from the entrance pupil; +inf: sky; NaN: no ray, or one that does not point forwards",
            "distance.Z": "m along the pixel's principal ray (587.56 nm) from its origin; +inf: sky; NaN: no ray",
            "mirror": mirror(&camera.body),
            "N": "unit shading normal, world",
            "P": "position, world, m, 32 bits",
            "P_low": "if present: rounding error of P, m; P + P_low is the position",
            "instances": plan.identities,
            "classes": plan.classes.iter().cloned().collect::<BTreeMap<String, u32>>(),
            "materials": plan.materials,
            "ids": "instances and materials: index in the list, from 1; 0 is the background",
        },
    });
    add_time(&mut facts, &camera.timing, "time", camera.timing.frame_start(first));
    facts
}

/// Settings that a side-car omits: those of biased approximations, those of a plan's estimates, and those stated elsewhere in it.
const NOT_IN_SIDECARS: [&str; 8] =
    ["integrator", "caustics", "min_spp", "noise_threshold", "bands", "sums_electrons", "spectral_gain", "seed"];

/// Settings of a camera's light; some have names of their own in side-cars.
fn sampling(camera: &CameraPlan) -> Value {
    let settings = &camera.settings;
    let Ok(Value::Object(mut sampling)) = serde_json::to_value(settings) else {
        unreachable!("settings are a map of numbers and words")
    };
    for key in NOT_IN_SIDECARS {
        sampling.remove(key);
    }
    for (name, of_sidecar) in [("pixels_sharing_paths", "correlated_block_px"), ("wavelength_range_nm", "range_nm")] {
        let value = sampling.remove(name).unwrap_or_default();
        sampling.insert(of_sidecar.to_owned(), value);
    }
    sampling.insert("spp".to_owned(), spp(settings));
    let blur = (settings.route != Route::Lens).then(|| depth_of_field(&camera.depth_of_field));
    sampling.insert("depth_of_field".to_owned(), json!(blur));
    if let Some(passes) = passes(camera) {
        sampling.insert("passes".to_owned(), json!(passes));
    }
    sampling.into()
}
