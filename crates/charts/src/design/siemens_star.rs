//! Siemens star: luminance as a function of the angle about a centre, by a cosine (ISO 12233, s-SFR) or in black and white.
//! Measures modulation over spatial frequency: c cycles have the frequency c / 2πr at the radius r.
//!
//! The cosine is a staircase of sectors: R(φ) = R₀ (1 + m v(φ)), v = cos at the middle of each of n steps per cycle, divided by
//! sin(π/n)/(π/n), so that its fundamental is the cosine itself; the remainder are the harmonics n ± 1 and their multiples.

use std::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{cos, sin};
use glam::DVec2;
use serde_json::json;

use super::BLEED;
use crate::drawing::{Drawing, Feature, FeatureKind, Patch};
use crate::shape::{CellContent, Fill, Lattice, Zone, ZoneFigure, disc};
use crate::{error::ChartError, ink::Ink, light::Panel, ray_camera::Footprint};

/// Steps per cycle.
const STEPS: usize = 24;
/// Diameter relative to the fully visible height.
const REACH: f64 = 0.92;
/// Inner radius relative to the outer.
const INNER: f64 = 0.05;
/// Mean reflectance, and relative amplitude of the cosine.
const MEAN: f64 = 0.4;
const MODULATION: f64 = 0.8;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SiemensStar {
    /// Cycles around.
    pub cycles: u32,
    /// True for black and white instead of a cosine.
    pub binary: bool,
}

impl SiemensStar {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(4..=360).contains(&self.cycles) {
            return Err(ChartError::option("cycles", self.cycles, "expected 4 … 360 cycles"));
        }
        let outer = REACH * footprint.inner_mm.min_element() / 2.0;
        let corners = STEPS * self.cycles as usize;
        // The first maximum is to the right, in the middle of its half cycle.
        let start = -TAU / (4.0 * f64::from(self.cycles));
        let [within, around] = [INNER * outer, outer].map(|radius| disc(DVec2::ZERO, radius, corners, start));
        let patch = |name: &str, outline: &Vec<DVec2>| Patch {
            name: name.to_owned(),
            panel: 0,
            ink: 0,
            outline_mm: outline.iter().step_by(corners / 64).copied().collect(),
        };
        let patches = vec![patch("centre", &within)];
        let edge_points = around.iter().step_by(corners / 64).copied().collect();
        let zones = vec![Zone::even(within, 0), Zone { outline: around, fills: self.fills(corners) }];
        let lattice = Lattice::framed(1, 1, DVec2::splat(2.04 * outer), footprint.outer_mm * BLEED);
        let figure = ZoneFigure { centre: DVec2::ZERO, zones };
        let sheet = lattice.sheet(|column, row| match lattice.is_inside(column, row) {
            true => CellContent::Figure(figure.clone(), Fill::Ink(0)),
            false => CellContent::Plain(Fill::Ink(0)),
        });
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), self.inks());
        drawing.features.push(Feature::at(FeatureKind::Centre, [0, 0], DVec2::ZERO));
        drawing
            .features
            .push(Feature { points_mm: edge_points, ..Feature::at(FeatureKind::Outline, [0, 0], DVec2::ZERO) });
        drawing.patches = patches;
        drawing.note("cycles", self.cycles);
        drawing.note("binary", self.binary);
        drawing.note("radii_mm", json!([INNER * outer, outer]));
        drawing.note("mean_reflectance", MEAN);
        drawing.note("modulation_of_the_fundamental", if self.binary { MODULATION * 4.0 / PI } else { MODULATION });
        drawing.note("crest_at_deg", 0.0);
        drawing.spp = 256;
        Ok(drawing)
    }

    /// The ground, then the levels of half a cycle from minimum to maximum; or dark and light.
    fn inks(&self) -> Vec<Ink> {
        let level = |(i, v): (usize, f64)| Ink::grey(format!("level-{:02}", i + 1), MEAN * (1.0 + MODULATION * v));
        let levels = if self.binary { vec![-1.0, 1.0] } else { staircase() };
        std::iter::once(Ink::grey("mean", MEAN)).chain(levels.into_iter().enumerate().map(level)).collect()
    }

    /// The ink of each sector, the first at the rise before the first maximum.
    fn fills(&self, corners: usize) -> Vec<Fill> {
        let half = STEPS / 2;
        let level = |i: usize| {
            // Steps from the minimum: a quarter of a cycle before the start.
            let step = (i + half / 2) % STEPS;
            let steps_from_trough = if step < half { step } else { STEPS - 1 - step };
            1 + if self.binary { usize::from(steps_from_trough >= half / 2) } else { steps_from_trough }
        };
        (0..corners).map(|i| Fill::Ink(level(i))).collect()
    }
}

/// The levels of half a cycle, −1 … 1, from minimum to maximum.
fn staircase() -> Vec<f64> {
    let step = TAU / STEPS as f64;
    let smoothed = sin(step / 2.0) / (step / 2.0);
    (0..STEPS / 2).map(|i| -cos(step * (i as f64 + 0.5)) / smoothed).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fourier coefficient of harmonic `k` over a cycle of the star's levels.
    fn harmonic(star: SiemensStar, k: usize) -> (f64, f64) {
        let inks = star.inks();
        let fraction = |fill: &Fill| match fill {
            Fill::Ink(i) => match inks[*i].paint {
                crate::Paint::Grey(r) => r / MEAN - 1.0,
                _ => f64::NAN,
            },
            Fill::Hole => f64::NAN,
        };
        let levels: Vec<f64> = star.fills(STEPS).iter().map(fraction).collect();
        let edge = |i: usize| (i as f64 / STEPS as f64 - 0.25) * TAU * k as f64;
        let part = |f: fn(f64) -> f64, sign: f64| -> f64 {
            let piece = |i: usize| levels[i] * sign * (f(edge(i + 1)) - f(edge(i)));
            (0..STEPS).map(piece).sum::<f64>() / (PI * k as f64)
        };
        (part(sin, 1.0), part(cos, -1.0))
    }

    #[test]
    fn the_staircase_has_the_cosine_s_fundamental() {
        let star = SiemensStar { cycles: 72, binary: false };
        let (along, across) = harmonic(star, 1);
        assert!((along - MODULATION).abs() < 1e-12 && across.abs() < 1e-12, "{along} {across}");
        assert!((2..=20).all(|k| harmonic(star, k).0.abs() < 1e-12));
        let (binary, _) = harmonic(SiemensStar { cycles: 72, binary: true }, 1);
        assert!((binary - MODULATION * 4.0 / PI).abs() < 1e-12, "{binary}");
    }
}
