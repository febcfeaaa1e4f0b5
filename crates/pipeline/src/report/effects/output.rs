//! Products.

use super::planned_effect::{EffectGroup, PlannedEffect, camera_change, required_if};
use crate::plan::{CameraPlan, ListedProduct, Plan, Products};
use crate::report::FrameCost;
use crate::report::cpu_time::{GroundTruthRays, cube_cpu_s, truth_cpu_s};
use etendue_core::Bands;

const GROUP: EffectGroup = EffectGroup::Output;

pub(super) fn effects(plan: &Plan, camera: &CameraPlan) -> Vec<PlannedEffect> {
    let products = camera.products.list().into_iter().map(|product| effect(plan, camera, product));
    std::iter::once(cube(camera)).chain(products).collect()
}

/// Spectral bands of the film.
fn cube(camera: &CameraPlan) -> PlannedEffect {
    let bands = camera.settings.bands;
    let text =
        bands.map_or(String::new(), |b| format!("{} bands of {} nm, each with its variance", b.count(), b.width_nm()));
    let status = required_if(bands.is_some(), text, "no output and no effect needs a spectrum");
    let (width, height) = camera.film_size();
    let planes = 2 * bands.map_or(0, Bands::count) * size_of::<f32>();
    PlannedEffect::new(GROUP, "spectral bands", status)
        .described_by("render.band_width_nm")
        .with_memory(f64::from(width) * f64::from(height) * planes as f64)
}

fn effect(plan: &Plan, camera: &CameraPlan, product: ListedProduct) -> PlannedEffect {
    let ListedProduct { key, name, is_delivered, is_flag, .. } = product;
    let effect =
        PlannedEffect::new(GROUP, name, required_if(is_delivered, "delivered", "not requested")).described_by(key);
    let effect = match cpu_s(plan, camera, key) {
        Some(cpu_s) => effect.with_cpu_time(cpu_s),
        None => effect,
    };
    // Keys with a value that is a name are not flags: it is not known here whether the job or the camera states them.
    let is_droppable = is_flag && !camera.products.is_empty_without(key);
    let keys = std::iter::once(key).chain(dependents(&camera.products, key)).filter(|_| is_droppable);
    effect.dropped_by(keys.map(|key| camera_change(camera, key, "false")))
}

/// CPU time of a product, s; `None` if unknown.
fn cpu_s(plan: &Plan, camera: &CameraPlan, key: &str) -> Option<f64> {
    let p = &camera.products;
    let (flow, depth_png) = (p.annotations.optical_flow.is_some(), p.depth_png_per_m.is_some());
    let planes_s = |is_for_others: bool| if is_for_others { 0.0 } else { truth_cpu_s(camera, GroundTruthRays::Planes) };
    Some(match key {
        "output.radiance" | "output.irradiance" | "output.ghosts" => {
            (if p.variance { 2.0 } else { 1.0 }) * cube_cpu_s(camera)
        }
        "output.ground_truth" => planes_s(depth_png || p.rays),
        "output.depth_png" => planes_s(p.ground_truth || p.rays),
        "output.rays" => planes_s(p.ground_truth || depth_png),
        "output.optical_flow" | "output.scene_flow" if flow && p.annotations.scene_flow => 0.0,
        "output.optical_flow" | "output.scene_flow" => truth_cpu_s(camera, GroundTruthRays::Neighbours),
        "output.disparity_to" => truth_cpu_s(camera, GroundTruthRays::Disparity),
        "output.boxes" => truth_cpu_s(camera, GroundTruthRays::Boxes),
        "output.cryptomatte" => truth_cpu_s(camera, GroundTruthRays::Coverage),
        "output.weather" => weather_s(&FrameCost::new(plan, camera)),
        _ => return None,
    })
}

/// Other keys that are removed together with a product's.
fn dependents(p: &Products, key: &str) -> Vec<&'static str> {
    match key {
        "output.picture" => rectified_products(p.undistorted, !p.ground_truth && !p.rays),
        "output.ground_truth" => with_truth(p),
        "output.rays" => rectified_products(p.undistorted, !p.ground_truth && !p.picture),
        "output.boxes" if p.annotations.tracks => vec!["output.tracks"],
        _ => Vec::new(),
    }
}

/// Removes the rectified camera if nothing of it would remain.
fn rectified_products(undistorted: Option<f64>, is_last: bool) -> Vec<&'static str> {
    if undistorted.is_some() && is_last { vec!["output.undistorted"] } else { Vec::new() }
}

fn with_truth(p: &Products) -> Vec<&'static str> {
    let position = p.camera_space_position.then_some("output.camera_space_position");
    position.into_iter().chain(rectified_products(p.undistorted, !p.rays && !p.picture)).collect()
}

fn weather_s(cost: &FrameCost) -> f64 {
    cost.parts.iter().filter(|part| part.name == "weather layers").map(|part| part.cpu_s).sum()
}
