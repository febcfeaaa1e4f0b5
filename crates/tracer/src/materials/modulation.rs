//! Light of surfaces that goes up and down.

use core::num::NonZeroU32;
use etendue_core::{TimeInterval, Waveform};
use glam::Vec2;
use std::sync::Arc;

/// What a light counts at least in the choice among lights, over its greatest level in the view's interval: no row of the picture that
/// it lights at its strongest draws it less than a sixteenth as often as it should.
const LEAST_OF_GREATEST: f64 = 1.0 / 16.0;

/// What a light's strength counts in the choice among lights that is made for a whole `interval`: its mean, but not less than a
/// sixteenth of its greatest level; 0 only where it is dark throughout.
#[must_use]
pub fn choice_level(waveform: &Waveform, interval: TimeInterval) -> f64 {
    waveform.mean(interval).max(LEAST_OF_GREATEST * waveform.greatest(interval))
}

/// How the strength of a surface's light changes over time: all of it together, or row by row as a panel's driver goes through its rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Modulation {
    waveform: Arc<Waveform>,
    /// Rows that take turns, from the top (v = 1) of the texture coordinates down, and the time from one to the next, s.
    rows: Option<(NonZeroU32, f64)>,
}

impl Modulation {
    /// The whole surface by one waveform.
    #[must_use]
    pub fn of(waveform: impl Into<Arc<Waveform>>) -> Self {
        Self { waveform: waveform.into(), rows: None }
    }

    /// A panel of so many rows, even bands of the texture coordinate v from 1 down to 0 (and again beyond), each later than the one
    /// above by an even part of the period; `None` where the waveform does not recur.
    #[must_use]
    pub fn in_rows(waveform: impl Into<Arc<Waveform>>, rows: NonZeroU32) -> Option<Self> {
        let waveform = waveform.into();
        let step_s = waveform.period_s()? / f64::from(rows.get());
        Some(Self { waveform, rows: Some((rows, step_s)) })
    }

    /// The same later by `delay_s`, which is finite.
    #[must_use]
    pub fn later(self, delay_s: f64) -> Self {
        Self { waveform: Arc::new(self.waveform.as_ref().clone().later(delay_s)), ..self }
    }

    /// Mean level over a time at texture coordinates.
    pub(crate) fn mean(&self, uv: Vec2, interval: TimeInterval) -> f32 {
        let over = match self.rows {
            None => interval,
            Some((rows, step_s)) => interval.later(-step_s * f64::from(row(uv.y, rows))),
        };
        self.waveform.mean(over) as f32
    }

    /// What it counts in the choice among lights, a panel in the mean over its rows.
    pub(crate) fn choice_level(&self, interval: TimeInterval) -> f64 {
        let Some((rows, step_s)) = self.rows else { return choice_level(&self.waveform, interval) };
        let of = |row: u32| choice_level(&self.waveform, interval.later(-step_s * f64::from(row)));
        (0..rows.get()).map(of).sum::<f64>() / f64::from(rows.get())
    }

    /// The greatest level at any time.
    #[must_use]
    pub fn greatest_level(&self) -> f64 {
        self.waveform.greatest_level()
    }

    /// The waveform, of a panel that of its topmost row.
    #[must_use]
    pub fn waveform(&self) -> &Waveform {
        &self.waveform
    }

    /// Rows that take turns; `None` where the whole surface has one waveform.
    #[must_use]
    pub fn rows(&self) -> Option<NonZeroU32> {
        self.rows.map(|(rows, _)| rows)
    }
}

/// The row of a texture coordinate, from the top.
fn row(v: f32, rows: NonZeroU32) -> u32 {
    let below_top = 1.0 - v;
    let part = below_top - below_top.floor();
    ((part * rows.get() as f32) as u32).min(rows.get() - 1)
}
