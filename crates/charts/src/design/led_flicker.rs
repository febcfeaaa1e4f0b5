//! Pulsed lamps in the dark: columns of frequencies, rows of duty cycles, equally bright while on, each with its own phase (LED
//! flicker; IEEE P2020).

use etendue_core::random::number_of_name;
use serde_json::json;

use super::patches::{FIELD_FRACTION, SIDE, rows};
use super::{GridSize, option::BLACK};
use crate::ink::{Ink, Paint};
use crate::{drawing::Drawing, error::ChartError, light::Panel, ray_camera::Footprint};

/// Pulsed lamps.
#[derive(Clone, Debug, PartialEq)]
pub struct LedFlicker {
    /// Frequencies of the columns, Hz.
    pub frequencies_hz: Vec<f64>,
    /// Duty cycles of the rows.
    pub duty_cycles: Vec<f64>,
}

/// Maximum columns or rows.
const MAX_GRID: usize = 32;

impl LedFlicker {
    pub(super) fn draw(&self, footprint: &Footprint, seed: u64) -> Result<Drawing, ChartError> {
        let Self { frequencies_hz, duty_cycles } = self;
        check("frequencies_hz", frequencies_hz, "1 … 32 frequencies above 0 and up to 1000000 Hz", |f| {
            f > 0.0 && f <= 1e6
        })?;
        check("duty_cycles", duty_cycles, "1 … 32 fractions, 0.001 … 0.999", |d| (0.001..=0.999).contains(&d))?;
        let (columns, lines) = (frequencies_hz.len(), duty_cycles.len());
        let size = GridSize { columns: Some(columns as u32), rows: Some(lines as u32), pitch_mm: None };
        let grid = size.fit_into(footprint.inner_mm * FIELD_FRACTION, columns as u32, 1)?;
        let lamps: Vec<(String, f64, f64, f64)> = duty_cycles
            .iter()
            .flat_map(|duty| frequencies_hz.iter().map(move |frequency_hz| (*frequency_hz, *duty)))
            .enumerate()
            .map(|(i, (frequency_hz, duty))| {
                let name = format!("led-{:03}", i + 1);
                let delay_s = number_of_name(&format!("{name} of seed {seed}")) / frequency_hz;
                (name, frequency_hz, duty, delay_s)
            })
            .collect();
        let paint = |(name, frequency_hz, duty, delay_s): &(String, f64, f64, f64)| {
            // While on, each is as bright as the light: its mean is the duty cycle.
            let pulses = Paint::Pulses { fraction: *duty, frequency_hz: *frequency_hz, duty: *duty, delay_s: *delay_s };
            Ink::new(name.clone(), pulses)
        };
        let inks: Vec<Ink> = std::iter::once(Ink::grey("frame", BLACK)).chain(lamps.iter().map(paint)).collect();
        let (sheet, patches) = rows(columns, lines, grid.pitch_mm, footprint, &inks);
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        drawing.is_illuminated = false;
        drawing.patches = patches;
        let lamp = |(name, frequency_hz, duty, delay_s): &(String, f64, f64, f64)| json!({ "name": name, "frequency_hz": frequency_hz, "duty_cycle": duty, "first_pulse_s": delay_s });
        drawing.note("lamps", lamps.iter().map(lamp).collect::<Vec<_>>());
        drawing.note("side_mm", SIDE * grid.pitch_mm);
        drawing.note("pitch_mm", grid.pitch_mm);
        Ok(drawing)
    }
}

fn check(
    option: &'static str,
    values: &[f64],
    expected: &str,
    is_valid: impl Fn(f64) -> bool,
) -> Result<(), ChartError> {
    if !(1..=MAX_GRID).contains(&values.len()) {
        return Err(ChartError::option(option, format!("{} numbers", values.len()), format!("expected {expected}")));
    }
    match values.iter().find(|value| !is_valid(**value)) {
        Some(value) => Err(ChartError::option(option, value, format!("expected {expected}"))),
        None => Ok(()),
    }
}
