//! Peak memory of a scene: loading, compiling and rendering its own picture, in a process of its own.

use crate::child;
use crate::scenes::{ALL, Scene, camera};
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_pipeline::NullObserver;
use etendue_pipeline::render::{LightRequest, light};

/// The argument that makes this program a child that measures the scene named next.
pub const CHILD: &str = "--peak-memory-of";

const NOTE: &str = "Most memory resident at any time (Linux), until the scene is compiled and until its picture (of the \
    size of its job, two threads) is on the film. Film: the part of it that the job's products decide. Photographs and \
    files come on top.";

/// Peak memory of all scenes.
pub fn table() -> Table {
    let head = ["scene", "compiled, MB", "rendered, MB", "film, MB"];
    let mut table = Table::new("Memory", NOTE, &head);
    ALL.iter().for_each(|scene| table.row(child::row(scene.name, &[CHILD, scene.name])));
    table
}

/// Renders a scene; megabytes at most until it was compiled and until it was rendered, and those of the film.
pub fn child(scene: &str) -> String {
    let plan = Scene::named(scene).thin_plan();
    let compiled = peak_mb();
    let camera = camera(&plan);
    let film = pool(2).install(|| light(&plan, camera, LightRequest::default(), &NullObserver));
    std::hint::black_box(film.expect("nobody cancels"));
    let (width, height) = camera.film_size();
    let film_mb = camera.film_layout().bytes(width as usize, height as usize) / 1e6;
    format!("{compiled} {} {film_mb:.0}", peak_mb())
}

/// Most memory that this process had resident, MB.
#[must_use]
pub fn peak_mb() -> String {
    status_mb("VmHWM:").map_or_else(|| "unknown".to_owned(), |mb| format!("{mb:.0}"))
}

/// Memory that this process has resident now, MB.
#[must_use]
pub fn resident_mb() -> String {
    status_mb("VmRSS:").map_or_else(|| "unknown".to_owned(), |mb| format!("{mb:.1}"))
}

fn status_mb(field: &str) -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let kib = text.lines().find_map(|line| line.strip_prefix(field)?.split_whitespace().next()?.parse::<f64>().ok());
    kib.map(|kib| kib * 1024.0 / 1e6)
}
