//! The light of a chart, the panel (a sheet with its pose in the world), and a camera's response to light.

use etendue_spectra::observer::{with_luminance, xyz_of_reflectance};
use etendue_spectra::{Spectrum, illuminant};
use glam::{DMat3, DVec2, DVec3};

use crate::{error::ChartError, shape::Sheet};

/// The light of a chart: an illuminant at a luminance, that of the perfect diffuser or of the brightest self-luminous ink.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    name: String,
    radiance: Spectrum,
    luminance_cd_m2: f64,
}

impl Light {
    /// Returns a tabulated illuminant at a luminance.
    ///
    /// # Errors
    /// If the name is not known or the luminance not above 0.
    pub fn named(name: &str, luminance_cd_m2: f64) -> Result<Self, ChartError> {
        let unknown =
            || ChartError::option("illuminant", name, format!("expected one of {}", illuminant::names().join(", ")));
        let spectrum = illuminant::by_name(name).ok_or_else(unknown)?;
        let is_valid = luminance_cd_m2.is_finite() && luminance_cd_m2 > 0.0;
        let radiance = with_luminance(spectrum, luminance_cd_m2).filter(|_| is_valid);
        let error = || ChartError::option("luminance_cd_m2", luminance_cd_m2, "expected a luminance above 0, cd/m²");
        Ok(Self { name: name.to_owned(), radiance: radiance.ok_or_else(error)?, luminance_cd_m2 })
    }

    /// Name of the illuminant.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Luminance, cd/m².
    #[must_use]
    pub fn luminance_cd_m2(&self) -> f64 {
        self.luminance_cd_m2
    }

    /// Radiance of the perfect diffuser, W·m⁻²·sr⁻¹·nm⁻¹.
    #[must_use]
    pub fn radiance(&self) -> &Spectrum {
        &self.radiance
    }

    /// CIE XYZ of the perfect diffuser, with Y = 1.
    #[must_use]
    pub fn white_xyz(&self) -> [f64; 3] {
        xyz_of_reflectance(&Spectrum::constant(1.0), &self.radiance)
    }

    /// The spectrum, at an arbitrary scale.
    pub(crate) fn spectrum(&self) -> &Spectrum {
        &self.radiance
    }
}

/// A camera's response to light, at the image centre.
pub struct CameraResponse<'a> {
    /// Exposure that its file describes, s.
    pub exposure_s: f64,
    /// Maximum exposure that it allows, s.
    pub longest_s: Option<f64>,
    /// Electrons at which a pixel or its ADC saturates.
    pub saturation_e: f64,
    /// Mean electrons of each channel in that exposure, by channel name, for a uniform radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    pub electrons: &'a dyn Fn(&Spectrum) -> Vec<(String, f64)>,
}

impl CameraResponse<'_> {
    /// Electrons of the strongest channel relative to saturation, for a radiance.
    #[must_use]
    pub fn saturation_fraction(&self, radiance: &Spectrum) -> f64 {
        (self.electrons)(radiance).iter().map(|(_, e)| *e).fold(0.0, f64::max) / self.saturation_e
    }
}

/// A sheet with its pose in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Name, which is that of its mesh.
    pub name: String,
    pub sheet: Sheet,
    /// Position of its centre, m.
    pub position_m: DVec3,
    /// Columns: the directions in the world of the sheet's x, its y, and the direction behind it.
    pub rotation: DMat3,
}

impl Panel {
    /// A sheet perpendicular to the axis of a camera at the origin that looks along +x.
    #[must_use]
    pub fn facing(name: impl Into<String>, sheet: Sheet, distance_m: f64) -> Self {
        let rotation = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
        Self { name: name.into(), sheet, position_m: DVec3::X * distance_m, rotation }
    }

    /// A point of the sheet (mm) in the world, m.
    #[must_use]
    pub fn world_m(&self, point_mm: DVec2) -> DVec3 {
        self.position_m + self.local_m(point_mm)
    }

    /// The same relative to the sheet's centre: a point of its mesh.
    #[must_use]
    pub fn local_m(&self, point_mm: DVec2) -> DVec3 {
        self.rotation * (point_mm / 1e3).extend(0.0)
    }
}
