//! From a camera's film to its files.

use crate::facts;
use crate::failure::Failure;
use crate::files::Files;
use crate::photographs::{Wanted, photographs};
use crate::results::Results;
use etendue_core::Plane;
use etendue_core::quantity::Electrons;
use etendue_io::exr::{self, Lengths, encode_ground_truth, encode_plane, encode_radiance, encode_rays};
use etendue_io::{OutputFolder, png};
use etendue_pipeline::film::Film;
use etendue_pipeline::photograph::Light;
use etendue_pipeline::plan::{CameraPlan, Plan};
use etendue_pipeline::pupil_depth::{PupilDepth, pupil_depth};
use etendue_pipeline::rays::ray_table;
use etendue_pipeline::truth::{GroundTruth, ground_truth};
use etendue_pipeline::twin::Twin;
use etendue_sensor::FrameAddress;
use etendue_tracer::accel::Simd;
use serde_json::Value;
use std::ops::Range;

/// The names, relative to the output folder, of all files of a plan.
pub fn names(plan: &Plan, frames: &Range<u32>) -> Vec<String> {
    let of_camera = |camera: &CameraPlan| {
        let names = Files::of(&camera.products, &camera.body, frames).into_keys().chain([Files::SIDECAR.to_owned()]);
        names.map(|name| format!("{}/{name}", camera.name)).collect::<Vec<_>>()
    };
    plan.cameras.iter().flat_map(of_camera).collect()
}

/// Writes everything that cameras of equal light deliver of their film. Runs on the caller's thread pool.
pub fn deliver(
    plan: &Plan,
    cameras: &[&CameraPlan],
    film: Film,
    frames: &Range<u32>,
    simd: Simd,
    folder: &mut OutputFolder,
) -> Result<(), Failure> {
    let Some((last, others)) = cameras.split_last() else { return Ok(()) };
    check_finite(last, &film)?;
    others.iter().try_for_each(|camera| camera_files(plan, camera, film.clone(), frames, simd, folder))?;
    camera_files(plan, last, film, frames, simd, folder)
}

/// Refuses a film that holds what is no finite number.
pub fn check_finite(camera: &CameraPlan, film: &Film) -> Result<(), Failure> {
    match film.not_finite_samples() {
        0 => Ok(()),
        count => Err(Failure::Run(format!(
            "camera {}: {count} samples of its light were not finite numbers, so nothing is delivered; a light is too bright \
             or too near for 32-bit floats: lower it or move it",
            camera.name
        ))),
    }
}

/// Writes everything that one camera delivers.
fn camera_files(
    plan: &Plan,
    camera: &CameraPlan,
    film: Film,
    frames: &Range<u32>,
    simd: Simd,
    folder: &mut OutputFolder,
) -> Result<(), Failure> {
    let mut results = Results { prefix: camera.name.clone(), folder };
    let depth = pupil_depth(plan, camera, simd);
    let light = Light::of_film(camera, film, depth.as_ref())
        .map_err(|error| Failure::Run(format!("camera {}: {error}", camera.name)))?;
    let scale = camera.products.undistorted;
    let twin = scale.map(|scale| Twin::of(&camera.body, scale).expect("a compiled plan's camera has its twin"));
    spectra(plan, camera, &light, depth.as_ref(), &mut results)?;
    let mut points = Vec::new();
    if let Some(electrons) = &light.electrons {
        self::electrons(plan, camera, electrons, &light, &mut results)?;
        let address = |frame| FrameAddress { seed: camera.settings.seed, camera: camera.index, frame, capture: 0 };
        let facts = facts::provenance(plan, camera);
        let products = &camera.products;
        let wanted = Wanted { products, camera: &camera.name, facts: &facts, undistorted: twin.as_ref() };
        points = photographs(&camera.body, electrons, frames, address, wanted, &mut results)?;
    }
    truth(plan, camera, simd, &mut results)?;
    if let Some(twin) = &twin {
        undistorted(plan, camera, twin, simd, &mut results)?;
    }
    let files = Files::of(&camera.products, &camera.body, frames);
    let mut facts = facts::sidecar(plan, camera, &files);
    facts["undistorted"] = twin.as_ref().map_or(Value::Null, facts::undistorted);
    facts["frames"] = points.into();
    results.json(Files::SIDECAR, &facts)
}

fn spectra(
    plan: &Plan,
    camera: &CameraPlan,
    light: &Light,
    depth: Option<&PupilDepth>,
    results: &mut Results<'_>,
) -> Result<(), Failure> {
    let products = &camera.products;
    if let Some(radiance) = light.radiance.as_ref().filter(|_| products.radiance) {
        let variance = products.variance.then_some(&radiance.variance);
        let facts = facts::radiance_provenance(plan, camera);
        let lengths = depth.map(|depth| Lengths { distance: &depth.distance, depth: &depth.depth });
        results.write(Files::RADIANCE, encode_radiance(&radiance.mean, variance, lengths, &facts))?;
    }
    if products.irradiance {
        results.irradiance(light, products.variance, &facts::provenance(plan, camera))?;
    }
    if products.ghosts {
        results.ghosts(light, &facts::provenance(plan, camera))?;
    }
    Ok(())
}

fn electrons(
    plan: &Plan,
    camera: &CameraPlan,
    mean: &Plane<Electrons>,
    light: &Light,
    results: &mut Results<'_>,
) -> Result<(), Failure> {
    if !camera.products.electrons {
        return Ok(());
    }
    let variance = light.electrons_variance.as_ref().filter(|_| camera.products.variance);
    results.write(Files::ELECTRONS, encode_plane(mean, variance, &facts::provenance(plan, camera)))
}

fn truth(plan: &Plan, camera: &CameraPlan, simd: Simd, results: &mut Results<'_>) -> Result<(), Failure> {
    let products = &camera.products;
    if products.rays {
        let table = ray_table(&camera.body);
        let facts = facts::provenance(plan, camera);
        results.write(
            Files::RAYS,
            encode_rays(&table.origin, &table.direction, &table.ray, table.path.as_ref(), &facts),
        )?;
    }
    if !products.ground_truth && products.depth_png_per_m.is_none() {
        return Ok(());
    }
    let truth = ground_truth(plan, camera, simd);
    if products.ground_truth {
        let facts = facts::provenance(plan, camera);
        results.write(Files::GROUND_TRUTH, encode_ground_truth(&planes(&truth), &facts))?;
    }
    if let Some(per_metre) = products.depth_png_per_m {
        results.write(Files::DEPTH, png::encode_depth16(&truth.depth, per_metre))?;
    }
    Ok(())
}

/// Ground truth and rays of the undistorted twin.
fn undistorted(
    plan: &Plan,
    camera: &CameraPlan,
    twin: &Twin,
    simd: Simd,
    results: &mut Results<'_>,
) -> Result<(), Failure> {
    let facts = facts::undistorted_provenance(plan, camera, twin);
    if camera.products.rays {
        let table = ray_table(twin.body());
        let bytes = encode_rays(&table.origin, &table.direction, &table.ray, table.path.as_ref(), &facts);
        results.write(&Files::undistorted(Files::RAYS), bytes)?;
    }
    if camera.products.ground_truth {
        let truth = ground_truth(plan, &twin.plan(camera), simd);
        results.write(&Files::undistorted(Files::GROUND_TRUTH), encode_ground_truth(&planes(&truth), &facts))?;
    }
    Ok(())
}

fn planes(truth: &GroundTruth) -> exr::GroundTruth<'_> {
    exr::GroundTruth {
        depth: Some(&truth.depth),
        distance: Some(&truth.distance),
        normal: Some(&truth.normal),
        position: Some(&truth.position),
        camera_space_position: truth.camera_space_position.as_ref(),
        instance: Some(&truth.instance),
        semantic: Some(&truth.semantic),
        material: Some(&truth.material),
        ray: Some(&truth.ray),
        mirror: truth.mirror.as_ref(),
    }
}
