//! Spectra for linear sRGB colours: mixtures of three fixed basis reflectances.
//!
//! Mallett & Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance": three reflectances
//! that are nowhere negative, sum to 1 at every wavelength, have exactly the colours of the sRGB primaries under D65,
//! and are as smooth as that allows (squared first differences over 380–780 nm in steps of 5 nm). They are solved for
//! this crate's observer and D65 by `tests/oracles/upsample_basis.py` and held beyond their ends.
//!
//! A mixture with components in 0 to 1 is therefore a reflectance, and its colour under D65 is the one asked for. The
//! model says nothing true about infrared or ultraviolet. Components outside 0 to 1 are mixed all the same; whether
//! they are legal is for the description to say.

use crate::illuminant;
use crate::observer;
use crate::spectrum::{NODES, node_below};
use crate::table::embedded;
use crate::{Outside, Spectrum};
use etendue_core::{Spectral, Wavelengths};
use std::sync::LazyLock;

static BASIS: LazyLock<[Spectrum; 3]> = LazyLock::new(|| {
    let table = embedded::<4>(include_str!("../data/srgb_basis.csv"), Outside::Hold);
    table.try_into().expect("three reflectances")
});

/// D65 with a luminance of 1 cd·m⁻², W·m⁻²·sr⁻¹·nm⁻¹.
static WHITE_LIGHT: LazyLock<Spectrum> =
    LazyLock::new(|| observer::with_luminance(illuminant::d65(), 1.0).expect("D65 has a luminance"));

/// The three weights of a node side by side, so that a look-up touches one place in memory.
type Nodes = Box<[[f32; 3]; NODES]>;

static REFLECTANCE: LazyLock<Nodes> = LazyLock::new(|| nodes(BASIS.each_ref()));

static EMISSION: LazyLock<Nodes> = LazyLock::new(|| {
    let lit = BASIS.each_ref().map(|basis| basis.product(&WHITE_LIGHT));
    nodes(lit.each_ref())
});

fn nodes(spectra: [&Spectrum; 3]) -> Nodes {
    let list: Vec<_> = (0..NODES).map(|i| spectra.map(|s| s.nodes()[i])).collect();
    list.try_into().expect("one entry a node")
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

/// The spectral radiance (W·m⁻²·sr⁻¹·nm⁻¹) of a linear sRGB colour of which (1, 1, 1) is D65 of 1 cd·m⁻², at a path's
/// wavelengths. Zero beyond 780 nm, where the table of D65 ends.
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
