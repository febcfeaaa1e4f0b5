//! Patches in rows and columns: the ColorChecker with its measured spectra, and grey patches that shine by themselves over
//! several decades, for contrast detection probability (CDP; IEEE P2020).

use super::{BLEED, GridSize};
use crate::drawing::{Drawing, Patch};
use crate::error::ChartError;
use crate::ink::{Ink, Paint};
use crate::panel::Panel;
use crate::ray_camera::Footprint;
use crate::shape::{Cell, Fill, Lattice, Sheet};
use etendue_core::maths::f64::pow;
use etendue_spectra::reflectance::colorchecker;
use glam::DVec2;

/// How much of what is wholly seen the patches take.
pub(super) const ROOM: f64 = 0.92;
/// Side of a patch over the distance between middles.
pub(super) const SIDE: f64 = 0.86;
/// Reflectance of the frame between colours.
const FRAME: f64 = 0.04;

/// The ColorChecker: 24 patches by the mean of measured spectra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColorChecker;

/// Shining grey patches, luminances in equal ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContrastPatches {
    /// How many. Default: 6 columns.
    pub size: GridSize,
    /// Decades from the brightest to the darkest.
    pub decades: f64,
}

impl ColorChecker {
    pub(super) fn draw(self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let size = GridSize { columns: Some(6), rows: Some(4), pitch_mm: None };
        let grid = size.in_room(seen.inner_mm * ROOM, 6, 1)?;
        let name = |name: &str| {
            let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
            let text: String = name.chars().map(plain).collect();
            text.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
        };
        let patches = colorchecker().iter();
        let patches = patches.map(|patch| Ink::new(name(patch.name), Paint::Spectral(patch.reflectance.clone())));
        let inks: Vec<Ink> = std::iter::once(Ink::grey("frame", FRAME)).chain(patches).collect();
        let (sheet, patches) = rows(6, 4, grid.pitch_mm, seen, &inks);
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), inks);
        drawing.patches = patches;
        drawing.note("side_mm", SIDE * grid.pitch_mm);
        drawing.note("pitch_mm", grid.pitch_mm);
        Ok(drawing)
    }
}

impl ContrastPatches {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(self.decades > 0.0 && self.decades <= 8.0) {
            return Err(ChartError::option("decades", self.decades, "expected a number above 0 and up to 8"));
        }
        let grid = self.size.in_room(seen.inner_mm * ROOM, 6, 1)?;
        let count = grid.columns * grid.rows;
        let last = count.saturating_sub(1).max(1) as f64;
        let glow = |i: usize| Paint::Glow(pow(10.0, -self.decades * i as f64 / last));
        let patches = (0..count).map(|i| Ink::new(format!("patch-{:03}", i + 1), glow(i)));
        let frame = Ink::new("frame", Paint::Glow(pow(10.0, -self.decades / 2.0)));
        let inks: Vec<Ink> = std::iter::once(frame).chain(patches).collect();
        let (sheet, patches) = rows(grid.columns, grid.rows, grid.pitch_mm, seen, &inks);
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), inks);
        drawing.lit = false;
        drawing.patches = patches;
        drawing.note("patches", vec![grid.columns, grid.rows]);
        drawing.note("side_mm", SIDE * grid.pitch_mm);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("decades", self.decades);
        Ok(drawing)
    }
}

/// Patches row by row from the top left, the inks from the second on, on a ground of the first.
pub(super) fn rows(columns: usize, rows: usize, pitch_mm: f64, seen: &Footprint, inks: &[Ink]) -> (Sheet, Vec<Patch>) {
    let lines = |count: usize, edge: f64| -> Vec<f64> {
        let first = -pitch_mm * (count as f64 - 1.0) / 2.0;
        let sides = (0..count).flat_map(|i| [-0.5, 0.5].map(|s| first + pitch_mm * (i as f64 + s * SIDE)));
        let edge = edge.max(-first + 0.55 * pitch_mm);
        [-edge].into_iter().chain(sides).chain([edge]).collect()
    };
    let half = seen.outer_mm * BLEED / 2.0;
    let lattice = Lattice::new(lines(columns, half.x), lines(rows, half.y));
    let mut patches = Vec::new();
    let sheet = lattice.sheet(|column, row| {
        let is_patch = column % 2 == 1 && row % 2 == 1;
        let ink = if is_patch { 1 + (row / 2) * columns + column / 2 } else { 0 };
        if is_patch {
            let outline_mm: Vec<DVec2> = lattice.cell(column, row);
            patches.push(Patch { name: inks[ink].name.clone(), panel: 0, ink, outline_mm });
        }
        Cell::Plain(Fill::Ink(ink))
    });
    (sheet, patches)
}
