//! The CIE 1931 2° standard observer: tristimulus values and luminance.
//!
//! X = 683 ∫ S(λ) x̄(λ) dλ and so on, with S a spectral radiance in W·m⁻²·sr⁻¹·nm⁻¹; Y is then the luminance in cd·m⁻²
//! (683 lm/W, the luminous efficacy of the SI; CIE 15:2018). The functions are tabulated from 360 to 830 nm and zero
//! outside. The integral is the sum over the nodes of the 1 nm grid.

use std::sync::LazyLock;

use etendue_core::Bands;

use crate::{Extrapolation, Spectrum, spectrum::embedded};

/// Luminous efficacy of the standard observer at its peak, lm/W.
pub const LUMINOUS_EFFICACY_LM_W: f64 = 683.0;

static FUNCTIONS: LazyLock<[Spectrum; 3]> = LazyLock::new(|| {
    let table = embedded::<4>(include_str!("../data/cie_1931_2deg_1nm.csv"), Extrapolation::Zero);
    table.try_into().expect("three functions")
});

/// x̄(λ).
#[must_use]
pub fn x_bar() -> &'static Spectrum {
    &FUNCTIONS[0]
}

/// ȳ(λ), the photopic luminous efficiency.
#[must_use]
pub fn y_bar() -> &'static Spectrum {
    &FUNCTIONS[1]
}

/// z̄(λ).
#[must_use]
pub fn z_bar() -> &'static Spectrum {
    &FUNCTIONS[2]
}

/// Tristimulus values of a spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹), Y in cd·m⁻².
#[must_use]
pub fn xyz(radiance: &Spectrum) -> [f64; 3] {
    FUNCTIONS.each_ref().map(|f| LUMINOUS_EFFICACY_LM_W * node_sum(&[radiance, f]))
}

/// Tristimulus values of a reflectance (or transmittance) in the light of `illuminant` (any scale); Y of the perfect
/// diffuser is 1. The illuminant must have a luminance.
#[must_use]
pub fn xyz_of_reflectance(reflectance: &Spectrum, illuminant: &Spectrum) -> [f64; 3] {
    let white = node_sum(&[illuminant, y_bar()]);
    FUNCTIONS.each_ref().map(|f| node_sum(&[reflectance, illuminant, f]) / white)
}

/// Luminance (cd·m⁻²) of a spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹); illuminance (lx) of a spectral irradiance.
#[must_use]
pub fn luminance(radiance: &Spectrum) -> f64 {
    LUMINOUS_EFFICACY_LM_W * node_sum(&[radiance, y_bar()])
}

/// A relative spectrum scaled to a luminance in cd·m⁻² (or an illuminance in lx). `None` if it has none: infrared cannot be scaled to a luminance.
#[must_use]
pub fn with_luminance(relative: &Spectrum, luminance_cd_m2: f64) -> Option<Spectrum> {
    let own = luminance(relative);
    (own > 0.0).then(|| relative.scaled(luminance_cd_m2 / own))
}

/// Contributions of each band to X, Y and Z for a mean spectral radiance of 1 W·m⁻²·sr⁻¹·nm⁻¹ in it.
#[must_use]
pub fn xyz_weights(bands: Bands) -> Vec<[f64; 3]> {
    let weight = LUMINOUS_EFFICACY_LM_W * bands.width_nm();
    let [x, y, z] = FUNCTIONS.each_ref().map(|f| f.band_means(bands));
    (0..bands.count()).map(|i| [x[i] * weight, y[i] * weight, z[i] * weight]).collect()
}

/// Tristimulus values of band means of a spectral radiance, Y in cd·m⁻²; `means` holds one value per band.
#[must_use]
pub fn xyz_of_bands(means: &[f32], bands: Bands) -> [f64; 3] {
    xyz_weights(bands)
        .iter()
        .zip(means)
        .fold([0.0; 3], |sum, (weight, mean)| core::array::from_fn(|c| sum[c] + weight[c] * f64::from(*mean)))
}

/// Sum over the nodes of the product of spectra: the trapezoidal integral, as the functions vanish at the ends.
fn node_sum(factors: &[&Spectrum]) -> f64 {
    (0..crate::spectrum::NODES).map(|i| factors.iter().map(|s| f64::from(s.nodes()[i])).product::<f64>()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illuminant;

    /// 1/683 W·m⁻²·sr⁻¹ in a narrow line at 555 nm is 1 cd·m⁻²: ȳ is 1 there.
    #[test]
    fn a_candela() {
        let line = [(554.0, 0.0), (555.0, 1.0 / 683.0), (556.0, 0.0)];
        let line = Spectrum::from_points(&line, Extrapolation::Zero).expect("a table");
        assert!((luminance(&line) - 1.0).abs() < 1e-7);
        // In a band the neighbours of the peak contribute: ȳ(554) = 0.9998, ȳ(556) = 0.99983 (CIE table).
        let bands = Bands::new(554.0, 2.0, 1).expect("a band");
        let mean = line.band_means(bands)[0] as f32;
        assert!((xyz_of_bands(&[mean], bands)[1] - 1.0).abs() < 2e-4);
    }

    #[test]
    fn bands_approach_the_sum_over_nodes() {
        let light = illuminant::by_name("A").expect("A");
        let exact = xyz(light);
        // The error of means of width h is about h²/12 S″/S, over nodes of 1 nm 1/4 S″/S; S″/S of A is 1e-4 in the blue.
        for (width, tolerance) in [(5.0, 3e-4), (1.0, 3e-5)] {
            let bands = Bands::covering(360.0, 830.0, width).expect("bands");
            let means: Vec<f32> = light.band_means(bands).into_iter().map(|v| v as f32).collect();
            let actual = xyz_of_bands(&means, bands);
            assert!((0..3).all(|c| (actual[c] / exact[c] - 1.0).abs() < tolerance), "{width} nm: {actual:?} {exact:?}");
        }
    }

    #[test]
    fn a_lamp_takes_the_luminance_asked_for_and_infrared_none() {
        let spectrum =
            with_luminance(illuminant::by_name("sodium-low-pressure").expect("a lamp"), 250.0).expect("bright");
        assert!((luminance(&spectrum) / 250.0 - 1.0).abs() < 1e-6);
        let infrared = [(900.0, 1.0), (1000.0, 1.0)];
        let infrared = Spectrum::from_points(&infrared, Extrapolation::Zero).expect("a table");
        assert!(with_luminance(&infrared, 1.0).is_none());
    }
}
