//! Transmitting surfaces: solids, panes, leaves.

use super::factor::{Factor, any_factor};
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::SpectrumValues;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{NumberRule, keyed, number, record};
use crate::record::curve::{Curve, curve};
use crate::record::reflectance::{Colour, Reflectance, any_colour, any_reflectance};

record! {
    /// A solid of glass, water or plastic.
    pub struct Dielectric check(check_dielectric) {
        /// Refractive index, equal at all wavelengths.
        required index: Placed<f64> = any_index();
        /// GGX roughness α; clear below 0.0001. Default: 0.
        optional alpha: Factor = any_factor();
        /// Absorption in the volume. Default: none.
        group absorption: Absorption;
        /// With "internal_transmittance": its path length.
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
        /// Refractive index, equal at all wavelengths. Default: 1.5.
        optional index: Placed<f64> = any_index();
        /// Absorption in the volume. Default: none.
        group absorption: Absorption;
        /// With "absorption_per_m": thickness of the pane.
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
    /// Absorption of a clear substance.
    pub enum Absorption {
        /// Absorption coefficient (natural logarithm).
        absorption_per_m => Coefficient(Curve) = curve(number("1/m").at_least(0.0));
        /// Transmittance without surface reflections, of "thickness_mm" (solid) or of the sheet; lists are linear sRGB.
        internal_transmittance => Transmittance(Colour) = any_colour();
    }
}

impl NamesFiles for Absorption {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Coefficient(curve) => curve.name_file(SpectrumValues::Light, files),
            Self::Transmittance(transmittance) => transmittance.name_files(files),
        }
    }
}

record! {
    /// A leaf.
    pub struct Leaf {
        /// Reflectance; with "transmittance" at most 1 at every wavelength.
        required reflectance: Reflectance = any_reflectance();
        /// Transmittance.
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

/// Indices from a nearly invisible substance to germanium; the tracer's `DIELECTRIC_INDICES`.
fn any_index() -> NumberRule {
    number("").at_least(1.0).at_most(4.0)
}

fn check_dielectric(glass: &Dielectric, errors: &mut DescriptionErrors) {
    match (&glass.absorption, &glass.thickness_mm) {
        (Some(Absorption::Transmittance(t)), None) => errors.add(
            ErrorCode::MissingKey,
            t.place(),
            "\"internal_transmittance\" of a solid does not state its path length",
            "add \"thickness_mm\"",
        ),
        (Some(Absorption::Coefficient(_)) | None, Some(thickness)) => errors.add(
            ErrorCode::NoEffect,
            &thickness.place,
            "\"thickness_mm\" has no effect here, the mesh determines the thickness of the solid",
            "remove it; it belongs to \"internal_transmittance\"",
        ),
        _ => {}
    }
}

fn check_sheet(sheet: &ThinSheet, errors: &mut DescriptionErrors) {
    match (&sheet.absorption, &sheet.thickness_mm) {
        (Some(Absorption::Coefficient(_)), None) => errors.add(
            ErrorCode::MissingKey,
            &sheet.place,
            "\"absorption_per_m\" of a thin sheet needs its thickness",
            "add \"thickness_mm\", or state \"internal_transmittance\"",
        ),
        (Some(Absorption::Transmittance(_)) | None, Some(thickness)) => {
            let problem = "\"thickness_mm\" has no effect here, it belongs to \"absorption_per_m\"";
            errors.add(ErrorCode::NoEffect, &thickness.place, problem, "remove it");
        }
        _ => {}
    }
}
