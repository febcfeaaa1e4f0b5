//! Environment maps: conversion from pbrt's equal-area square to our equirectangular images.
//!
//! pbrt's environments use an equal-area map of the sphere to a square.
//!
//! Source: P. Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", JGT 13(3), 2008, as in pbrt-v4.

use std::f64::consts::{FRAC_2_PI, FRAC_PI_4, PI};

use etendue_core::maths::f64 as maths;
use etendue_io::picture::read_image;
use etendue_scene::{asset::ImageAsset, record::Environment, record::environment::EnvironmentImage};
use etendue_spectra::colour::BT709;
use glam::DVec3;

use crate::scenery::{Graphics, SceneBuilder, linear_pixels};

impl SceneBuilder {
    /// Environment of an image whose numbers are cd/m² times `scale`, or times the factor that gives `lux` on a surface facing the image's +z; `None`, with a
    /// note, for an unsupported image.
    pub(super) fn environment(
        &mut self,
        file: &str,
        graphics: &Graphics,
        scale: f64,
        lux: Option<f64>,
    ) -> Result<Option<Environment>, String> {
        let path = self.source_file(file);
        let image = read_image(&path).map_err(|e| e.to_string())?.in_rec_709();
        let Some(texels) = Texels::new(&image) else {
            self.report.note(format!("the environment map `{file}` is left out: expected linear values (EXR, HDR)"));
            return Ok(None);
        };
        if image.width != image.height {
            return Err(format!(
                "`{file}` has {} by {} pixels; pbrt-v4 expects a square image (imgtool makeequiarea)",
                image.width, image.height
            ));
        }
        let scale = match lux {
            Some(lux) => scale * lux / texels.illuminance().max(f64::MIN_POSITIVE),
            None => scale,
        };
        if scale <= 0.0 || !scale.is_finite() {
            self.report.note("a light \"infinite\" emits no light and is left out");
            return Ok(None);
        }
        // 4 n² pixels of the square sample the sphere as finely as 2 n × 4 n of ours at the horizon.
        let rows = image.height as usize;
        let to_light = graphics.to_world.matrix3.inverse() * self.to_ours.transpose();
        let radiance = |direction: DVec3| texels.bilinear(square_of((to_light * direction).normalize_or(DVec3::Z)));
        let path = self.environment_file(rows, &radiance)?;
        self.report
            .note(format!("environment map `{file}`: resampled to {} by {rows} pixels, 1 is {scale} cd/m²", 2 * rows));
        Ok(Some(Environment::Image(EnvironmentImage::new(path.as_str(), scale))))
    }
}

/// Linear pixels of a square.
struct Texels<'a> {
    size: usize,
    pixel: Box<dyn Fn(usize) -> [f32; 3] + 'a>,
}

impl<'a> Texels<'a> {
    fn new(image: &'a ImageAsset) -> Option<Self> {
        Some(Self { size: image.width as usize, pixel: linear_pixels(image)? })
    }

    /// Illuminance of a surface that faces the image's +z, lx for numbers in cd/m².
    fn illuminance(&self) -> f64 {
        let n = self.size;
        let lux = |i: usize| {
            let along = |k: usize| (k as f64 + 0.5) / n as f64;
            let cos = direction_of([along(i % n), along(i / n)]).z.max(0.0);
            let luminance: f64 = (self.pixel)(i).iter().zip(BT709).map(|(v, weight)| f64::from(*v) * weight).sum();
            cos * luminance
        };
        (0..n * n).map(lux).sum::<f64>() * 4.0 * PI / (n * n) as f64
    }

    /// Texel at whole coordinates, which may lie one outside: the square continues mirrored about the middle of its edge.
    fn at(&self, x: isize, y: isize) -> [f32; 3] {
        let n = self.size as isize;
        let inside = |v: isize| (0..n).contains(&v);
        let (mut x, mut y) = (x, y);
        if !inside(x) {
            (x, y) = (x.clamp(0, n - 1), n - 1 - y);
        }
        if !inside(y) {
            (x, y) = (n - 1 - x, y.clamp(0, n - 1));
        }
        (self.pixel)((y * n + x) as usize)
    }

    fn bilinear(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let [x, y] = [u, v].map(|c| c * self.size as f64 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let corner = |dx: isize, dy: isize| self.at(x0 as isize + dx, y0 as isize + dy).map(f64::from);
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        std::array::from_fn(|i| (1.0 - fy) * ((1.0 - fx) * a[i] + fx * b[i]) + fy * ((1.0 - fx) * c[i] + fx * d[i]))
    }
}

/// Position in the unit square of a unit direction; the second coordinate increases with rows.
fn square_of(d: DVec3) -> [f64; 2] {
    let [x, y, z] = d.abs().to_array();
    let r = (1.0 - z).max(0.0).sqrt();
    let angle = if x == 0.0 && y == 0.0 { 0.0 } else { FRAC_2_PI * maths::atan2(y, x) };
    let (u, v) = (r - angle * r, angle * r);
    let (u, v) = if d.z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
    [0.5 * (u.copysign(d.x) + 1.0), 0.5 * (v.copysign(d.y) + 1.0)]
}

/// Direction of a point of the unit square: the inverse of [`square_of`].
fn direction_of([u, v]: [f64; 2]) -> DVec3 {
    let (u, v) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    // Inner half of the square: above the horizon; corners: below.
    let above = 1.0 - (u.abs() + v.abs());
    let r = 1.0 - above.abs();
    let azimuth = if r == 0.0 { 0.0 } else { FRAC_PI_4 * ((v.abs() - u.abs()) / r + 1.0) };
    let (sin, cos) = maths::sin_cos(azimuth);
    let level = r * (2.0 - r * r).max(0.0).sqrt();
    DVec3::new((cos * level).copysign(u), (sin * level).copysign(v), (1.0 - r * r).copysign(above))
}

#[cfg(test)]
mod tests {
    use etendue_core::maths::f64 as maths;

    use super::*;
    use crate::scenery::resampled;

    const SIZE: usize = 32;

    /// Half of the square white, resampled.
    fn half(is_white: impl Fn(usize, usize) -> bool) -> Vec<f32> {
        let pixel = |i: usize| [f32::from(u8::from(is_white(i % SIZE, i / SIZE))); 3];
        let texels = Texels { size: SIZE, pixel: Box::new(pixel) };
        resampled(SIZE, &|direction| texels.bilinear(square_of(direction)))[0].clone()
    }

    #[test]
    fn directions_are_found_where_they_were() {
        let at = |image: &[f32], azimuth_deg: f64| {
            let column = ((180.0 - azimuth_deg) / 360.0 * 2.0 * SIZE as f64) as usize % (2 * SIZE);
            image[(SIZE / 2) * 2 * SIZE + column]
        };
        // The square's left half is x < 0, its upper half y < 0, its inner half (by area) z > 0.
        let behind = half(|x, _| x < SIZE / 2);
        assert_eq!([0.0, 80.0, 100.0, 180.0, -100.0].map(|a| at(&behind, a)), [0.0, 0.0, 1.0, 1.0, 1.0]);
        let right = half(|_, y| y < SIZE / 2);
        assert_eq!([10.0, 90.0, 170.0, -10.0, -90.0].map(|a| at(&right, a)), [0.0, 0.0, 0.0, 1.0, 1.0]);
        let above = half(|x, y| (2 * x + 1).abs_diff(SIZE) + (2 * y + 1).abs_diff(SIZE) < SIZE);
        let row = |row: usize| &above[row * 2 * SIZE..(row + 1) * 2 * SIZE];
        assert!(row(4).iter().all(|v| *v == 1.0) && row(SIZE - 5).iter().all(|v| *v == 0.0));
    }

    #[test]
    fn an_even_picture_of_1_cd_m2_gives_pi_lx() {
        let texels = |white: fn(usize) -> f32| Texels { size: SIZE, pixel: Box::new(move |i| [white(i); 3]) };
        // The horizon runs along the diagonals of 2 n of n² texels, whose centres count as dark; their upper halves contribute at a mean cosine of 4 / (3 n).
        // That is (2 n · ½ · 4 / (3 n)) / (n² / 4) = 16 / (3 n²) of the whole at most.
        let even = texels(|_| 1.0).illuminance();
        assert!((even - PI).abs() < 16.0 / (3 * SIZE * SIZE) as f64 * PI, "{even}");
        // Its corners are the sky below.
        let below = texels(|i| f32::from(u8::from(i % SIZE + i / SIZE < SIZE / 2 - 1)));
        assert_eq!(below.illuminance(), 0.0);
    }

    #[test]
    fn light_is_kept() {
        let image = half(|x, y| (x + y) % 3 == 0);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (row, values) in image.chunks(2 * SIZE).enumerate() {
            let weight = maths::cos(PI * (0.5 - (row as f64 + 0.5) / SIZE as f64));
            sum += weight * values.iter().map(|v| f64::from(*v)).sum::<f64>();
            weights += weight * values.len() as f64;
        }
        // A third of the texels, of equal areas; the mean of an irregular sample of stripes of one texel is off by some thousandths.
        assert!((sum / weights - 1.0 / 3.0).abs() < 5e-3, "{}", sum / weights);
    }

    #[test]
    fn axes_lie_where_the_paper_has_them() {
        let near = |d: DVec3, [u, v]: [f64; 2]| {
            let [a, b] = square_of(d);
            assert!((a - u).abs() < 1e-12 && (b - v).abs() < 1e-12, "{d}: {a} {b}");
        };
        near(DVec3::Z, [0.5, 0.5]);
        near(DVec3::X, [1.0, 0.5]);
        near(DVec3::NEG_Y, [0.5, 0.0]);
        near(DVec3::new(1.0, 1.0, 0.0).normalize(), [0.75, 0.75]);
    }

    #[test]
    fn points_of_the_square_lead_back_to_themselves() {
        for i in 0..400 {
            let point = [(f64::from(i % 20) + 0.3) / 20.0, (f64::from(i / 20) + 0.6) / 20.0];
            let direction = direction_of(point);
            let back = square_of(direction);
            assert!((direction.length() - 1.0).abs() < 1e-12, "{point:?}");
            assert!((0..2).all(|k| (back[k] - point[k]).abs() < 1e-9), "{point:?} {back:?}");
        }
    }

    /// Uniformly distributed directions are uniform on the square.
    #[test]
    fn areas_are_kept() {
        const N: u32 = 400;
        let mut cells = [0_u32; 16];
        for i in 0..N * N {
            let (a, b) = ((f64::from(i % N) + 0.5) / f64::from(N), (f64::from(i / N) + 0.5) / f64::from(N));
            let z = 2.0 * a - 1.0;
            let (s, c) = maths::sin_cos(std::f64::consts::TAU * b);
            let r = (1.0 - z * z).sqrt();
            let [u, v] = square_of(DVec3::new(r * c, r * s, z));
            cells[((u * 4.0) as usize).min(3) + 4 * ((v * 4.0) as usize).min(3)] += 1;
        }
        // A grid of 160 000 over 16 cells: along the boundaries it is irregular by a line of 400 in 10 000; a quarter of that is allowed.
        assert!(cells.iter().all(|n| n.abs_diff(N * N / 16) < N * N / 1600), "{cells:?}");
    }
}
