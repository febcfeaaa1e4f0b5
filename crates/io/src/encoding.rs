//! How a picture's numbers relate to light, and what says so.
//!
//! In this order: a side-car of this program that lists the picture; of a PNG its chunks cICP, iCCP, sRGB, gAMA (PNG
//! specification, third edition, 4.3: the first of these that is there and understood); the kind of numbers, which is a guess.
//! Left out: ICC profiles other than those named sRGB, the profiles of JPEG and TIFF, EXIF's ColorSpace.

use etendue_core::maths::f64::pow;
use serde_json::{Value, json};

/// How numbers over their full scale relate to light 0 … 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Encoding {
    /// In proportion to light, but for a black level.
    Linear,
    /// For display after IEC 61966-2-1; white is the full scale.
    Srgb,
    /// A power: number = light^(1/γ), γ above 0.
    Gamma(f64),
    /// An S-curve of this contrast about this encoded value, on the curve of sRGB.
    Contrast {
        /// Slope of the log-odds.
        contrast: f64,
        /// The encoded value that becomes a half.
        midpoint: f64,
    },
    /// Light and number from light 0 to light 1, straight lines between.
    Table(Vec<(f64, f64)>),
    /// A measured conversion function: exposure and output level.
    Oecf {
        /// Exposure (any unit, the largest is light 1) and output.
        points: Vec<(f64, f64)>,
        /// The largest output level; `None`: the picture's full scale.
        largest_output: Option<f64>,
    },
}

/// An encoding and the reason why it is taken, in words.
#[derive(Clone, Debug, PartialEq)]
pub struct Stated {
    /// The encoding.
    pub encoding: Encoding,
    /// Who says so.
    pub reason: String,
    /// Whether nobody does.
    pub guessed: bool,
}

impl Stated {
    /// An encoding for a reason.
    #[must_use]
    pub fn new(encoding: Encoding, reason: impl Into<String>) -> Self {
        Self { encoding, reason: reason.into(), guessed: false }
    }

    /// A guess by what kind of numbers the file has.
    pub(crate) fn guessed(encoding: Encoding, by: &str) -> Self {
        let reason = format!("guessed, as {by}; `encoding` says otherwise");
        Self { guessed: true, ..Self::new(encoding, reason) }
    }
}

impl Encoding {
    /// Its name, of few words.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Linear => "linear".to_owned(),
            Self::Srgb => "sRGB".to_owned(),
            Self::Gamma(gamma) => format!("gamma {}", (gamma * 1e4).round() / 1e4),
            Self::Contrast { contrast, midpoint } => format!("S-curve of contrast {contrast} about {midpoint}"),
            Self::Table(points) => format!("tone curve of {} points", points.len()),
            Self::Oecf { points, .. } => format!("OECF of {} points", points.len()),
        }
    }

    /// As a side-car states it, in the words of `tone_curve` of a camera file.
    #[must_use]
    pub fn to_json(&self) -> Value {
        match self {
            Self::Linear => json!("linear"),
            Self::Srgb => json!("srgb"),
            Self::Gamma(gamma) => json!({ "gamma": gamma }),
            Self::Contrast { contrast, midpoint } => json!({ "contrast": contrast, "midpoint": midpoint }),
            Self::Table(points) => json!({ "table": points }),
            Self::Oecf { points, largest_output } => json!({ "oecf": points, "largest_output": largest_output }),
        }
    }

    /// Reads [`to_json`](Self::to_json); `None` of anything else.
    #[must_use]
    pub fn from_json(said: &Value) -> Option<Self> {
        let number = |key: &str| said[key].as_f64();
        let points = |key: &str| serde_json::from_value::<Vec<(f64, f64)>>(said[key].clone()).ok();
        match said.as_str() {
            Some("linear") => return Some(Self::Linear),
            Some("srgb") => return Some(Self::Srgb),
            _ => {}
        }
        if let Some(gamma) = number("gamma") {
            return Some(Self::Gamma(gamma));
        }
        if let Some((contrast, midpoint)) = number("contrast").zip(number("midpoint")) {
            return Some(Self::Contrast { contrast, midpoint });
        }
        let oecf = |points| Self::Oecf { points, largest_output: number("largest_output") };
        points("table").map(Self::Table).or_else(|| points("oecf").map(oecf))
    }

    /// The curve of ITU-R BT.709 by 1024 points at even steps of the number: straight lines are within 1e-6 of it, but for
    /// 3e-5 where its two parts meet (their rounded numbers leave a jump of 5e-5).
    pub(crate) fn bt709() -> Self {
        const STEPS: u32 = 1024;
        let light = |number: f64| {
            if number < 0.081 { number / 4.5 } else { pow((number + 0.099) / 1.099, 1.0 / 0.45) }
        };
        let number = |i: u32| f64::from(i) / f64::from(STEPS);
        Self::Table((0..=STEPS).map(|i| (light(number(i)), number(i))).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_car_keeps_every_curve() {
        let curves = [
            Encoding::Linear,
            Encoding::Srgb,
            Encoding::Gamma(2.2),
            Encoding::Contrast { contrast: 1.5, midpoint: 0.4 },
            Encoding::Table(vec![(0.0, 0.1), (1.0, 0.9)]),
            Encoding::Oecf { points: vec![(0.5, 3.0), (2.0, 250.0)], largest_output: Some(255.0) },
        ];
        for curve in curves {
            assert_eq!(Encoding::from_json(&curve.to_json()), Some(curve));
        }
        assert_eq!(Encoding::from_json(&json!("sepia")), None);
        assert_eq!(Encoding::from_json(&json!(null)), None);
    }

    #[test]
    fn bt709_by_straight_lines_is_the_curve() {
        let Encoding::Table(points) = Encoding::bt709() else { panic!("a table") };
        assert_eq!((points[0], points[points.len() - 1].1), ((0.0, 0.0), 1.0));
        for pair in points.windows(2) {
            let number = 0.5 * (pair[0].1 + pair[1].1);
            let exact = if number < 0.081 { number / 4.5 } else { pow((number + 0.099) / 1.099, 1.0 / 0.45) };
            let line = 0.5 * (pair[0].0 + pair[1].0);
            assert!(
                (line - exact).abs() < if (0.079..0.083).contains(&number) { 3e-5 } else { 1e-6 },
                "{number} {line} {exact}"
            );
        }
    }
}
