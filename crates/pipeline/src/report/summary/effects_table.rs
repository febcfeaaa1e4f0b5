//! Cost of each effect of a camera, and the result of dropping it: a table of those with figures, lists of the others.

use super::words::seconds;
use crate::plan::{CameraPlan, Plan};
use crate::report::FrameCost;
use crate::report::effects::{EffectGroup, OmissionResult, PlannedEffect};
use etendue_core::EffectStatus;
use std::fmt::{self, Formatter};

/// Columns of a line of a list.
const WIDTH: usize = 110;
/// Column at which lists begin.
const INDENT: usize = 17;
/// Column at which the last column of the table begins.
const OMISSION_COLUMN: usize = 62;
/// Minimum fraction of the frame's time for a row, if nothing else is known of the effect.
const MIN_LISTED_FRACTION: f64 = 0.005;

pub(super) fn effects_table(plan: &Plan, camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let frame_s = FrameCost::new(plan, camera).cpu_s();
    let effects = plan.effects(camera);
    let (rows, rest): (Vec<_>, Vec<_>) = effects.iter().partition(|effect| has_figures(effect, frame_s));
    let (name, need) = ("effect", "");
    writeln!(f, "  {name:<29} {need:<8} {:>6} {:>5} {:>6}  if dropped", "CPU s", "share", "MB")?;
    rows.iter().try_for_each(|effect| row(effect, frame_s, f))?;
    let named = |is_there: fn(&PlannedEffect) -> bool| {
        let of = rest.iter().filter(move |effect| is_there(effect));
        of.map(|effect| effect.name).collect::<Vec<_>>()
    };
    list("also required", &named(|effect| matches!(effect.status, EffectStatus::Modelled(_))), f)?;
    list("also guarded", &named(|effect| matches!(effect.status, EffectStatus::WhereNeeded(_))), f)?;
    list("skipped", &named(|effect| !effect.status.is_modelled() && !is_listed_above(effect)), f)
}

/// Returns true if the lines of the sensor, of processing and of products already state that it is left out.
fn is_listed_above(effect: &PlannedEffect) -> bool {
    matches!(effect.group, EffectGroup::Sensor | EffectGroup::Processing | EffectGroup::Output)
}

/// Returns true if a row would state more than the name.
fn has_figures(effect: &PlannedEffect, frame_s: f64) -> bool {
    let has_errors = effect.omission.as_ref().is_some_and(|omission| !omission.errors.is_empty());
    let takes = effect.cpu_s.is_some_and(|s| s > MIN_LISTED_FRACTION * frame_s);
    effect.status.is_modelled() && (takes || effect.memory_bytes.is_some() || has_errors)
}

fn row(effect: &PlannedEffect, frame_s: f64, f: &mut Formatter<'_>) -> fmt::Result {
    let unknown = || "–".to_owned();
    let cpu = effect.cpu_s.map_or_else(unknown, seconds);
    let fraction = effect.cpu_s.filter(|_| frame_s > 0.0);
    let fraction = fraction.map_or_else(unknown, |s| format!("{:.0} %", 100.0 * s / frame_s));
    let memory = effect.memory_bytes.map_or_else(unknown, |bytes| format!("{:.1}", bytes / 1e6));
    let need = if matches!(effect.status, EffectStatus::WhereNeeded(_)) { "guarded" } else { "required" };
    write!(f, "  {:<29} {need:<8} {cpu:>6} {fraction:>5} {memory:>6}  ", effect.name)?;
    let parts = effect.omission.as_ref().map_or_else(Vec::new, |omission| self::dropped(effect.group, omission));
    writeln!(f, "{}", wrapped(&parts, OMISSION_COLUMN))
}

/// Result of dropping it, part by part; the removal of a product changes nothing else.
fn dropped(group: EffectGroup, omission: &OmissionResult) -> Vec<String> {
    let saving = match (&omission.set, omission.cpu_saved_s) {
        (None, _) => Some("always on".to_owned()),
        (Some(_), Some(s)) => Some(format!("saves {} s", seconds(s))),
        (Some(_), None) => None,
    };
    let is_unknown = omission.errors.is_empty() && omission.set.is_some() && group != EffectGroup::Output;
    let errors = omission.errors.iter().map(ToString::to_string);
    saving.into_iter().chain(errors).chain(is_unknown.then(|| "error unknown".to_owned())).collect()
}

/// Parts separated by commas, in lines that begin at a column and end within the width.
fn wrapped(parts: &[String], column: usize) -> String {
    let (mut text, mut length) = (String::new(), column);
    for (i, part) in parts.iter().enumerate() {
        let comma = if i + 1 < parts.len() { "," } else { "" };
        let columns = part.chars().count() + comma.len();
        if length > column && length + 1 + columns > WIDTH {
            text += "\n";
            text += &" ".repeat(column);
            length = column;
        } else if length > column {
            text += " ";
            length += 1;
        }
        text += part;
        text += comma;
        length += columns;
    }
    text
}

/// Names after a word, within the width; empty without names.
fn list(word: &str, names: &[&str], f: &mut Formatter<'_>) -> fmt::Result {
    let names: Vec<String> = names.iter().map(|&name| name.to_owned()).collect();
    if names.is_empty() { Ok(()) } else { writeln!(f, "  {word:<14} {}", wrapped(&names, INDENT)) }
}
