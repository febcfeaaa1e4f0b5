//! The same hills with more and more triangles: time to build, time of a ray.

use crate::embree::{DEFAULT, Embree};
use crate::flush;
use etendue_benches::clock::timed;
use etendue_benches::runs::Runs;
use etendue_benches::table::Table;
use etendue_benches::threads::pool;
use etendue_benches::{flat, memory, terrain};
use etendue_core::Ray;
use etendue_tracer::geometry::Mesh;
use glam::DVec3;
use std::hint::black_box;

/// Turns of everybody.
const TURNS: usize = 5;

/// Build and ray times for meshes of `sizes` triangles.
pub fn table(embree: &Embree, sizes: &[usize]) -> Table {
    let note = "Hills seen by the same camera. Build: processor time of one thread, default quality; ours from a \
        checked mesh. Ray: primary, closest hit, median of five turns. Growth: of our time a ray, over that of the \
        first row. Memory: the most that was resident so far, both programs' trees included.";
    let head = [
        "triangles",
        "build, µs each",
        "Embree's",
        "ratio",
        "ns a ray",
        "Embree's",
        "growth",
        "Embree's",
        "memory, MB",
    ];
    let mut table = Table::new("Hills of more and more triangles", note, &head);
    let mut first = None;
    for size in sizes {
        let row = Row::measure(embree, *size);
        let first = first.get_or_insert((row.ours_ns, row.theirs_ns));
        table.row(row.cells(*first));
    }
    table
}

struct Row {
    triangles: usize,
    our_build_s: f64,
    their_build_s: f64,
    ours_ns: f64,
    theirs_ns: f64,
}

impl Row {
    fn measure(embree: &Embree, size: usize) -> Self {
        let mesh = terrain::mesh(size);
        let rays = terrain::primary();
        let (world, our_build_s) = pool(1).install(|| {
            let mesh = mesh.clone();
            timed(|| flat::world(mesh))
        });
        let (scene, their_build_s) = timed(|| embree.scene(&mesh, DEFAULT));
        let view = world.render_space(DVec3::ZERO);
        let (mut ours, mut theirs) = (Runs::default(), Runs::default());
        for _ in 0..TURNS {
            ours.add(ns(&rays, |ray| view.closest(ray).is_some()));
            theirs.add(flush::to_zero(|| ns(&rays, |ray| scene.closest(ray).is_some())));
        }
        let triangles = count(&mesh);
        Self { triangles, our_build_s, their_build_s, ours_ns: ours.median(), theirs_ns: theirs.median() }
    }

    fn cells(&self, first: (f64, f64)) -> Vec<String> {
        let each = |seconds: f64| format!("{:.2}", seconds / self.triangles as f64 * 1e6);
        vec![
            self.triangles.to_string(),
            each(self.our_build_s),
            each(self.their_build_s),
            format!("{:.1}", self.our_build_s / self.their_build_s),
            format!("{:.0}", self.ours_ns),
            format!("{:.0}", self.theirs_ns),
            format!("{:.2}", self.ours_ns / first.0),
            format!("{:.2}", self.theirs_ns / first.1),
            memory::peak_mb(),
        ]
    }
}

fn count(mesh: &Mesh) -> usize {
    mesh.triangles().len()
}

/// Nanoseconds of processor time a ray.
fn ns(rays: &[Ray], met: impl Fn(&Ray) -> bool) -> f64 {
    let (_, seconds) = timed(|| black_box(rays.iter().filter(|ray| met(ray)).count()));
    seconds / rays.len() as f64 * 1e9
}
