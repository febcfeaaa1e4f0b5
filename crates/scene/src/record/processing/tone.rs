//! Tone curves.

use crate::fault::{DescriptionErrors, ErrorCode};
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
        /// γ of output = light^(1/γ).
        gamma => Gamma(Placed<f64>) = number("").above(0.0);
        /// Contrast of an S-curve on sRGB; 1 is none.
        contrast => Contrast(Placed<f64>) = number("").above(0.0);
        /// Two columns: linear light 0 … 1, output 0 … 1.
        table => Table(Placed<PathBuf>) = path(&["csv"]);
        /// Measured OECF (ISO 14524), two columns: exposure (the largest is white), output level.
        oecf => Oecf(Placed<PathBuf>) = path(&["csv"]);
    }
}

record! {
    /// A tone curve with parameters.
    pub struct CurveTable check(check) {
        /// Kind of curve.
        inside kind: CurveKind;
        /// With "contrast": encoded value that becomes 0.5. Default: 0.5.
        optional midpoint: Placed<f64> = number("").above(0.0).at_most(0.999);
        /// With "oecf": largest possible output level. Default: 255.
        optional largest_output: Placed<f64> = number("").above(0.0);
    }
}

fn check(curve: &CurveTable, errors: &mut DescriptionErrors) {
    let is_s = matches!(curve.kind, CurveKind::Contrast(_));
    let is_oecf = matches!(curve.kind, CurveKind::Oecf(_));
    for (key, owner, value, fits) in
        [("midpoint", "contrast", &curve.midpoint, is_s), ("largest_output", "oecf", &curve.largest_output, is_oecf)]
    {
        if let Some(value) = value.as_ref().filter(|_| !fits) {
            errors.add(
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
