//! What is delivered.

use super::planned_effect::{EffectGroup, PlannedEffect, of_camera, where_there};
use crate::plan::{CameraPlan, Plan, Products};
use crate::report::FrameCost;
use crate::report::cpu_time::{Truth, cube_cpu_s, truth_cpu_s};
use etendue_core::Bands;

const GROUP: EffectGroup = EffectGroup::Output;

/// A product: its name, its key, whether it is delivered, the time it takes (s) where it is known, and the other keys that need it.
struct Product {
    name: &'static str,
    key: &'static str,
    is_wanted: bool,
    cpu_s: Option<f64>,
    /// Whether a flag of its own says so, which can be set to false.
    is_flag: bool,
    with: Vec<&'static str>,
}

pub(super) fn effects(plan: &Plan, camera: &CameraPlan) -> Vec<PlannedEffect> {
    let products = products(plan, camera);
    std::iter::once(cube(camera)).chain(products.iter().map(|product| effect(camera, product))).collect()
}

/// The spectral bands that the film keeps.
fn cube(camera: &CameraPlan) -> PlannedEffect {
    let bands = camera.settings.bands;
    let text =
        bands.map_or(String::new(), |b| format!("{} bands of {} nm, each with its variance", b.count(), b.width_nm()));
    let status = where_there(bands.is_some(), text, "no output and no effect needs a spectrum");
    let (width, height) = camera.film_size();
    let planes = 2 * bands.map_or(0, Bands::count) * size_of::<f32>();
    PlannedEffect::new(GROUP, "cube of bands", status)
        .described_by("render.band_width_nm")
        .holding(f64::from(width) * f64::from(height) * planes as f64)
}

fn effect(camera: &CameraPlan, product: &Product) -> PlannedEffect {
    let Product { name, key, is_wanted, cpu_s, is_flag, with } = product;
    let effect =
        PlannedEffect::new(GROUP, name, where_there(*is_wanted, "delivered", "not asked for")).described_by(key);
    let effect = match cpu_s {
        Some(cpu_s) => effect.taking(*cpu_s),
        None => effect,
    };
    let keys = std::iter::once(key).chain(with).filter(|_| *is_flag && is_one_of_many(&camera.products, key));
    effect.dropped_by(keys.map(|key| of_camera(camera, key, "false")))
}

/// Whether something else is delivered: a camera must.
fn is_one_of_many(products: &Products, key: &str) -> bool {
    let mut rest = *products;
    match key {
        "output.radiance" => rest.radiance = false,
        "output.irradiance" => rest.irradiance = false,
        "output.ghosts" => rest.ghosts = false,
        "output.sampling" => rest.sampling = false,
        "output.electrons" => rest.electrons = false,
        "output.raw" => rest.raw = false,
        "output.signal_breakdown" => rest.signal_breakdown = false,
        "output.picture" => rest.picture = false,
        "output.weather" => rest.weather = false,
        "output.ground_truth" => rest.ground_truth = false,
        "output.depth_png" => rest.depth_png_per_m = None,
        "output.rays" => rest.rays = false,
        "output.scene_flow" => rest.annotations.scene_flow = false,
        "output.cryptomatte" => rest.annotations.cryptomatte = false,
        "output.boxes" => (rest.annotations.boxes, rest.annotations.tracks) = (false, false),
        _ => {}
    }
    !rest.is_empty()
}

fn products(plan: &Plan, camera: &CameraPlan) -> Vec<Product> {
    let p = &camera.products;
    let new = |name, key, is_wanted| Product { name, key, is_wanted, cpu_s: None, is_flag: true, with: Vec::new() };
    let cube = |name, key, is_wanted| {
        let cubes = if p.variance { 2.0 } else { 1.0 };
        Product { cpu_s: Some(cubes * cube_cpu_s(camera)), ..new(name, key, is_wanted) }
    };
    let truth = |product: Product, what| Product { cpu_s: Some(truth_cpu_s(camera, what)), ..product };
    // Words that name a thing are no flags: which of the job and the camera says them is not known here.
    let named = |name, key, is_wanted| Product { is_flag: false, ..new(name, key, is_wanted) };
    let annotations = &p.annotations;
    let (flow, disparity) = (annotations.optical_flow.is_some(), annotations.disparity.is_some());
    let neighbours = if flow && annotations.scene_flow { 0.0 } else { truth_cpu_s(camera, Truth::Neighbours) };
    let is_pixel_ray = |others: bool| if others { 0.0 } else { truth_cpu_s(camera, Truth::Planes) };
    vec![
        cube("spectral radiance", "output.radiance", p.radiance),
        cube("spectral irradiance", "output.irradiance", p.irradiance),
        cube("ghosts by themselves", "output.ghosts", p.ghosts),
        new("variance", "output.variance", p.variance),
        new("samples of pixels", "output.sampling", p.sampling),
        new("electrons", "output.electrons", p.electrons),
        new("raw", "output.raw", p.raw),
        new("signal breakdown", "output.signal_breakdown", p.signal_breakdown),
        Product {
            is_flag: !p.video,
            with: twins(p.undistorted, !p.ground_truth && !p.rays),
            ..new("picture", "output.picture", p.picture)
        },
        named("video", "output.video", p.video),
        Product {
            cpu_s: Some(is_pixel_ray(p.depth_png_per_m.is_some() || p.rays)),
            with: with_truth(p),
            ..new("ground truth", "output.ground_truth", p.ground_truth)
        },
        new("positions in the camera's frame", "output.camera_space_position", p.camera_space_position),
        Product {
            cpu_s: Some(is_pixel_ray(p.ground_truth || p.rays)),
            ..new("depth PNG", "output.depth_png", p.depth_png_per_m.is_some())
        },
        Product {
            cpu_s: Some(is_pixel_ray(p.ground_truth || p.depth_png_per_m.is_some())),
            with: twins(p.undistorted, !p.ground_truth && !p.picture),
            ..new("ray table", "output.rays", p.rays)
        },
        new("undistorted twin", "output.undistorted", p.undistorted.is_some()),
        Product { cpu_s: Some(neighbours), ..named("optical flow", "output.optical_flow", flow) },
        Product { cpu_s: Some(neighbours), ..new("scene flow", "output.scene_flow", annotations.scene_flow) },
        truth(named("disparity", "output.disparity_to", disparity), Truth::Disparity),
        Product {
            with: if annotations.tracks { vec!["output.tracks"] } else { Vec::new() },
            ..truth(new("boxes", "output.boxes", annotations.boxes), Truth::Boxes)
        },
        new("tracks", "output.tracks", annotations.tracks),
        truth(new("Cryptomatte", "output.cryptomatte", annotations.cryptomatte), Truth::Coverage),
        Product {
            cpu_s: Some(weather_s(&FrameCost::of(plan, camera))),
            ..new("layers of weather", "output.weather", p.weather)
        },
        new("calibration files", "output.calibration_files", p.calibration_files),
    ]
}

/// The twin goes where nothing of it would be left.
fn twins(undistorted: Option<f64>, is_last: bool) -> Vec<&'static str> {
    if undistorted.is_some() && is_last { vec!["output.undistorted"] } else { Vec::new() }
}

fn with_truth(p: &Products) -> Vec<&'static str> {
    let position = p.camera_space_position.then_some("output.camera_space_position");
    position.into_iter().chain(twins(p.undistorted, !p.rays && !p.picture)).collect()
}

fn weather_s(cost: &FrameCost) -> f64 {
    cost.parts.iter().filter(|part| part.name == "layers of weather").map(|part| part.cpu_s).sum()
}
