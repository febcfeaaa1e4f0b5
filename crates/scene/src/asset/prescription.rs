//! A lens by its surfaces, as lens files give it.

/// Number of aspheric terms: r², r⁴ … r²⁰, as CODE V has them.
pub const ASPHERE_TERMS: usize = 10;

/// A prescription in a file: surfaces from the scene to the sensor, without object and image.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescriptionAsset {
    /// What the file calls it; may be empty.
    pub title: String,
    /// Surfaces; those that neither refract nor have an opening that stops light are left out, their thickness added to the one before.
    pub surfaces: Vec<SurfaceAsset>,
    /// Distance of the object before the first surface, mm; infinite for a distant one.
    pub object_distance_mm: f64,
    /// Distance of the image behind the last surface, mm; 0 where the file leaves it to be found.
    pub back_focus_mm: f64,
    /// Where the file leaves the image to be found: how far behind the paraxial image it is looked at, mm.
    pub defocus_mm: f64,
    /// How far the lens opens; `None` where the stop's own aperture says it.
    pub opening: Option<LensOpening>,
    /// The file's line that says so, from 1; 0 where none does.
    pub opening_line: usize,
    /// The field points of the file.
    pub fields: Option<LensFields>,
    /// Vignetting factors by field: the share of the pupil's radius taken off at its upper and its lower end; 0 where none is stated.
    pub vignetting: [Vec<f64>; 2],
    /// The wavelengths of the file, nm.
    pub wavelengths_nm: Vec<f64>,
    /// The file's primary wavelength, nm: that of its focal length, f-number and paraxial image; `None` where it states none.
    pub primary_nm: Option<f64>,
    /// What was not taken as it stands in the file, and why: with the line.
    pub notes: Vec<String>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// A surface and the space behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceAsset {
    /// Radius of curvature, mm, positive where the centre lies towards the sensor; infinite for a plane.
    pub radius_mm: f64,
    /// Conic constant.
    pub conic: f64,
    /// Coefficients of r², r⁴ … r²⁰, mm^(1 − 2i).
    pub asphere: [f64; ASPHERE_TERMS],
    /// Clear semi-aperture, mm; `None` where the file leaves it to be found from the light.
    pub semi_aperture_mm: Option<f64>,
    /// Whether that opening stops light by the file's own statement (Zemax CLAP and FLAP, CODE V CIR), and is not a size for drawing (DIAM).
    pub rim: bool,
    /// Distance to the next surface (from the last one: to the image), mm.
    pub thickness_mm: f64,
    /// What fills that space.
    pub glass: GlassAsset,
    /// Whether this is the aperture stop.
    pub stop: bool,
    /// The file's line that begins it, from 1.
    pub line: usize,
}

/// What fills the space behind a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum GlassAsset {
    /// Air.
    Air,
    /// A glass of a maker's catalogue, by the name that [`etendue_spectra::glass`] has for it.
    Named(String),
    /// A medium of one index.
    Index(f64),
    /// A glass known by n_d and V_d.
    Abbe {
        /// n_d.
        index: f64,
        /// V_d.
        abbe: f64,
    },
}

/// How far a lens opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LensOpening {
    /// Diameter of the entrance pupil, mm.
    EntrancePupil {
        /// The diameter, mm.
        diameter_mm: f64,
    },
    /// f-number for an object at infinity.
    FNumber {
        /// The number.
        f_number: f64,
    },
    /// The cone of light from the axial point of the object.
    ObjectCone {
        /// Sine of its half angle.
        sine: f64,
    },
    /// The cone of light to the axial point of the image, wherever the object stands.
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
