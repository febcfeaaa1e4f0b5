//! Spectral power of emitters: the wavelengths of the light of a scene.
//!
//! Surfaces and lamps count by the flux that leaves them: a surface of radiance L and area A emits π A L from a side; a lamp of intensity I where its
//! profile is 1 emits I ∫ profile dΩ. Sources at infinity count by their flux through the cross-section of a ball about the scene (π r² E, with E the
//! irradiance of a surface that faces the source; Pharr, Jakob and Humphreys 2016, 12.6). Strengths that change over time count by their mean.
//! Occlusion is left out: these are estimates.

use core::f64::consts::PI;

use etendue_core::Waveform;
use etendue_spectra::{Spectrum, upsample};
use glam::Vec3;

use super::{environment::Environment, lamp::Lamp, scene_lights::Sources, sun::Sun};
use crate::materials::{Emission, EmissionSides, MaterialTable, Modulation};
use crate::{MaterialId, accel::World};

/// Minimum radius of the ball about a scene, m: surroundings emit even into an empty scene.
const MIN_SCENE_RADIUS_M: f64 = 1e-3;

/// Spectral flux of each source, W·nm⁻¹: emitting materials, lamps, suns, surroundings.
#[must_use]
pub fn spectral_fluxes(world: &World, material_table: &MaterialTable, sources: &Sources) -> Vec<Spectrum> {
    let radius_m = world.radius_at_start_m().max(MIN_SCENE_RADIUS_M);
    let of_distant = |irradiance: Spectrum| irradiance.scaled(PI * radius_m * radius_m);
    let suns = sources.suns.iter().map(Sun::irradiance).map(of_distant);
    let surroundings = sources.environment.iter().map(facing).map(of_distant);
    let lamps = sources.lamps.iter().map(lamp_flux);
    surface_fluxes(world, material_table).into_iter().chain(lamps).chain(suns).chain(surroundings).collect()
}

/// Flux of each emitting material, from all surfaces that have it.
fn surface_fluxes(world: &World, material_table: &MaterialTable) -> Vec<Spectrum> {
    let mut areas_m2 = vec![0.0; material_table.materials().len()];
    for instance in world.instances() {
        let mut glowing: Vec<MaterialId> =
            instance.materials.iter().copied().filter(|id| material_table.emission(*id).is_some()).collect();
        glowing.sort_by_key(|id| id.0);
        glowing.dedup();
        for id in glowing {
            areas_m2[id.0 as usize] += world.area_at_start_m2(instance, id);
        }
    }
    let flux = |(id, area_m2): (usize, &f64)| {
        let emission = material_table.emission(MaterialId(id as u32)).filter(|_| *area_m2 > 0.0)?;
        Some(mean_radiance(emission, material_table).scaled(PI * area_m2))
    };
    areas_m2.iter().enumerate().filter_map(flux).collect()
}

/// Mean radiance over texture and time, both sides of a surface together, W·m⁻²·sr⁻¹·nm⁻¹.
fn mean_radiance(emission: &Emission, material_table: &MaterialTable) -> Spectrum {
    let sides = if emission.sides == EmissionSides::Both { 2.0 } else { 1.0 };
    let level = emission.modulation.as_ref().map(Modulation::waveform).map_or(1.0, mean_level);
    let radiance = emission.radiance.scaled(sides * level);
    match emission.factor {
        None => radiance,
        Some(id) => {
            let colour = material_table.textures()[id.0 as usize].mean().max(Vec3::ZERO);
            radiance.product(&upsample::reflectance_spectrum(colour.to_array()))
        }
    }
}

fn lamp_flux(lamp: &Lamp) -> Spectrum {
    lamp.intensity().scaled(lamp.profile().flux_sr() * lamp.modulation().map_or(1.0, mean_level))
}

/// The mean over all times, or the maximum if nothing recurs.
fn mean_level(waveform: &Waveform) -> f64 {
    waveform.mean_level().unwrap_or_else(|| waveform.max_level())
}

/// Irradiance of surroundings, W·m⁻²·nm⁻¹: of a surface under uniform radiance, in the mean over all directions of an image, of level
/// ground under a sky.
fn facing(environment: &Environment) -> Spectrum {
    match environment {
        Environment::Uniform(radiance) => radiance.scaled(PI),
        Environment::Image(image) => image.irradiance(),
        Environment::Sky(sky) => sky.irradiance().clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::WorldBuilder;
    use crate::geometry::{Instance, Shape};
    use crate::lights::Profile;
    use crate::materials::{Material, Surface};
    use etendue_core::Motion;
    use glam::{DAffine3, DMat3, DVec3};

    /// Closed forms: a sphere of radius r emits 4 π² r² L, a lamp of intensity I 4 π I, a sky of radiance L through a ball about a scene of
    /// radius R (of the sphere's box: √3 r) π² R² L.
    #[test]
    fn fluxes_are_those_of_closed_forms() {
        let level = |value: f64| Spectrum::constant(value);
        let emission = Emission { radiance: level(3.0), factor: None, sides: EmissionSides::Front, modulation: None };
        let material = Material { emission: Some(emission), ..Material::new(Surface::Absorber) };
        let table = MaterialTable::new(vec![material], Vec::new()).expect("legal");
        let mut builder = WorldBuilder::new();
        builder.add_instance(Instance {
            shape: Shape::Sphere { radius_m: 0.5 },
            to_world: Motion::constant(DAffine3::from_scale(DVec3::splat(2.0))),
            materials: vec![MaterialId(0)],
            instance_id: 1,
            semantic_id: 0,
        });
        let world = builder.build().expect("legal");
        let lamp = Lamp::new(DVec3::ZERO, DMat3::IDENTITY, level(5.0), Profile::Isotropic).expect("legal");
        let sun = Sun::from_irradiance(DVec3::Z, 0.5, &level(7.0)).expect("legal").with_limb();
        let environment = Some(Environment::Uniform(level(2.0)));
        let sources = Sources { suns: vec![sun], lamps: vec![lamp], environment };
        let fluxes: Vec<f32> = spectral_fluxes(&world, &table, &sources).iter().map(|s| s.at(550.0)).collect();
        let disc = PI * 3.0;
        let exact = [4.0 * PI * PI * 3.0, 4.0 * PI * 5.0, disc * 7.0, disc * PI * 2.0];
        assert_eq!(fluxes.len(), exact.len());
        for (flux, exact) in fluxes.iter().zip(exact) {
            // Some roundings to f32.
            assert!((f64::from(*flux) / exact - 1.0).abs() < 1e-5, "{fluxes:?}");
        }
    }
}
