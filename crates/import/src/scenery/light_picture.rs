//! Pictures of light from infinity that are turned.

use super::stage::Scenery;
use crate::naming::{azimuth_elevation_deg, rounded};
use etendue_core::maths::f64 as maths;
use etendue_scene::record::Environment;
use etendue_scene::record::environment::EnvironmentImage;
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};

/// An equirectangular picture, the first row at the top.
pub(crate) struct LightPicture<'a> {
    /// As the file calls it.
    pub(crate) shown: &'a str,
    /// As the written scene names it.
    pub(crate) path: &'a str,
    pub(crate) columns: usize,
    /// Pixels by their numbers.
    pub(crate) pixel: &'a dyn Fn(usize) -> [f32; 3],
}

impl Scenery {
    /// The environment of a picture of `rows` rows, in which 1 is `scale` cd/m²; `turn` leads from the space of our pictures (the middle column is +x, the
    /// top +z) to our world, and may mirror. It is named where it lies where it is upright, else resampled.
    pub(crate) fn light_picture(
        &mut self,
        picture: &LightPicture<'_>,
        rows: usize,
        turn: DMat3,
        scale: f64,
    ) -> Result<Environment, String> {
        let LightPicture { shown, path, columns, pixel } = *picture;
        if is_upright(&turn) {
            let [azimuth, _] = azimuth_elevation_deg(turn.x_axis);
            let [degrees, ..] = rounded([azimuth, 0.0, 0.0]);
            self.report.note(format!("the light of `{shown}`: 1 is {scale} cd/m²"));
            let picture = EnvironmentImage::new(path, scale);
            let rotation_deg = (degrees != 0.0).then(|| degrees.into());
            return Ok(Environment::Image(EnvironmentImage { rotation_deg, ..picture }));
        }
        let to_picture = turn.transpose();
        let found = |direction: DVec3| {
            let d = to_picture * direction;
            let [across, down] = [0.5 - maths::atan2(d.y, d.x) / TAU, maths::acos(d.z.clamp(-1.0, 1.0)) / PI];
            bilinear(pixel, [columns, rows], [across * columns as f64 - 0.5, down * rows as f64 - 0.5])
        };
        let written = self.environment_file(rows, &found)?;
        self.report.note(format!("the light of `{shown}`: turned, and resampled; 1 is {scale} cd/m²"));
        Ok(Environment::Image(EnvironmentImage::new(written.as_str(), scale)))
    }
}

/// Whether a picture by [`Scenery::light_picture`]'s `turn` stands upright and is not mirrored: it needs no other pixels.
pub(crate) fn is_upright(turn: &DMat3) -> bool {
    (turn.z_axis - DVec3::Z).length() < 1e-9 && turn.determinant() > 0.0
}

/// Columns go round, rows end at the poles.
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
