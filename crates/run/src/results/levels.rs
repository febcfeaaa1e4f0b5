//! Level of raw frames: detects frames that are entirely black or clipped.

use etendue_core::observer::{Message, Observer};
use etendue_sensor::Raw;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The key of a frame's facts in the side-car.
pub(crate) const LEVELS: &str = "levels";

/// Fraction of clipped pixels above which a frame causes a warning.
const MAX_CLIPPED_FRACTION: f64 = 0.99;
/// Mean level above black below which a frame causes a warning, DN: rounding.
const BLACK_DN: f64 = 0.5;

/// Mean, and fractions at both ends of the range, of a frame.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct FrameLevels {
    mean_dn: f64,
    /// Fraction of pixels at or above the white level.
    clipped_fraction: f64,
    /// Fraction of pixels at or below the black level.
    black_fraction: f64,
}

impl FrameLevels {
    /// Levels of the part of a frame that receives light.
    pub(crate) fn new(raw: &Raw) -> Self {
        let area = raw.image;
        let rows = raw.plane.samples().chunks(raw.plane.width().max(1)).skip(area.y).take(area.height);
        let (mut sum, mut clipped, mut black) = (0_u64, 0_u64, 0_u64);
        for reading in rows.flat_map(|row| &row[area.x..area.x + area.width]) {
            sum += u64::from(*reading);
            clipped += u64::from(f64::from(*reading) >= raw.white_level_dn);
            black += u64::from(f64::from(*reading) <= raw.black_level_dn);
        }
        let fraction = |count: u64| count as f64 / (area.width * area.height).max(1) as f64;
        Self { mean_dn: fraction(sum), clipped_fraction: fraction(clipped), black_fraction: fraction(black) }
    }

    /// Mean over frames; `None` for no frames.
    fn mean(frames: &[Self]) -> Option<Self> {
        let mean = |of: fn(&Self) -> f64| frames.iter().map(of).sum::<f64>() / frames.len() as f64;
        (!frames.is_empty()).then(|| Self {
            mean_dn: mean(|frame| frame.mean_dn),
            clipped_fraction: mean(|frame| frame.clipped_fraction),
            black_fraction: mean(|frame| frame.black_fraction),
        })
    }
}

/// The facts of a frame that its levels require.
#[derive(Deserialize)]
struct FrameFacts {
    levels: FrameLevels,
    black_level_dn: f64,
    white_level_dn: f64,
}

/// Reports the levels of a camera's frames to the observer in one line; a warning if all frames are white or black. Reports nothing for a camera without raw
/// frames.
pub(crate) fn report<'a>(camera: &str, frames: impl Iterator<Item = &'a Value>, observer: &dyn Observer) {
    let frame_facts: Vec<FrameFacts> = frames.filter_map(|facts| FrameFacts::deserialize(facts).ok()).collect();
    let levels: Vec<FrameLevels> = frame_facts.iter().map(|frame| frame.levels).collect();
    let (Some(mean), Some(first)) = (FrameLevels::mean(&levels), frame_facts.first()) else { return };
    // Black and white are the same in all frames of a camera.
    let (black, white) = (first.black_level_dn, first.white_level_dn);
    let of = if frame_facts.len() > 1 { format!(" of {} frames", frame_facts.len()) } else { String::new() };
    let line = format!(
        "camera {camera}: mean level{of} {:.1} DN, {:.2} % from black ({black:.0}) to white ({white:.0}); {:.2} % of the pixels are clipped, {:.2} % black",
        mean.mean_dn,
        100.0 * (mean.mean_dn - black) / (white - black),
        100.0 * mean.clipped_fraction,
        100.0 * mean.black_fraction
    );
    if mean.clipped_fraction >= MAX_CLIPPED_FRACTION {
        observer.message(Message::Warning(&format!("{line}: shorten the exposure, or dim the scene")));
    } else if mean.mean_dn - black < BLACK_DN {
        observer.message(Message::Warning(&format!("{line}: no light is recorded")));
    } else {
        observer.message(Message::Note(&line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::sync::Mutex;

    #[derive(Default)]
    struct RecordedMessages(Mutex<Vec<String>>);

    impl Observer for RecordedMessages {
        fn message(&self, message: Message<'_>) {
            let text = match message {
                Message::Note(text) => format!("note: {text}"),
                Message::Warning(text) => format!("warning: {text}"),
            };
            self.0.lock().expect("one thread").push(text);
        }
    }

    fn reported(frames: &[(f64, f64, f64)]) -> String {
        let facts: Vec<Value> = frames
            .iter()
            .map(|(mean_dn, clipped_fraction, black_fraction)| {
                let levels = FrameLevels {
                    mean_dn: *mean_dn,
                    clipped_fraction: *clipped_fraction,
                    black_fraction: *black_fraction,
                };
                json!({ LEVELS: levels, "black_level_dn": 64.0, "white_level_dn": 4064.0 })
            })
            .collect();
        let recorded = RecordedMessages::default();
        report("front", facts.iter(), &recorded);
        recorded.0.into_inner().expect("one thread").join("\n")
    }

    #[test]
    fn white_and_black_frames_are_warned_of() {
        assert_eq!(
            reported(&[(1064.0, 0.25, 0.0), (3064.0, 0.75, 0.5)]),
            "note: camera front: mean level of 2 frames 2064.0 DN, 50.00 % from black (64) to white (4064); 50.00 % of the pixels are clipped, \
             25.00 % black"
        );
        assert!(
            reported(&[(4063.0, 0.995, 0.0)]).starts_with("warning: ")
                && reported(&[(4063.0, 0.985, 0.0)]).starts_with("note: ")
        );
        assert!(reported(&[(64.2, 0.0, 0.5)]).ends_with("no light is recorded"));
        assert_eq!(reported(&[]), "");
    }
}
