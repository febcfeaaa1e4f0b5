//! An image projected into space: a mask like a slide in front of the lamp of a projector.
//!
//! The image fills a field of a horizontal and a vertical full angle about +x. Its right edge is on the right as seen along +x, its top row up. A
//! unit direction (x, y, z) with x > 0 crosses it at (−y/x / tan(h/2), z/x / tan(v/2)), each in −1…1. The value is that of the texels, linear between
//! their centres, held from the outermost centres to the edge, and zero outside. It is a factor on the intensity: a plane across the axis receives
//! cos³ less off the axis, as behind any small lamp. Left out: colours, the blur of a real projector.

use core::f64::consts::PI;

use etendue_core::maths;
use glam::{DVec3, Vec2, Vec3};

use super::spread::{DirectionalExtent, GAUSS, ProfileNode};

/// Error of a mask.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaskImageError {
    /// The texels do not fill the image.
    #[error("the mask has {actual} texels, but its size is {width} × {height}; correct its size")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Number of texels given.
        actual: usize,
    },
    /// A texel is negative or not finite.
    #[error("texel {texel} of the mask is negative or not a finite number; correct the image")]
    Texel {
        /// Index of the texel, by rows from the top.
        texel: usize,
    },
    /// The field is out of range.
    #[error(
        "the mask's field is {}° × {}°; both angles must be between 0° and 180°",
        horizontal_rad.to_degrees(),
        vertical_rad.to_degrees()
    )]
    Field {
        /// Full horizontal angle, rad.
        horizontal_rad: f64,
        /// Full vertical angle, rad.
        vertical_rad: f64,
    },
}

/// A mask over a field. Its `Debug` text leaves out the texels.
#[derive(Clone, PartialEq)]
pub struct MaskImage {
    width: usize,
    height: usize,
    texels: Vec<f32>,
    /// Tangents of the half angles.
    half: Vec2,
    spread: DirectionalExtent,
}

impl core::fmt::Debug for MaskImage {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("MaskImage")
            .field("size", &(self.width, self.height))
            .field("half", &self.half)
            .field("spread", &self.spread)
            .finish_non_exhaustive()
    }
}

impl MaskImage {
    /// An image of factors, rows from the top, over a field of full angles.
    ///
    /// # Errors
    /// If the texels do not fill the image, one is negative or not finite, or an angle is not between 0 and π.
    pub fn new(
        width: usize,
        height: usize,
        texels: Vec<f32>,
        horizontal_rad: f64,
        vertical_rad: f64,
    ) -> Result<Self, MaskImageError> {
        if texels.is_empty() || texels.len() != width * height {
            return Err(MaskImageError::Size { width, height, actual: texels.len() });
        }
        if let Some(texel) = texels.iter().position(|t| !(t.is_finite() && *t >= 0.0)) {
            return Err(MaskImageError::Texel { texel });
        }
        if ![horizontal_rad, vertical_rad].iter().all(|a| *a > 1e-6 && *a < PI - 1e-6) {
            return Err(MaskImageError::Field { horizontal_rad, vertical_rad });
        }
        let half = [horizontal_rad, vertical_rad].map(|a| maths::f64::tan(0.5 * a) as f32);
        let mut image = Self { width, height, texels, half: Vec2::from(half), spread: DirectionalExtent::EVERYWHERE };
        let peak = image.texels.iter().copied().fold(0.0, f32::max);
        image.spread = DirectionalExtent { peak: f64::from(peak), ..DirectionalExtent::from_nodes(&image.nodes()) };
        Ok(image)
    }

    pub(super) fn value(&self, direction: Vec3) -> f32 {
        if direction.x <= 0.0 {
            return 0.0;
        }
        let place = Vec2::new(-direction.y, direction.z) / (direction.x * self.half);
        if place.abs().max_element() > 1.0 { 0.0 } else { self.at(place) }
    }

    /// The value at a place of the image: to the right and upwards, −1…1.
    fn at(&self, place: Vec2) -> f32 {
        let (w, h) = (self.width as f32, self.height as f32);
        let x = ((0.5 + 0.5 * place.x) * w - 0.5).clamp(0.0, w - 1.0);
        let y = ((0.5 - 0.5 * place.y) * h - 0.5).clamp(0.0, h - 1.0);
        let (column, row) = (x as usize, y as usize);
        let (s, t) = (x - column as f32, y - row as f32);
        let texel = |i: usize, j: usize| self.texels[j.min(self.height - 1) * self.width + i.min(self.width - 1)];
        let line = |j: usize| texel(column, j) + s * (texel(column + 1, j) - texel(column, j));
        line(row) + t * (line(row + 1) - line(row))
    }

    pub(super) fn spread(&self) -> &DirectionalExtent {
        &self.spread
    }

    /// Four directions in each of equal cells of the field. Cells end where the linear pieces do: at half texels.
    pub(super) fn nodes(&self) -> Vec<ProfileNode> {
        let (columns, rows) = (cells(self.width), cells(self.height));
        let size = self.half.as_dvec2() * 2.0 / glam::DVec2::new(columns as f64, rows as f64);
        let place = |i: usize, s: f64, count: usize| -1.0 + 2.0 * (i as f64 + s) / count as f64;
        let of_cell = |(i, j): (usize, usize)| {
            GAUSS.into_iter().flat_map(move |s| GAUSS.map(|t| (place(i, s, columns), place(j, t, rows))))
        };
        let node = |(x, y): (f64, f64)| {
            let long = DVec3::new(1.0, -x * f64::from(self.half.x), y * f64::from(self.half.y));
            let length = long.length();
            ProfileNode {
                direction: (long / length).as_vec3(),
                value: self.at(Vec2::new(x as f32, y as f32)),
                weight_sr: 0.25 * size.x * size.y / (length * length * length),
                spacing_rad: (size.x + size.y) as f32,
            }
        };
        (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))).flat_map(of_cell).map(node).collect()
    }
}

/// Cells along a side of `texels`: an even multiple, and 64 at least.
fn cells(texels: usize) -> usize {
    2 * texels * (32_usize.div_ceil(texels))
}
