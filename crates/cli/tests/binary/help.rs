//! Help texts of the program.

use crate::support::{etendue, root};

/// Verbs.
const VERBS: &[&str] = &[
    "render",
    "rig",
    "merge",
    "plan",
    "expose",
    "develop",
    "flat",
    "datasheet",
    "inspect",
    "view",
    "compare",
    "calibrate",
    "schema",
    "explain",
    "tradeoff",
    "dataset",
    "characterise",
    "laboratory",
];
/// Verbs whose options belong to their subcommands.
const GROUPS: [&str; 2] = ["chart", "measure"];

#[test]
fn help_names_every_verb_and_the_exit_statuses() {
    let help = etendue(["--help"]).ok().out;
    let statuses = ["Exit status: 0 done, 1", "2 unusable"];
    for word in VERBS.iter().copied().chain(GROUPS).chain(statuses) {
        assert!(help.contains(word), "{word} is missing in:\n{help}");
    }
}

/// `tests/tests/house/tidy.rs` checks that all packages of the workspace have this version.
#[test]
fn the_version_is_the_newest_of_the_change_log() {
    let changes = std::fs::read_to_string(root().join("CHANGELOG.md")).expect("the change log");
    let newest = changes.lines().find_map(|line| line.strip_prefix("## ")).expect("a release");
    let newest = newest.split(' ').next().expect("its version");
    assert_eq!(etendue(["--version"]).ok().out, format!("etendue {newest}\n"));
}

#[test]
fn every_option_explains_itself() {
    for verb in VERBS.iter().copied() {
        let help = etendue(["help", verb]).ok().out;
        let options = help.lines().filter(|line| line.trim_start().starts_with("--")).count();
        let lines: Vec<&str> = help.lines().collect();
        let is_option = |line: &str| line.trim_start().starts_with("--");
        // The text is next to the option or below it.
        let explained =
            lines.windows(2).filter(|w| is_option(w[0]) && (w[0].contains("   ") || !w[1].trim().is_empty()));
        assert_eq!(options, explained.count(), "{help}");
    }
}

#[test]
fn a_lens_is_measured_as_text_and_as_json() {
    let text = etendue(["measure", "lens", "double-gauss"]).ok().out;
    assert!(text.contains("focal length") && text.contains("entrance pupil"), "{text}");
    let json: serde_json::Value =
        serde_json::from_str(&etendue(["measure", "lens", "telephoto", "--json", "--fields", "4"]).ok().out)
            .expect("JSON");
    // The lens of the patent has a focal length of 100 mm.
    assert!((json["focal_length_mm"].as_f64().expect("a number") - 100.0).abs() < 2.0, "{json}");
    assert_eq!(json["fields"].as_array().map(Vec::len), Some(4));
    assert!(text.contains("ghosts of a far point") && !text.contains("-0.0000 "), "{text}");
    let ghosts = json["fields"][0]["ghosts"].as_array().expect("ghosts");
    assert_eq!(ghosts.len(), 3);
    let light = |i: usize| ghosts[i]["light"].as_f64().expect("a number");
    assert!(light(0) >= light(1) && light(0) < 0.01 && light(2) > 0.0, "{ghosts:?}");
    etendue(["measure", "lens", "biotar"]).refused(&["biotar", "double-gauss"]);
}

#[test]
fn a_lens_file_is_measured_as_far_as_its_fields() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let file = place.path().join("singlet.seq");
    let lens = |fields: &str| {
        format!(
            "RDM\nDIM M\nEPD 4\nWL 587.56\n{fields}\nSO 0 1e20\nS 50 4 NBK7_SCHOTT\nCIR 8\nSTO\nS -50 47\nCIR 8\nSI 0 0\nGO\n"
        )
    };
    let radius = |fields: &str| {
        std::fs::write(&file, lens(fields)).expect("written");
        let path = file.to_str().expect("a path");
        let text = etendue(["measure", "lens", path, "--json", "--fields", "2"]).ok().out;
        let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let edge = &json["fields"][1];
        (edge["height_mm"].as_f64().expect("a number"), edge["angle_deg"].as_f64().expect("a number"))
    };
    assert!((radius("YIM 0 3 7").0 - 7.0).abs() < 1e-9);
    assert!((radius("YAN 0 5 9").1 - 9.0).abs() < 1e-6, "{:?}", radius("YAN 0 5 9"));
}

#[test]
fn unknown_words_are_refused_with_status_2() {
    etendue(["rende", "x"]).refused(&["rende"]);
    etendue(["render", "x.toml", "-o", "y", "--frame", "0..1"]).refused(&["--frame"]);
    etendue(["render", "x.toml", "-o", "y", "--frames", "3..3"]).refused(&["FIRST < END"]);
    etendue(["render", "x.toml", "-o", "y", "--shard", "3/3"]).refused(&["I < N"]);
    etendue(["render", "x.toml", "-o", "y", "--threads", "0"]).refused(&["--threads"]);
    etendue(["render", "x.toml"]).refused(&["--output"]);
}

#[test]
fn schemas_are_json_that_names_the_keys() {
    for (kind, key) in [("scene", "materials"), ("camera", "lens"), ("job", "cameras")] {
        let schema: serde_json::Value = serde_json::from_str(&etendue(["schema", kind]).ok().out).expect("JSON");
        assert!(schema.to_string().contains(&format!("\"{key}\"")), "{kind}: {key}");
    }
}

/// Words in backticks are keys of files here, although one of them is also the name of an argument (`time_s`, `--time`).
#[test]
fn schemas_keep_the_words_of_files() {
    let schema = etendue(["schema", "job"]).ok().out;
    assert!(schema.contains("`time_s`, `x_m`, `y_m`") && !schema.contains("--time"), "{schema}");
}
