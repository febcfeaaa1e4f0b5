//! Grey steps around a ring, all at the same distance from the middle, densities in equal steps (ISO 14524). Opto-electronic
//! conversion function, dynamic range.

use super::BLEED;
use crate::drawing::{Drawing, Patch};
use crate::error::ChartError;
use crate::ink::{Ink, Paint};
use crate::panel::Panel;
use crate::ray_camera::Footprint;
use crate::shape::{Cell, Figure, Fill, Lattice, Zone, disc};
use etendue_core::maths::f64::pow;
use glam::DVec2;
use serde_json::json;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Edges of a step's arc, and of the gap after it.
const ARC: usize = 20;
const GAP: usize = 5;
/// Radii of the ring over half the height that is wholly seen.
const RADII: [f64; 2] = [0.55, 0.92];
/// Density of the lightest step.
const LIGHTEST: f64 = 0.05;
/// Density of the ground, that of 18 %.
const GROUND: f64 = 0.745;

/// Grey steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OecfSteps {
    /// How many.
    pub steps: u32,
    /// Density of the darkest.
    pub density: f64,
    /// Whether the chart shines by itself, as transparencies on a light box do.
    pub backlit: bool,
}

impl OecfSteps {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(2..=60).contains(&self.steps) {
            return Err(ChartError::option("steps", self.steps, "expected 2 … 60 steps"));
        }
        if !(self.density > LIGHTEST && self.density <= 6.0) {
            return Err(ChartError::option(
                "density",
                self.density,
                format!("expected a density above {LIGHTEST} and up to 6"),
            ));
        }
        let steps = self.steps as usize;
        let corners = steps * (ARC + GAP);
        let half = seen.inner_mm.min_element() / 2.0;
        // The first step begins at the top and the others follow clockwise.
        let start = -FRAC_PI_2 - TAU * ARC as f64 / (2 * corners) as f64;
        let [within, around] = RADII.map(|share| disc(DVec2::ZERO, share * half, corners, start));
        let step_of = |i: usize| if i % (ARC + GAP) < ARC { 1 + i / (ARC + GAP) } else { 0 };
        let fills = (0..corners).map(|i| Fill::Ink(step_of(i))).collect();
        let patch = |step: usize| {
            let arc = || step * (ARC + GAP)..=step * (ARC + GAP) + ARC;
            let outer = arc().map(|i| around[i % corners]);
            let outline_mm = outer.chain(arc().rev().map(|i| within[i % corners])).collect();
            Patch { name: format!("step-{:02}", step + 1), panel: 0, ink: step + 1, outline_mm }
        };
        let patches = (0..steps).map(patch).collect();
        let figure = Figure {
            centre: DVec2::ZERO,
            zones: vec![Zone::even(within.clone(), 0), Zone { outline: around.clone(), fills }],
        };
        let lattice = Lattice::framed(1, 1, DVec2::splat(2.0 * half), seen.outer_mm * BLEED);
        let sheet = lattice.sheet(|column, row| match lattice.is_inside(column, row) {
            true => Cell::Figure(figure.clone(), Fill::Ink(0)),
            false => Cell::Plain(Fill::Ink(0)),
        });
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), self.inks());
        drawing.lit = !self.backlit;
        drawing.patches = patches;
        drawing.note("steps", self.steps);
        drawing.note("densities", json!(self.densities()));
        drawing.note("radii_mm", json!(RADII.map(|share| share * half)));
        Ok(drawing)
    }

    fn densities(&self) -> Vec<f64> {
        let step = (self.density - LIGHTEST) / f64::from(self.steps - 1);
        (0..self.steps).map(|i| LIGHTEST + step * f64::from(i)).collect()
    }

    fn inks(&self) -> Vec<Ink> {
        let paint = |density: f64| {
            let share = pow(10.0, -density);
            if self.backlit { Paint::Glow(share) } else { Paint::Grey(share) }
        };
        let steps = self.densities().into_iter().enumerate();
        let steps = steps.map(|(i, density)| Ink::new(format!("step-{:02}", i + 1), paint(density)));
        std::iter::once(Ink::new("ground", paint(GROUND))).chain(steps).collect()
    }
}
