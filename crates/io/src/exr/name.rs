//! Channel names of the spectral layout.
//!
//! Fichet, Pacanowski, Wilkie, "An OpenEXR layout for spectral images", JCGT 10(3), 2021: `S0.550,000000nm` is the
//! unpolarised emission at 550 nm, `T.550,000000nm` a reflectance or transmittance. The decimal sign is a comma,
//! because a point divides layers. Other writers use a point as well, SI prefixes, and frequencies in Hz.

use core::fmt;

/// Speed of light in vacuum, m/s (exact, SI).
const LIGHT_M_PER_S: f64 = 299_792_458.0;

/// What a spectral channel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stokes {
    /// A component of the Stokes vector of emitted light; 0 is the intensity.
    Emissive(u8),
    /// A reflectance or transmittance.
    Reflective,
}

/// A channel name taken apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralChannel {
    /// What it holds.
    pub stokes: Stokes,
    /// Wavelength in vacuum, nm.
    pub nm: f64,
    /// Whether the name stated a wavelength and not a frequency.
    pub by_wavelength: bool,
    /// Whether this is our variance of that channel.
    pub variance: bool,
}

/// The layer that holds our variance channels, with its dot.
const VARIANCE: &str = "variance.";

impl fmt::Display for Stokes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Emissive(component) => write!(f, "S{component}"),
            Self::Reflective => f.write_str("T"),
        }
    }
}

/// The name of a channel at `nm`, six decimals.
#[must_use]
pub fn channel_name(stokes: Stokes, nm: f64, variance: bool) -> String {
    let number = format!("{nm:.6}").replace('.', ",");
    format!("{}{stokes}.{number}nm", if variance { VARIANCE } else { "" })
}

/// Takes a channel name apart; `None` where it is no spectral channel.
#[must_use]
pub fn parse_channel_name(name: &str) -> Option<SpectralChannel> {
    let bare = name.strip_prefix(VARIANCE);
    let (layer, value) = bare.unwrap_or(name).split_once('.')?;
    let stokes = parse_stokes(layer)?;
    let (nm, by_wavelength) = parse_wavelength(value)?;
    Some(SpectralChannel { stokes, nm, by_wavelength, variance: bare.is_some() })
}

fn parse_stokes(layer: &str) -> Option<Stokes> {
    match layer {
        "T" => Some(Stokes::Reflective),
        _ => layer.strip_prefix('S')?.parse().ok().filter(|&c| c < 4).map(Stokes::Emissive),
    }
}

/// Vacuum wavelength in nm, and whether it was stated as one.
fn parse_wavelength(text: &str) -> Option<(f64, bool)> {
    let (rest, by_wavelength) = match text.strip_suffix("Hz") {
        Some(rest) => (rest, false),
        None => (text.strip_suffix('m')?, true),
    };
    let digits = rest.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let scale = prefix_scale(&rest[digits.len()..])?;
    let value: f64 = digits.replace(',', ".").parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0)?;
    let nm = if by_wavelength { value * (scale * 1e9) } else { LIGHT_M_PER_S / (value * scale) * 1e9 };
    Some((nm, by_wavelength))
}

fn prefix_scale(prefix: &str) -> Option<f64> {
    Some(match prefix {
        "" => 1.0,
        "k" => 1e3,
        "M" => 1e6,
        "G" => 1e9,
        "T" => 1e12,
        "P" => 1e15,
        "c" => 1e-2,
        "m" => 1e-3,
        "u" => 1e-6,
        "n" => 1e-9,
        "p" => 1e-12,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nm(name: &str) -> Option<f64> {
        parse_channel_name(name).map(|c| c.nm)
    }

    #[test]
    fn our_names_are_those_of_the_paper() {
        assert_eq!(channel_name(Stokes::Emissive(0), 550.0, false), "S0.550,000000nm");
        assert_eq!(channel_name(Stokes::Reflective, 382.5, false), "T.382,500000nm");
        assert_eq!(channel_name(Stokes::Emissive(0), 550.0, true), "variance.S0.550,000000nm");
    }

    #[test]
    fn names_of_other_writers_are_understood() {
        assert_eq!(nm("S0.550nm"), Some(550.0));
        assert_eq!(nm("S0.550.25nm"), Some(550.25));
        // Scaling by 1e3 and 1e9 rounds once or twice: 4 units in the last place at most.
        for name in ["S0.0,55um", "S0.5,5E-7m", "S0.545077,19636363636GHz", "S0.545.07719636363636THz"] {
            let parsed = nm(name).expect(name);
            assert!((parsed - 550.0).abs() < 550.0 * 1e-9, "{name}: {parsed}");
        }
        assert_eq!(parse_channel_name("S2.550nm").map(|c| c.stokes), Some(Stokes::Emissive(2)));
    }

    #[test]
    fn other_channels_are_left_alone() {
        for name in ["R", "N.X", "S0.Y", "S4.550nm", "S0.-5nm", "S0.nm", "S0.550", "T.0nm", "S0.infnm", "depth.Z"] {
            assert_eq!(parse_channel_name(name), None, "{name}");
        }
    }

    proptest::proptest! {
        #[test]
        fn a_name_reads_back_to_its_wavelength(stored in 300_000_000_u32..1_100_000_000) {
            let stored_nm = f64::from(stored) * 1e-6;
            let back = parse_channel_name(&channel_name(Stokes::Emissive(0), stored_nm, true)).expect("our own name");
            // Six decimals are written: half a unit of the last.
            proptest::prop_assert!(back.variance && (back.nm - stored_nm).abs() <= 0.5e-6);
        }
    }
}
