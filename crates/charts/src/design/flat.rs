//! Flat fields: a white sheet in uniform light (ISO 17957, EMVA 1288), and a self-luminous panel in the dark, the paper's
//! retro-lighting chart. Measures vignetting, shading, tone curve, photon transfer.
//!
//! Flare: a white field with light traps, holes with a deep black box behind (ISO 18844). Measures veiling glare.
//!
//! A trap is not perfectly black. With reflectance R inside, opening radius r and depth h, its bottom has about R r²/(r² + h²) of
//! the field's luminance; its walls have more towards the opening.

use glam::DVec2;

use super::{BLEED, GridSize, WHITE, reflectance_option};
use crate::drawing::{Cavity, Drawing, Patch};
use crate::ink::{Ink, Paint};
use crate::shape::{CellContent, Fill, Lattice, Sheet, Zone, ZoneFigure, disc, rectangle};
use crate::{error::ChartError, light::Panel, ray_camera::Footprint};

/// A white sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatField {
    pub reflectance: f64,
}

/// A self-luminous panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Backlit;

impl FlatField {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let reflectance = reflectance_option("reflectance", self.reflectance)?;
        Ok(uniform_sheet(footprint, Ink::grey("sheet", reflectance)))
    }
}

impl Backlit {
    pub(super) fn draw(self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        Ok(Drawing { is_illuminated: false, ..uniform_sheet(footprint, Ink::new("panel", Paint::Luminous(1.0))) })
    }
}

fn uniform_sheet(footprint: &Footprint, ink: Ink) -> Drawing {
    let half = footprint.outer_mm * BLEED / 2.0;
    let patch = Patch { name: ink.name.clone(), panel: 0, ink: 0, outline_mm: rectangle(-half, half) };
    let sheet = Sheet::plain(2.0 * half, 0);
    let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), vec![ink]);
    drawing.patches.push(patch);
    // Sampling of the spectrum and of the pupil leaves about 0.1 % in a pixel.
    drawing.spp = 256;
    drawing
}

/// Corners of a hole.
const CORNERS: usize = 64;
/// Depth of a trap relative to the diameter of its opening.
const TRAP_DEPTH: f64 = 3.0;
/// Reflectance inside a trap.
const TRAP_REFLECTANCE: f64 = 0.01;

/// A white field with light traps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flare {
    /// Number and spacing of the traps. Default: 5 columns over the fully visible width.
    pub size: GridSize,
    /// Diameter of an opening relative to the distance between centres.
    pub trap_ratio: f64,
}

impl Flare {
    pub(super) fn draw(&self, footprint: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        if !(0.02..=0.8).contains(&self.trap_ratio) {
            return Err(ChartError::option("trap_ratio", self.trap_ratio, "expected 0.02 … 0.8"));
        }
        let grid = self.size.fit_into(footprint.inner_mm, 5, 1)?;
        let radius = self.trap_ratio * grid.pitch_mm / 2.0;
        let depth_mm = 2.0 * TRAP_DEPTH * radius;
        let pitch = DVec2::splat(grid.pitch_mm);
        let lattice = Lattice::framed(grid.columns, grid.rows, pitch, footprint.outer_mm * BLEED);
        let (mut patches, mut cavities) = (Vec::new(), Vec::new());
        let sheet = lattice.sheet(|column, row| {
            if !lattice.is_inside(column, row) {
                return CellContent::Plain(Fill::Ink(0));
            }
            let centre = lattice.middle(column, row);
            let opening_mm = disc(centre, radius, CORNERS, std::f64::consts::FRAC_PI_4);
            let name = format!("trap-{}-{}", column - 1, row - 1);
            patches.push(Patch { name, panel: 0, ink: 1, outline_mm: opening_mm.clone() });
            cavities.push(Cavity { panel: 0, opening_mm: opening_mm.clone(), depth_mm, ink: 1 });
            let hole = Zone { outline: opening_mm, fills: vec![Fill::Hole] };
            CellContent::Figure(ZoneFigure { centre, zones: vec![hole] }, Fill::Ink(0))
        });
        let inks = vec![Ink::grey("white", WHITE), Ink::grey("trap-inside", TRAP_REFLECTANCE)];
        let mut drawing = Drawing::printed(Panel::facing("chart", sheet, footprint.distance_m), inks);
        (drawing.patches, drawing.cavities) = (patches, cavities);
        drawing.note("traps", vec![grid.columns, grid.rows]);
        drawing.note("pitch_mm", grid.pitch_mm);
        drawing.note("opening_mm", 2.0 * radius);
        drawing.note("depth_mm", depth_mm);
        drawing.note(
            "luminance_of_a_trap_s_bottom_over_white_about",
            TRAP_REFLECTANCE / (1.0 + 4.0 * TRAP_DEPTH * TRAP_DEPTH) / WHITE,
        );
        Ok(drawing)
    }
}
