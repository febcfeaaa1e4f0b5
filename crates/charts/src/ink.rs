//! Inks: materials of the pieces of a sheet, and their appearance in the chart's light.

use etendue_spectra::colour::{Lab, lab, linear_srgb_from_xyz};
use etendue_spectra::observer::{xyz, xyz_of_reflectance};
use etendue_spectra::{Spectrum, illuminant};

use crate::light::Light;

/// A named ink.
#[derive(Clone, Debug, PartialEq)]
pub struct Ink {
    /// Name in the mesh, the scene and the ground truth: letters, digits and `-`.
    pub name: String,
    /// Reflection or emission.
    pub paint: Paint,
}

/// Reflection or emission of an ink.
#[derive(Clone, Debug, PartialEq)]
pub enum Paint {
    /// Lambertian, the same reflectance at all wavelengths, 0 … 1.
    Grey(f64),
    /// Lambertian with a measured reflectance.
    Spectral(Spectrum),
    /// Self-luminous: this fraction of the light's luminance, in its spectrum. Reflects nothing.
    Luminous(f64),
    /// Self-luminous in pulses; the fraction is the mean over time.
    Pulses {
        /// Fraction of the light's luminance.
        fraction: f64,
        /// Pulse frequency, Hz.
        frequency_hz: f64,
        /// Fraction of the period that a pulse lasts.
        duty: f64,
        /// Start of the first pulse, s.
        delay_s: f64,
    },
    /// Lambertian with the reflectances of a texture of the drawing, and their mean.
    Texture {
        /// Index of the texture in the drawing's list.
        texture: usize,
        /// Mean reflectance.
        mean: f64,
    },
}

impl Ink {
    /// An ink.
    #[must_use]
    pub fn new(name: impl Into<String>, paint: Paint) -> Self {
        Self { name: name.into(), paint }
    }

    /// A grey ink.
    #[must_use]
    pub fn grey(name: impl Into<String>, reflectance: f64) -> Self {
        Self::new(name, Paint::Grey(reflectance))
    }

    /// Radiance of the ink under the light, W·m⁻²·sr⁻¹·nm⁻¹: reflectance × radiance of the perfect diffuser under uniform light
    /// from all directions.
    #[must_use]
    pub fn radiance(&self, light: &Light) -> Spectrum {
        match &self.paint {
            Paint::Grey(fraction)
            | Paint::Luminous(fraction)
            | Paint::Pulses { fraction, .. }
            | Paint::Texture { mean: fraction, .. } => light.radiance().scaled(*fraction),
            Paint::Spectral(reflectance) => light.radiance().product(reflectance),
        }
    }

    /// Luminance under the light, cd/m².
    #[must_use]
    pub fn luminance_cd_m2(&self, light: &Light) -> f64 {
        xyz(&self.radiance(light))[1]
    }

    /// Luminance relative to the perfect diffuser: the luminous reflectance.
    #[must_use]
    pub fn luminous_fraction(&self, light: &Light) -> f64 {
        match &self.paint {
            Paint::Grey(fraction)
            | Paint::Luminous(fraction)
            | Paint::Pulses { fraction, .. }
            | Paint::Texture { mean: fraction, .. } => *fraction,
            Paint::Spectral(reflectance) => xyz_of_reflectance(reflectance, light.spectrum())[1],
        }
    }

    /// Linear sRGB of its print, white 1, seen in daylight (D65), clamped to the gamut of a screen.
    #[must_use]
    pub fn print_rgb(&self) -> [f64; 3] {
        let own = match &self.paint {
            Paint::Spectral(reflectance) => linear_srgb_from_xyz(xyz_of_reflectance(reflectance, illuminant::d65())),
            Paint::Grey(fraction)
            | Paint::Luminous(fraction)
            | Paint::Pulses { fraction, .. }
            | Paint::Texture { mean: fraction, .. } => [*fraction; 3],
        };
        own.map(|v| v.clamp(0.0, 1.0))
    }

    /// CIE XYZ in the light, with Y = 1 for the perfect diffuser.
    #[must_use]
    pub fn xyz(&self, light: &Light) -> [f64; 3] {
        match &self.paint {
            Paint::Spectral(reflectance) => xyz_of_reflectance(reflectance, light.spectrum()),
            _ => light.white_xyz().map(|v| v * self.luminous_fraction(light)),
        }
    }

    /// CIELAB with the light itself as reference white.
    #[must_use]
    pub fn lab(&self, light: &Light) -> Lab {
        lab(self.xyz(light), light.white_xyz())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_spectra::reflectance::colorchecker;

    #[test]
    fn greys_and_spectra_are_shown_by_the_light() {
        let light = Light::named("D65", 1000.0).expect("an illuminant");
        let grey = Ink::grey("grey", 0.18);
        assert!((grey.luminance_cd_m2(&light) - 180.0).abs() < 1e-3);
        // L* = 116 (0.18)^(1/3) − 16 = 49.496.
        let lab = grey.lab(&light);
        assert!((lab.l - 49.496).abs() < 1e-3 && lab.a.abs() < 1e-6 && lab.b.abs() < 1e-6, "{lab:?}");
        let red = Ink::new("red", Paint::Spectral(colorchecker()[14].reflectance.clone()));
        let fraction = red.luminous_fraction(&light);
        assert!((red.luminance_cd_m2(&light) / 1000.0 / fraction - 1.0).abs() < 1e-5);
        // BabelColor's averages: the red patch is near L* 42, a* 54, b* 28.
        let lab = red.lab(&light);
        assert!((lab.l - 42.0).abs() < 2.5 && lab.a > 45.0 && lab.b > 18.0, "{lab:?}");
    }
}
