//! Images of textures as linear numbers, and their values between pixels.

use std::path::{Path, PathBuf};

use etendue_core::maths::f64 as maths;
use etendue_io::picture::read_foreign_image;
use etendue_spectra::colour::decode;

use super::super::stored::stored_pixels;

/// Encoding of the numbers of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ImageEncoding {
    Linear,
    Srgb,
    /// Power of the stored numbers.
    Gamma(f64),
}

impl ImageEncoding {
    fn decoded(self, stored: f32) -> f64 {
        match self {
            Self::Linear => f64::from(stored),
            Self::Srgb => f64::from(decode(stored)),
            Self::Gamma(exponent) => maths::pow(f64::from(stored).max(0.0), exponent),
        }
    }
}

/// Continuation of an image beyond its borders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ImageWrap {
    Repeat,
    Clamp,
    Black,
}

/// Format of an image by the end of its name, as pbrt decides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ImageFormat(String);

impl ImageFormat {
    pub(crate) fn from_name(name: &str) -> Self {
        Self(name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase())
    }

    /// Returns true if its numbers are linear.
    pub(crate) fn is_linear(&self) -> bool {
        matches!(self.0.as_str(), "exr" | "hdr" | "pfm")
    }

    pub(crate) fn is_png(&self) -> bool {
        self.0 == "png"
    }

    /// Returns true if a written scene can name such a file.
    pub(crate) fn is_ours(&self) -> bool {
        matches!(self.0.as_str(), "png" | "jpg" | "jpeg" | "hdr" | "exr")
    }

    /// Returns true if pbrt can read it.
    pub(crate) fn is_known(&self) -> bool {
        self.is_ours() || matches!(self.0.as_str(), "pfm" | "qoi" | "tga" | "bmp" | "ppm" | "pgm" | "pnm")
    }

    /// Returns true if pbrt keeps its opacity.
    pub(crate) fn has_opacity(&self) -> bool {
        matches!(self.0.as_str(), "png" | "exr" | "qoi")
    }
}

/// Reads an image of a light; the error names the file.
pub(crate) fn read_light_image(file: &Path) -> Result<LinearImage, String> {
    let is_linear = ImageFormat::from_name(&file.to_string_lossy()).is_linear();
    let encoding = if is_linear { ImageEncoding::Linear } else { ImageEncoding::Srgb };
    LinearImage::read(file, encoding, ImageUse::Colours)
}

/// Linear image; its first row is the top one.
pub(crate) struct LinearImage {
    pub(crate) columns: usize,
    pub(crate) rows: usize,
    /// Red, green, blue; all are the number for an image of numbers.
    pixels: Vec<[f32; 3]>,
}

/// Use of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ImageUse {
    Colours,
    /// Its opacity if it has transparent parts, else the mean of its colours.
    Numbers,
}

impl LinearImage {
    /// Reads an image; the error names the file.
    pub(crate) fn read(file: &Path, encoding: ImageEncoding, usage: ImageUse) -> Result<Self, String> {
        let image = read_foreign_image(file).map_err(|e| e.to_string())?.in_rec_709();
        let stored = stored_pixels(&image);
        let format = ImageFormat::from_name(&file.to_string_lossy());
        let is_opacity = usage == ImageUse::Numbers && format.has_opacity() && stored.iter().any(|p| p[3] != 1.0);
        let pixel = |[r, g, b, a]: [f32; 4]| {
            let rgb = [r, g, b].map(|v| encoding.decoded(v));
            match usage {
                ImageUse::Colours => rgb.map(|v| v as f32),
                ImageUse::Numbers if is_opacity => [a; 3],
                ImageUse::Numbers => [(rgb.iter().sum::<f64>() / 3.0) as f32; 3],
            }
        };
        let (columns, rows) = (image.width as usize, image.height as usize);
        Ok(Self { columns, rows, pixels: stored.into_iter().map(pixel).collect() })
    }

    /// Pixel by its index, row by row.
    pub(crate) fn pixel_at(&self, index: usize) -> [f32; 3] {
        self.pixels[index]
    }

    /// Bilinear value at texture coordinates; t = 0 is the lower border.
    pub(crate) fn at(&self, [s, t]: [f64; 2], wrap: ImageWrap) -> [f64; 3] {
        let (x, y) = (s * self.columns as f64 - 0.5, (1.0 - t) * self.rows as f64 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let corner = |dx: f64, dy: f64, weight: f64| match weight {
            0.0 => [0.0; 3],
            _ => self.pixel(x0 + dx, y0 + dy, wrap).map(|v| weight * f64::from(v)),
        };
        let corners = [
            corner(0.0, 0.0, (1.0 - fx) * (1.0 - fy)),
            corner(1.0, 0.0, fx * (1.0 - fy)),
            corner(0.0, 1.0, (1.0 - fx) * fy),
            corner(1.0, 1.0, fx * fy),
        ];
        std::array::from_fn(|i| corners.iter().map(|corner| corner[i]).sum())
    }

    fn pixel(&self, x: f64, y: f64, wrap: ImageWrap) -> [f32; 3] {
        let inside = |v: f64, count: usize| match wrap {
            ImageWrap::Repeat => Some((v.rem_euclid(count as f64) as usize).min(count - 1)),
            ImageWrap::Clamp => Some(v.clamp(0.0, count as f64 - 1.0) as usize),
            ImageWrap::Black => (v >= 0.0 && v < count as f64).then_some(v as usize),
        };
        match (inside(x, self.columns), inside(y, self.rows)) {
            (Some(column), Some(row)) => self.pixels[row * self.columns + column],
            _ => [0.0; 3],
        }
    }
}

/// Content of an image of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NumberImage {
    /// Transparent parts: pbrt uses the opacity.
    Opacity,
    Grey,
    Colours,
}

/// Reads what an image of numbers holds; the error names the file.
pub(crate) fn number_image(file: &Path) -> Result<NumberImage, String> {
    let stored = stored_pixels(&read_foreign_image(file).map_err(|e| e.to_string())?);
    let format = ImageFormat::from_name(&file.to_string_lossy());
    let is_opacity = format.has_opacity() && stored.iter().any(|p| p[3] != 1.0);
    let is_grey = stored.iter().all(|[r, g, b, _]| r == g && g == b);
    Ok(if is_opacity {
        NumberImage::Opacity
    } else if is_grey {
        NumberImage::Grey
    } else {
        NumberImage::Colours
    })
}

/// Image file of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ImageFile {
    pub(crate) path: PathBuf,
    pub(crate) encoding: ImageEncoding,
}
