//! The same hills with more and more triangles: time and memory to build, time of a ray.

use crate::embree::{DEFAULT, Embree, ROBUST, Scene};
use crate::flush;
use crate::heap::{Added, EMBREES, OURS};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::Runs;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_bench_rays::{flat, terrain};
use etendue_core::Ray;
use etendue_tracer::accel::World;
use etendue_tracer::geometry::Mesh;
use glam::DVec3;
use std::hint::black_box;

/// Turns of everybody.
const TURNS: usize = 5;
/// A build of fewer triangles is repeated until it has made so many; the median counts.
const BUILT: usize = 1_000_000;

const BUILDS: &str = "Of the hills, one thread, ours from a checked mesh, Embree's in default quality. Time: processor time, \
    µs a triangle; of small meshes the median of several builds. Memory: bytes a triangle beyond the mesh, at most while \
    building and when it is done; ours as asked of the allocator, Embree's as its memory monitor tells.";
const RAYS: &str = "Hills seen by the same camera. Primary rays, closest hit, processor time of one thread, medians of five \
    turns. Growth: over the first row.";

/// Builds and rays of meshes of `sizes` triangles.
pub fn tables(embree: &Embree, sizes: &[usize]) -> [Table; 2] {
    let head = [
        "triangles",
        "ours, µs",
        "Embree's",
        "ratio",
        "robust",
        "ours, peak B",
        "Embree's",
        "ours, kept B",
        "Embree's",
        "robust",
    ];
    let mut builds = Table::new("Builds", BUILDS, &head);
    let head = ["triangles", "ours, ns", "Embree's", "ratio", "robust", "ratio", "growth", "Embree's", "robust"];
    let mut rays = Table::new("Hills of more and more triangles", RAYS, &head);
    let mut first = None;
    for size in sizes {
        let row = Row::measure(embree, *size);
        builds.row(row.builds());
        let first = first.get_or_insert(row.ns);
        rays.row(row.rays(first));
    }
    [builds, rays]
}

/// A build: its time a triangle, s, and its memory.
struct Build {
    seconds: f64,
    memory: Added,
}

/// Ours, Embree's default, Embree's robust mode.
struct Row {
    triangles: usize,
    builds: [Build; 3],
    ns: [f64; 3],
}

impl Row {
    fn measure(embree: &Embree, size: usize) -> Self {
        let mesh = terrain::mesh(size);
        let rays = terrain::primary();
        let (world, ours) = our_build(&mesh);
        let (scene, theirs) = their_build(&mesh, || embree.scene(&mesh, DEFAULT));
        let (sure, robust) = their_build(&mesh, || embree.scene(&mesh, ROBUST));
        let view = world.render_space(DVec3::ZERO);
        let mut runs = [(); 3].map(|()| Runs::default());
        for _ in 0..TURNS {
            runs[0].add(ns(&rays, |ray| view.closest(ray).is_some()));
            runs[1].add(their_ns(&rays, &scene));
            runs[2].add(their_ns(&rays, &sure));
        }
        Self { triangles: mesh.triangles().len(), builds: [ours, theirs, robust], ns: runs.map(|r| r.median()) }
    }

    fn builds(&self) -> Vec<String> {
        let each = self.triangles as f64;
        let micros = |build: &Build| format!("{:.2}", build.seconds / each * 1e6);
        let bytes = |bytes: isize| format!("{:.0}", bytes as f64 / each);
        let [ours, theirs, robust] = &self.builds;
        vec![
            self.triangles.to_string(),
            micros(ours),
            micros(theirs),
            format!("{:.1}", ours.seconds / theirs.seconds),
            micros(robust),
            bytes(ours.memory.peak),
            bytes(theirs.memory.peak),
            bytes(ours.memory.held),
            bytes(theirs.memory.held),
            bytes(robust.memory.held),
        ]
    }

    fn rays(&self, first: &[f64; 3]) -> Vec<String> {
        let [ours, theirs, robust] = self.ns;
        let rate = |theirs: f64| format!("{:.3}", theirs / ours);
        let time = |ns: f64| format!("{ns:.0}");
        let mut cells =
            vec![self.triangles.to_string(), time(ours), time(theirs), rate(theirs), time(robust), rate(robust)];
        cells.extend(self.ns.iter().zip(first).map(|(ns, first)| format!("{:.2}", ns / first)));
        cells
    }
}

fn our_build(mesh: &Mesh) -> (World, Build) {
    let build = || {
        let mesh = mesh.clone();
        pool(1).install(|| OURS.measure(|| timed(|| flat::world(mesh))))
    };
    let ((world, first_s), memory) = build();
    (world, Build { seconds: median(mesh, first_s, || build().0.1), memory })
}

fn their_build<'a>(mesh: &Mesh, build: impl Fn() -> Scene<'a>) -> (Scene<'a>, Build) {
    let ((scene, first_s), memory) = EMBREES.measure(|| timed(&build));
    (scene, Build { seconds: median(mesh, first_s, || timed(&build).1), memory })
}

/// Of the first time and more, as many as make [`BUILT`] triangles.
fn median(mesh: &Mesh, first_s: f64, again: impl Fn() -> f64) -> f64 {
    let mut runs = Runs::default();
    runs.add(first_s);
    (1..(BUILT / mesh.triangles().len()).min(2 * TURNS)).for_each(|_| runs.add(again()));
    runs.median()
}

fn their_ns(rays: &[Ray], scene: &Scene<'_>) -> f64 {
    flush::to_zero(|| ns(rays, |ray| scene.closest(ray).is_some()))
}

/// Nanoseconds of processor time a ray.
fn ns(rays: &[Ray], hits: impl Fn(&Ray) -> bool) -> f64 {
    let (_, seconds) = timed(|| black_box(rays.iter().filter(|ray| hits(ray)).count()));
    seconds / rays.len() as f64 * 1e9
}
