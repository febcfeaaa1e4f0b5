//! A mesh of a million triangles from its OBJ file to the first ray.

use etendue_bench_rays::clock::{clock_s, process_cpu_s};
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::terrain;
use etendue_bench_rays::threads::pool;
use etendue_core::{Motion, Ray};
use etendue_io::mesh::read_mesh;
use etendue_scene::asset::MeshAsset;
use etendue_tracer::MaterialId;
use etendue_tracer::accel::WorldBuilder;
use etendue_tracer::geometry::{Instance, Mesh, Shape};
use glam::{DAffine3, DVec3, Vec2, Vec3};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const NOTE: &str = "Hills as a Wavefront OBJ file (`v` with six decimals, `f` of three vertices), read as the program reads it, with \
    two threads: by the clock (wants an idle machine), and processor time of all threads. First ray: placing the world \
    about the camera, and one ray.";

/// Triangles of the hills.
const TRIANGLES: usize = 1_000_000;

/// The stages, in order.
const STAGES: [&str; 4] = ["read the file", "check the mesh", "build the tree", "first ray"];

/// Seconds of the stages.
pub fn table() -> Table {
    let file = HillsFile::new();
    let two = pool(2);
    let mut clock: [RunStatistics; STAGES.len() + 1] = Default::default();
    let mut cpu = clock.clone();
    for _ in 0..etendue_bench_rays::runs::COUNT {
        let times = two.install(|| stages(&file.0));
        let total = times.iter().fold((0.0, 0.0), |sum, time| (sum.0 + time.0, sum.1 + time.1));
        for (i, time) in times.into_iter().chain([total]).enumerate() {
            clock[i].add(time.0);
            cpu[i].add(time.1);
        }
    }
    let mut table = Table::new("From a file to the first ray", NOTE, &["stage", "clock, s", "processor, s", "spread"]);
    for (i, name) in STAGES.into_iter().chain(["**all**"]).enumerate() {
        table.row([
            name.to_owned(),
            format!("{:.2}", clock[i].median()),
            format!("{:.2}", cpu[i].median()),
            cpu[i].spread_text(),
        ]);
    }
    table
}

/// Time by the clock and processor time of each stage, s.
fn stages(file: &Path) -> [(f64, f64); STAGES.len()] {
    let (asset, reading) = both(|| read_mesh(file).expect("readable hills"));
    let (mesh, checking) = both(|| checked(&asset));
    let (world, building) = both(|| {
        let mut builder = WorldBuilder::new();
        let shape = Shape::Mesh(builder.add_mesh(mesh));
        let to_world = Motion::constant(DAffine3::IDENTITY);
        builder.add_instance(Instance {
            shape,
            to_world,
            materials: vec![MaterialId(0)],
            instance_id: 1,
            semantic_id: 0,
        });
        builder.build().expect("a legal world")
    });
    let (hit, asking) = both(|| {
        let view = world.render_space(DVec3::ZERO);
        view.closest(&Ray::new(Vec3::ZERO, -Vec3::Z, 0.0)).is_some()
    });
    assert!(hit, "the hills lie below the camera");
    [reading, checking, building, asking]
}

fn checked(asset: &MeshAsset) -> Mesh {
    let vectors = |list: &[[f32; 3]]| list.iter().copied().map(Vec3::from).collect();
    let uvs = asset.uvs.iter().copied().map(Vec2::from).collect();
    let (triangles, slots) = (asset.triangles.clone(), asset.slots.clone());
    Mesh::new(vectors(&asset.positions), vectors(&asset.normals), uvs, triangles, slots).expect("hills are legal").0
}

/// What `work` answers, its time by the clock and the processor time of all threads, s.
fn both<R>(work: impl FnOnce() -> R) -> (R, (f64, f64)) {
    let start = (clock_s(), process_cpu_s());
    let answer = work();
    (answer, (clock_s() - start.0, process_cpu_s() - start.1))
}

/// The hills in a file that is removed at the end.
struct HillsFile(PathBuf);

impl HillsFile {
    fn new() -> Self {
        let path = std::env::temp_dir().join(format!("etendue-hills-{}.obj", std::process::id()));
        let file = Self(path);
        std::fs::write(&file.0, text()).expect("the folder of temporary files can be written to");
        file
    }
}

impl Drop for HillsFile {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn text() -> String {
    let (positions, triangles) = terrain::grid(TRIANGLES);
    let mut text = String::with_capacity(64 * positions.len() + 32 * triangles.len());
    for p in positions {
        writeln!(text, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z).expect("memory");
    }
    for [a, b, c] in triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("memory");
    }
    text
}
