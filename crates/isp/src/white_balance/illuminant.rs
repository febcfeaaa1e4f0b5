//! White balance from the spectrum of the light.

use super::balancing;
use etendue_spectra::Spectrum;

/// A channel that sees nothing of the light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "channel {0} (0 red, 1 green, 2 blue) does not respond to the illuminant, so no gain makes it grey: choose an illuminant that lights every channel"
)]
pub struct NoResponse(pub usize);

/// Gains of the channels for which a spectrally flat reflector under `illuminant` (any scale) is neutral; the smallest
/// is 1.
///
/// # Errors
/// Where a channel does not respond to the illuminant.
pub fn white_balance_from_illuminant(
    responsivities: &[&Spectrum],
    illuminant: &Spectrum,
) -> Result<Vec<f64>, NoResponse> {
    let white: Vec<f64> = responsivities.iter().map(|r| response(r, illuminant, None)).collect();
    balancing(&white).ok_or_else(|| NoResponse(white.iter().position(|w| *w <= 0.0).unwrap_or(0)))
}

/// ∫ responsivity × illuminant × reflectance dλ, by trapezia of 1 nm (the ends, at 300 and 1 100 nm, count in full); of a
/// white where no reflectance is given.
pub(crate) fn response(responsivity: &Spectrum, illuminant: &Spectrum, reflectance: Option<&Spectrum>) -> f64 {
    let light = responsivity.nodes().iter().zip(illuminant.nodes()).map(|(r, i)| f64::from(*r) * f64::from(*i));
    match reflectance {
        None => light.sum(),
        Some(reflectance) => light.zip(reflectance.nodes()).map(|(l, r)| l * f64::from(*r)).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::{camera, illuminant};

    #[test]
    fn a_grey_is_neutral_and_the_smallest_gain_is_one() {
        let canon = camera::named("canon-eos-5d-mark-ii").expect("a camera");
        let channels = [&canon.r, &canon.g, &canon.b];
        let light = illuminant::named("A").unwrap_or(illuminant::d65());
        let gains = white_balance_from_illuminant(&channels, light).expect("light in all channels");
        let grey = Spectrum::constant(0.18);
        let balanced: [f64; 3] = core::array::from_fn(|c| gains[c] * response(channels[c], light, Some(&grey)));
        assert!((balanced[0] / balanced[1] - 1.0).abs() < 1e-12 && (balanced[2] / balanced[1] - 1.0).abs() < 1e-12);
        assert_eq!(gains.into_iter().fold(f64::INFINITY, f64::min), 1.0);
    }

    #[test]
    fn a_blind_channel_is_refused() {
        let (flat, blind) = (Spectrum::constant(1.0), Spectrum::constant(0.0));
        let refused = white_balance_from_illuminant(&[&flat, &flat, &blind], illuminant::d65());
        assert_eq!(refused, Err(NoResponse(2)));
    }
}
