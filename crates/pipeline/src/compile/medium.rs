//! Participating media: from records to the tracer's.

use super::context::{Context, ErrorCode};
use super::frames::Frames;
use super::spectrum;
use etendue_core::{Motion, maths};
use etendue_scene::record::medium::{self, Extinction, MediumMesh, MediumShape};
use etendue_scene::record::{Light, Medium as Record, Scene};
use etendue_spectra::{Extrapolation, Spectrum};
use etendue_tracer::media::{DensityVariation, Medium, MediumRegion, Noise, Phase, Solid, SpectralTable};
use glam::DVec3;
use std::sync::Arc;

/// Default median diameter of droplets, µm.
const DROPLETS_UM: f64 = 12.0;

/// Media of a scene.
pub(super) fn media(scene: &Scene, frames: &Frames<'_>, context: &mut Context<'_>) -> Vec<Medium> {
    note_darkness(scene, context);
    scene.media.iter().filter_map(|record| medium(record, frames, context)).collect()
}

fn medium(record: &Record, frames: &Frames<'_>, context: &mut Context<'_>) -> Option<Medium> {
    let extinction = extinction(&record.extinction, context);
    let albedo = match &record.albedo {
        None => Some(Spectrum::constant(1.0)),
        Some(albedo) => spectrum::curve(albedo, Extrapolation::Hold, context),
    };
    let to_world = frames.world_motion(record.frame.as_ref(), Motion::constant(record.transform.to_world()));
    let shape = shape(record.shape.as_ref(), context)?;
    let medium = Medium::new(extinction?, albedo?, phase(record.phase.as_ref()), shape, to_world);
    let medium = context.accept(&record.place, medium)?;
    Some(with_unevenness(medium, record.unevenness.as_ref()))
}

/// Returns points inside a bounded medium, in the world at the epoch, m: its centre and points near its bounds; none for other media.
pub(super) fn inner_points(record: &Record, frames: &Frames<'_>, context: &Context<'_>) -> Vec<DVec3> {
    /// Number of tested points of a mesh, and their distance from its centre as a fraction of that of the bounds.
    const MAX_POINTS: usize = 16;
    const BOUNDS_FRACTION: f64 = 0.9;
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let mut bounds: Vec<DVec3> = match &record.shape {
        None | Some(MediumShape::Everywhere(_) | MediumShape::Layer(_)) => return Vec::new(),
        Some(MediumShape::Box(cuboid)) => axes.map(|axis| axis * DVec3::from_array(cuboid.size_m.value) * 0.5).to_vec(),
        Some(MediumShape::Sphere(sphere)) => axes.map(|axis| axis * sphere.radius_m.value).to_vec(),
        Some(MediumShape::Mesh(mesh)) => {
            let Some(asset) = context.assets.meshes.get(&mesh.file.value) else { return Vec::new() };
            let unit_m = mesh.unit_m.as_ref().map_or(1.0, |unit| unit.value);
            let place = |p: &[f32; 3]| (DVec3::from_array(p.map(f64::from)) + DVec3::from_array(asset.origin)) * unit_m;
            asset.positions.iter().step_by(asset.positions.len().div_ceil(MAX_POINTS).max(1)).map(place).collect()
        }
    };
    let centre = bounds.iter().sum::<DVec3>() / bounds.len().max(1) as f64;
    bounds.iter_mut().for_each(|point| *point = centre + (*point - centre) * BOUNDS_FRACTION);
    bounds.push(centre);
    let to_world = frames.world_motion(record.frame.as_ref(), Motion::constant(record.transform.to_world())).at(0.0);
    bounds.into_iter().map(|point| to_world.transform_point3(point)).collect()
}

pub(super) fn with_unevenness(medium: Medium, record: Option<&medium::DensityNoise>) -> Medium {
    record.into_iter().fold(medium, |medium, of| medium.with_unevenness(unevenness(of)))
}

pub(super) fn shape(record: Option<&MediumShape>, context: &mut Context<'_>) -> Option<MediumRegion> {
    Some(match record {
        None | Some(MediumShape::Everywhere(_)) => MediumRegion::Everywhere,
        Some(MediumShape::Layer(layer)) => MediumRegion::Below { top_m: layer.top_m.value },
        Some(MediumShape::Box(of)) => MediumRegion::Box { half_m: DVec3::from_array(of.size_m.value) * 0.5 },
        Some(MediumShape::Sphere(of)) => MediumRegion::Ball { radius_m: of.radius_m.value },
        Some(MediumShape::Mesh(of)) => MediumRegion::Mesh(Arc::new(solid(of, context)?)),
    })
}

/// Interior of a file's triangles.
fn solid(record: &MediumMesh, context: &mut Context<'_>) -> Option<Solid> {
    let Some(asset) = context.assets.meshes.get(&record.file.value) else {
        context.error(ErrorCode::UnreadableFile, &record.file.place, "the mesh was not loaded", "give a readable file");
        return None;
    };
    let unit_m = record.unit_m.as_ref().map_or(1.0, |unit| unit.value);
    let origin = DVec3::from_array(asset.origin);
    let positions: Vec<DVec3> =
        asset.positions.iter().map(|p| (DVec3::from_array(p.map(f64::from)) + origin) * unit_m).collect();
    context.accept(&record.file.place, Solid::new(&positions, &asset.triangles))
}

pub(super) fn extinction(record: &Extinction, context: &mut Context<'_>) -> Option<Spectrum> {
    match record {
        Extinction::PerMetre(curve) => spectrum::curve(curve, Extrapolation::Hold, context),
        Extinction::Visibility(visibility) => {
            let per_m = -maths::f64::ln(visibility.contrast.value) / visibility.distance_m.value;
            Some(Spectrum::constant(per_m))
        }
    }
}

fn phase(record: Option<&medium::Phase>) -> Phase {
    match record {
        None => Phase::Table(SpectralTable::from_water(DROPLETS_UM)),
        Some(medium::Phase::WaterDroplets(of)) => Phase::Table(SpectralTable::from_water(of.diameter_um.value)),
        Some(medium::Phase::WaterDropletsFit(of)) => {
            Phase::Table(SpectralTable::fitted_to_water(of.diameter_um.value).expect("the key's range is the fit's"))
        }
        Some(medium::Phase::HenyeyGreenstein(of)) => Phase::HenyeyGreenstein { g: of.g.value as f32 },
        Some(medium::Phase::Rayleigh(_)) => Phase::Rayleigh,
        Some(medium::Phase::Isotropic(_)) => Phase::Isotropic,
    }
}

fn unevenness(record: &medium::DensityNoise) -> DensityVariation {
    let noise = Noise {
        scale_m: record.scale_m.value,
        octaves: record.octaves.as_ref().map_or(4, |octaves| octaves.value as u32),
        gain: record.gain.as_ref().map_or(0.5, |gain| gain.value),
        seed: record.seed.as_ref().map_or(0, |seed| seed.value as u32),
    };
    let wind_mps = record.wind_m_s.as_ref().map_or(DVec3::ZERO, |wind| DVec3::from_array(wind.value));
    DensityVariation { noise, amplitude: record.amplitude.value, wind_mps }
}

/// Notes that no light from infinity passes an unbounded medium.
fn note_darkness(scene: &Scene, context: &mut Context<'_>) {
    let endless = scene.media.iter().find(|medium| matches!(medium.shape, None | Some(MediumShape::Everywhere(_))));
    let shines = scene.environment.is_some() || scene.lights.iter().any(|light| matches!(light, Light::Sun(_)));
    if let (Some(medium), true) = (endless, shines) {
        context.warn_on(
            format!("medium \"{}\"", medium.name.value),
            "it is unbounded and blocks all light of sky and sun, which comes from infinity; give the medium a \
             \"shape\" with bounds, such as a layer",
        );
    }
}
