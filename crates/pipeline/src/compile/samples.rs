//! Samples a pixel, and the replicates that tell their variance.

use super::context::Context;
use super::{Choices, Quality};
use etendue_scene::record::{Output, Render};
use etendue_scene::stated;

/// Independent replicates where nobody says how many.
const REPLICATES: u64 = 4;

/// Samples a pixel and replicates; the replicates divide the samples.
pub(super) fn samples(render: &Render, choices: &Choices, context: &mut Context<'_>) -> (u32, u32) {
    let by_quality = || choices.quality.unwrap_or(Quality::Standard).spp();
    let spp = render.spp.as_ref().map_or_else(by_quality, |s| s.value as u32);
    let given = render.replicates.as_ref();
    if let Some(replicates) = given.filter(|r| u64::from(spp) % r.value == 0) {
        return (spp, replicates.value as u32);
    }
    if let Some(replicates) = given {
        let problem = format!("{spp} samples cannot be shared evenly among {} replicates", replicates.value);
        let remedy = "give samples that are a multiple of the replicates";
        let by_quality = render.spp.is_none() && choices.quality.is_some();
        if by_quality && !replicates.place.is_command_line() {
            context.notice(format!("--quality supersedes {}", stated("replicates", &replicates.place)));
        } else {
            let cause = render.spp.as_ref().map(|spp| &spp.place);
            context.idle(("replicates", &replicates.place), cause, problem, remedy);
        }
    }
    let most = [REPLICATES, 2, 1].into_iter().find(|r| u64::from(spp) % r == 0).unwrap_or(1);
    if most == 1 {
        context.remark(format!("{spp} samples are one replicate, which knows no variance: an even number gives two"));
    }
    (spp, most as u32)
}

/// Whether variance can be delivered where it is asked for: one replicate knows none.
pub(super) fn has_variance(output: &Output, replicates: u32, render: &Render, context: &mut Context<'_>) -> bool {
    let Some(variance) = output.variance.as_ref().filter(|variance| variance.value && replicates < 2) else {
        return true;
    };
    let by_flag = render.spp.as_ref().map(|spp| &spp.place).filter(|place| place.is_command_line());
    if let Some(by) = by_flag.filter(|_| !variance.place.is_command_line()) {
        context.notice(format!(
            "{by} supersedes {}: one replicate knows no variance",
            stated("variance", &variance.place)
        ));
        return false;
    }
    let place = render.replicates.as_ref().map_or(&render.place, |r| &r.place);
    let remedy = "give \"replicates\" = 2 or more (16 for a golden image) and samples that are a multiple";
    context.fault(place, "one replicate knows no variance, and variance is asked for", remedy);
    true
}
