//! Sheetings as specified by standards.
//!
//! Minimum coefficients of white sheeting: EN 12899-1:2007, classes RA1 and RA2 (glass beads), at observation angles 0.2°, 0.33° and 2° and entrance
//! angles 5°, 30° and 40°; ASTM D4956 type IX (micro-prisms), at 0.1°, 0.2°, 0.5° and 1° and −4° (taken as 4°) and 30°. Colours by the ratio of their
//! minimum to white's at 0.2° and the first entrance angle of the same standards; daylight reflectance by the minimum luminance factors of EN
//! 12899-1. All are minima: new sheeting has more. Figures as handbooks give them; the standards themselves are authoritative.
//!
//! The colours' spectra are smooth edges and bands set to the colours' regions, not measured ones.

use etendue_core::maths::f64::exp;
use etendue_spectra::{Spectrum, illuminant, observer};

use super::{RetroTable, Sheeting, SheetingError};

/// The classes that [`SheetingPreset::named`] accepts.
pub const SHEETING_CLASSES: &[&str] = &["ra1", "ra2", "d4956-ix"];

/// The colours that [`SheetingPreset::named`] accepts.
pub const SHEETING_COLOURS: &[&str] = &["white", "yellow", "red", "blue", "green"];

struct SheetingClassValues {
    observation_deg: &'static [f64],
    entrance_deg: &'static [f64],
    white: &'static [f64],
    /// White, yellow, red, blue, green: R_A at the first geometry of 0.2°, cd·lx⁻¹·m⁻².
    colours: [f64; 5],
    /// Luminance factor by day, of the same.
    day: [f64; 5],
}

const CLASSES: [SheetingClassValues; 3] = [
    SheetingClassValues {
        observation_deg: &[0.2, 0.33, 2.0],
        entrance_deg: &[5.0, 30.0, 40.0],
        white: &[70.0, 30.0, 10.0, 50.0, 24.0, 9.0, 5.0, 2.5, 1.5],
        colours: [70.0, 50.0, 14.5, 4.0, 9.0],
        day: [0.35, 0.27, 0.05, 0.01, 0.04],
    },
    SheetingClassValues {
        observation_deg: &[0.2, 0.33, 2.0],
        entrance_deg: &[5.0, 30.0, 40.0],
        white: &[250.0, 150.0, 110.0, 180.0, 100.0, 95.0, 5.0, 2.5, 1.5],
        colours: [250.0, 170.0, 45.0, 20.0, 45.0],
        day: [0.27, 0.16, 0.03, 0.01, 0.03],
    },
    SheetingClassValues {
        observation_deg: &[0.1, 0.2, 0.5, 1.0],
        entrance_deg: &[4.0, 30.0],
        white: &[660.0, 370.0, 380.0, 215.0, 240.0, 135.0, 80.0, 45.0],
        colours: [380.0, 285.0, 76.0, 17.0, 38.0],
        day: [0.27, 0.16, 0.03, 0.01, 0.03],
    },
];

/// Values of a standard for a class and colour.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetingPreset {
    /// Coefficients of the colour itself.
    pub table: RetroTable,
    /// The colour's spectrum, of no particular scale.
    pub colour: Spectrum,
    /// Luminance factor by day.
    pub luminance_factor: f64,
}

impl SheetingPreset {
    /// The preset of one of [`SHEETING_CLASSES`] and one of [`SHEETING_COLOURS`]; `None` for other names.
    #[must_use]
    pub fn named(class: &str, colour: &str) -> Option<Self> {
        let class = &CLASSES[SHEETING_CLASSES.iter().position(|c| *c == class)?];
        let i = SHEETING_COLOURS.iter().position(|c| *c == colour)?;
        let table = RetroTable::new(class.observation_deg, class.entrance_deg, class.white).expect("a legal table");
        Some(Self {
            table: table.scaled(class.colours[i] / class.colours[0]),
            colour: Spectrum::from_fn(|nm| shape(i, nm)),
            luminance_factor: class.day[i],
        })
    }

    /// The sheeting: its reflectance by day has the luminance factor under D65.
    ///
    /// # Errors
    /// If more would be reflected than arrives: no preset does.
    pub fn sheeting(&self) -> Result<Sheeting, SheetingError> {
        let luminous = observer::xyz_of_reflectance(&self.colour, illuminant::d65())[1];
        Sheeting::new(self.colour.scaled(self.luminance_factor / luminous), &self.colour, self.table.clone())
    }
}

/// Transmitted fraction at a wavelength of the dye of a colour, in the order of [`SHEETING_COLOURS`].
fn shape(colour: usize, nm: f64) -> f64 {
    let edge = |at: f64, width: f64| 1.0 / (1.0 + exp((at - nm) / width));
    let band = |low: f64, high: f64| edge(low, 8.0) * (1.0 - edge(high, 12.0));
    match colour {
        0 => 1.0,
        1 => 0.02 + 0.98 * edge(515.0, 10.0),
        2 => 0.01 + 0.99 * edge(605.0, 8.0),
        3 => 0.005 + 0.995 * band(415.0, 485.0),
        _ => 0.01 + 0.99 * band(480.0, 545.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_legal_and_has_its_colour() {
        for class in SHEETING_CLASSES {
            for (i, colour) in SHEETING_COLOURS.iter().enumerate() {
                let preset = SheetingPreset::named(class, colour).expect("a preset");
                let sheeting = preset.sheeting().expect("a legal sheeting");
                assert!(sheeting.cut_off_deg() > 2.0, "{class} {colour}: {}", sheeting.limits());
                let xyz = observer::xyz_of_reflectance(&preset.colour, illuminant::d65());
                let (x, y) = (xyz[0] / xyz.iter().sum::<f64>(), xyz[1] / xyz.iter().sum::<f64>());
                // Yellow, red, blue and green lie in these parts of the chart (EN 12899-1, roughly).
                let right = match i {
                    0 => (x - 0.3127).abs() < 1e-3 && (y - 0.329).abs() < 1e-3,
                    1 => x > 0.42 && y > 0.42,
                    2 => x > 0.6 && y < 0.35,
                    3 => x < 0.2 && y < 0.25,
                    _ => x < 0.25 && y > 0.4,
                };
                assert!(right, "{class} {colour}: {x} {y}");
            }
        }
        assert!(SheetingPreset::named("ra9", "white").is_none() && SheetingPreset::named("ra1", "pink").is_none());
    }
}
