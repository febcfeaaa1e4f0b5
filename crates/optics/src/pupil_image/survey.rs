//! Where a picture looks, in samples: what decides the geometry of a stored image.

use super::aim::Aim;
use super::view::Face;
use crate::lens::Lens;
use crate::wavelength::PRINCIPAL_NM;
use core::f64::consts::PI;
use etendue_core::WavelengthRange;
use etendue_core::maths::f64::atan2;
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

/// Samples along a side of the picture, at least; its border is looked at pixel by pixel.
const SAMPLES: usize = 256;
/// Wavelengths at which a lens is asked whose chief rays depend on them.
const WAVELENGTHS: usize = 5;

/// A sample of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look {
    pub(super) direction: DVec3,
    /// Directions half a pixel to the left, right, above, below, where all are.
    around: Option<[DVec3; 4]>,
}

impl Look {
    /// Sides of the pixel about the sample on the plane at unit distance of a face: across columns and across rows.
    pub(super) fn sides_tan(&self, face: Face) -> Option<[f64; 2]> {
        let [left, right, above, below] = self.around?;
        let length = |a: DVec3, b: DVec3| Some(face.tangent(a)?.distance(face.tangent(b)?));
        Some([length(left, right)?, length(above, below)?])
    }
}

/// Samples of a picture.
#[derive(Clone, Debug)]
pub(super) struct Survey {
    pub(super) looks: Vec<Look>,
    /// Pixels between samples inside the picture.
    pub(super) step_px: usize,
    /// Whether some samples look nowhere.
    pub(super) dark: bool,
}

impl Survey {
    /// Of a lens and a raster, at the wavelengths of a range where they matter.
    pub(super) fn new(lens: &Lens, raster: &Raster, range: WavelengthRange) -> Self {
        let step_px = raster.width().max(raster.height()).div_ceil(SAMPLES);
        let mut survey = Self { looks: Vec::new(), step_px, dark: false };
        for nm in wavelengths(lens, range) {
            let aim = Aim::new(lens, raster.max_radius_mm() * REACH, nm);
            points(raster, step_px).for_each(|px| survey.add(&aim, raster, px));
        }
        survey
    }

    fn add(&mut self, aim: &Aim<'_>, raster: &Raster, px: DVec2) {
        let at = |x: f64, y: f64| aim.direction(raster.sensor_mm(px + DVec2::new(x, y)));
        let Some(direction) = at(0.0, 0.0) else {
            self.dark = true;
            return;
        };
        let around = [at(-0.5, 0.0), at(0.5, 0.0), at(0.0, -0.5), at(0.0, 0.5)];
        let around = if let [Some(a), Some(b), Some(c), Some(d)] = around { Some([a, b, c, d]) } else { None };
        self.looks.push(Look { direction, around });
    }

    /// The greatest angle from the axis, rad.
    pub(super) fn widest_rad(&self) -> f64 {
        let angle = |look: &Look| atan2(look.direction.truncate().length(), look.direction.z);
        self.looks.iter().map(angle).fold(0.0, f64::max).min(PI)
    }
}

/// Tables reach a little beyond the picture.
pub(super) const REACH: f64 = 1.02;

/// The wavelengths whose chief rays differ.
fn wavelengths(lens: &Lens, range: WavelengthRange) -> Vec<f64> {
    if !lens.spreads_colours() {
        return vec![PRINCIPAL_NM];
    }
    (0..WAVELENGTHS).map(|i| range.low_nm + range.width_nm() * i as f64 / (WAVELENGTHS - 1) as f64).collect()
}

/// Pixel corners: a lattice inside the picture, all along its border.
fn points(raster: &Raster, step_px: usize) -> impl Iterator<Item = DVec2> {
    let (w, h) = (raster.width(), raster.height());
    let row = move |y: usize| {
        let step = if y == 0 || y == h { 1 } else { step_px };
        (0..w).step_by(step).chain([w]).map(move |x| (x, y))
    };
    let inside = (0..h).step_by(step_px).chain([h]).flat_map(row);
    let sides = (0..=h).filter(move |y| y % step_px != 0 && *y != h).flat_map(move |y| [(0, y), (w, y)]);
    inside.chain(sides).map(|(x, y)| DVec2::new(x as f64, y as f64))
}
