//! Benchmarks of Étendue: what a machine does in a second, as tables in Markdown on the standard output.
//!
//! `just bench` runs all of them; `cargo run --release -p etendue-benches -- rays paths` runs those that are named.
//! docs/evidence/performance.md keeps a set of results and says how to read them.
//!
//! | name | what is measured |
//! | --- | --- |
//! | `rays` | millions of rays a second in the street: primary, bounce, shadow; AVX2 and scalar |
//! | `paths` | paths a second of the scenes that ship with the project, one thread and two |
//! | `lamps` | cost and error of a path under 10 to 10 000 lamps |
//! | `road` | error of the road by night at 64 samples a pixel, dry and wet |
//! | `lenses` | nanoseconds of a ray through each kind of lens |
//! | `adaptive` | samples by the sensor's noise against as many everywhere: five scenes (some ten minutes) |
//! | `defocus` | depth of field through the lens, physical and fast: error of a point's blur, time |
//! | `ghosts` | milliseconds of a picture's layer of ghosts |
//! | `views` | a fisheye and a panorama, through the lens and by six views |
//! | `trees` | time to build the accelerator, a triangle |
//! | `obj` | a million triangles from their OBJ file to the first ray, by stages |
//! | `instances` | the street with 10⁵ and 10⁶ instances more: time and memory until its light can be gathered |
//! | `motion` | the street with fifty objects more, at rest and moving |
//! | `textures` | peak memory and time of textures that are larger than the memory that they may take |
//! | `films` | peak memory and time of films of a hundred megapixels, whose bands are on the disk |
//! | `memory` | peak memory of a scene, in a process of its own |
//! | `frames` | raw and picture of a frame of two megapixels |
//! | `sensor` | mean electrons to digital numbers: all noises, all effects, each alone; time and memory |
//! | `files` | megabytes a second into a spectral EXR |
//! | `inputs` | time and peak memory of reading the largest inputs |
//! | `soak` | memory of a thousand renders in one process |
//!
//! Times are processor times of one thread, medians of several runs that take turns, so that a busy machine disturbs
//! little. Only the speed-up by a second thread is looked at by the clock.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

use etendue_bench_rays::machine;
use etendue_bench_rays::table::Table;
use etendue_benches::{
    adaptive, defocus, files, films, frames, inputs, instances, lamps, lenses, memory, motion, obj, paths, peer,
    questions, rays, road, sensor, soak, textures, trees, views,
};
use std::process::ExitCode;

/// A benchmark: its name and what it answers.
type Benchmark = (&'static str, fn() -> Table);

const BENCHMARKS: [Benchmark; 21] = [
    ("rays", rays::table),
    ("paths", paths::table),
    ("lamps", lamps::table),
    ("road", road::table),
    ("lenses", lenses::table),
    ("adaptive", adaptive::table),
    ("defocus", defocus::table),
    ("ghosts", lenses::ghosts),
    ("views", views::table),
    ("trees", trees::table),
    ("obj", obj::table),
    ("instances", instances::table),
    ("motion", motion::table),
    ("textures", textures::table),
    ("films", films::table),
    ("memory", memory::table),
    ("frames", frames::table),
    ("sensor", sensor::table),
    ("files", files::table),
    ("inputs", inputs::table),
    ("soak", soak::table),
];

/// Writes the street for the comparison with Embree.
const CONTEST: &str = "--contest";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.as_slice() {
        [flag, scene] if flag == memory::CHILD => {
            println!("{}", memory::child(scene));
            ExitCode::SUCCESS
        }
        [flag, world] if flag == instances::CHILD => {
            println!("{}", instances::child(world));
            ExitCode::SUCCESS
        }
        [flag, name] if flag == sensor::CHILD => {
            println!("{}", sensor::child(name));
            ExitCode::SUCCESS
        }
        [flag, folder, limit_mb] if flag == textures::CHILD => {
            println!("{}", textures::child(folder, limit_mb));
            ExitCode::SUCCESS
        }
        [flag, folder, job] if flag == films::CHILD => {
            println!("{}", films::child(folder, job));
            ExitCode::SUCCESS
        }
        [flag, input, path] if flag == inputs::CHILD => {
            println!("{}", inputs::child(input, path));
            ExitCode::SUCCESS
        }
        [flag, renders] if flag == soak::CHILD => {
            println!("{}", soak::child(renders));
            ExitCode::SUCCESS
        }
        [flag, file] if flag == CONTEST => {
            let written = questions::write_street(file.as_ref());
            answer(written.map(|()| Vec::new()).map_err(|error| format!("{file}: {error}")))
        }
        [flag, order @ ..] if flag == peer::FLAG => answer(peer::rendered(order)),
        names => report(names),
    }
}

fn answer(lines: Result<Vec<String>, String>) -> ExitCode {
    match lines {
        Ok(lines) => {
            lines.iter().for_each(|line| println!("{line}"));
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

/// Runs the benchmarks that are named, or all.
fn report(names: &[String]) -> ExitCode {
    if let Some(unknown) = names.iter().find(|name| !BENCHMARKS.iter().any(|(known, _)| known == name)) {
        let known = BENCHMARKS.map(|(name, _)| name).join(", ");
        eprintln!("there is no benchmark \"{unknown}\"; give some of {known}, or nothing for all");
        return ExitCode::from(2);
    }
    println!("{}", machine::line());
    for (name, table) in BENCHMARKS {
        if names.is_empty() || names.iter().any(|n| n == name) {
            println!("\n{}", table());
        }
    }
    println!("\n{}", machine::load());
    ExitCode::SUCCESS
}
