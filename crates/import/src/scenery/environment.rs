//! Light from infinity, brought into our equirectangular pictures.

use super::stage::Scenery;
use etendue_core::maths::f64 as maths;
use etendue_io::Provenance;
use etendue_io::exr::{Layer, encode_layers};
use etendue_scene::asset::{ImageAsset, ImagePixels};
use glam::DVec3;
use std::f64::consts::PI;

/// Red, green and blue from a direction of our world of length 1.
pub(crate) type Found<'a> = dyn Fn(DVec3) -> [f64; 3] + 'a;

/// A pixel by its number, row by row.
pub(crate) type Pixels<'a> = Box<dyn Fn(usize) -> [f32; 3] + 'a>;

/// The pixels of a picture of linear numbers; `None` of another.
pub(crate) fn linear_pixels(image: &ImageAsset) -> Option<Pixels<'_>> {
    match &image.pixels {
        ImagePixels::Rgb32F(pixels) => Some(Box::new(|i| pixels[i])),
        ImagePixels::Rgba32F(pixels) => Some(Box::new(|i| [pixels[i][0], pixels[i][1], pixels[i][2]])),
        _ => None,
    }
}

impl Scenery {
    /// Writes a picture of the sphere with `rows` rows; its path.
    pub(crate) fn environment_file(&mut self, rows: usize, found: &Found<'_>) -> Result<String, String> {
        let channels = resampled(rows, found);
        let layers: Vec<(String, Layer<'_>)> = ["B", "G", "R"]
            .iter()
            .zip([&channels[2], &channels[1], &channels[0]])
            .map(|(n, c)| ((*n).to_owned(), Layer::Float(c)))
            .collect();
        let bytes = encode_layers(2 * rows, rows, &layers, &Provenance::default()).map_err(|e| e.to_string())?;
        let name = self.file_names.take("environment", "environment");
        let path = self.add_file(format!("{name}.exr"), bytes);
        self.check_size()?;
        Ok(path)
    }
}

/// Red, green and blue of `rows` rows of twice as many columns, each the mean of four by four points.
pub(crate) fn resampled(rows: usize, found: &Found<'_>) -> [Vec<f32>; 3] {
    const POINTS: usize = 4;
    let columns = 2 * rows;
    let mut channels = [(); 3].map(|()| Vec::with_capacity(rows * columns));
    for row in 0..rows {
        for column in 0..columns {
            let mut sum = [0.0; 3];
            for point in 0..POINTS * POINTS {
                let along = |pixel: usize, i: usize| pixel as f64 + (i as f64 + 0.5) / POINTS as f64;
                let azimuth = PI * (1.0 - along(column, point % POINTS) / rows as f64);
                let elevation = PI * (0.5 - along(row, point / POINTS) / rows as f64);
                let ((sa, ca), (se, ce)) = (maths::sin_cos(azimuth), maths::sin_cos(elevation));
                let here = found(DVec3::new(ce * ca, ce * sa, se));
                sum = std::array::from_fn(|i| sum[i] + here[i]);
            }
            for (channel, sum) in channels.iter_mut().zip(sum) {
                channel.push((sum / (POINTS * POINTS) as f64) as f32);
            }
        }
    }
    channels
}
