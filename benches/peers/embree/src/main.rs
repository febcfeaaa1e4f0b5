//! Étendue's accelerator beside Intel Embree: the same triangles, the same rays, one thread, in turns.
//!
//! `benches/peers/embree.sh` fetches Embree and runs this: `etendue-beside-embree LIBRARY [rays] [agreement] [sizes]`.
//! docs/performance.md keeps a set of results.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

mod contest;
mod embree;
mod flush;
mod sizes;

use contest::Contest;
use embree::Embree;
use etendue_benches::{flat, machine, questions, scenes, terrain};
use glam::DVec3;
use std::path::Path;
use std::process::ExitCode;

/// Triangles of the hills in the contest.
const HILLS: usize = 1_000_000;
/// Triangles of the hills that grow.
const SIZES: [usize; 4] = [10_000, 100_000, 1_000_000, 10_000_000];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some((library, names)) = arguments.split_first() else {
        eprintln!("usage: etendue-beside-embree LIBRARY [rays] [agreement] [sizes]; embree.sh finds the library");
        return ExitCode::from(2);
    };
    match Embree::open(Path::new(library)) {
        Ok(embree) => {
            report(&embree, names);
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{library} cannot be opened as Embree 4: {error}");
            ExitCode::FAILURE
        }
    }
}

fn report(embree: &Embree, names: &[String]) {
    let wanted = |name: &str| names.is_empty() || names.iter().any(|n| n == name);
    println!("{}", machine::line());
    if wanted("rays") || wanted("agreement") {
        let contests = [street(), hills()];
        if wanted("rays") {
            println!("\n{}", contest::rates(embree, &contests));
        }
        if wanted("agreement") {
            println!("\n{}", contest::agreement(embree, &contests));
        }
    }
    if wanted("sizes") {
        println!("\n{}", sizes::table(embree, &SIZES));
    }
    println!("\n{}", machine::load());
}

/// The street with its instances written out as one mesh.
fn street() -> Contest {
    let plan = scenes::STREET.plan();
    let camera = scenes::camera(&plan);
    let view = plan.world.render_space(camera.pose.position_m);
    let questions = questions::questions(&plan, camera, &view);
    Contest { name: "street", world: flat::world(flat::mesh(&view)), questions }
}

fn hills() -> Contest {
    let world = flat::world(terrain::mesh(HILLS));
    let questions = questions::about(terrain::primary(), terrain::SUN, &world.render_space(DVec3::ZERO));
    Contest { name: "hills", world, questions }
}
