//! The street with a hundred thousand instances more: what grows with their number.

use crate::child;
use crate::clock::{clock_s, process_cpu_s};
use crate::memory::peak_mb;
use crate::scenes::{STREET, camera, text_of};
use crate::table::Table;
use crate::threads::pool;
use etendue_pipeline::render::light_counts;
use std::fmt::Write as _;

/// The argument that asks a child process for its times and memory.
pub const CHILD: &str = "--instances-of-a-process";

const NOTE: &str = "The street as it is, with 10⁵ instances more of its small things on a square of 2 km, and with 10⁵ objects \
    of one instance each; two threads, a process of its own each. Job: reading and checking it with its files, and building \
    its world. View: placing the world about the camera, its tree over instances, and collecting the lights. Clock (wants an \
    idle machine), processor time of all threads, and most memory resident at any time.";

/// Instances that are added.
const ADDED: usize = 100_000;
/// Meshes of the street whose instances they are.
const MESHES: [&str; 8] = ["bollard", "bin", "bench", "lamp-post", "walker", "tree-a", "tree-b", "van"];
/// Rows and columns of instances: a square with room for all.
const COLUMNS: usize = 317;
const STEP_M: f64 = 2000.0 / COLUMNS as f64;

/// Times and memory of the street, with many instances and with many objects.
pub fn table() -> Table {
    let head = ["world", "instances", "job, s", "processor, s", "view, s", "processor, s", "memory, MB"];
    let mut table = Table::new("Many instances", NOTE, &head);
    for (name, way) in
        [("street", "none"), ("and instances of eight objects", "instances"), ("and as many objects", "objects")]
    {
        table.row(child::row(name, &[CHILD, way]));
    }
    table
}

/// Loads the street with what `way` adds; instances, clock and processor time of job and view, s, and megabytes at most.
pub fn child(way: &str) -> String {
    let scene = scene(way);
    pool(2).install(|| {
        let start = (clock_s(), process_cpu_s());
        let plan = STREET.with_scene(&scene, &[]);
        let loaded = (clock_s(), process_cpu_s());
        std::hint::black_box(light_counts(&plan, camera(&plan)));
        let viewed = (clock_s(), process_cpu_s());
        let instances = plan.world.instances().len();
        let between = |a: (f64, f64), b: (f64, f64)| format!("{:.2} {:.2}", b.0 - a.0, b.1 - a.1);
        format!("{instances} {} {} {}", between(start, loaded), between(loaded, viewed), peak_mb())
    })
}

/// The street's scene and what is added to it.
fn scene(way: &str) -> String {
    let mut text = text_of("street/scene.toml");
    match way {
        "instances" => (0..MESHES.len()).for_each(|mesh| add_instances(&mut text, mesh)),
        "objects" => (0..ADDED).for_each(|number| add_object(&mut text, number)),
        _ => {}
    }
    text
}

fn add_instances(text: &mut String, mesh: usize) {
    let name = MESHES[mesh];
    writeln!(text, "[[objects]]\nname = \"more {name}\"\nmesh = \"{name}\"\nmaterial = \"bollard\"\ninstances = [")
        .expect("memory");
    for number in (mesh..ADDED).step_by(MESHES.len()) {
        writeln!(text, "  {{ {} }},", placed(number).join(", ")).expect("memory");
    }
    text.push_str("]\n");
}

fn add_object(text: &mut String, number: usize) {
    let (mesh, placed) = (MESHES[number % MESHES.len()], placed(number).join("\n"));
    writeln!(text, "[[objects]]\nname = \"more {number}\"\nmesh = \"{mesh}\"\nmaterial = \"bollard\"\n{placed}")
        .expect("memory");
}

/// Where an instance stands: on a square, turned by its number.
fn placed(number: usize) -> [String; 2] {
    let (x, y) = ((number % COLUMNS) as f64 * STEP_M, (number / COLUMNS) as f64 * STEP_M - 1000.0);
    [format!("position_m = [{x:.2}, {y:.2}, 0]"), format!("rotation_deg = [{}, 0, 0]", number * 37 % 360)]
}
