//! Paths in the Cornell box, whose surfaces are all diffuse: what a tracer costs that has all effects, beside one that has none of
//! those that the box does not need. `just instructions` counts the instructions of both; they print the same mean.

mod cornell;

use cornell::Cornell;
use etendue_core::random::{FrameAddress, PathStream, Pixel, PixelAddress};
use etendue_core::{FieldRay, RadianceField, Ray, TimeInterval, Wavelengths};
use etendue_tracer::integrator::{PathSettings, PathTracer};
use glam::{DVec3, Vec3};
use std::process::ExitCode;

/// Columns and rows of the picture.
const SIDE: u32 = 48;
/// Paths a pixel.
const SAMPLES: u32 = 8;
/// The camera's entrance pupil, m.
const CAMERA: DVec3 = DVec3::new(-0.8, 0.278, 0.273);
/// Half the width of the field at 1 m: 12.5 mm at a focal length of 35 mm.
const HALF_WIDTH: f32 = 12.5 / 35.0;

/// The mean radiance over the picture, W·m⁻²·sr⁻¹·nm⁻¹: what is counted.
#[inline(never)]
fn mean_of_paths(tracer: &PathTracer<'_>) -> f64 {
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| Pixel { x, y }));
    let sum: f64 = pixels.map(|pixel| pixel_sum(tracer, pixel)).sum();
    sum / f64::from(SIDE * SIDE * SAMPLES)
}

fn pixel_sum(tracer: &PathTracer<'_>, pixel: Pixel) -> f64 {
    let address = PixelAddress { frame: FrameAddress { seed: 1, ..FrameAddress::default() }, pixel, replicate: 0 };
    let stream = PathStream::new(&address, 0);
    let place = |i: u32| ((i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0) * HALF_WIDTH;
    let direction = Vec3::new(1.0, -place(pixel.x), -place(pixel.y)).normalize();
    let sample_radiance = |sample| {
        let ray = Ray::new(Vec3::ZERO, direction, 0.0);
        let field_ray = FieldRay { ray, stream: stream.with_sample(sample), light_interval: TimeInterval::default() };
        let wavelengths = Wavelengths::<4>::uniform(400.0, 700.0, (sample as f32 + 0.5) / SAMPLES as f32);
        tracer.radiance(&field_ray, &wavelengths).mean()
    };
    (0..SAMPLES).map(|sample| f64::from(sample_radiance(sample))).sum()
}

#[expect(clippy::print_stdout, reason = "a program's answer")]
fn main() -> ExitCode {
    let box_ = Cornell::new();
    let view = box_.world.render_space(CAMERA);
    let lights = box_.lights(&view);
    let settings = PathSettings { max_bounces: 12, ..PathSettings::default() };
    println!("{}", mean_of_paths(&PathTracer::new(&view, &box_.materials, &lights, settings)));
    ExitCode::SUCCESS
}
