//! Substitutes for the light and the camera of a scene that has none.

use etendue_core::maths::f64 as maths;
use etendue_scene::record::{Emission, Environment, Level, LightColour, Pose, Scene};
use glam::DVec3;

use super::written::{ImportedCamera, View, size_of};

/// Luminance of the default sky, cd/m²: an overcast day's.
const SKY_CD_M2: f64 = 2000.0;

/// Gives a scene a uniform sky; returns the note on it.
pub(super) fn even_sky(scene: &mut Scene) -> String {
    let level = Level::Luminance(SKY_CD_M2.into());
    let emission = Emission { colour: Some(LightColour::Illuminant("D65".into())), ..Emission::new(level) };
    scene.environment = Some(Environment::Uniform(emission));
    format!("it has no light: a uniform sky of {SKY_CD_M2} cd/m² is added")
}

/// View of the box between two corners in the world, m, from the front and above.
pub(super) fn whole_view(low: DVec3, high: DVec3) -> ImportedCamera {
    const HALF_FIELD_RAD: f64 = 0.35;
    let (middle, radius) = (0.5 * (low + high), (0.5 * (high - low).length()).max(1e-3));
    let from = middle + DVec3::new(0.8, 0.4, 0.45).normalize_or(DVec3::X) * radius / maths::sin(HALF_FIELD_RAD);
    ImportedCamera {
        name: "view".to_owned(),
        pose: Pose::looking_at(from.to_array(), middle.to_array(), [0.0, 0.0, 1.0]),
        view: View::Perspective { yfov_rad: 2.0 * HALF_FIELD_RAD },
        size_px: size_of(4.0 / 3.0),
    }
}
