//! Emission of surfaces.
//!
//! Radiance is the same in every direction of a glowing side (Lambert): a surface of radiance L sends π L per area.
//!
//! A texture multiplies it colour by colour, and may be above 1: a picture in real units (HDR) is its colours times a
//! radiance. With D65 of 1 cd/m² as the radiance, colours in cd/m² come out as
//! [`etendue_spectra::upsample::emission`] has them.

use etendue_core::{Spectral, TimeInterval, Wavelengths};
use etendue_spectra::{Spectrum, upsample};
use glam::Vec3;

use super::modulation::Modulation;
use crate::ALL_EFFECTS;
use crate::textures::{ImageTexture, Lookup, TextureId};

/// Which sides of a surface glow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EmissionSides {
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
    pub sides: EmissionSides,
    /// How its strength changes over time; `None` where it does not.
    pub modulation: Option<Modulation>,
}

/// Arguments of an emission: point, direction, wavelengths and time.
#[derive(Clone, Copy, Debug)]
pub struct EmissionQuery<'a, const N: usize> {
    /// The wavelengths.
    pub wavelengths: &'a Wavelengths<N>,
    /// The interval over which strengths that change over time are averaged.
    pub interval: &'a TimeInterval,
}

impl Emission {
    /// Whether light leaves along `direction` from a surface of this geometric normal.
    #[must_use]
    pub fn leaves(&self, geometric_normal: Vec3, direction: Vec3) -> bool {
        self.sides == EmissionSides::Both || geometric_normal.dot(direction) > 0.0
    }

    pub(crate) fn at<const N: usize>(
        &self,
        textures: &[ImageTexture],
        lookup: &Lookup,
        query: EmissionQuery<'_, N>,
    ) -> Spectral<N> {
        let EmissionQuery { wavelengths, interval } = query;
        let radiance = self.radiance.sample(wavelengths);
        let radiance = match self.factor {
            None => radiance,
            Some(_) if !ALL_EFFECTS => unreachable!("no textures"),
            Some(id) => radiance * upsample::reflectance(textures[id.0 as usize].sample(lookup), wavelengths),
        };
        match &self.modulation {
            None => radiance,
            Some(_) if !ALL_EFFECTS => unreachable!("nothing changes over time"),
            Some(modulation) => radiance * modulation.mean(lookup.uv, *interval),
        }
    }

    /// Mean radiance over a range of wavelengths and over the texture: how much this glow matters beside others, at the level 1.
    pub(crate) fn mean_radiance(&self, textures: &[ImageTexture], low_nm: f64, high_nm: f64) -> f64 {
        let texture = self.factor.map_or(1.0, |id| f64::from(textures[id.0 as usize].mean().element_sum()) / 3.0);
        self.radiance.band_mean(low_nm, high_nm) * texture
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::textures::{Sampling, Texels};
    use glam::Vec2;

    #[test]
    fn a_picture_in_candelas_glows_in_candelas() {
        let colour = [1200.0, 35.0, 400.0];
        let picture =
            ImageTexture::new(1, 1, Texels::Float(vec![colour]), Sampling::default()).expect("a picture above 1");
        let unit = upsample::emission_spectrum([1.0; 3]);
        let emission =
            Emission { radiance: unit, factor: Some(TextureId(0)), sides: EmissionSides::Front, modulation: None };
        let wavelengths = Wavelengths::<8>::uniform(380.0, 780.0, 0.3);
        let query = EmissionQuery { wavelengths: &wavelengths, interval: &TimeInterval::default() };
        let radiance = emission.at(&[picture], &Lookup::point(Vec2::ZERO), query);
        let expected = upsample::emission(colour, &wavelengths);
        for i in 0..8 {
            // Products of interpolated spectra, and the product interpolated: tables of D65 bend by 1e-3 over a nanometre.
            assert!((radiance[i] / expected[i] - 1.0).abs() < 2e-3, "{} {}", radiance[i], expected[i]);
        }
    }
}
