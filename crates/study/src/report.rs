//! Table and plot of a study.

use crate::error::{ErrorMetrics, Estimate};
use crate::front::{FrontPoint, Recommendation};
use crate::measured::{ConfigurationMeasurement, Role};
use crate::study::Study;
use etendue::plot::{Axis, Mark, Plot, Series, svg};
use etendue_core::maths::f64::log10;
use std::fmt::Write as _;

/// Slow-down of pilots above which a machine is reported as busy.
const BUSY_RATIO: f64 = 1.25;

/// A time as readable text.
pub(crate) fn time_text(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{s:.2} s"),
        s if s < 10.0 => format!("{s:.1} s"),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} h", s / 3600.0),
        s => format!("{:.1} days", s / 86_400.0),
    }
}

/// An error as text, in the deciding metric.
pub(crate) fn error_text(error: &ErrorMetrics<Estimate>) -> String {
    match &error.sensor {
        Some(e) => format!("{} of the sensor's noise", figure(*e)),
        None => format!("{} of the light", percent(error.relative)),
    }
}

/// Formats a value with the decimals that the first digit of its uncertainty needs, at most three.
pub(crate) fn figure(e: Estimate) -> String {
    if e == Estimate::default() {
        return "0".to_owned();
    }
    if e.uncertainty.is_nan() {
        return format!("{:.3} ± ?", e.value);
    }
    let size = if e.uncertainty > 0.0 { e.uncertainty } else { e.value.abs().max(1.0) * 1e-2 };
    let digits = (-log10(size)).ceil().clamp(0.0, 3.0) as usize;
    format!("{:.digits$} ± {:.digits$}", e.value, e.uncertainty)
}

pub(crate) fn percent(e: Estimate) -> String {
    format!("{} %", figure(e.times(100.0)))
}

/// Table of a study: configurations, Pareto front, recommendations.
#[must_use]
pub fn table(study: &Study) -> String {
    let mut out = String::new();
    let own = &study.as_stated;
    let _ = writeln!(
        out,
        "camera {}: {} of the tiles evaluated in {}; light is measured as {}\n",
        study.camera,
        if study.pixel_fraction >= 1.0 { "all".to_owned() } else { format!("{:.1} %", 100.0 * study.pixel_fraction) },
        time_text(study.took_s),
        study.signal
    );
    if study.slowed > BUSY_RATIO {
        let slowed = study.slowed;
        let _ = writeln!(
            out,
            "times are those of an idle machine; this one was busy, and pilots took {slowed:.1} times as long\n"
        );
    }
    let _ = writeln!(
        out,
        "as in the job: {} samples, {}, {} in {}\n",
        own.spp,
        own.configuration.label(),
        error_text(&own.error),
        time_text(own.seconds.value)
    );
    configurations(study, &mut out);
    points(&study.front, &mut out);
    study.recommendations.iter().for_each(|recommendation| recommended(recommendation, &mut out));
    out += "\nDepth, normals and ids are the same in every configuration: they have separate rays.\n";
    out
}

/// Every configuration with the job's number of samples.
fn configurations(study: &Study, out: &mut String) {
    let (spp, replicates) = (study.as_stated.spp, study.as_stated.replicates);
    let of = if study.as_stated.error.sensor.is_some() { "sensor's noise" } else { "light" };
    let _ = writeln!(
        out,
        "configurations, at {spp} samples: noise and bias relative to the {of}; noise of means of 8 × 8 px relative to their light\n\
         {:<54} {:>8} {:>14} {:>16} {:>14}",
        "configuration", "time", "noise", "of 8 × 8 px", "bias"
    );
    for measured in &study.configurations {
        let noise = measured
            .variance
            .map(|law| law.at(f64::from(spp) / f64::from(replicates)).times(1.0 / f64::from(replicates)).root());
        let bias = measured.bias.as_ref().filter(|_| measured.role != Role::Choice);
        let bias = bias.map(|bias| main_metric_text(&bias.squares.map(|square| square.root())));
        let _ = writeln!(
            out,
            "{:<54} {:>8} {:>14} {:>16} {:>14}",
            measured.configuration.label(),
            time_text(measured.seconds(f64::from(spp), study.rest_s).value),
            main_metric_text(&noise),
            percent(noise.patch),
            bias.unwrap_or_else(|| "–".to_owned()),
        );
    }
    biases(&study.configurations, out);
}

/// Text of the deciding metric.
fn main_metric_text(error: &ErrorMetrics<Estimate>) -> String {
    error.sensor.map_or_else(|| percent(error.relative), figure)
}

/// Omissions of each approximation, and the significance of their bias.
fn biases(measurements: &[ConfigurationMeasurement], out: &mut String) {
    let _ = writeln!(out, "\nbias, named:");
    for measured in measurements.iter().filter(|measured| matches!(measured.role, Role::Approximation | Role::Stated)) {
        let (left_out, Some(bias)) = (measured.configuration.left_out(), &measured.bias) else { continue };
        if left_out.is_empty() {
            continue;
        }
        let biases = error_text(&bias.squares.map(|square| square.root()));
        let sure = match bias.squares.main_metric() {
            Estimate { value: 0.0, uncertainty: 0.0 } => ": the light is bit-identical",
            square if square.exceeds(2.0) => "",
            _ => ": not significant, less than two standard uncertainties",
        };
        let _ = writeln!(
            out,
            "  {}, against {}: {biases}{sure}\n    it omits {left_out}",
            measured.configuration.label(),
            bias.against.label()
        );
    }
}

fn points(front: &[FrontPoint], out: &mut String) {
    let _ = writeln!(
        out,
        "\nPareto front: no other configuration is both faster and more accurate\n{:>8} {:>22}  configuration",
        "time", "error"
    );
    for point in front {
        let error = main_metric_text(&point.error);
        let _ = writeln!(
            out,
            "{:>8} {error:>22}  {} samples, {}",
            time_text(point.seconds.value),
            point.spp,
            point.configuration.label()
        );
    }
    out.push('\n');
}

fn recommended(recommendation: &Recommendation, out: &mut String) {
    let Recommendation { target, point, is_reached, confirmation } = recommendation;
    let _ = writeln!(
        out,
        "{}: {} samples, {}: {} in {}{}",
        target.name,
        point.spp,
        point.configuration.label(),
        error_text(&point.error),
        time_text(point.seconds.value),
        if *is_reached { "" } else { "; the target is not reached" }
    );
    let _ = match confirmation {
        Some(test) => writeln!(
            out,
            "  tested on {} {} tiles with {} samples per replicate: {} of the time estimated by the pilots (the time above follows the test){}",
            test.tiles,
            if test.unseen { "other" } else { "of the same" },
            test.samples,
            figure(test.seconds),
            test.noise.map_or_else(String::new, |noise| format!(", {} of the noise", figure(noise)))
        ),
        None => writeln!(out, "  not tested: the image has too few tiles"),
    };
}

/// Time against error as SVG: the curve of each configuration, the Pareto front, and the recommendations.
#[must_use]
pub fn plot(study: &Study) -> String {
    let has_sensor = study.as_stated.error.sensor.is_some();
    let label = if has_sensor { "error relative to the sensor's noise (rms)" } else { "error of the light (rms)" };
    let place = |point: &FrontPoint| (point.seconds.value, point.error.main_metric().value);
    let mut series = Vec::new();
    let on_front = study.front.iter().map(|p| p.configuration);
    let mut named: Vec<_> = on_front.chain([study.as_stated.configuration]).collect();
    named.dedup();
    named.sort_by_key(|configuration| study.configurations.iter().position(|m| m.configuration == *configuration));
    named.dedup();
    for configuration in named {
        let Some(measured) = study.configurations.iter().find(|m| m.configuration == configuration) else { continue };
        let replicates = f64::from(study.as_stated.replicates);
        let curve = (2..=14).map(|power| f64::from(1_u32 << power)).filter(|spp| *spp >= replicates).map(|spp| {
            let error = measured.error(spp, replicates).main_metric().root().value;
            (measured.seconds(spp, study.rest_s).value, error)
        });
        series.push(Series::new(&configuration.label(), Mark::Line, curve));
    }
    series.push(Series::new("as in the job", Mark::Points, [place(&study.as_stated)]));
    let recommended = study.recommendations.iter().map(|r| place(&r.point));
    series.push(Series::new("draft, standard, reference", Mark::Points, recommended));
    svg(&[Plot {
        title: format!("Time against error: camera {}", study.camera),
        x: Axis::log("time of a run, s"),
        y: Axis::log(label),
        series,
    }])
}
