//! Conversion of lights of other programs: points, cones, parallel light.

use etendue_scene::record::light::{LampAim, LampPlacement, LampStrength, PointLamp, SpotLamp};
use etendue_scene::record::{Light, LightColour, Sun, SunLevel};
use glam::DVec3;

use super::naming::{azimuth_elevation_deg, rounded};

/// Angular diameter of parallel light, degrees. Its rays are exactly parallel in the file; the disc is as small as shadows require.
const PARALLEL_DEG: f64 = 0.01;

/// Point light of `candela` at `position` in the world, m.
pub(super) fn point(name: &str, position: DVec3, candela: f64, colour: LightColour) -> Light {
    let placement = LampPlacement { position_m: Some(position.to_array().into()), ..LampPlacement::default() };
    Light::Point(PointLamp::new(name, placement, LampStrength::Intensity(candela.into()), colour))
}

/// Spot light along a unit vector from `position` in the world, m: `candela` within its inner half angle, none outside its outer one; degrees.
pub(super) fn spot(
    name: &str,
    position: DVec3,
    ahead: DVec3,
    [inner_deg, outer_deg]: [f64; 2],
    candela: f64,
    colour: LightColour,
) -> Light {
    let [azimuth, elevation] = azimuth_elevation_deg(ahead);
    let aim = Some(LampAim::Rotation(rounded([azimuth, -elevation, 0.0]).into()));
    let placement = LampPlacement { position_m: Some(position.to_array().into()), aim, ..LampPlacement::default() };
    let lamp = SpotLamp::new(name, placement, LampStrength::Intensity(candela.into()), colour, 2.0 * outer_deg);
    Light::Spot(SpotLamp { inner_angle_deg: Some((2.0 * inner_deg).into()), ..lamp })
}

/// Parallel light from the direction of a unit vector of the world, `lux` on a surface that faces it.
pub(super) fn parallel(name: &str, from: DVec3, lux: f64, colour: LightColour) -> Light {
    let [azimuth, elevation, _] = {
        let [azimuth, elevation] = azimuth_elevation_deg(from);
        rounded([azimuth, elevation, 0.0])
    };
    let sun = Sun::new(name, elevation, azimuth, SunLevel::Illuminance(lux.into()));
    Light::Sun(Sun { colour: Some(colour), angular_diameter_deg: Some(PARALLEL_DEG.into()), ..sun })
}

/// The same light in a frame; suns have none.
pub(super) fn in_frame(light: Light, frame: Option<String>) -> Light {
    let mut light = light;
    let frame = frame.map(|frame| frame.as_str().into());
    match &mut light {
        Light::Point(lamp) => lamp.placement.frame = frame,
        Light::Spot(lamp) => lamp.placement.frame = frame,
        _ => {}
    }
    light
}
