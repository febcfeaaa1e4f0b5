//! Notes on light in media: the number of scattering events, and unsupported settings.

use super::context::{Context, ErrorCode};
use crate::plan::CameraPlan;
use crate::sizes::block::Blocks;
use etendue_core::Integrator;
use etendue_core::{Ray, TimeInterval};
use etendue_scene::Description;
use etendue_tracer::media::{Media, Medium};
use glam::Vec3;

/// Albedo above which multiple scattering makes the limit of bounces significant.
const MIN_ALBEDO: f32 = 0.5;

/// Bounces per optical depth plus one that include about 95 % of fog's light: with the forward peak of its phase function simulated, and with it treated as
/// unscattered. Measured for water droplets of 12 µm in a layer of optical depth 2.2.
const BOUNCES: [f64; 2] = [10.0, 4.0];

/// Maximum number of bounces that can be requested.
const MAX_BOUNCES: f64 = 1024.0;

/// Refuses weather layers without weather; adds the cover to them if there is precipitation.
pub(super) fn layers(
    description: &Description,
    cameras: &mut [CameraPlan],
    has_media: bool,
    falls: bool,
    context: &mut Context<'_>,
) {
    for setup in &description.cameras {
        let Some(key) = setup.output.weather.as_ref().filter(|key| key.value) else { continue };
        if !has_media {
            let problem = "\"weather\" is requested, but the scene has neither [[media]] nor [precipitation]";
            context.error(
                ErrorCode::UnavailableOutput,
                &key.place,
                problem,
                "add them to the scene, or remove the key",
            );
        }
    }
    cameras.iter_mut().for_each(|camera| camera.products.cover = camera.products.weather && falls);
}

/// Reports cameras that lose light in fog, and settings that are ignored.
pub(super) fn note_light_loss(cameras: &[CameraPlan], media: &[Medium], context: &mut Context<'_>) {
    if media.is_empty() {
        return;
    }
    for camera in cameras.iter().filter(|camera| camera.settings.paths.integrator == Integrator::Path) {
        let subject = || format!("camera \"{}\"", camera.name);
        if camera.settings.blocks != Blocks::SINGLE {
            context.note_on(
                subject(),
                "\"path_reuse_px\" is ignored: with scattering media, each pixel traces its own paths",
            );
        }
        let depth = depth_above(camera, media);
        let min_bounces = BOUNCES[usize::from(!camera.settings.paths.caustics)] * (1.0 + depth);
        // In an unbounded medium no number is reported: light of its lamps comes from nearby.
        if depth > 0.0 && depth.is_finite() && f64::from(camera.settings.paths.max_bounces) < min_bounces {
            context.note_on(subject(), format!(
                "it is in a medium of optical depth {depth:.1} towards the sky; light scattered more than max_bounces \
                 = {} times is missing, so the medium is too dark; about {:.0} bounces include nearly all of it",
                camera.settings.paths.max_bounces, min_bounces.min(MAX_BOUNCES).ceil()
            ));
        }
    }
}

/// Optical depth of scattering media, straight up from a camera at its first frame.
fn depth_above(camera: &CameraPlan, media: &[Medium]) -> f64 {
    let start_s = camera.timing.frame_start_s(0);
    let interval = TimeInterval::at(start_s).unwrap_or_default();
    let columns_m =
        Media::new(media, camera.path.at(start_s).position_m, interval).columns_m(&Ray::new(Vec3::ZERO, Vec3::Z, 0.0));
    let bright = media.iter().zip(columns_m).filter(|(medium, _)| medium.albedo().max_value() > MIN_ALBEDO);
    bright
        .map(|(medium, column_m)| f64::from(medium.extinction().max_value()) * column_m)
        .filter(|depth| !depth.is_nan())
        .sum()
}
