//! Tone curves.

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{Rule, choice, either, keyed, number, path, record, variant, words};
use std::path::PathBuf;

/// Tone curve from linear light to image values.
#[derive(Clone, Debug)]
pub enum ToneCurve {
    /// A curve without parameters.
    Named(Placed<NamedCurve>),
    /// A curve with parameters.
    Curve(Box<CurveTable>),
}

words! {
    /// A tone curve without parameters.
    pub enum NamedCurve {
        /// The curve of IEC 61966-2-1.
        "srgb" => Srgb,
        /// Output proportional to light.
        "linear" => Linear,
    }
}

keyed! {
    /// A tone curve with parameters.
    pub enum CurveKind {
        /// γ of output = light^(1/γ), above 0.
        gamma => Gamma(Placed<f64>) = number("").above(0.0);
        /// Contrast of an S-curve on top of sRGB, above 0; 1 is none, more darkens shadows and brightens highlights.
        contrast => Contrast(Placed<f64>) = number("").above(0.0);
        /// A table of two columns, linear light from 0 to 1 and output 0 … 1, with linear interpolation.
        table => Table(Placed<PathBuf>) = path(&["csv"]);
        /// A measured conversion function (OECF, ISO 14524): a table of two columns, exposure (any unit, the largest is white) and output level.
        oecf => Oecf(Placed<PathBuf>) = path(&["csv"]);
    }
}

record! {
    /// A tone curve with parameters.
    pub struct CurveTable check(check) {
        /// Kind of curve.
        inside kind: CurveKind;
        /// With "contrast": encoded value that is mapped to 0.5, above 0 and below 1. Default: 0.5.
        optional midpoint: Placed<f64> = number("").above(0.0).at_most(0.999);
        /// With "oecf": largest possible output level, above 0. Default: 255.
        optional largest_output: Placed<f64> = number("").above(0.0);
    }
}

fn check(curve: &CurveTable, faults: &mut Faults) {
    let is_s = matches!(curve.kind, CurveKind::Contrast(_));
    let is_oecf = matches!(curve.kind, CurveKind::Oecf(_));
    for (key, owner, value, fits) in
        [("midpoint", "contrast", &curve.midpoint, is_s), ("largest_output", "oecf", &curve.largest_output, is_oecf)]
    {
        if let Some(value) = value.as_ref().filter(|_| !fits) {
            faults.add(
                ErrorCode::NoEffect,
                &value.place,
                format!("\"{key}\" has no effect here, it belongs to \"{owner}\""),
                "remove it",
            );
        }
    }
}

pub(super) fn tone_curve() -> impl Rule<Out = ToneCurve> {
    either(variant!(choice(), ToneCurve::Named), variant!(record(), ToneCurve::Curve))
}

impl ToneCurve {
    /// The table's file.
    pub(super) fn file(&self) -> Option<&Placed<PathBuf>> {
        match self {
            Self::Curve(curve) => match &curve.kind {
                CurveKind::Table(file) | CurveKind::Oecf(file) => Some(file),
                CurveKind::Gamma(_) | CurveKind::Contrast(_) => None,
            },
            Self::Named(_) => None,
        }
    }
}
