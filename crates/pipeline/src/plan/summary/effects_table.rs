//! What each effect of a camera takes, and what dropping it would bring: a table of those that have a figure, lists of the others.

use crate::plan::effects::{IfDropped, PlannedEffect};
use crate::plan::{CameraPlan, FrameCost, Plan};
use etendue_core::EffectStatus;
use std::fmt::{self, Formatter};

/// Columns of a line of a list.
const WIDTH: usize = 110;
/// Where lists begin.
const INDENT: usize = 17;
/// What a row takes at least if nothing else is known of it: this share of the frame.
const LISTED_SHARE: f64 = 0.005;

pub(super) fn effects_table(plan: &Plan, camera: &CameraPlan, f: &mut Formatter<'_>) -> fmt::Result {
    let frame_s = FrameCost::of(plan, camera).cpu_s();
    let effects = plan.effects(camera);
    let (rows, rest): (Vec<_>, Vec<_>) = effects.iter().partition(|effect| has_figures(effect, frame_s));
    let (name, need) = ("of a frame", "");
    writeln!(f, "  {name:<29} {need:<8} {:>7} {:>5} {:>6}  if dropped", "CPU s", "share", "MB")?;
    rows.iter().try_for_each(|effect| row(effect, frame_s, f))?;
    let named = |is_there: fn(&EffectStatus) -> bool| {
        let of = rest.iter().filter(move |effect| is_there(&effect.status));
        of.map(|effect| effect.name).collect::<Vec<_>>()
    };
    list("required too", &named(|status| matches!(status, EffectStatus::Modelled(_))), f)?;
    list("guarded too", &named(|status| matches!(status, EffectStatus::WhereNeeded(_))), f)?;
    list("skipped", &named(|status| !status.is_modelled()), f)
}

/// Whether a row would say more than the name.
fn has_figures(effect: &PlannedEffect, frame_s: f64) -> bool {
    let has_errors = effect.if_dropped.as_ref().is_some_and(|dropped| !dropped.errors.is_empty());
    let takes = effect.cpu_s.is_some_and(|s| s > LISTED_SHARE * frame_s);
    effect.status.is_modelled() && (takes || effect.memory_bytes.is_some() || has_errors)
}

fn row(effect: &PlannedEffect, frame_s: f64, f: &mut Formatter<'_>) -> fmt::Result {
    let unknown = || "–".to_owned();
    let cpu = effect.cpu_s.map_or_else(unknown, super::seconds);
    let share = effect.cpu_s.filter(|_| frame_s > 0.0);
    let share = share.map_or_else(unknown, |s| format!("{:.0} %", 100.0 * s / frame_s));
    let memory = effect.memory_bytes.map_or_else(unknown, |bytes| format!("{:.1}", bytes / 1e6));
    let need = if matches!(effect.status, EffectStatus::WhereNeeded(_)) { "guarded" } else { "required" };
    let dropped = effect.if_dropped.as_ref().map_or_else(String::new, dropped);
    writeln!(f, "  {:<29} {need:<8} {cpu:>7} {share:>5} {memory:>6}  {dropped}", effect.name)
}

/// What dropping it would bring.
fn dropped(dropped: &IfDropped) -> String {
    let errors: Vec<String> = dropped.errors.iter().map(ToString::to_string).collect();
    let saved = match (&dropped.set, dropped.cpu_saved_s) {
        (None, _) => Some("no key".to_owned()),
        (Some(_), Some(s)) => Some(format!("saves {} s", super::seconds(s))),
        (Some(_), None) => None,
    };
    let error = match (&dropped.set, errors.is_empty()) {
        (_, false) => Some(errors.join(", ")),
        (Some(_), true) => Some("error ?".to_owned()),
        (None, true) => None,
    };
    saved.into_iter().chain(error).collect::<Vec<_>>().join("; ")
}

/// Names after a word, within the width; nothing where there are none.
fn list(word: &str, names: &[&str], f: &mut Formatter<'_>) -> fmt::Result {
    let mut line = format!("  {word:<14} ");
    let mut length = INDENT;
    for (i, name) in names.iter().enumerate() {
        let part = if i + 1 < names.len() { format!("{name},") } else { (*name).to_owned() };
        if length > INDENT && length + 1 + part.chars().count() > WIDTH {
            writeln!(f, "{line}")?;
            (line, length) = (" ".repeat(INDENT), INDENT);
        }
        if length > INDENT {
            (line, length) = (line + " ", length + 1);
        }
        length += part.chars().count();
        line += &part;
    }
    if names.is_empty() { Ok(()) } else { writeln!(f, "{line}") }
}
