//! Measured spectral sensitivities of cameras.
//!
//! Three bodies from the rawtoaces collection, 380–780 nm, zero outside. The values are **relative**: the channels of one camera are comparable with
//! each other, but their scale is not a quantum efficiency. They are responses per unit of radiant power, lens and filters included.

use std::sync::LazyLock;

use crate::{Extrapolation, Spectrum, spectrum::embedded};

/// Relative sensitivities of a camera's three channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Red channel.
    pub r: Spectrum,
    /// Green channel.
    pub g: Spectrum,
    /// Blue channel.
    pub b: Spectrum,
}

const NAMES: &[&str] = &["canon-eos-5d-mark-ii", "nikon-d5100", "sony-ilce-7sm2"];

static TABLES: LazyLock<Vec<Sensitivity>> = LazyLock::new(|| {
    [
        include_str!("../data/camera_canon_eos_5d_mark_ii.csv"),
        include_str!("../data/camera_nikon_d5100.csv"),
        include_str!("../data/camera_sony_ilce_7sm2.csv"),
    ]
    .into_iter()
    .map(sensitivity)
    .collect()
});

fn sensitivity(text: &str) -> Sensitivity {
    let [r, g, b] = embedded::<4>(text, Extrapolation::Zero).try_into().expect("three columns");
    Sensitivity { r, g, b }
}

/// A camera by name; `None` for one not in [`names`].
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Sensitivity> {
    NAMES.iter().position(|n| *n == name).map(|i| &TABLES[i])
}

/// The names accepted by [`by_name`]: canon-eos-5d-mark-ii, nikon-d5100, sony-ilce-7sm2.
#[must_use]
pub fn names() -> &'static [&'static str] {
    NAMES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_peak_in_their_colours() {
        for name in names() {
            let Sensitivity { r, g, b } = by_name(name).expect("a camera of the list");
            let [r, g, b] = [r, g, b].map(|s| {
                assert!(s.min_value() >= 0.0 && s.at(900.0) == 0.0, "{name}");
                300 + s.nodes().iter().position(|v| *v == s.max_value()).unwrap_or(0)
            });
            assert!((580..=640).contains(&r) && (510..=560).contains(&g) && (430..=480).contains(&b), "{name}");
        }
        assert!(by_name("brownie").is_none());
    }
}
