//! Patches in rows and columns: the ColorChecker with its measured spectra, and self-luminous grey patches over several decades,
//! for contrast detection probability (CDP; IEEE P2020).
//!
//! Grey steps in a ring, all at the same distance from the centre, with densities in equal steps (ISO 14524). Measures
//! opto-electronic conversion function, dynamic range.

use std::f64::consts::{FRAC_PI_2, TAU};

use etendue_core::maths::f64::pow;
use etendue_spectra::reflectance::colorchecker;
use glam::DVec2;
use serde_json::json;

use super::{BLEED, GridSize};
use crate::drawing::{Drawing, Patch};
use crate::ink::{Ink, Paint};
use crate::shape::{CellContent, Fill, Lattice, Sheet, Zone, ZoneFigure, disc};
use crate::{error::ChartError, light::Panel, ray_camera::Footprint};

/// Size of the patches' field relative to the fully visible rectangle.
pub(super) const FIELD_FRACTION: f64 = 0.92;
/// Side of a patch relative to the distance between centres.
pub(super) const SIDE: f64 = 0.86;
/// Reflectance of the frame between colours.
const FRAME: f64 = 0.04;

/// The ColorChecker: 24 patches with the mean of measured spectra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColorChecker;

/// Self-luminous grey patches, luminances in equal ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContrastPatches {
    /// Number. Default: 6 columns.
    pub size: GridSize,
    /// Decades from the brightest to the darkest.
    pub decades: f64,
}

impl ColorChecker {
    pub(super) fn draw(self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let size = GridSize { columns: Some(6), rows: Some(4), pitch_mm: None };
        let grid = size.fit_into(footprint.inner_mm * FIELD_FRACTION, 6, 1)?;
        let name = |name: &str| {
            let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
            let text: String = name.chars().map(plain).collect();
            text.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
        };
        let patches = colorchecker().iter();
        let patches = patches.map(|patch| Ink::new(name(patch.name), Paint::Spectral(patch.reflectance.clone())));
        let inks: Vec<Ink> = std::iter::once(Ink::grey("frame", FRAME)).chain(patches).collect();
        let (sheet, patches) = rows(6, 4, grid.pitch_mm, footprint, &inks);
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        drawing.patches = patches;
        drawing.note("side_mm", SIDE * grid.pitch_mm);
        drawing.note("pitch_mm", grid.pitch_mm);
        Ok(drawing)
    }
}

impl ContrastPatches {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(self.decades > 0.0 && self.decades <= 8.0) {
            return Err(ChartError::option("decades", self.decades, "expected a number above 0 and up to 8"));
        }
        let grid = self.size.fit_into(footprint.inner_mm * FIELD_FRACTION, 6, 1)?;
        let count = grid.columns * grid.rows;
        let last = count.saturating_sub(1).max(1) as f64;
        let glow = |i: usize| Paint::Luminous(pow(10.0, -self.decades * i as f64 / last));
        let patches = (0..count).map(|i| Ink::new(format!("patch-{:03}", i + 1), glow(i)));
        let frame = Ink::new("frame", Paint::Luminous(pow(10.0, -self.decades / 2.0)));
        let inks: Vec<Ink> = std::iter::once(frame).chain(patches).collect();
        let (sheet, patches) = rows(grid.columns, grid.rows, grid.pitch_mm, footprint, &inks);
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        drawing.is_illuminated = false;
        drawing.patches = patches;
        drawing.note("patches", vec![grid.columns, grid.rows]);
        drawing.note("side_mm", SIDE * grid.pitch_mm);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("decades", self.decades);
        Ok(drawing)
    }
}

/// Patches row by row from the top left, with the inks from the second on, on a ground of the first.
pub(super) fn rows(
    columns: usize,
    rows: usize,
    pitch_mm: f64,
    footprint: &Footprint,
    inks: &[Ink],
) -> (Sheet, Vec<Patch>) {
    let lines = |count: usize, edge: f64| -> Vec<f64> {
        let first = -pitch_mm * (count as f64 - 1.0) / 2.0;
        let sides = (0..count).flat_map(|i| [-0.5, 0.5].map(|s| first + pitch_mm * (i as f64 + s * SIDE)));
        let edge = edge.max(-first + 0.55 * pitch_mm);
        [-edge].into_iter().chain(sides).chain([edge]).collect()
    };
    let half = footprint.outer_mm * BLEED / 2.0;
    let lattice = Lattice::new(lines(columns, half.x), lines(rows, half.y));
    let mut patches = Vec::new();
    let sheet = lattice.sheet(|column, row| {
        let is_patch = column % 2 == 1 && row % 2 == 1;
        let ink = if is_patch { 1 + (row / 2) * columns + column / 2 } else { 0 };
        if is_patch {
            let outline_mm: Vec<DVec2> = lattice.cell(column, row);
            patches.push(Patch { name: inks[ink].name.clone(), panel: 0, ink, outline_mm });
        }
        CellContent::Plain(Fill::Ink(ink))
    });
    (sheet, patches)
}

/// Edges of a step's arc, and of the gap after it.
const ARC: usize = 20;
const GAP: usize = 5;
/// Radii of the ring relative to half the fully visible height.
const RADII: [f64; 2] = [0.55, 0.92];
/// Density of the lightest step.
const LIGHTEST: f64 = 0.05;
/// Density of the ground: 18 % reflectance.
const GROUND: f64 = 0.745;

/// Grey steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OecfSteps {
    /// Number of steps.
    pub steps: u32,
    /// Density of the darkest step.
    pub density: f64,
    /// True for a self-luminous chart, such as a transparency on a light box.
    pub backlit: bool,
}

impl OecfSteps {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
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
        let half = footprint.inner_mm.min_element() / 2.0;
        // The first step begins at the top and the others follow clockwise.
        let start = -FRAC_PI_2 - TAU * ARC as f64 / (2 * corners) as f64;
        let [within, around] = RADII.map(|fraction| disc(DVec2::ZERO, fraction * half, corners, start));
        let step_of = |i: usize| if i % (ARC + GAP) < ARC { 1 + i / (ARC + GAP) } else { 0 };
        let fills = (0..corners).map(|i| Fill::Ink(step_of(i))).collect();
        let patch = |step: usize| {
            let arc = || step * (ARC + GAP)..=step * (ARC + GAP) + ARC;
            let outer = arc().map(|i| around[i % corners]);
            let outline_mm = outer.chain(arc().rev().map(|i| within[i % corners])).collect();
            Patch { name: format!("step-{:02}", step + 1), panel: 0, ink: step + 1, outline_mm }
        };
        let patches = (0..steps).map(patch).collect();
        let figure = ZoneFigure {
            centre: DVec2::ZERO,
            zones: vec![Zone::even(within.clone(), 0), Zone { outline: around.clone(), fills }],
        };
        let lattice = Lattice::framed(1, 1, DVec2::splat(2.0 * half), footprint.outer_mm * BLEED);
        let sheet = lattice.sheet(|column, row| match lattice.is_inside(column, row) {
            true => CellContent::Figure(figure.clone(), Fill::Ink(0)),
            false => CellContent::Plain(Fill::Ink(0)),
        });
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), self.inks());
        drawing.is_illuminated = !self.backlit;
        drawing.patches = patches;
        drawing.note("steps", self.steps);
        drawing.note("densities", json!(self.densities()));
        drawing.note("radii_mm", json!(RADII.map(|fraction| fraction * half)));
        Ok(drawing)
    }

    fn densities(&self) -> Vec<f64> {
        let step = (self.density - LIGHTEST) / f64::from(self.steps - 1);
        (0..self.steps).map(|i| LIGHTEST + step * f64::from(i)).collect()
    }

    fn inks(&self) -> Vec<Ink> {
        let paint = |density: f64| {
            let fraction = pow(10.0, -density);
            if self.backlit { Paint::Luminous(fraction) } else { Paint::Grey(fraction) }
        };
        let steps = self.densities().into_iter().enumerate();
        let steps = steps.map(|(i, density)| Ink::new(format!("step-{:02}", i + 1), paint(density)));
        std::iter::once(Ink::new("ground", paint(GROUND))).chain(steps).collect()
    }
}
