//! The street with up to a million instances more: what grows with their number.

use crate::child;
use crate::memory::peak_mb;
use crate::scenes::{STREET, camera, text_of};
use etendue_bench_rays::clock::{clock_s, process_cpu_s};
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_pipeline::render::light_counts;
use std::fmt::Write as _;

/// The argument that asks a child process for its times and memory.
pub const CHILD: &str = "--instances-of-a-process";

const NOTE: &str = "The street as it is, with 10⁵ and 10⁶ instances more of its small things on a square of 2 km, and with as many objects \
    of one instance each; two threads, a process of its own each. Job: reading and checking it with its files, and building \
    its world. View: placing the world about the camera, its tree over instances, and collecting the lights. Clock (wants an \
    idle machine), processor time of all threads, and most memory resident at any time.";

/// Meshes of the street whose instances they are.
const MESHES: [&str; 8] = ["bollard", "bin", "bench", "lamp-post", "walker", "tree-a", "tree-b", "van"];
/// What is added to the street: in words, how many, and whether as objects of their own.
const WORLDS: [(&str, usize, bool); 5] = [
    ("street", 0, false),
    ("and 10⁵ instances of eight objects", 100_000, false),
    ("and as many objects", 100_000, true),
    ("and 10⁶ instances of eight objects", 1_000_000, false),
    ("and as many objects", 1_000_000, true),
];
/// Side of the square on which they stand, m.
const SQUARE_M: f64 = 2000.0;

/// Times and memory of the street, with many instances and with many objects.
pub fn table() -> Table {
    let head = ["world", "instances", "job, s", "processor, s", "view, s", "processor, s", "memory, MB"];
    let mut table = Table::new("Many instances", NOTE, &head);
    for (i, (name, ..)) in WORLDS.iter().enumerate() {
        table.row(child::row(name, &[CHILD, &i.to_string()]));
    }
    table
}

/// Loads the street with what the world of this number adds; instances, clock and processor time of job and view, s, and megabytes at most.
pub fn child(world: &str) -> String {
    let (_, count, as_objects) = WORLDS[world.parse::<usize>().expect("the number of a world")];
    let scene = scene(count, as_objects);
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
fn scene(count: usize, as_objects: bool) -> String {
    let mut text = text_of("street/scene.toml");
    if as_objects {
        (0..count).for_each(|number| add_object(&mut text, number, count));
    } else if count > 0 {
        (0..MESHES.len()).for_each(|mesh| add_instances(&mut text, mesh, count));
    }
    text
}

fn add_instances(text: &mut String, mesh: usize, count: usize) {
    let name = MESHES[mesh];
    writeln!(text, "[[objects]]\nname = \"more {name}\"\nmesh = \"{name}\"\nmaterial = \"bollard\"\ninstances = [")
        .expect("memory");
    for number in (mesh..count).step_by(MESHES.len()) {
        writeln!(text, "  {{ {} }},", placed(number, count).join(", ")).expect("memory");
    }
    text.push_str("]\n");
}

fn add_object(text: &mut String, number: usize, count: usize) {
    let (mesh, placed) = (MESHES[number % MESHES.len()], placed(number, count).join("\n"));
    writeln!(text, "[[objects]]\nname = \"more {number}\"\nmesh = \"{mesh}\"\nmaterial = \"bollard\"\n{placed}")
        .expect("memory");
}

/// Where an instance of so many stands: on a square with room for all, turned by its number.
fn placed(number: usize, count: usize) -> [String; 2] {
    let columns = (count - 1).isqrt() + 1;
    let step_m = SQUARE_M / columns as f64;
    let (x, y) = ((number % columns) as f64 * step_m, (number / columns) as f64 * step_m - 0.5 * SQUARE_M);
    [format!("position_m = [{x:.2}, {y:.2}, 0]"), format!("rotation_deg = [{}, 0, 0]", number * 37 % 360)]
}
