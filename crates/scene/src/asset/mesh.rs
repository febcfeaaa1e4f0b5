//! Contents of meshes, images and spectra.

use std::path::PathBuf;

use etendue_spectra::{Extrapolation, Spectrum, SpectrumError};

use super::mtl::SlotMaterial;

/// A triangle mesh in the axes and units of its file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshAsset {
    /// Origin of the vertices, in units of the file: zero, or the middle of a mesh so far from the file's origin that 32 bits would round its
    /// vertices noticeably.
    pub origin: [f64; 3],
    /// Vertices relative to `origin`, in units of the file.
    pub positions: Vec<[f32; 3]>,
    /// Normals of the vertices, of any length above 0; none, or one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, v upwards; none, or one per vertex.
    pub uvs: Vec<[f32; 2]>,
    /// Indices of vertices, counter-clockwise as seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// The material slot of each triangle: an index to `slot_materials`.
    pub slots: Vec<u16>,
    /// Materials, by their names in the file.
    pub slot_materials: Vec<SlotMaterial>,
    /// Images embedded in the file, by their names among the images of the assets.
    pub embedded_images: Vec<(PathBuf, ImageAsset)>,
    /// Content that was read and not used, in sentences for the user: fields without meaning here, dropped triangles.
    pub report: Vec<String>,
    /// Causes of differences from the appearance that the file intends, in sentences for the user.
    pub warnings: Vec<String>,
    /// Missing material libraries that the file names, one sentence each with its line.
    pub missing_libraries: Vec<String>,
    /// SHA-256 of the contents of the file and of the material files it names.
    pub hash: [u8; 32],
}

impl MeshAsset {
    /// True for each slot with a triangle; if no triangle states its slot, true for all.
    #[must_use]
    pub fn shown_slots(&self) -> Vec<bool> {
        let mut is_visible = vec![self.slots.is_empty(); self.slot_materials.len()];
        for slot in &self.slots {
            if let Some(is_visible) = is_visible.get_mut(usize::from(*slot)) {
                *is_visible = true;
            }
        }
        is_visible
    }
}

/// An image; its first row is the top one.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageAsset {
    /// Width, px.
    pub width: u32,
    /// Height, px.
    pub height: u32,
    /// Pixels, row by row.
    pub pixels: ImagePixels,
    /// Conversion from the file's colours to Rec. 709; `None` if they are Rec. 709.
    pub to_rec_709: Option<ColourMatrix>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

/// Converts linear colours from other primaries, row by row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourMatrix(pub [[f64; 3]; 3]);

impl ColourMatrix {
    /// Converts a linear colour.
    #[must_use]
    pub fn apply(&self, colour: [f32; 3]) -> [f32; 3] {
        let [r, g, b] = colour.map(f64::from);
        self.0.map(|row| (row[0] * r + row[1] * g + row[2] * b) as f32)
    }
}

impl ImageAsset {
    /// Converts the image's colours to Rec. 709.
    #[must_use]
    pub fn in_rec_709(mut self) -> Self {
        if let Some(matrix) = self.to_rec_709.take() {
            match &mut self.pixels {
                ImagePixels::Rgb32F(pixels) => pixels.iter_mut().for_each(|p| *p = matrix.apply(*p)),
                ImagePixels::Rgba32F(pixels) => {
                    for [r, g, b, _] in pixels {
                        [*r, *g, *b] = matrix.apply([*r, *g, *b]);
                    }
                }
                ImagePixels::Gray8(_) | ImagePixels::Gray16(_) | ImagePixels::Rgb8(_) | ImagePixels::Rgba8(_) => {}
            }
        }
        self
    }
}

/// Pixels as stored in the file; the description gives their meaning.
#[derive(Clone, Debug, PartialEq)]
pub enum ImagePixels {
    /// One channel, 0 … 255.
    Gray8(Vec<u8>),
    /// One channel, 0 … 65 535.
    Gray16(Vec<u16>),
    /// Red, green, blue, 0 … 255.
    Rgb8(Vec<[u8; 3]>),
    /// Red, green, blue, opacity, 0 … 255.
    Rgba8(Vec<[u8; 4]>),
    /// Red, green, blue: linear values, or 0 … 1 as encoded in a 16-bit image.
    Rgb32F(Vec<[f32; 3]>),
    /// As [`Self::Rgb32F`], with opacity: a linear value.
    Rgba32F(Vec<[f32; 4]>),
}

impl ImagePixels {
    /// Number of pixels.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Gray8(p) => p.len(),
            Self::Gray16(p) => p.len(),
            Self::Rgb8(p) => p.len(),
            Self::Rgba8(p) => p.len(),
            Self::Rgb32F(p) => p.len(),
            Self::Rgba32F(p) => p.len(),
        }
    }

    /// True if there are no pixels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A tabulated spectrum, as stored in the file. Its values outside the table depend on its use.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpectrumAsset {
    /// Wavelength in nm, increasing, and value.
    pub points: Vec<(f64, f64)>,
    /// SHA-256 of the file.
    pub hash: [u8; 32],
}

impl SpectrumAsset {
    /// Returns the spectrum, extended as its use requires: emissions and sensitivities are zero outside the table, reflectances hold their end
    /// values.
    ///
    /// # Errors
    /// The points are no function of wavelength.
    pub fn spectrum(&self, outside: Extrapolation) -> Result<Spectrum, SpectrumError> {
        Spectrum::from_points(&self.points, outside)
    }
}
