//! Relation between the numbers of an image and light, and its source.
//!
//! The sources, in order: a side-car of this program that lists the image; the PNG chunks cICP, iCCP, sRGB, gAMA (PNG specification, third edition, 4.3: the
//! first of these that is present and understood); the kind of numbers, which is a guess. Not supported: ICC profiles other than those named sRGB, the profiles
//! of JPEG and TIFF, EXIF's ColorSpace.

use etendue_core::maths::f64::pow;
use serde_json::{Value, json};

/// Relation of numbers, over their full scale, to light 0 … 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Encoding {
    /// Proportional to light, except for a black level.
    Linear,
    /// Display encoding of IEC 61966-2-1; white is the full scale.
    Srgb,
    /// A power: number = light^(1/γ), γ above 0.
    Gamma(f64),
    /// S-curve on the curve of sRGB, with this contrast about this encoded value.
    Contrast {
        /// Slope of the log-odds.
        contrast: f64,
        /// Encoded value that maps to one half.
        midpoint: f64,
    },
    /// Pairs of light and number from light 0 to light 1, linear between.
    Table(Vec<(f64, f64)>),
    /// A measured conversion function: exposure and output level.
    Oecf {
        /// Exposure (any unit; the largest is light 1) and output.
        points: Vec<(f64, f64)>,
        /// Largest output level; `None`: the full scale of the image.
        largest_output: Option<f64>,
    },
}

/// Encoding with its source, in words.
#[derive(Clone, Debug, PartialEq)]
pub struct SourcedEncoding {
    pub encoding: Encoding,
    /// Source of the encoding.
    pub reason: String,
    /// True if the encoding is a guess.
    pub guessed: bool,
}

impl SourcedEncoding {
    /// Returns an encoding with its source.
    #[must_use]
    pub fn new(encoding: Encoding, reason: impl Into<String>) -> Self {
        Self { encoding, reason: reason.into(), guessed: false }
    }

    /// Returns an encoding guessed from the kind of numbers in the file.
    pub(crate) fn guessed(encoding: Encoding, by: &str) -> Self {
        let reason = format!("assumed, because {by}; set `encoding` to override");
        Self { guessed: true, ..Self::new(encoding, reason) }
    }
}

impl Encoding {
    /// Short name.
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

    /// Returns the encoding as a side-car states it, in the words of `tone_curve` of a camera file.
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

    /// Parses the result of [`to_json`](Self::to_json); `None` for anything else.
    #[must_use]
    pub fn from_json(stated: &Value) -> Option<Self> {
        let number = |key: &str| stated[key].as_f64();
        let points = |key: &str| serde_json::from_value::<Vec<(f64, f64)>>(stated[key].clone()).ok();
        match stated.as_str() {
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

    /// Curve of ITU-R BT.709 by 1024 points at equal steps of the number. Straight lines are within 1e-6 of it, except for 3e-5 where its two parts meet (their
    /// rounded constants leave a jump of 5e-5).
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
