//! Conversion of environment maps to our equirectangular images.

use std::f64::consts::{PI, TAU};

use etendue_core::maths::f64 as maths;
use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, encode_layers};
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_scene::{record::Environment, record::environment::EnvironmentImage};
use glam::{DMat3, DVec3};

use super::stage::SceneBuilder;
use crate::naming::{azimuth_elevation_deg, rounded};

/// Red, green and blue from a unit direction of our world.
pub(crate) type RadianceFn<'a> = dyn Fn(DVec3) -> [f64; 3] + 'a;

/// Pixel by its index, row by row.
pub(crate) type Pixels<'a> = Box<dyn Fn(usize) -> [f32; 3] + 'a>;

/// Pixels of an image of linear numbers; `None` for others.
pub(crate) fn linear_pixels(image: &ImageAsset) -> Option<Pixels<'_>> {
    match &image.pixels {
        ImagePixels::Rgb32F(pixels) => Some(Box::new(|i| pixels[i])),
        ImagePixels::Rgba32F(pixels) => Some(Box::new(|i| [pixels[i][0], pixels[i][1], pixels[i][2]])),
        _ => None,
    }
}

impl SceneBuilder {
    /// Writes an image of the sphere with `rows` rows; returns its path.
    pub(crate) fn environment_file(&mut self, rows: usize, radiance: &RadianceFn<'_>) -> Result<String, String> {
        let channels = resampled(rows, radiance);
        let layers: Vec<(String, ExrLayer<'_>)> = ["B", "G", "R"]
            .iter()
            .zip([&channels[2], &channels[1], &channels[0]])
            .map(|(n, c)| ((*n).to_owned(), ExrLayer::Float(c)))
            .collect();
        let bytes = encode_layers(2 * rows, rows, &layers, &Provenance::default()).map_err(|e| e.to_string())?;
        let name = self.file_names.take("environment", "environment");
        let path = self.add_file(format!("{name}.exr"), bytes);
        self.check_size()?;
        Ok(path)
    }
}

/// Red, green and blue of `rows` rows and twice as many columns, each the mean of four by four points.
pub(crate) fn resampled(rows: usize, radiance: &RadianceFn<'_>) -> [Vec<f32>; 3] {
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
                let here = radiance(DVec3::new(ce * ca, ce * sa, se));
                sum = std::array::from_fn(|i| sum[i] + here[i]);
            }
            for (channel, sum) in channels.iter_mut().zip(sum) {
                channel.push((sum / (POINTS * POINTS) as f64) as f32);
            }
        }
    }
    channels
}

/// Equirectangular image, with the first row at the top.
pub(crate) struct LightImage<'a> {
    /// Name in the file.
    pub(crate) shown: &'a str,
    /// Name in the written scene.
    pub(crate) path: &'a str,
    pub(crate) columns: usize,
    /// Pixels by index.
    pub(crate) pixel: &'a dyn Fn(usize) -> [f32; 3],
}

impl SceneBuilder {
    /// Environment of an image of `rows` rows, in which 1 is `scale` cd/m². `turn` transforms our image space (the middle column is +x, the top +z) to our
    /// world, and may mirror. An upright image is referenced; others are resampled.
    pub(crate) fn light_image(
        &mut self,
        image: &LightImage<'_>,
        rows: usize,
        turn: DMat3,
        scale: f64,
    ) -> Result<Environment, String> {
        let LightImage { shown, path, columns, pixel } = *image;
        if is_upright(&turn) {
            let [azimuth, _] = azimuth_elevation_deg(turn.x_axis);
            let [degrees, ..] = rounded([azimuth, 0.0, 0.0]);
            self.report.note(format!("environment map `{shown}`: 1 is {scale} cd/m²"));
            let image = EnvironmentImage::new(path, scale);
            let rotation_deg = (degrees != 0.0).then(|| degrees.into());
            return Ok(Environment::Image(EnvironmentImage { rotation_deg, ..image }));
        }
        let to_picture = turn.transpose();
        let radiance = |direction: DVec3| {
            let d = to_picture * direction;
            let [across, down] = [0.5 - maths::atan2(d.y, d.x) / TAU, maths::acos(d.z.clamp(-1.0, 1.0)) / PI];
            bilinear(pixel, [columns, rows], [across * columns as f64 - 0.5, down * rows as f64 - 0.5])
        };
        let written = self.environment_file(rows, &radiance)?;
        self.report.note(format!("environment map `{shown}`: rotated and resampled, 1 is {scale} cd/m²"));
        Ok(Environment::Image(EnvironmentImage::new(written.as_str(), scale)))
    }
}

/// Returns true if `turn` of [`SceneBuilder::light_image`] leaves the image upright and not mirrored: no resampling is needed.
pub(crate) fn is_upright(turn: &DMat3) -> bool {
    (turn.z_axis - DVec3::Z).length() < 1e-9 && turn.determinant() > 0.0
}

/// Bilinear interpolation: columns wrap around, rows end at the poles.
fn bilinear(pixel: &dyn Fn(usize) -> [f32; 3], [columns, rows]: [usize; 2], [x, y]: [f64; 2]) -> [f64; 3] {
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let at = |dx: f64, dy: f64| {
        let column = (x0 + dx).rem_euclid(columns as f64) as usize;
        let row = (y0 + dy).clamp(0.0, (rows - 1) as f64) as usize;
        pixel(row * columns + column.min(columns - 1)).map(f64::from)
    };
    let [a, b, c, d] = [at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(1.0, 1.0)];
    std::array::from_fn(|i| (1.0 - fy) * ((1.0 - fx) * a[i] + fx * b[i]) + fy * ((1.0 - fx) * c[i] + fx * d[i]))
}

/// Rotation from another program's world to ours, from a camera's axes there (columns: right, up, forward, as in its image). The axis nearest to the camera's
/// up points upwards, the next one (x, y, z, x) forward, and the image is not mirrored.
pub(crate) fn to_ours(camera: DMat3) -> DMat3 {
    let up = camera.y_axis;
    let size = up.abs();
    let axis = if size.z >= size.x && size.z >= size.y { 2 } else { usize::from(size.y >= size.x) };
    let unit = |i: usize| DVec3::from_array(std::array::from_fn(|j| f64::from(u8::from(i == j))));
    let (ahead, up) = (unit((axis + 1) % 3), unit(axis) * up[axis].signum());
    // Right, up, forward is left-handed in a right-handed world.
    let left = up.cross(ahead) * if camera.determinant() > 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(ahead, left, up).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_right_handed_world_is_turned_and_a_left_handed_one_mirrored() {
        // The camera looks along −z with y upwards, as in most right-handed scenes: right is x.
        let right_handed = to_ours(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::NEG_Z));
        assert_eq!(right_handed * DVec3::Z, DVec3::X);
        assert_eq!(right_handed * DVec3::X, DVec3::Y);
        assert_eq!(right_handed * DVec3::Y, DVec3::Z);
        // The camera looks along z, right is x: left-handed.
        let left_handed = to_ours(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::Z));
        assert_eq!(left_handed * DVec3::Z, DVec3::X);
        assert_eq!(left_handed * DVec3::X, DVec3::NEG_Y);
    }
}
