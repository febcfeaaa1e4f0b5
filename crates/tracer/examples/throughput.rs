//! Rays a second of processor time on a procedural terrain of a million triangles, one thread.
//!
//! `cargo run --release -p etendue-tracer --example throughput [cells]`

#![allow(clippy::print_stdout, reason = "an example that reports to its user")]

use etendue_core::{Ray, Track, warp};
use etendue_tracer::MaterialId;
use etendue_tracer::accel::{Simd, World, WorldBuilder};
use etendue_tracer::geometry::{Instance, Mesh, Shape};
use etendue_tracer::view::View;
use glam::{DAffine3, DVec3, Vec2, Vec3};
use std::time::Instant;

const SIDE_M: f32 = 200.0;

fn main() {
    let cells = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(708);
    let mesh = terrain(cells);
    println!("{} triangles", mesh.triangles().len());
    let start = Instant::now();
    let world = world(mesh);
    println!("built in {:.2} s", start.elapsed().as_secs_f64());
    for simd in [Simd::Auto, Simd::Scalar] {
        report(&world.view_with(DVec3::new(-60.0, -70.0, 25.0), simd), simd);
    }
}

fn report(view: &View<'_>, simd: Simd) {
    let primary = primary_rays(1000);
    let (hits, first) = rate(&primary, |ray| view.closest(ray));
    let points: Vec<_> =
        primary.iter().zip(&hits).filter_map(|(ray, hit)| Some(view.surface(ray, hit.as_ref()?))).collect();
    let mut random = Random(1);
    let bounces: Vec<_> = points
        .iter()
        .map(|p| {
            let d = etendue_core::Basis::about(p.geometric_normal).outward(warp::cosine_hemisphere(random.pair()));
            Ray::new(p.spawn(d), d, 0.0)
        })
        .collect();
    let (_, bounce) = rate(&bounces, |ray| view.closest(ray));
    let sun = Vec3::new(0.8, 0.3, 0.25).normalize();
    let shadows: Vec<_> = points.iter().map(|p| Ray::new(p.spawn(sun), sun, 0.0)).collect();
    let (blocked, shadow) = rate(&shadows, |ray| view.occluded(ray));
    let blocked = blocked.iter().filter(|b| **b).count() as f64 / blocked.len() as f64;
    println!(
        "{simd:?}: primary {first:.2}, bounce {bounce:.2}, shadow {shadow:.2} Mray/s ({} hits, {:.0} % in shadow)",
        points.len(),
        100.0 * blocked
    );
}

/// The answers, and the best of five rates in millions a second.
fn rate<R>(rays: &[Ray], answer: impl Fn(&Ray) -> R) -> (Vec<R>, f64) {
    let mut best = f64::INFINITY;
    let mut answers = Vec::new();
    for _ in 0..5 {
        let start = cpu_s();
        answers = rays.iter().map(&answer).collect();
        best = best.min(cpu_s() - start);
    }
    (answers, rays.len() as f64 / best / 1e6)
}

/// Processor time of this thread, s, from the Linux kernel's accounting; elsewhere the clock's.
fn cpu_s() -> f64 {
    let accounted = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = accounted.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds
        .map_or_else(|| std::time::SystemTime::UNIX_EPOCH.elapsed().map_or(0.0, |d| d.as_secs_f64()), |ns| ns * 1e-9)
}

fn primary_rays(side: u32) -> Vec<Ray> {
    let (forward, right, up) = (Vec3::new(0.6, 0.75, -0.28), Vec3::new(0.78, -0.62, 0.0), Vec3::new(0.17, 0.22, 0.96));
    (0..side * side)
        .map(|i| {
            let p = Vec2::new((i % side) as f32 + 0.5, (i / side) as f32 + 0.5) / side as f32 - 0.5;
            Ray::new(Vec3::ZERO, (forward + right * p.x - up * p.y).normalize(), 0.0)
        })
        .collect()
}

fn world(mesh: Mesh) -> World {
    let mut builder = WorldBuilder::new();
    let mesh = builder.add_mesh(mesh);
    builder.add_instance(Instance {
        shape: Shape::Mesh(mesh),
        to_world: Track::still(DAffine3::IDENTITY),
        materials: vec![MaterialId(0)],
        instance_id: 1,
        semantic_id: 1,
    });
    builder.build().expect("a legal world")
}

fn terrain(cells: u32) -> Mesh {
    let row = cells + 1;
    let vertex = |i: u32| {
        let p = Vec2::new((i % row) as f32, (i / row) as f32) / cells as f32;
        let xy = (p - 0.5) * SIDE_M;
        Vec3::new(xy.x, xy.y, height(p))
    };
    let cell = |i: u32| {
        let at = i / cells * row + i % cells;
        [[at, at + 1, at + row + 1], [at, at + row + 1, at + row]]
    };
    let triangles = (0..cells * cells).flat_map(cell).collect();
    Mesh::new((0..row * row).map(vertex).collect(), vec![], vec![], triangles, vec![]).expect("a legal mesh").0
}

/// Octaves of smooth noise, m.
fn height(p: Vec2) -> f32 {
    let octave = |k: u32| noise(p * (4 << k) as f32) * 14.0 / (1 << k) as f32;
    (0..7).map(octave).sum()
}

fn noise(p: Vec2) -> f32 {
    let (cell, f) = (p.floor(), p - p.floor());
    let f = f * f * (Vec2::splat(3.0) - f * 2.0);
    let at = |x: u32, y: u32| {
        let key = (cell.x as u64 + u64::from(x)) << 32 | (cell.y as u64 + u64::from(y));
        Random(key.wrapping_mul(0x9e37_79b9_7f4a_7c15)).pair().x
    };
    let (low, high) = (at(0, 0) * (1.0 - f.x) + at(1, 0) * f.x, at(0, 1) * (1.0 - f.x) + at(1, 1) * f.x);
    low * (1.0 - f.y) + high * f.y
}

/// Splitmix64.
struct Random(u64);

impl Random {
    fn pair(&mut self) -> Vec2 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        Vec2::new((z >> 40) as f32, (z as u32 >> 8) as f32) / 16_777_216.0
    }
}
