//! Environment lights of a scene before they are joined.

use etendue_scene::record::LightColour;
use etendue_spectra::{Spectrum, colour::linear_srgb_from_xyz, observer};
use glam::DVec3;

/// Environment light.
pub(crate) enum InfiniteLight {
    Uniform(UniformLight),
    Image(ImageLight),
}

/// Equal light from all directions.
pub(crate) struct UniformLight {
    pub(crate) colour: LightColour,
    pub(crate) luminance_cd_m2: f64,
    /// Relative spectrum.
    pub(crate) spectrum: Spectrum,
}

/// Image of the sphere.
pub(crate) struct ImageLight {
    /// Red, green and blue from a unit direction of our world.
    pub(crate) radiance: Box<dyn Fn(DVec3) -> [f64; 3]>,
    /// Rows of an equirectangular image that is as fine.
    pub(crate) rows: usize,
    /// Luminance of 1.
    pub(crate) scale_cd_m2: f64,
}

impl UniformLight {
    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    pub(crate) fn radiance(&self) -> Spectrum {
        observer::with_luminance(&self.spectrum, self.luminance_cd_m2).unwrap_or_else(|| Spectrum::constant(0.0))
    }

    /// Linear sRGB, in which white of 1 is 1 cd/m².
    pub(crate) fn linear_srgb(&self) -> [f64; 3] {
        linear_srgb_from_xyz(observer::xyz(&self.radiance()))
    }
}
