//! The level of raw frames: whether a camera's frames are useful at all.

use crate::observer::{Message, Observer};
use etendue_sensor::Raw;
use serde_json::{Value, json};

/// The key of a frame's facts in the side-car.
pub(crate) const LEVELS: &str = "levels";

/// Share of clipped pixels above which a frame is warned of.
const CLIPPED: f64 = 0.99;
/// Mean level over black below which a frame is warned of, DN: rounding.
const BLACK_DN: f64 = 0.5;

/// Mean and ends of the part of a frame that light reaches, as facts of its side-car. Clipped pixels are at the white level or above, black ones at the
/// black level or below.
pub(crate) fn facts(raw: &Raw) -> Value {
    let area = raw.picture;
    let rows = raw.plane.samples().chunks(raw.plane.width().max(1)).skip(area.y).take(area.height);
    let (mut sum, mut clipped, mut black) = (0_u64, 0_u64, 0_u64);
    for reading in rows.flat_map(|row| &row[area.x..area.x + area.width]) {
        sum += u64::from(*reading);
        clipped += u64::from(f64::from(*reading) >= raw.white_level_dn);
        black += u64::from(f64::from(*reading) <= raw.black_level_dn);
    }
    let count = (area.width * area.height).max(1) as f64;
    json!({
        "mean_dn": sum as f64 / count,
        "clipped_fraction": clipped as f64 / count,
        "black_fraction": black as f64 / count,
    })
}

/// Tells the caller the levels of a camera's frames in one line, a warning where all frames are white or black; nothing of a camera without raw frames.
pub(crate) fn tell<'a>(camera: &str, frames: impl Iterator<Item = &'a Value>, observer: &dyn Observer) {
    let found: Vec<[f64; 5]> = frames.filter_map(of_frame).collect();
    if found.is_empty() {
        return;
    }
    let mean = |i: usize| found.iter().map(|frame| frame[i]).sum::<f64>() / found.len() as f64;
    let [level, clipped, black, from, to] = [0, 1, 2, 3, 4].map(mean);
    let share = 100.0 * (level - from) / (to - from);
    let of = if found.len() > 1 { format!(" of {} frames", found.len()) } else { String::new() };
    let line = format!(
        "camera {camera}: mean level{of} {level:.1} DN, {share:.2} % from black ({from:.0}) to white ({to:.0}); {:.2} % of the pixels are clipped, {:.2} % black",
        100.0 * clipped,
        100.0 * black
    );
    if clipped >= CLIPPED {
        observer.message(Message::Warning(&format!("{line}: shorten the exposure, or dim the scene")));
    } else if level - from < BLACK_DN {
        observer.message(Message::Warning(&format!("{line}: no light is recorded")));
    } else {
        observer.message(Message::Note(&line));
    }
}

/// Mean, clipped and black shares, black and white level of a frame.
fn of_frame(facts: &Value) -> Option<[f64; 5]> {
    let levels = facts.get(LEVELS)?;
    let number = |of: &Value, key: &str| of.get(key)?.as_f64();
    Some([
        number(levels, "mean_dn")?,
        number(levels, "clipped_fraction")?,
        number(levels, "black_fraction")?,
        number(facts, "black_level_dn")?,
        number(facts, "white_level_dn")?,
    ])
}
