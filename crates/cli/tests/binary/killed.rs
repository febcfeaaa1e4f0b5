//! Runs killed repeatedly at random moments, and then rerun or resumed: files with a final name are complete at every moment, and the final bytes are
//! those of an undisturbed run, without further files.
//!
//! `ETENDUE_KILLS=1000` kills that often in all, instead of a few times, and writes the results to `target/kills.md` (`just kills`;
//! docs/robustness.md has them); `ETENDUE_KILLS_SEED` gives other moments. The few kills are a section of docs/evidence/extremes.md.

use crate::support::{assert_same, contents, etendue, root, small, tests, text};
use etendue_io::exr::read_exr;
use etendue_io::picture::read_image;
use etendue_testkit::page::{self, Row};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Number of kills in the quick part, over all kinds of runs.
const QUICK_KILLS: usize = 12;

/// A kind of run.
struct RunKind {
    name: &'static str,
    arguments: Vec<String>,
    /// Further arguments of a run that follows a killed one.
    repeat_arguments: &'static str,
    /// True if files are replaced by refined ones during the run.
    refines: bool,
}

impl RunKind {
    fn new(name: &'static str, arguments: &[&str], repeat_arguments: &'static str) -> Self {
        let arguments: Vec<String> = arguments.iter().map(|word| (*word).to_owned()).collect();
        let refines = arguments.iter().any(|word| word == "--progressive");
        Self { name, arguments, repeat_arguments, refines }
    }

    fn all(shards: [&str; 2]) -> Vec<Self> {
        let (small, moving) = (small(), text(&tests().join("jobs/moving/moving.toml")));
        vec![
            Self::new("render", &["render", &small, "--spp", "2"], "--overwrite"),
            Self::new("passes", &["render", &small, "--spp", "24", "--progressive"], "--resume"),
            Self::new("frames", &["render", &moving, "--spp", "2", "--frames", "0..2"], "--resume"),
            Self::new(
                "frames in passes",
                &["render", &moving, "--spp", "12", "--frames", "0..2", "--progressive"],
                "--resume",
            ),
            Self::new("shard", &["render", &small, "--spp", "2", "--shard", "1/2"], "--overwrite"),
            Self::new("merge", &["merge", shards[0], shards[1]], "--overwrite"),
        ]
    }

    /// Result of this many kills: an incomplete file, or different final bytes, has failed the run before.
    fn row(&self, count: &KillCounts, kills: usize) -> Row {
        Row {
            extreme: format!("{}, killed, then begun again with `{}`", self.name, self.repeat_arguments),
            expected: "complete files, final bytes equal".to_owned(),
            actual: format!("after each of {} kills", count.killed),
            holds: count.killed == kills && count.completed > 0,
        }
    }

    fn arguments(&self, out: &Path, is_again: bool) -> Vec<String> {
        let output = ["-o".to_owned(), text(out)];
        self.arguments.iter().cloned().chain(output).chain(is_again.then(|| self.repeat_arguments.to_owned())).collect()
    }
}

/// A generator of random moments: SplitMix64 (Steele, Lea and Flood 2014).
struct RandomMoments(u64);

impl RandomMoments {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number from 0 to 1.
    fn random_fraction(&mut self) -> f64 {
        self.next() as f64 / u64::MAX as f64
    }
}

/// Results of kills of one kind of run.
#[derive(Default)]
struct KillCounts {
    killed: usize,
    /// Runs that ended before their moment.
    too_late: usize,
    /// Kills after which no file had its final name, some files had, or temporary files were left.
    no_file: usize,
    some_files: usize,
    leftovers: usize,
    completed: usize,
}

/// True if a file is as its writer made it, as far as its format shows.
fn is_readable(path: &Path, bytes: &[u8]) -> bool {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("exr") => read_exr(path).is_ok(),
        Some("png") => read_image(path).is_ok(),
        Some("json") => serde_json::from_slice::<serde_json::Value>(bytes).is_ok(),
        _ => false,
    }
}

/// Kills a run of a kind after a time; returns true if it was still running.
fn kill(kind: &RunKind, out: &Path, is_again: bool, after: Duration) -> bool {
    let mut command = Command::new(env!("CARGO_BIN_EXE_etendue"));
    command.current_dir(root()).args(kind.arguments(out, is_again)).stdout(Stdio::null()).stderr(Stdio::null());
    let mut run = command.spawn().expect("it starts");
    std::thread::sleep(after);
    let is_running = run.try_wait().expect("a child").is_none();
    let _ = run.kill();
    run.wait().expect("it ends");
    is_running
}

/// Asserts that every file with its final name is complete.
#[track_caller]
fn check(kind: &RunKind, out: &Path, expected: &BTreeMap<String, Vec<u8>>, count: &mut KillCounts) {
    let (mut finals, mut hidden) = (0, 0);
    for (name, bytes) in contents(out) {
        let file = Path::new(&name).file_name().unwrap_or_default().to_string_lossy().into_owned();
        if file.starts_with('.') {
            assert!(file.ends_with(".part"), "{}: {name}", kind.name);
            hidden += 1;
            continue;
        }
        finals += 1;
        let is_whole = expected.get(&name) == Some(&bytes) || (kind.refines && is_readable(&out.join(&name), &bytes));
        assert!(is_whole, "{}: {name} is not whole after a kill", kind.name);
    }
    count.no_file += usize::from(finals == 0);
    count.some_files += usize::from(finals > 0);
    count.leftovers += usize::from(hidden > 0);
}

/// Kills runs of a kind at `kills` moments within them.
fn kill_repeatedly(kind: &RunKind, kills: usize, moments: &mut RandomMoments) -> KillCounts {
    let place = tempfile::tempdir().expect("a temporary folder");
    let undisturbed = place.path().join("whole");
    let begin = Instant::now();
    etendue(kind.arguments(&undisturbed, false)).ok();
    let takes = begin.elapsed();
    let expected = contents(&undisturbed);
    let (out, mut count, mut is_again) = (place.path().join("out"), KillCounts::default(), false);
    while count.killed < kills {
        assert!(count.too_late < 20 + 4 * kills, "{}: no moment is within a run", kind.name);
        match kill(kind, &out, is_again, takes.mul_f64(moments.random_fraction())) {
            true => count.killed += 1,
            false => count.too_late += 1,
        }
        check(kind, &out, &expected, &mut count);
        // A run that had ended leaves nothing to resume; others are killed again in half of all cases.
        is_again = true;
        if count.killed == kills || moments.next().is_multiple_of(2) {
            etendue(kind.arguments(&out, true)).ok();
            assert_same(&expected, &contents(&out), kind.name);
            count.completed += 1;
            std::fs::remove_dir_all(&out).expect("removed");
            is_again = false;
        }
    }
    count
}

fn setting(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

#[test]
fn runs_that_are_killed_at_random_moments_end_in_the_bytes_of_undisturbed_ones() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let shards = ["0", "1"].map(|index| text(&place.path().join(index)));
    for (index, shard) in shards.iter().enumerate() {
        etendue(["render", &small(), "--spp", "2", "--shard", &format!("{index}/2"), "-o", shard]).ok();
    }
    let many = setting("ETENDUE_KILLS").map(|kills| kills as usize);
    let kinds = RunKind::all(shards.each_ref().map(String::as_str));
    let mut moments = RandomMoments(setting("ETENDUE_KILLS_SEED").unwrap_or(1));
    let mut table =
        "| run | killed | nothing had its name | some files had | temporary files were left | rerun or resumed |\n\
                     | --- | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    let mut rows = Vec::new();
    for kind in &kinds {
        let kills = many.unwrap_or(QUICK_KILLS).div_ceil(kinds.len());
        let count = kill_repeatedly(kind, kills, &mut moments);
        let KillCounts { killed, no_file: nothing, some_files: some, leftovers, completed, .. } = count;
        rows.push(kind.row(&count, kills));
        writeln!(table, "| {} | {killed} | {nothing} | {some} | {leftovers} | {completed} |", kind.name)
            .expect("memory");
    }
    if many.is_some() {
        std::fs::write(root().join("target/kills.md"), table).expect("written");
    } else {
        let caption = "Small runs are killed and repeated until they end. Every file under a final name is complete, and the final bytes are those of an uninterrupted run. 996 kills are in docs/robustness.md (`just kills 1000`).";
        page::check("Kills at random moments", caption, &rows);
    }
}
