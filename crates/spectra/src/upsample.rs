//! Spectra for linear sRGB colours: mixtures of three fixed basis reflectances.
//!
//! Mallett & Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance": three non-negative reflectances that sum to 1 at
//! every wavelength, have exactly the colours of the sRGB primaries under D65, and are as smooth as these conditions allow (squared first differences
//! over 380–780 nm in steps of 5 nm). They are solved for this crate's observer and D65 by `tests/oracles/upsample_basis.py` and held beyond their
//! ends.
//!
//! A mixture with components in 0 to 1 is therefore a reflectance, and its colour under D65 is the requested one. Infrared and ultraviolet values
//! have no physical basis. Components outside 0 to 1 are mixed as well; the description decides whether they are legal.

use std::sync::LazyLock;

use etendue_core::{Spectral, Wavelengths};

use crate::spectrum::{NODES, embedded, node_below};
use crate::{Extrapolation, Spectrum, illuminant, observer};

static BASIS: LazyLock<[Spectrum; 3]> = LazyLock::new(|| {
    let table = embedded::<4>(include_str!("../data/srgb_basis.csv"), Extrapolation::Hold);
    table.try_into().expect("three reflectances")
});

/// D65 with a luminance of 1 cd·m⁻², W·m⁻²·sr⁻¹·nm⁻¹.
static WHITE_LIGHT: LazyLock<Spectrum> =
    LazyLock::new(|| observer::with_luminance(illuminant::d65(), 1.0).expect("D65 has a luminance"));

/// The three weights of a node are adjacent, so that a look-up touches one location in memory.
type Nodes = Box<[[f32; 3]; NODES]>;

static REFLECTANCE: LazyLock<Nodes> = LazyLock::new(|| nodes(BASIS.each_ref()));

static EMISSION: LazyLock<Nodes> = LazyLock::new(|| {
    let lit_basis = BASIS.each_ref().map(|basis| basis.product(&WHITE_LIGHT));
    nodes(lit_basis.each_ref())
});

fn nodes(spectra: [&Spectrum; 3]) -> Nodes {
    let list: Vec<_> = (0..NODES).map(|i| spectra.map(|s| s.nodes()[i])).collect();
    list.try_into().expect("one entry per node")
}

/// The basis reflectances of red, green and blue.
#[must_use]
pub fn basis() -> &'static [Spectrum; 3] {
    &BASIS
}

/// The reflectance of a linear sRGB colour, at a path's wavelengths.
#[must_use]
#[inline]
pub fn reflectance<const N: usize>(rgb: [f32; 3], wavelengths: &Wavelengths<N>) -> Spectral<N> {
    mix(&REFLECTANCE, rgb, wavelengths)
}

/// The spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) of a linear sRGB colour, scaled so that (1, 1, 1) is D65 of 1 cd·m⁻², at a path's wavelengths. Zero beyond
/// 780 nm, where the table of D65 ends.
#[must_use]
#[inline]
pub fn emission<const N: usize>(rgb: [f32; 3], wavelengths: &Wavelengths<N>) -> Spectral<N> {
    mix(&EMISSION, rgb, wavelengths)
}

#[inline]
fn mix<const N: usize>(nodes: &Nodes, rgb: [f32; 3], wavelengths: &Wavelengths<N>) -> Spectral<N> {
    Spectral(wavelengths.nm.map(|nm| {
        let (i, t) = node_below(nm);
        let (low, high) = (dot(nodes[i], rgb), dot(nodes[i + 1], rgb));
        low + t * (high - low)
    }))
}

#[inline]
fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The reflectance of a linear sRGB colour as a spectrum.
#[must_use]
pub fn reflectance_spectrum(rgb: [f32; 3]) -> Spectrum {
    mixture(&REFLECTANCE, rgb)
}

/// The spectral radiance of [`emission`] as a spectrum.
#[must_use]
pub fn emission_spectrum(rgb: [f32; 3]) -> Spectrum {
    mixture(&EMISSION, rgb)
}

fn mixture(nodes: &Nodes, rgb: [f32; 3]) -> Spectrum {
    let mut node = nodes.iter();
    Spectrum::from_fn(|_| f64::from(node.next().map_or(0.0, |n| dot(*n, rgb))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colour::{D65_WHITE, ciede2000, lab, linear_srgb_from_xyz, xyz_from_linear_srgb};

    #[test]
    fn the_basis_is_positive_and_sums_to_one() {
        let [r, g, b] = basis();
        for i in 0..NODES {
            let sum = f64::from(r.nodes()[i]) + f64::from(g.nodes()[i]) + f64::from(b.nodes()[i]);
            // Ten digits in the file, then three roundings to f32 of at most 3e-8 each.
            assert!((sum - 1.0).abs() < 1e-7, "node {i}: {sum}");
        }
        assert!(basis().iter().all(|s| s.min_value() >= 0.0 && s.max_value() <= 1.0));
    }

    #[test]
    fn colours_come_back() {
        let steps = [0.0_f32, 0.05, 0.18, 0.4, 0.7, 0.95, 1.0];
        for (r, g, b) in steps.iter().flat_map(|r| steps.iter().flat_map(move |g| steps.map(|b| (*r, *g, b)))) {
            let xyz = observer::xyz_of_reflectance(&reflectance_spectrum([r, g, b]), illuminant::d65());
            let request = xyz_from_linear_srgb([r, g, b].map(f64::from));
            let difference = ciede2000(lab(xyz, D65_WHITE), lab(request, D65_WHITE));
            // Rounding to f32 changes XYZ by 1e-7; L*a*b* has slopes up to 1 000, and 4 500 for a* near black.
            assert!(difference < 1e-3, "{r} {g} {b}: {difference}");
        }
    }

    #[test]
    fn reflectances_are_reflectances() {
        let wavelengths = Wavelengths::<8>::uniform(300.0, 1100.0, 0.61);
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 0.0, 0.2], [0.3, 1.0, 0.0]] {
            let (values, spectrum) = (reflectance(rgb, &wavelengths), reflectance_spectrum(rgb));
            for i in 0..8 {
                assert!((0.0..=1.0 + 1e-6).contains(&values[i]), "{values:?}");
                // Interpolated before or after storing: roundings of f32.
                assert!((values[i] - spectrum.at(wavelengths.nm[i])).abs() < 3e-7);
            }
        }
    }

    #[test]
    fn white_emission_is_one_candela_and_colours_are_kept() {
        let white = emission_spectrum([1.0; 3]);
        assert!((observer::luminance(&white) - 1.0).abs() < 1e-6);
        let rgb = linear_srgb_from_xyz(observer::xyz(&emission_spectrum([120.0, 3.5, 40.0])));
        for (actual, request) in rgb.into_iter().zip([120.0, 3.5, 40.0]) {
            // Roundings of f32 at the scale of the largest component.
            assert!((actual - request).abs() < 120.0 * 1e-6, "{rgb:?}");
        }
        let wavelengths = Wavelengths::<4>::uniform(380.0, 780.0, 0.2);
        let values = emission([1.0; 3], &wavelengths);
        (0..4).for_each(|i| assert!((values[i] / white.at(wavelengths.nm[i]) - 1.0).abs() < 1e-6));
    }
}
