//! What lets light through: solids, panes, leaves.

use super::factor::{Factor, any_factor};
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::Values;
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{Number, keyed, number, record};
use crate::record::curve::{Curve, curve};
use crate::record::reflectance::{Colour, Reflectance, any_colour, any_reflectance};

record! {
    /// A solid of glass, water or plastic.
    pub struct Dielectric check(check_dielectric) {
        /// Refractive index against air, 1 … 4; the same at all wavelengths.
        required index: Placed<f64> = any_index();
        /// Roughness α of the surface's GGX distribution (not its square root), 0 … 1; below 0.0001 it is clear. Default: 0.
        optional alpha: Factor = any_factor();
        /// What it absorbs inside. Default: nothing.
        group absorption: Absorption;
        /// With "internal_transmittance": the way through the substance for which it is stated, mm, above 0.
        optional thickness_mm: Placed<f64> = number("mm").above(0.0);
    }
}

impl NamesFiles for Dielectric {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, index: _, alpha: _, absorption, thickness_mm: _ } = self;
        absorption.name_files(files);
    }
}

record! {
    /// A pane.
    pub struct ThinSheet check(check_sheet) {
        /// Refractive index against air, 1 … 4; the same at all wavelengths. Default: 1.5.
        optional index: Placed<f64> = any_index();
        /// What it absorbs inside. Default: nothing.
        group absorption: Absorption;
        /// With "absorption_per_m": how thick the pane is, mm, above 0.
        optional thickness_mm: Placed<f64> = number("mm").above(0.0);
    }
}

impl NamesFiles for ThinSheet {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, index: _, absorption, thickness_mm: _ } = self;
        absorption.name_files(files);
    }
}

keyed! {
    /// What a clear substance absorbs.
    pub enum Absorption {
        /// Coefficient of absorption (natural logarithm), 1/m, 0 or more: a number, or `{ spectrum = file }`.
        absorption_per_m => Coefficient(Curve) = curve(number("1/m").at_least(0.0));
        /// Share of light that comes through the substance itself, without what its surfaces reflect, above 0 and at most 1:
        /// a number, `[r, g, b]` (linear sRGB), `{ srgb = … }` or `{ spectrum = file }`. Of a solid it is stated for
        /// "thickness_mm", of a thin sheet it is that of the sheet.
        internal_transmittance => Transmittance(Colour) = any_colour();
    }
}

impl NamesFiles for Absorption {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Coefficient(curve) => curve.name_file(Values::Light, files),
            Self::Transmittance(share) => share.name_files(files),
        }
    }
}

record! {
    /// A leaf.
    pub struct Leaf {
        /// Share of light reflected, as for "diffuse". Together with "transmittance" at most 1 at every wavelength.
        required reflectance: Reflectance = any_reflectance();
        /// Share of light let through, as for "diffuse".
        required transmittance: Reflectance = any_reflectance();
    }
}

impl NamesFiles for Leaf {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, reflectance, transmittance } = self;
        reflectance.name_files(files);
        transmittance.name_files(files);
    }
}

/// From a substance that nobody sees to germanium; the tracer's `DIELECTRIC_INDICES`.
fn any_index() -> Number {
    number("").at_least(1.0).at_most(4.0)
}

fn check_dielectric(glass: &Dielectric, faults: &mut Faults) {
    match (&glass.absorption, &glass.thickness_mm) {
        (Some(Absorption::Transmittance(t)), None) => faults.add(
            ErrorCode::MissingKey,
            t.place(),
            "\"internal_transmittance\" of a solid does not say for which way through it",
            "add \"thickness_mm\"",
        ),
        (Some(Absorption::Coefficient(_)) | None, Some(thickness)) => faults.add(
            ErrorCode::NoEffect,
            &thickness.place,
            "\"thickness_mm\" has no effect here, the mesh says how thick the solid is",
            "remove it; it belongs to \"internal_transmittance\"",
        ),
        _ => {}
    }
}

fn check_sheet(sheet: &ThinSheet, faults: &mut Faults) {
    match (&sheet.absorption, &sheet.thickness_mm) {
        (Some(Absorption::Coefficient(_)), None) => faults.add(
            ErrorCode::MissingKey,
            &sheet.place,
            "\"absorption_per_m\" of a thin sheet needs its thickness",
            "add \"thickness_mm\", or state \"internal_transmittance\"",
        ),
        (Some(Absorption::Transmittance(_)) | None, Some(thickness)) => {
            let problem = "\"thickness_mm\" has no effect here, it belongs to \"absorption_per_m\"";
            faults.add(ErrorCode::NoEffect, &thickness.place, problem, "remove it");
        }
        _ => {}
    }
}
