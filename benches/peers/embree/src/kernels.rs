//! Which of its kernels Embree runs on this processor, in its own words.
//!
//! Embree prints what it chooses when a device is verbose. A child process builds two small scenes on such a device and
//! its output is read.

use crate::embree::{DEFAULT, Embree, ROBUST};
use etendue_bench_rays::terrain;
use std::path::Path;
use std::process::Command;

/// The argument that makes this program that child: `--kernels LIBRARY [ISA]`.
pub const CHILD: &str = "--kernels";

/// One line about Embree's kernels.
pub fn line(library: &str, isa: Option<&str>) -> String {
    let program = std::env::current_exe().expect("this program has a file");
    let output = Command::new(program).args([CHILD, library]).args(isa).output().expect("this program runs again");
    let text = String::from_utf8_lossy(&output.stdout);
    let kernel = |start: &str, end: &str| {
        let mut names = text.lines().filter_map(|line| line.trim().strip_prefix(start));
        let name = names.find(|name| name.ends_with(end)).unwrap_or("unknown");
        name.trim_end_matches(" ...").to_owned()
    };
    let ray = |end: &str| kernel("intersector1  = ", end);
    let builder = kernel("building BVH8<triangle4> using ", " ...");
    format!("Embree's kernels: {}; robust {}; builder {builder}", ray("Moeller"), ray("Pluecker"))
}

/// The child's work.
pub fn child(library: &str, isa: Option<&str>) -> Result<(), libloading::Error> {
    let embree = Embree::verbose(Path::new(library), isa)?;
    let mesh = terrain::mesh(200);
    [DEFAULT, ROBUST].into_iter().for_each(|mode| drop(embree.scene(&mesh, mode)));
    Ok(())
}
