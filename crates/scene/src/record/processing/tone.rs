//! Tone curves.

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{Rule, choice, either, keyed, number, path, record, variant, words};
use std::path::PathBuf;

/// From linear light to a picture's numbers.
#[derive(Clone, Debug)]
pub enum ToneCurve {
    /// One without numbers.
    Named(Placed<NamedCurve>),
    /// One with numbers.
    Curve(Box<CurveTable>),
}

words! {
    /// A tone curve without numbers.
    pub enum NamedCurve {
        /// That of IEC 61966-2-1.
        "srgb" => Srgb,
        /// Output proportional to light.
        "linear" => Linear,
    }
}

keyed! {
    /// A tone curve with numbers.
    pub enum CurveKind {
        /// γ of output = light^(1/γ), above 0.
        gamma => Gamma(Placed<f64>) = number("").above(0.0);
        /// An S-curve on top of sRGB: its contrast, above 0; 1 is none, more darkens shadows and brightens lights.
        contrast => Contrast(Placed<f64>) = number("").above(0.0);
        /// A table of two columns, linear light from 0 to 1 and output 0 … 1, straight lines between.
        table => Table(Placed<PathBuf>) = path(&["csv"]);
        /// A measured conversion function (ISO 14524): a table of two columns, exposure (any unit, the largest is white) and
        /// output level.
        oecf => Oecf(Placed<PathBuf>) = path(&["csv"]);
    }
}

record! {
    /// A tone curve with numbers.
    pub struct CurveTable check(check) {
        /// Which.
        inside kind: CurveKind;
        /// With "contrast": the encoded value that becomes a half, above 0 and below 1. Default: 0.5.
        optional midpoint: Placed<f64> = number("").above(0.0).at_most(0.999);
        /// With "oecf": the largest level that the output can have, above 0. Default: 255.
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
    /// The table that it names.
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
