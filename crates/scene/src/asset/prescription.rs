//! A lens given by its surfaces, from a lens file.

use std::path::PathBuf;

use etendue_spectra::glass::agf::{AgfCatalogue, AgfError};
use etendue_spectra::glass::{CatalogueGlass, Dispersion, plain};

/// Number of aspheric terms: r², r⁴ … r²⁰, as CODE V has them.
pub const ASPHERE_TERMS: usize = 10;

/// A prescription in a file: surfaces from the scene to the sensor, without object and image.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescriptionAsset {
    /// Title in the file; may be empty.
    pub title: String,
    /// Surfaces. Those that neither refract, reflect nor stop light are omitted, and their thickness is added to the preceding one.
    pub surfaces: Vec<SurfaceAsset>,
    /// Distance of the object before the first surface, mm; infinite for a distant one.
    pub object_distance_mm: f64,
    /// Distance of the image behind the last surface, mm; 0 where the file leaves it to be computed.
    pub back_focus_mm: f64,
    /// Distance of the image plane behind the paraxial image, mm, where the file leaves the image to be computed.
    pub defocus_mm: f64,
    /// Aperture of the lens; `None` if it is given by the stop's own aperture.
    pub opening: Option<LensOpening>,
    /// Line of the file that states it, from 1; 0 if there is none.
    pub opening_line: usize,
    /// The field points of the file.
    pub fields: Option<LensFields>,
    /// Vignetting factors by field: fraction of the pupil's radius removed at its upper and its lower end; 0 if not stated.
    pub vignetting: [Vec<f64>; 2],
    /// The wavelengths of the file, nm.
    pub wavelengths_nm: Vec<f64>,
    /// Primary wavelength of the file, nm: that of its focal length, f-number and paraxial image; `None` if not stated.
    pub primary_nm: Option<f64>,
    /// Content of the file that was changed, and the reason, with the line.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// A surface and the space behind it, in the unfolded lens: light travels towards +z everywhere, so that after an odd number of mirrors curvatures, sags
/// and distances have the opposite sign of those in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceAsset {
    /// True for a mirror; its medium is that of the space before it.
    pub mirror: bool,
    /// Focal length of an ideal thin lens in the vertex plane, mm.
    pub thin_lens_mm: Option<f64>,
    /// Radius of curvature, mm, positive where the centre lies behind the surface as the light meets it; infinite for a plane.
    pub radius_mm: f64,
    /// Conic constant.
    pub conic: f64,
    /// Coefficients of r², r⁴ … r²⁰, mm^(1 − 2i).
    pub asphere: [f64; ASPHERE_TERMS],
    /// Clear semi-aperture, mm; `None` where the file leaves it to be computed from the light.
    pub semi_aperture_mm: Option<f64>,
    /// Radius within which the surface stops light, mm; 0 for none.
    pub obscured_radius_mm: f64,
    /// True if the file states that this aperture clips light (Zemax CLAP and FLAP, CODE V CIR); false for a drawing size (DIAM).
    pub clips_light: bool,
    /// Distance to the next surface (from the last one: to the image), mm.
    pub thickness_mm: f64,
    /// Medium of that space.
    pub glass: GlassAsset,
    /// True for the aperture stop.
    pub stop: bool,
    /// Line of the file at which it begins, from 1.
    pub line: usize,
}

/// Medium of the space behind a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum GlassAsset {
    Air,
    /// A glass of a catalogue.
    Named(Box<NamedGlass>),
    /// A medium with a constant index.
    Index(f64),
    /// A glass given by n_d and V_d.
    Abbe {
        /// n_d.
        index: f64,
        /// V_d.
        abbe: f64,
    },
}

/// A glass of a catalogue that is built in or given as a file.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedGlass {
    /// Its name in the catalogue.
    pub name: String,
    /// Maker, or name of the catalogue's file.
    pub catalogue: String,
    /// Dispersion.
    pub dispersion: Dispersion,
}

impl NamedGlass {
    /// A glass of a built-in catalogue.
    #[must_use]
    pub fn built_in(glass: &CatalogueGlass) -> Self {
        Self { name: glass.name.to_owned(), catalogue: glass.maker.to_owned(), dispersion: glass.dispersion }
    }
}

/// A glass catalogue given as a file.
#[derive(Clone, Debug, PartialEq)]
pub struct GlassCatalogueAsset {
    /// The file.
    pub file: PathBuf,
    /// Its glasses.
    pub catalogue: AgfCatalogue,
    /// Hash of its bytes.
    pub hash: [u8; 32],
}

impl GlassCatalogueAsset {
    /// The glass of a name, whose hyphens, blanks and capitals may differ; `None` if the catalogue does not have it.
    ///
    /// # Errors
    /// The file has the glass, but its record cannot be used.
    pub fn find(&self, name: &str) -> Result<Option<NamedGlass>, AgfError> {
        let is_match = |other: &str| plain(other) == plain(name);
        if let Some(glass) = self.catalogue.glasses.iter().find(|glass| is_match(&glass.name)) {
            let catalogue = self.file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            return Ok(Some(NamedGlass { name: glass.name.clone(), catalogue, dispersion: glass.dispersion }));
        }
        let unusable = self.catalogue.unusable.iter().find(|(other, _)| is_match(other));
        unusable.map_or(Ok(None), |(_, error)| Err(error.clone()))
    }
}

/// Aperture of a lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensOpening {
    /// Diameter of the entrance pupil, mm.
    EntrancePupil { diameter_mm: f64 },
    /// f-number for an object at infinity.
    FNumber {
        /// The f-number.
        f_number: f64,
    },
    /// The cone of light from the axial point of the object.
    ObjectCone {
        /// Sine of its half angle.
        sine: f64,
    },
    /// The cone of light to the axial point of the image, for any object distance.
    ImageCone {
        /// Sine of its half angle.
        sine: f64,
    },
}

/// Field points across the meridian.
#[derive(Clone, Debug, PartialEq)]
pub enum LensFields {
    /// Angles from the axis in front of the lens, degrees.
    AnglesDeg(Vec<f64>),
    /// Heights of the object, mm.
    ObjectMm(Vec<f64>),
    /// Heights of the image, mm.
    ImageMm(Vec<f64>),
}
