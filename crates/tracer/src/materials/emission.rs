//! Emission of surfaces.
//!
//! Radiance is the same in every direction of a glowing side (Lambert): a surface of radiance L sends π L per area.

use etendue_core::{Spectral, Wavelengths};
use etendue_spectra::{Spectrum, upsample};
use glam::Vec3;

use crate::textures::{ImageTexture, Lookup, TextureId};

/// Which sides of a surface glow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Glow {
    /// The side that the geometric normal points to: by the winding of a triangle, outwards for a sphere.
    Front,
    /// Both, each with the stated radiance.
    Both,
}

/// What a surface emits.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    pub radiance: Spectrum,
    /// A factor on the radiance over the surface: linear sRGB colours of a texture, made spectra as reflectances are
    /// (white is 1 at every wavelength).
    pub factor: Option<TextureId>,
    /// Which sides glow.
    pub glow: Glow,
}

impl Emission {
    /// Whether light leaves along `direction` from a surface of this geometric normal.
    #[must_use]
    pub fn leaves(&self, geometric_normal: Vec3, direction: Vec3) -> bool {
        self.glow == Glow::Both || geometric_normal.dot(direction) > 0.0
    }

    pub(crate) fn at<const N: usize>(
        &self,
        textures: &[ImageTexture],
        lookup: &Lookup,
        wavelengths: &Wavelengths<N>,
    ) -> Spectral<N> {
        let radiance = self.radiance.sample(wavelengths);
        match self.factor {
            None => radiance,
            Some(id) => radiance * upsample::reflectance(textures[id.0 as usize].sample(lookup), wavelengths),
        }
    }

    /// Mean radiance over a range of wavelengths and over the texture: how much this glow matters beside others.
    pub(crate) fn mean_radiance(&self, textures: &[ImageTexture], low_nm: f64, high_nm: f64) -> f64 {
        let texture = self.factor.map_or(1.0, |id| f64::from(textures[id.0 as usize].mean().element_sum()) / 3.0);
        self.radiance.band_mean(low_nm, high_nm) * texture
    }
}
