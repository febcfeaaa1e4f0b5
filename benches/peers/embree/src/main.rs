//! Étendue's accelerator beside Intel Embree: the same triangles, the same rays, one thread, in turns.
//!
//! `benches/peers/embree.sh` fetches Embree and runs this: `etendue-beside-embree LIBRARY STREET [rays] [agreement] [sizes]`.
//! `--max-isa avx2` holds Embree to the instruction set that Étendue uses; `--largest 1000000` leaves out larger hills.
//! docs/evidence/performance.md keeps a set of results.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports to its user")]

mod contest;
mod embree;
mod flush;
mod heap;
mod kernels;
mod sizes;

use contest::Contest;
use embree::Embree;
use etendue_bench_rays::contest_file::ContestFile;
use etendue_bench_rays::{flat, machine, questions, terrain};
use glam::DVec3;
use std::path::Path;
use std::process::ExitCode;

/// Triangles of the hills in the contest.
const HILLS: usize = 1_000_000;
/// Triangles of the hills that grow.
const SIZES: [usize; 4] = [10_000, 100_000, 1_000_000, 10_000_000];

#[global_allocator]
static HEAP: heap::Counting = heap::Counting;

const USAGE: &str = "usage: etendue-beside-embree LIBRARY STREET [--max-isa sse4.2|avx|avx2|avx512] [--largest TRIANGLES] \
    [rays] [agreement] [sizes]; embree.sh finds the library and writes the street";

/// What is asked for.
#[derive(Default)]
struct Order {
    /// The largest instruction set that Embree may use, in its words.
    isa: Option<String>,
    /// Most triangles of the hills that grow.
    largest: Option<usize>,
    /// Names of tables; none for all.
    tables: Vec<String>,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let done = match arguments.as_slice() {
        [flag, library, isa @ ..] if flag == kernels::CHILD => {
            kernels::child(library, isa.first().map(String::as_str)).map_err(|error| error.to_string())
        }
        [library, street, rest @ ..] => Order::read(rest).and_then(|order| order.report(library, Path::new(street))),
        _ => Err(USAGE.to_owned()),
    };
    done.map_or_else(
        |what| {
            eprintln!("{what}");
            ExitCode::from(2)
        },
        |()| ExitCode::SUCCESS,
    )
}

impl Order {
    fn read(arguments: &[String]) -> Result<Self, String> {
        let mut order = Self::default();
        let mut rest = arguments.iter();
        while let Some(word) = rest.next() {
            match word.as_str() {
                "--max-isa" => order.isa = Some(rest.next().ok_or(USAGE)?.clone()),
                "--largest" => order.largest = Some(rest.next().and_then(|n| n.parse().ok()).ok_or(USAGE)?),
                "rays" | "agreement" | "sizes" => order.tables.push(word.clone()),
                _ => return Err(USAGE.to_owned()),
            }
        }
        Ok(order)
    }

    fn wants(&self, name: &str) -> bool {
        self.tables.is_empty() || self.tables.iter().any(|n| n == name)
    }

    fn report(&self, library: &str, street: &Path) -> Result<(), String> {
        let isa = self.isa.as_deref();
        let unusable = |error| format!("{library} cannot be opened as Embree 4: {error}");
        let embree = Embree::open(Path::new(library), isa).map_err(unusable)?;
        println!("{}\n{}", machine::line(), kernels::line(library, isa));
        if self.wants("rays") || self.wants("agreement") {
            let contests = [self::street(street)?, hills()];
            if self.wants("rays") {
                println!("\n{}", contest::rates(&embree, &contests));
            }
            if self.wants("agreement") {
                println!("\n{}", contest::agreement(&embree, &contests));
            }
        }
        if self.wants("sizes") {
            let sizes: Vec<usize> = SIZES.into_iter().filter(|n| *n <= self.largest.unwrap_or(usize::MAX)).collect();
            sizes::tables(&embree, &sizes).iter().for_each(|table| println!("\n{table}"));
        }
        println!("\n{}", machine::load());
        Ok(())
    }
}

/// The street with its instances written out as one mesh, from the file that `etendue-benches --contest` writes.
fn street(file: &Path) -> Result<Contest, String> {
    let unreadable = |error| format!("{}: {error}", file.display());
    let ContestFile { corners, primary, sun } = ContestFile::read(file).map_err(unreadable)?;
    let world = flat::world(flat::mesh_from_corners(corners));
    let questions = questions::about(primary, sun, &world.render_space(DVec3::ZERO));
    Ok(Contest { name: "street", world, questions })
}

fn hills() -> Contest {
    let world = flat::world(terrain::mesh(HILLS));
    let questions = questions::about(terrain::primary(), terrain::SUN, &world.render_space(DVec3::ZERO));
    Contest { name: "hills", world, questions }
}
