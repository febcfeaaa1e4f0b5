//! The house rules that a machine can check: the arrows between crates, the length of files, what libraries never do.

use crate::{additions, root, texts};
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// Which workspace crates a crate may use (docs/architecture.md). A new arrow is a decision, written down there.
const ARROWS: &[(&str, &[&str])] = &[
    ("core", &[]),
    ("stats", &["core"]),
    ("spectra", &["core"]),
    ("projection", &["core"]),
    ("scene", &["core", "spectra", "projection"]),
    ("tracer", &["core", "spectra"]),
    ("optics", &["core", "spectra", "projection"]),
    ("sensor", &["core", "spectra"]),
    ("isp", &["core", "spectra"]),
    ("pipeline", &["core", "stats", "spectra", "projection", "scene", "tracer", "optics", "sensor", "isp"]),
    ("io", &["core", "spectra", "projection", "scene"]),
    ("arguments", &["core", "scene"]),
    ("import", &["core", "spectra", "scene", "io"]),
    ("charts", &["core", "spectra", "scene"]),
    ("metrology", &["core", "stats", "spectra", "projection"]),
    ("plan-report", &["core", "projection", "scene", "tracer", "optics", "sensor", "isp", "pipeline", "io"]),
    (
        "measurement",
        &[
            "arguments",
            "core",
            "stats",
            "spectra",
            "projection",
            "scene",
            "optics",
            "sensor",
            "isp",
            "pipeline",
            "io",
            "charts",
            "metrology",
            "plan-report",
        ],
    ),
    (
        "run",
        &[
            "arguments",
            "core",
            "spectra",
            "projection",
            "scene",
            "tracer",
            "optics",
            "sensor",
            "pipeline",
            "io",
            "charts",
            "plan-report",
        ],
    ),
    ("etendue", &["core", "tracer", "sensor", "pipeline", "io", "import", "plan-report", "measurement", "run"]),
    ("study", &["core", "stats", "etendue"]),
    ("dataset", &["arguments", "core", "scene", "io", "etendue"]),
    ("view", &["arguments", "core", "io", "etendue"]),
    ("cli", &["arguments", "dataset", "etendue", "scene", "study", "view"]),
    ("python", &["core", "etendue", "cli"]),
    ("testkit", &["core", "stats"]),
    ("scenes", &["core"]),
    ("packaging", &["cli"]),
];

/// Libraries that matter, and the only crates that may use them.
const RESTRICTED_LIBRARIES: &[(&str, &[&str])] = &[
    ("obvhs", &["tracer"]),
    ("exr", &["io"]),
    ("image", &["io", "scenes"]),
    ("tobj", &["io"]),
    ("gltf", &["io"]),
    ("roxmltree", &["import", "io"]),
    ("openusd", &["import"]),
    ("lz4_flex", &["import"]),
    ("saphyr-parser", &["io"]),
    ("toml", &["scene"]),
    ("clap", &["arguments", "measurement", "run", "import", "study", "dataset", "view", "cli"]),
    ("clap_complete", &["packaging"]),
    ("clap_mangen", &["packaging"]),
    ("indicatif", &["cli"]),
    ("tracing-subscriber", &["cli"]),
    ("libm", &["core"]),
    ("pyo3", &["python"]),
];

/// The packages of the workspace, as cargo knows them.
fn metadata() -> serde_json::Value {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo metadata runs");
    serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON")
}

/// Normal (not dev) dependencies of every workspace crate, without the prefix of workspace names.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let metadata = metadata();
    let short = |name: &serde_json::Value| name.as_str().expect("a name").trim_start_matches("etendue-").to_owned();
    let packages = metadata["packages"].as_array().expect("packages");
    packages
        .iter()
        .map(|package| {
            let dependencies = package["dependencies"].as_array().expect("dependencies");
            let normal = dependencies.iter().filter(|d| d["kind"].is_null()).map(|d| short(&d["name"]));
            (short(&package["name"]), normal.collect())
        })
        .collect()
}

#[test]
fn crates_use_only_what_the_architecture_allows() {
    let dependencies = dependencies();
    let workspace: BTreeSet<&str> = dependencies.keys().map(String::as_str).collect();
    let mut violations = Vec::new();
    for (name, allowed) in ARROWS {
        let used = dependencies.get(*name).unwrap_or_else(|| panic!("crate {name} is in the table but not there"));
        for arrow in used.iter().filter(|u| workspace.contains(u.as_str()) && !allowed.contains(&u.as_str())) {
            violations.push(format!("{name} → {arrow}"));
        }
    }
    assert!(violations.is_empty(), "arrows that are not in the table: {violations:?}");
    let listed: BTreeSet<&str> = ARROWS
        .iter()
        .map(|(name, _)| *name)
        .chain(["tests", "benches", "bench-rays", "instructions", "validation", "fuzz"])
        .collect();
    assert!(workspace.is_subset(&listed), "crates missing from the table: {:?}", &workspace - &listed);
}

#[test]
fn libraries_stay_with_their_keepers() {
    let mut violations = Vec::new();
    for (name, used) in dependencies() {
        for (library, keepers) in RESTRICTED_LIBRARIES {
            if used.contains(*library) && !keepers.contains(&name.as_str()) && name != "benches" {
                violations.push(format!("{name} uses {library}"));
            }
        }
    }
    assert!(violations.is_empty(), "{violations:?}");
}

#[test]
fn files_stay_readable_and_never_a_drawer() {
    const MAX_FILE_LINES: usize = 450;
    let drawers = ["utils.rs", "util.rs", "common.rs", "helpers.rs", "misc.rs"];
    let mut violations = Vec::new();
    for (name, text) in texts(&[".rs"]) {
        let lines = text.lines().count();
        if lines > MAX_FILE_LINES {
            violations.push(format!("{name}: {lines} lines, more than {MAX_FILE_LINES}: one concept a file"));
        }
        if drawers.iter().any(|d| name.ends_with(&format!("/{d}"))) {
            violations.push(format!("{name}: name the concept"));
        }
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn libraries_do_not_print_read_clocks_or_start_pools() {
    let forbidden = ["println!(", "eprintln!(", "SystemTime::now", "Instant::now", "build_global("];
    let mut violations = Vec::new();
    for (name, text) in texts(&[".rs"]) {
        let is_program = ["crates/cli/", "crates/python/"].iter().any(|folder| name.starts_with(folder));
        let library = name.starts_with("crates/") && !is_program && !name.contains("/examples/");
        if library && !name.contains("/tests/") {
            violations.extend(forbidden.iter().filter(|f| text.contains(**f)).map(|f| format!("{name}: {f}")));
        }
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

/// Flags in texts below the front ends: messages name arguments by their fields, and a front end spells them. Left are commands of other programs and commands
/// that are printed or written to be run.
const FLAGS_BELOW_FRONT_ENDS: usize = 11;

#[test]
fn only_front_ends_spell_flags() {
    let is_flag = |text: &str| {
        text.match_indices("--").any(|(at, _)| {
            let before = text[..at].chars().next_back();
            let after = text[at + 2..].chars().next();
            after.is_some_and(|c| c.is_ascii_lowercase() || c == '{') && before.is_none_or(|c| c != '-')
        })
    };
    let mut flags = Vec::new();
    for (name, text) in texts(&[".rs"]) {
        let is_front_end =
            ["crates/cli/", "crates/python/", "crates/testkit/"].iter().any(|front| name.starts_with(front));
        if !name.starts_with("crates/") || !name.contains("/src/") || is_front_end {
            continue;
        }
        let is_code = |line: &&str| !line.trim_start().starts_with("//") && !line.trim_start().starts_with("#[");
        flags.extend(
            text.lines().filter(is_code).filter(|line| is_flag(line)).map(|line| format!("{name}: {}", line.trim())),
        );
    }
    assert!(
        flags.len() <= FLAGS_BELOW_FRONT_ENDS,
        "{} flags, more than {FLAGS_BELOW_FRONT_ENDS}: {flags:#?}",
        flags.len()
    );
}

#[test]
fn nothing_names_a_machine() {
    let homes = ["root", "home", "work", "tmp"].map(|folder| format!("/{folder}/"));
    let mut violations = Vec::new();
    for (name, text) in texts(&[".rs", ".toml", ".md", ".py", ".json", ".yml", "justfile", "run"]) {
        violations.extend(homes.iter().filter(|h| text.contains(h.as_str())).map(|h| format!("{name}: {h}")));
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

#[test]
fn no_merge_is_left_undone() {
    let marks = ["<<<<<<< ", "||||||| ", ">>>>>>> "];
    let mut violations = Vec::new();
    for (name, text) in texts(&[".rs", ".toml", ".md", ".py", ".json", ".yml", "justfile"]) {
        let marked = text.lines().enumerate().filter(|(_, line)| marks.iter().any(|mark| line.starts_with(mark)));
        violations.extend(marked.map(|(i, _)| format!("{name}:{}", i + 1)));
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

/// Words of former versions that no engineer of the field would look for, with what stands in their place (docs/glossary.md). None is an
/// alias: nothing reads them.
const REPLACED: &[(&str, &str)] = &[
    ("tail_sharing_px", "path_reuse_px"),
    ("paper_filters", "image_filters"),
    ("front_rim", "front_aperture"),
    ("rear_rim", "rear_aperture"),
    ("alike_px", "correlated_block_px"),
    ("region_px", "roi_px"),
    ("cross_talk", "crosstalk"),
    ("same_charge", "dual_conversion_gain"),
    ("switch_at", "transition_level"),
    ("dead_share", "dead_fraction"),
    ("exposure_share", "exposure_ratio"),
    ("gain_share", "gain_ratio"),
    ("diffusion_share", "diffusion_fraction"),
    ("etendue_sr", "projected_solid_angle_sr"),
    ("Lottery", "DiscreteSampler"),
    ("Palette", "MaterialTable"),
    ("MeshTree", "Blas"),
    ("Workshop", "MaterialCompiler"),
    ("gather_glow", "add_emission"),
    ("gather_drawn", "sample_direct_light"),
    ("met_pdf", "light_pdf"),
    ("MovedBorders", "PreparedBrighterFatter"),
    ("NoisyRead", "PreparedReadNoise"),
    ("Telling", "ReportArgs"),
    ("stand-in camera", "reference camera"),
];

#[test]
fn words_are_the_field_s_own() {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut violations = Vec::new();
    for (name, text) in texts(&[".rs", ".toml", ".md", ".py", ".txt"]) {
        if ["tests/tests/house/tidy.rs", "docs/glossary.md", "CHANGELOG.md"].contains(&name.as_str()) {
            continue;
        }
        for (old, new) in REPLACED {
            let stands = text.match_indices(old).any(|(at, _)| {
                let before = text[..at].chars().next_back().is_none_or(|c| !is_part(c));
                let after =
                    text[at + old.len()..].chars().next().is_none_or(|c| !is_part(c) || *old == "stand-in camera");
                before && after
            });
            if stands {
                violations.push(format!("{name}: {old}, now {new}"));
            }
        }
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

/// Words in backticks.
pub(crate) fn quoted(page: &str) -> impl Iterator<Item = &str> {
    page.split('`').skip(1).step_by(2)
}

/// Whether a word means a file or folder of the repository.
fn is_path(word: &&str) -> bool {
    let rooms = ["crates/", "docs/", "tests/", "scenes/", "charts/", "benches/", ".ci/"];
    rooms.iter().any(|room| word.starts_with(room)) && !word.contains(char::is_whitespace)
}

/// Pages for those who add to the project.
fn contributors_pages() -> Vec<(String, String)> {
    let is_one = |name: &str| name == "CONTRIBUTING.md" || name.starts_with("docs/how-to-add/");
    texts(&[".md"]).into_iter().filter(|(name, _)| is_one(name)).collect()
}

#[test]
fn paths_for_contributors_exist() {
    let pages = contributors_pages();
    assert!(pages.len() > 8, "CONTRIBUTING.md and docs/how-to-add");
    let added = additions::files_of_all();
    let mut violations = Vec::new();
    for (name, page) in &pages {
        let is_there = |path: &str| root().join(path).exists() || added.contains(path);
        let missing = quoted(page).filter(is_path).filter(|path| !is_there(path));
        violations.extend(missing.map(|path| format!("{name}: {path} does not exist")));
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

/// How many code files adding a thing touches is a measure of the design: each page states it, its steps name them, the index repeats it.
#[test]
fn how_to_add_counts_its_code_files() {
    const MAX_FUNCTION_LINES: usize = 80;
    let pages = contributors_pages();
    let index = "docs/how-to-add/README.md";
    let (_, table) = pages.iter().find(|(name, _)| name == index).expect("an index");
    let mut violations = Vec::new();
    for (name, page) in pages.iter().filter(|(name, _)| name.starts_with("docs/how-to-add/") && name != index) {
        let stated = page.split_once("Touches ").and_then(|(_, rest)| rest.split_once(" code files"));
        let stated = stated.and_then(|(count, _)| count.parse::<usize>().ok());
        let steps = page.split_once("\n## Steps\n").map_or("", |(_, rest)| rest.split("\n## ").next().unwrap_or(rest));
        let files: BTreeSet<&str> = quoted(steps).filter(|w| w.starts_with("crates/") && w.ends_with(".rs")).collect();
        if stated != Some(files.len()) {
            violations.push(format!("{name} states {stated:?} code files, its steps name {}", files.len()));
        }
        let file = name.trim_start_matches("docs/how-to-add/");
        let row = table.lines().find(|line| line.contains(&format!("]({file})")));
        if !row.is_some_and(|row| row.ends_with(&format!("| {} |", files.len()))) {
            violations.push(format!("{index}: the row of {file} lacks its {} code files", files.len()));
        }
        if page.lines().count() > MAX_FUNCTION_LINES {
            violations.push(format!("{name}: more than {MAX_FUNCTION_LINES} lines"));
        }
    }
    assert!(violations.is_empty(), "{violations:#?}");
}

/// The change log, every package of the workspace and the Python package have one version; the program states it (`crates/cli/tests/binary/help.rs`).
#[test]
fn there_is_one_version() {
    let read = |name: &str| std::fs::read_to_string(root().join(name)).expect("a file of the repository");
    let changes = read("CHANGELOG.md");
    let latest = changes.lines().find_map(|line| line.strip_prefix("## ")).expect("a release");
    let latest = latest.split(' ').next().expect("its version");
    let metadata = metadata();
    for package in metadata["packages"].as_array().expect("packages") {
        assert_eq!(package["version"], latest, "{} and the newest of CHANGELOG.md", package["name"]);
    }
    // maturin takes the version from the package of cargo.
    assert!(read("crates/python/pyproject.toml").contains("\ndynamic = [\"version\"]\n"));
}
