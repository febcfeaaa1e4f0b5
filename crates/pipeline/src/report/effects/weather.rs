//! Fog, rain and snow.

use super::planned_effect::{EffectGroup, PlannedEffect, camera_change, required_if};
use crate::plan::{CameraPlan, Plan};
use crate::render::change_over;
use etendue_core::EffectStatus;

const GROUP: EffectGroup = EffectGroup::Weather;

pub(super) fn effects(plan: &Plan, camera: &CameraPlan) -> Vec<PlannedEffect> {
    vec![media(plan), falling(plan), near(plan, camera)]
}

/// The layers of weather, which require at least one element: removed together with the last.
fn layers(plan: &Plan, is_last: bool) -> impl Iterator<Item = String> {
    let cameras = plan.cameras.iter().filter(move |camera| is_last && camera.products.weather);
    cameras.map(|camera| camera_change(camera, "output.weather", "false"))
}

fn media(plan: &Plan) -> PlannedEffect {
    let count = plan.media.len() - usize::from(plan.precipitation.is_some());
    let text = format!("{count} participating media: scattering distances are sampled along rays");
    let status = required_if(count > 0, text, "the air is clear");
    let set = std::iter::once("scene.media=null".to_owned()).chain(layers(plan, plan.precipitation.is_none()));
    PlannedEffect::new(GROUP, "fog and other media", status).described_by("scene.media").dropped_by(set)
}

fn falling(plan: &Plan) -> PlannedEffect {
    let text = match &plan.precipitation {
        Some(precipitation) if precipitation.field.law().is_snow() => "snow is a participating medium for all rays",
        _ => "rain is a participating medium for all rays",
    };
    let status = required_if(plan.precipitation.is_some(), text, "no precipitation");
    let set = std::iter::once("scene.precipitation=null".to_owned()).chain(layers(plan, plan.media.len() == 1));
    PlannedEffect::new(GROUP, "rain and snow", status).described_by("scene.precipitation").dropped_by(set)
}

/// Resolved drops or flakes.
fn near(plan: &Plan, camera: &CameraPlan) -> PlannedEffect {
    let expected = change_over(plan, camera).map_or(0.0, |change_over| change_over.expected);
    let status = if expected >= 0.5 {
        EffectStatus::WhereNeeded(format!(
            "about {expected:.0} resolved individually, hit only by rays from the camera"
        ))
    } else {
        EffectStatus::LeftOut("no drop or flake is large enough in the image".to_owned())
    };
    PlannedEffect::new(GROUP, "near drops and flakes", status)
        .described_by("scene.precipitation.most")
        .dropped_by(["scene.precipitation.most=0".to_owned()])
}
