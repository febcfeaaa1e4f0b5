//! A small job rendered and written a thousand times in one process, as a service does: memory, open files and threads must not grow.

use crate::child;
use crate::memory::resident_mb;
use etendue::{ExistingFiles, JobRequest, NullObserver, RenderOptions};
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use std::path::{Path, PathBuf};

/// The argument that asks a child process to render a job this often.
pub const CHILD: &str = "--soak";

const NOTE: &str = "The tests' job with a little of everything (46 × 30 px, mesh, textures, sky, lamps, sensor, picture, ground truth) at 2 samples a pixel: opened, \
    compiled, rendered and written again and again into one folder by one process, through the library, two threads. Memory resident after so many renders (Linux). \
    More than a twentieth and 2 MB above that after the hundredth ends the benchmark.";

/// After how many renders is looked.
const CHECKPOINTS: [usize; 6] = [1, 10, 100, 300, 600, 1000];

/// The look that the last one is compared with.
const SETTLED_CHECKPOINT: usize = 2;

/// Memory by the number of renders.
pub fn table() -> Table {
    let answer = child::answer(&[CHILD, "1000"]);
    let mut table = Table::new("Soak", NOTE, &["renders", "memory, MB", "open files", "threads"]);
    let rows: Vec<Vec<String>> =
        answer.lines().map(|line| line.split_whitespace().map(str::to_owned).collect()).collect();
    let memory_mb = |row: &[String]| row[1].parse::<f64>().ok();
    if let (Some(settled), Some(last)) = (memory_mb(&rows[SETTLED_CHECKPOINT]), memory_mb(&rows[rows.len() - 1])) {
        assert!(last <= 1.05 * settled + 2.0, "memory grows: {rows:?}");
    }
    let [settled, last] = [&rows[SETTLED_CHECKPOINT], &rows[rows.len() - 1]];
    assert_eq!(settled[2..], last[2..], "files or threads stay open: {rows:?}");
    rows.into_iter().for_each(|row| table.row(row));
    table
}

/// Renders so often; a line for each look.
pub fn child(renders: &str) -> String {
    let renders: usize = renders.parse().expect("a number of renders");
    let job = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/cli/tests/jobs/small/small.toml");
    let folder = Folder(std::env::temp_dir().join(format!("etendue-soak-{}", std::process::id())));
    let mut lines = Vec::new();
    pool(2).install(|| {
        for done in 1..=renders {
            render(&job, &folder.0);
            if CHECKPOINTS.contains(&done) {
                lines.push(format!("{done} {} {} {}", resident_mb(), entries("fd"), entries("task")));
            }
        }
    });
    lines.join("\n")
}

fn render(job: &Path, folder: &Path) {
    let request = JobRequest { spp: Some(2), ..JobRequest::new(job) };
    let job = request.open().unwrap_or_else(|errors| panic!("{errors}"));
    let result = job.save(&RenderOptions::default(), folder, ExistingFiles::Replace, &NullObserver);
    result.unwrap_or_else(|error| panic!("{error}"));
}

/// How many entries a folder of this process has: what is open (`fd`), or threads (`task`).
fn entries(folder_path: &str) -> String {
    let entries = std::fs::read_dir(Path::new("/proc/self").join(folder_path));
    entries.map_or_else(|_| "unknown".to_owned(), |entries| entries.count().to_string())
}

/// A folder that is removed at the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
