//! Samples per pixel, and the replicates that give their variance.

use super::choices::{self, Choices, Refinement};
use super::context::{Context, ErrorCode};
use crate::plan::{AdaptiveSampling, MAX_PASSES, Pass, Passes};
use etendue_core::Quality;
use etendue_scene::record::samples::MAX_SPP as MAX_KEY_SPP;
use etendue_scene::record::{Output, Render};
use etendue_scene::{Placed, key_with_place};

/// Default number of independent replicates.
const REPLICATES: u64 = 4;

/// Minimum and maximum samples of a pixel in noise-limited sampling.
const MIN_SPP: u64 = 16;
const MAX_SPP: u64 = 4096;

/// Sample counts of a camera's pixels.
pub(super) struct SampleSettings {
    /// Samples of every pixel; with noise-limited sampling the maximum.
    pub(super) spp: u32,
    /// Replicates; divide the samples.
    pub(super) replicates: u32,
    /// Noise-limited sampling, if any.
    pub(super) adaptive: Option<AdaptiveSampling>,
    /// Passes, if there are several, or a given time determines them.
    pub(super) passes: Option<Passes>,
}

/// Sample counts of a camera's pixels.
pub(super) fn samples(render: &Render, choices: &Choices, context: &mut Context<'_>) -> SampleSettings {
    if choices.refinement == Refinement::Timed {
        return timed(render, context);
    }
    if let Some(threshold) = render.samples.threshold_in_force() {
        if choices.refinement == Refinement::Progressive {
            let problem =
                "\"noise_threshold\" sets the samples of each pixel, but `progressive` refines all pixels in passes";
            context.error(
                ErrorCode::Contradiction,
                &threshold.place,
                problem,
                "give `spp`, or render without `progressive`",
            );
        }
        return adaptive(threshold, render, context);
    }
    if let Some(numbers) = render.samples.passes_in_force() {
        return in_passes(numbers, render, context);
    }
    let (spp, replicates) = uniform_samples(render, choices, context);
    let passes = (choices.refinement == Refinement::Progressive).then(|| Passes::doubling(spp, replicates));
    SampleSettings { spp, replicates, adaptive: None, passes }
}

/// For a given time: one pass, the smallest, until the time is known.
fn timed(render: &Render, context: &mut Context<'_>) -> SampleSettings {
    let noise = render.samples.noise_threshold.as_ref().map(|limit| ("noise_threshold", &limit.place));
    let passes = render.samples.passes.first().map(|pass| ("passes", &pass.place));
    let spp = render.samples.spp.as_ref().map(|spp| ("spp", &spp.place));
    for (key, place) in [noise, passes, spp].into_iter().flatten() {
        context.overridden(format!("`time_s` overrides {}", key_with_place(key, place)));
    }
    let replicates = render.samples.replicates.as_ref().map_or(REPLICATES, |setting| setting.value) as u32;
    SampleSettings {
        spp: replicates,
        replicates,
        adaptive: None,
        passes: Some(Passes::new(vec![Pass::all_pixels(replicates)])),
    }
}

/// For stated passes.
fn in_passes(numbers: &[Placed<f64>], render: &Render, context: &mut Context<'_>) -> SampleSettings {
    let divides = |r: &u64| numbers.iter().all(|n| n.value.fract() != 0.0 || (n.value as u64).is_multiple_of(*r));
    let max_replicates = || [REPLICATES, 2, 1].into_iter().find(divides).unwrap_or(1);
    let replicates = render.samples.replicates.as_ref().map_or_else(max_replicates, |key| key.value) as u32;
    let mut list = Vec::new();
    for number in numbers {
        match Pass::from_number(number.value, replicates) {
            Some(pass) => list.push(pass),
            None => {
                let problem =
                    format!("{} samples cannot be divided equally among {replicates} replicates", number.value);
                let remedy = "give each pass a multiple of the replicates, or fewer samples than replicates (an \
                              average per pixel)";
                context.error(ErrorCode::NotAMultiple, &number.place, problem, remedy);
            }
        }
    }
    let passes = Passes::new(list);
    let max_spp = MAX_KEY_SPP as f64;
    if numbers.len() > MAX_PASSES || passes.mean_spp() > max_spp {
        let problem = format!("found {} passes of {} samples", numbers.len(), passes.mean_spp());
        context.error(
            ErrorCode::OutOfRange,
            &numbers[0].place,
            problem,
            format!("give at most {MAX_PASSES} passes of at most {max_spp} samples in total"),
        );
    } else if passes.list().len() == numbers.len() && passes.spp() == 0 {
        let problem = format!("no pass samples all pixels: each has fewer samples than the {replicates} replicates");
        context.error(
            ErrorCode::NotAMultiple,
            &numbers[0].place,
            problem,
            "give one pass a multiple of the replicates",
        );
    }
    SampleSettings { spp: passes.spp().max(replicates), replicates, adaptive: None, passes: Some(passes) }
}

/// Default and minimum number of replicates in noise-limited sampling: two or more determine the samples of each, and no two determine each other's.
const DEFAULT_ADAPTIVE_REPLICATES: u64 = 8;
const MIN_ADAPTIVE_REPLICATES: u64 = 5;

/// For noise-limited sampling.
fn adaptive(threshold: &Placed<f64>, render: &Render, context: &mut Context<'_>) -> SampleSettings {
    let replicates = adaptive_replicates(threshold, render, context);
    let keys = [("min_spp", &render.samples.min_spp), ("max_spp", &render.samples.max_spp)];
    for (key, stated) in keys.into_iter().filter_map(|(key, stated)| Some((key, stated.as_ref()?))) {
        if stated.value % replicates != 0 {
            let problem = format!("{} samples cannot be divided equally among {replicates} replicates", stated.value);
            context.error(
                ErrorCode::NotAMultiple,
                &stated.place,
                problem,
                format!("give a \"{key}\" that is a multiple of the replicates"),
            );
        }
    }
    let value = |key: &Option<Placed<u64>>, default: u64| key.as_ref().map_or(default, |spp| spp.value);
    let min = value(&render.samples.min_spp, MIN_SPP.next_multiple_of(replicates));
    let max = value(&render.samples.max_spp, MAX_SPP.max(min).next_multiple_of(replicates));
    if let Some(stated) = render.samples.max_spp.as_ref().or(render.samples.min_spp.as_ref()).filter(|_| max < min) {
        let problem = format!("the maximum of {max} samples is below the minimum of {min}");
        context.error(
            ErrorCode::WrongOrder,
            &stated.place,
            problem,
            "give a larger \"max_spp\" or a smaller \"min_spp\"",
        );
    }
    let adaptive = AdaptiveSampling { threshold: threshold.value, min_spp: min as u32 };
    SampleSettings { spp: max as u32, replicates: replicates as u32, adaptive: Some(adaptive), passes: None }
}

/// Replicates that determine each other's samples.
fn adaptive_replicates(threshold: &Placed<f64>, render: &Render, context: &mut Context<'_>) -> u64 {
    let Some(replicates_key) = &render.samples.replicates else { return DEFAULT_ADAPTIVE_REPLICATES };
    if replicates_key.value >= MIN_ADAPTIVE_REPLICATES {
        return replicates_key.value;
    }
    let problem = format!(
        "\"noise_threshold\" requires replicates that determine each other's samples; found {}",
        replicates_key.value
    );
    let remedy = format!("give {MIN_ADAPTIVE_REPLICATES} or more, or remove the key for {DEFAULT_ADAPTIVE_REPLICATES}");
    context.error_without_effect(
        ErrorCode::OutOfRange,
        "replicates",
        &replicates_key.place,
        Some(&threshold.place),
        problem,
        &remedy,
    );
    DEFAULT_ADAPTIVE_REPLICATES
}

/// Samples per pixel and replicates; the replicates divide the samples.
fn uniform_samples(render: &Render, choices: &Choices, context: &mut Context<'_>) -> (u32, u32) {
    let by_quality = || choices::spp(choices.quality.unwrap_or(Quality::Standard));
    let spp = render.samples.spp.as_ref().map_or_else(by_quality, |s| s.value as u32);
    let requested = render.samples.replicates.as_ref();
    if let Some(replicates) = requested.filter(|r| u64::from(spp) % r.value == 0) {
        return (spp, replicates.value as u32);
    }
    if let Some(replicates) = requested {
        let problem = format!("{spp} samples cannot be divided equally among {} replicates", replicates.value);
        let remedy = "give samples that are a multiple of the replicates";
        let by_quality = render.samples.spp.is_none() && choices.quality.is_some();
        if by_quality && !replicates.place.is_command_line() {
            context.overridden(format!("`quality` overrides {}", key_with_place("replicates", &replicates.place)));
        } else {
            let cause = render.samples.spp.as_ref().map(|spp| &spp.place);
            context.error_without_effect(
                ErrorCode::NotAMultiple,
                "replicates",
                &replicates.place,
                cause,
                problem,
                remedy,
            );
        }
    }
    let max_replicates = [REPLICATES, 2, 1].into_iter().find(|r| u64::from(spp) % r == 0).unwrap_or(1);
    if max_replicates == 1 {
        context
            .note(format!("{spp} samples form one replicate, which gives no variance; use an even number of samples"));
    }
    (spp, max_replicates as u32)
}

/// Returns true if a requested variance can be delivered: one replicate gives none.
pub(super) fn has_variance(output: &Output, replicates: u32, render: &Render, context: &mut Context<'_>) -> bool {
    let Some(variance) = output.variance.as_ref().filter(|variance| variance.value && replicates < 2) else {
        return true;
    };
    let by_flag = render.samples.spp.as_ref().map(|spp| &spp.place).filter(|place| place.is_command_line());
    if let Some(by) = by_flag.filter(|_| !variance.place.is_command_line()) {
        context.overridden(format!(
            "{by} overrides {}: one replicate gives no variance",
            key_with_place("variance", &variance.place)
        ));
        return false;
    }
    let place = render.samples.replicates.as_ref().map_or(&render.place, |r| &r.place);
    let remedy = "give \"replicates\" = 2 or more (16 for a reference image) and samples that are a multiple";
    context.error(
        ErrorCode::UnavailableOutput,
        place,
        "one replicate gives no variance, but variance is requested",
        remedy,
    );
    true
}
