//! Whether a camera has an effect on the irradiance, and by what its point spread spreads light.

use super::camera::CameraPlan;
use super::settings::Route;
use etendue_core::EffectStatus;
use etendue_optics::effects::{Effect, SpreadBy};

/// Whether it is modelled, and why.
pub(super) fn irradiance_effect_status(camera: &CameraPlan, effect: Effect) -> EffectStatus {
    match (effect, camera.body.effects.status(effect)) {
        (Effect::PointSpread, EffectStatus::Modelled(of)) => EffectStatus::Modelled(of + &spread_by(camera)),
        (_, status) => status,
    }
}

/// By what the point spread spreads light, and how much contrast a film would lack or add.
fn spread_by(camera: &CameraPlan) -> String {
    let Some((by, width)) = camera.body.effects.spread_by() else { return String::new() };
    let by = if camera.settings.route == Route::Lens { by } else { SpreadBy::Film };
    let error = width.film_error;
    match by {
        SpreadBy::Samples => {
            format!(", by displaced samples (by the film contrast would be wrong by up to {error:.2})")
        }
        SpreadBy::Film => format!(", by the film (contrast wrong by up to {error:.3})"),
    }
}
