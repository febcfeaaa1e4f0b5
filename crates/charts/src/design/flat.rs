//! Even fields: a white sheet in even light (ISO 17957, EMVA 1288), and a panel that shines by itself in the dark, the paper's
//! retro-lighting chart. Vignetting, shading, tone curve, photon transfer.

use super::{BLEED, share};
use crate::drawing::{Drawing, Patch};
use crate::error::ChartError;
use crate::ink::{Ink, Paint};
use crate::panel::Panel;
use crate::ray_camera::Footprint;
use crate::shape::{Sheet, rectangle};

/// A white sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatField {
    /// Its reflectance.
    pub reflectance: f64,
}

/// A panel that shines by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Backlit;

impl FlatField {
    pub(super) fn draw(&self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        let reflectance = share("reflectance", self.reflectance)?;
        Ok(even(seen, Ink::grey("sheet", reflectance)))
    }
}

impl Backlit {
    pub(super) fn draw(self, seen: &Footprint, _seed: u64) -> Result<Drawing, ChartError> {
        Ok(Drawing { lit: false, ..even(seen, Ink::new("panel", Paint::Glow(1.0))) })
    }
}

fn even(seen: &Footprint, ink: Ink) -> Drawing {
    let half = seen.outer_mm * BLEED / 2.0;
    let patch = Patch { name: ink.name.clone(), panel: 0, ink: 0, outline_mm: rectangle(-half, half) };
    let sheet = Sheet::plain(2.0 * half, 0);
    let mut drawing = Drawing::printed(Panel::facing("chart", sheet, seen.distance_m), vec![ink]);
    drawing.patches.push(patch);
    // Samples of the spectrum and of the pupil leave about 0.1 % in a pixel.
    drawing.spp = 256;
    drawing
}
