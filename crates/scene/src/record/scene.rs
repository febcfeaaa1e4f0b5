//! The scene.

use super::environment::Environment;
use super::frame::{self, Frame};
use super::light::Light;
use super::material::Material;
use super::medium::Medium;
use super::mesh::Mesh;
use super::object::Object;
use super::precipitation::Precipitation;
use super::texture::Texture;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{integer, keyed_by_name, list, record};

record! {
    /// A scene: everything that cameras see.
    pub struct Scene check(check) {
        /// Triangle meshes from files.
        many meshes: Mesh = list(record(), 0);
        /// Images on surfaces.
        many textures: Texture = list(record(), 0);
        /// Optical properties of surfaces.
        many materials: Material = list(record(), 0);
        /// Semantic classes: name and number. Class 0 is everything else.
        many classes: (Placed<String>, Placed<u64>) = keyed_by_name(integer(1, 65_535));
        /// Moving frames that carry objects, lamps and cameras.
        many frames: Frame = list(record(), 0);
        /// Objects; their order numbers the instances.
        many objects: Object = list(record(), 0);
        /// Lights that are no surfaces.
        many lights: Light = list(record(), 0);
        /// Participating media such as fog.
        many media: Medium = list(record(), 0);
        /// Rain or snow.
        optional precipitation: Precipitation = record();
        /// Light from infinity. Default: none, black.
        optional environment: Environment = record();
    }
}

fn check(scene: &Scene, errors: &mut DescriptionErrors) {
    frame::check_circles(&scene.frames, errors);
    check_sun(scene, errors);
    if let Some(Environment::Uniform(emission)) = &scene.environment
        && let Some((key, place)) = emission.level.flux()
    {
        let problem = format!("\"{key}\" is the flux of a surface, and the sky has no area");
        errors.add(ErrorCode::Contradiction, place, problem, "give \"luminance_cd_m2\" or \"radiance_w_m2_sr_nm\"");
    }
}

/// Refuses a second sun besides that of the sky.
fn check_sun(scene: &Scene, errors: &mut DescriptionErrors) {
    let Some(Environment::Sky(sky)) = &scene.environment else { return };
    if sky.sun.as_ref().is_some_and(|sun| !sun.value) {
        return;
    }
    for light in &scene.lights {
        if let Light::Sun(sun) = light {
            let problem = format!("the sky has its own sun ({}); this light would be a second one", sky.place);
            errors.add(
                ErrorCode::Contradiction,
                &sun.place,
                problem,
                "remove this one, or set sun = false in the environment",
            );
        }
    }
}
