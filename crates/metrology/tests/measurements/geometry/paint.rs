//! Images of charts in closed form: each pixel is the mean of the chart over its area, seen through a camera model.

use crate::draws::normals;
use etendue_core::maths::f64::sin_cos;
use etendue_metrology::Image;
use etendue_projection::Calibration;
use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

/// A plane chart in front of a camera.
#[derive(Clone)]
pub(crate) struct View {
    pub(crate) camera: Calibration,
    /// Rotation from the chart's frame (x along columns, y along rows, z away from the camera) to the camera's.
    pub(crate) rotation: DMat3,
    pub(crate) translation: DVec3,
}

/// A rotation by a vector of angle and axis.
pub(crate) fn rotation(v: [f64; 3]) -> DMat3 {
    let v = DVec3::from(v);
    let angle = v.length();
    if angle == 0.0 { DMat3::IDENTITY } else { DMat3::from_axis_angle_exact(v / angle, angle) }
}

trait ExactRotation {
    fn from_axis_angle_exact(axis: DVec3, angle: f64) -> DMat3;
}

impl ExactRotation for DMat3 {
    fn from_axis_angle_exact(axis: DVec3, angle: f64) -> DMat3 {
        let (s, c) = sin_cos(angle);
        let cross = DMat3::from_cols(axis.cross(DVec3::X), axis.cross(DVec3::Y), axis.cross(DVec3::Z));
        DMat3::IDENTITY + s * cross + (1.0 - c) * (cross * cross)
    }
}

impl View {
    pub(crate) fn new(camera: &Calibration, rotation_vector: [f64; 3], centre: DVec2, place: DVec3) -> Self {
        let turn = rotation(rotation_vector);
        // `place` is the position of the chart's point `centre`.
        Self { camera: camera.clone(), rotation: turn, translation: place - turn * centre.extend(0.0) }
    }

    /// The image of a point of the chart.
    pub(crate) fn image(&self, chart: DVec2) -> Option<DVec2> {
        self.camera.project(self.rotation * chart.extend(0.0) + self.translation)
    }

    /// The point of the chart at a position in the image.
    fn chart(&self, raster: DVec2) -> Option<DVec2> {
        let direction = self.rotation.transpose() * self.camera.unproject(raster)?;
        let origin = self.rotation.transpose() * -self.translation;
        let t = -origin.z / direction.z;
        (t > 0.0).then(|| (origin + t * direction).truncate())
    }

    /// The image of a chart whose brightness is `paint`; outside the plane it is 0.5. `fine` × `fine` samples of every pixel that
    /// an edge may cross.
    pub(crate) fn render(&self, fine: u32, paint: &(impl Fn(DVec2) -> f64 + Sync)) -> Image {
        let [width, height] = self.camera.size_px();
        let sample = |x: f64, y: f64| self.chart(DVec2::new(x, y)).map_or(0.5, paint);
        let row = |y: usize| {
            let corners: Vec<f64> = (0..=2 * width).map(|i| sample(0.5 * i as f64, y as f64)).collect();
            (0..width).map(move |x| (x, y, corners[2 * x], corners[2 * x + 1], corners[2 * x + 2])).collect::<Vec<_>>()
        };
        let samples: Vec<f32> = (0..height)
            .into_par_iter()
            .flat_map_iter(|y| {
                let mean = |(x, y, a, b, c): (usize, usize, f64, f64, f64)| {
                    let (x, y) = (x as f64, y as f64);
                    let others = [[0.0, 0.5], [0.5, 0.5], [1.0, 0.5], [0.0, 1.0], [0.5, 1.0], [1.0, 1.0]];
                    let flat = b == a && c == a && others.iter().all(|[u, v]| sample(x + u, y + v) == a);
                    if flat { a } else { fine_mean(fine, |u, v| sample(x + u, y + v)) }
                };
                row(y).into_iter().map(move |p| mean(p) as f32).collect::<Vec<_>>()
            })
            .collect();
        Image::from_samples(width, height, samples).expect("all pixels")
    }
}

fn fine_mean(fine: u32, sample: impl Fn(f64, f64) -> f64) -> f64 {
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(fine);
    let sum: f64 = (0..fine).flat_map(|i| (0..fine).map(move |j| (i, j))).map(|(i, j)| sample(at(i), at(j))).sum();
    sum / f64::from(fine * fine)
}

/// Squares of side 1 about corners at integers 0 … columns − 1, with one square more on each side and white around.
pub(crate) fn checkerboard(columns: i32, rows: i32) -> impl Fn(DVec2) -> f64 + Sync {
    move |p| {
        let [x, y] = p.floor().to_array().map(|c| c as i32);
        let inside = x >= -1 && y >= -1 && x < columns && y < rows;
        if inside && (x + y).rem_euclid(2) == 0 { 0.1 } else { 0.9 }
    }
}

/// Discs of a radius about integers 0 … columns − 1.
pub(crate) fn dots(columns: i32, rows: i32, radius: f64) -> impl Fn(DVec2) -> f64 + Sync {
    move |p| {
        let nearest = p.round();
        let [x, y] = nearest.to_array().map(|c| c as i32);
        let inside = x >= 0 && y >= 0 && x < columns && y < rows;
        if inside && (p - nearest).length_squared() < radius * radius { 0.1 } else { 0.9 }
    }
}

/// Independent normal noise of a standard deviation.
pub(crate) fn noisy(image: &Image, sigma: f64, seed: u64) -> Image {
    let mut normal = normals(seed, 0);
    image.map(|v| v + (sigma * normal()) as f32)
}
