//! The catalogue of errors: its examples have their errors, and the page of errors is generated from it.

use crate::support::{CommandOutput, bless, error_code, etendue, etendue_in, root, tests};
use etendue::{ErrorCode, ExampleContext};
use std::fs::{self, File};
use std::path::Path;

/// Edits of the small job that prepare an example.
fn edits(code: ErrorCode) -> &'static [(&'static str, &'static str)] {
    match code {
        ErrorCode::WrongCount => &[("white_balance = \"D65\"", "white_balance = [1.9, 1, 1.4]")],
        ErrorCode::ImpossibleTiming => &[("[render]", "[sequence]\nframe_rate_hz = 30\n\n[render]")],
        ErrorCode::NotEnoughMemory => {
            &[("width_px = 46", "width_px = 460"), ("height_px = 30", "height_px = 300"), ("um = 120", "um = 12")]
        }
        _ => &[],
    }
}

/// Writes the files that the example of a code needs next to the small job; a returned file stays open.
fn prepare(code: ErrorCode, folder: &Path) -> Option<File> {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("written");
    let copy = |from: &str, name: &str| {
        fs::copy(root().join(from), folder.join(name)).expect("copied");
    };
    match code {
        ErrorCode::WrongFileKind => copy("scenes/cameras/web.toml", "camera.toml"),
        ErrorCode::UnreadableFile => fs::create_dir(folder.join("scenes")).expect("made"),
        ErrorCode::UnsuitableFile => write("defects.csv", "x,y\n3,4\n46,4\n"),
        ErrorCode::OutsideFolder => {
            let job = fs::read_to_string(folder.join("job.toml")).expect("the job");
            write("outside.toml", &job.replace("file = \"checker.png\"", "file = \"../checker.png\""));
        }
        ErrorCode::OutputExists => drop(etendue_in(folder, ["rig", "job.toml", "-o", "done"]).ok()),
        ErrorCode::OtherRun => {
            for (index, name) in [("0/2", "shard"), ("1/2", "shard2")] {
                etendue_in(folder, ["render", "job.toml", "-o", name, "--shard", index]).ok();
            }
        }
        ErrorCode::NotComparable => copy("scenes/import/letter.png", "letter.png"),
        ErrorCode::FolderInUse => {
            fs::create_dir(folder.join("busy")).expect("made");
            let busy = File::open(folder.join("busy")).expect("a folder");
            busy.lock().expect("locked");
            return Some(busy);
        }
        _ => {}
    }
    None
}

/// Commands whose corrected form takes long, or needs files that no test makes here.
const NOT_RUN: [ErrorCode; 3] = [ErrorCode::NotMeasurable, ErrorCode::NotStated, ErrorCode::NotEnoughMemory];

fn replace_in_file(path: &Path, from: &str, to: &str) {
    let text = fs::read_to_string(path).expect("text");
    assert!(text.contains(from), "{} lacks {from}", path.display());
    fs::write(path, text.replacen(from, to, 1)).expect("written");
}

/// Arguments of a command of the catalogue.
fn words(command: &str) -> Vec<String> {
    let word = |word: &str| match word.strip_prefix('`').and_then(|word| word.strip_suffix('`')) {
        Some("memory_mb") => "--memory".to_owned(),
        Some(field) => format!("--{}", field.replace('_', "-")),
        None => word.to_owned(),
    };
    command.split_whitespace().map(word).collect()
}

fn codes(output: &CommandOutput) -> Vec<&str> {
    output.err.lines().filter_map(error_code).collect()
}

#[test]
fn every_example_has_its_error_and_none_when_mended() {
    for code in ErrorCode::ALL.iter().copied() {
        let place = tempfile::tempdir().expect("a temporary folder");
        let folder = place.path();
        for entry in fs::read_dir(tests().join("jobs/small")).expect("the small job") {
            let path = entry.expect("readable").path();
            fs::copy(&path, folder.join(path.file_name().expect("a name"))).expect("copied");
        }
        let job = folder.join("job.toml");
        fs::rename(folder.join("small.toml"), &job).expect("renamed");
        edits(code).iter().for_each(|(from, to)| replace_in_file(&job, from, to));
        let prepared = prepare(code, folder);
        let example = code.explanation().example;
        let modified = match example.context {
            ExampleContext::Keys => Some(job),
            ExampleContext::File(name) => Some(folder.join(name)),
            ExampleContext::Command => None,
        };
        let (wrong, right) = match &modified {
            Some(_) => ("plan job.toml", "plan job.toml"),
            None => (example.wrong, example.right),
        };
        if !NOT_RUN.contains(&code) && prepared.is_none() && modified.is_some() {
            etendue_in(folder, words(right)).ok();
        }
        if let Some(path) = &modified {
            replace_in_file(path, example.right, example.wrong);
        }
        let output = etendue_in(folder, words(wrong));
        assert!(output.status == 2 && codes(&output).contains(&code.word()), "{code}: {output:?}");
        if modified.is_none() && !NOT_RUN.contains(&code) {
            etendue_in(folder, words(right)).ok();
        }
    }
}

#[test]
fn a_code_is_explained_with_cause_example_and_remedy() {
    let printed = etendue(["explain", "unknown-key"]).ok().out;
    for part in ["unknown-key: A table has a key", "focal_lenght_mm = 6", "focal_length_mm = 6", "What to do: "] {
        assert!(printed.contains(part), "{printed}");
    }
    assert!(etendue(["explain", "output-exists"]).ok().out.contains("with --overwrite."), "flags are spelled");
    let list = etendue(["explain"]).ok().out;
    assert_eq!(list.lines().count(), ErrorCode::ALL.len());
    let output = etendue(["explain", "unknwn-key"]);
    assert_eq!(output.status, 2);
    let expected = "error[unknown-name]: there is no error code \"unknwn-key\"; did you mean \"unknown-key\"?\n";
    assert_eq!(output.err, expected);
}

#[test]
fn codes_are_words_of_their_own() {
    for (i, code) in ErrorCode::ALL.iter().enumerate() {
        let word = code.word();
        assert!(word.chars().all(|c| c.is_ascii_lowercase() || c == '-') && word.parse() == Ok(*code), "{word}");
        assert!(ErrorCode::ALL[..i].iter().all(|other| other.word() != word), "{word}");
        let explanation = code.explanation();
        assert!([explanation.cause, explanation.remedy].iter().all(|text| text.ends_with('.')), "{word}");
    }
}

/// The part of the page of errors below its mark.
fn page() -> String {
    let mut page = String::from("| code | cause | what to do |\n| --- | --- | --- |\n");
    for code in ErrorCode::ALL {
        let printed = etendue(["explain", code.word()]).ok().out;
        let remedy = printed.lines().find_map(|line| line.strip_prefix("What to do: ")).expect("a remedy");
        page.push_str(&format!("| `{code}` | {} | {remedy} |\n", code.explanation().cause));
    }
    page
}

#[test]
fn the_page_of_errors_is_the_catalogue() {
    const MARK: &str = "<!-- catalogue: made by the tests of crates/cli; ETENDUE_BLESS=1 writes it anew -->\n\n";
    let path = root().join("docs/errors.md");
    let text = fs::read_to_string(&path).expect("the page");
    let (head, stored) = text.split_once(MARK).expect("its mark");
    let generated = page();
    if bless() {
        fs::write(&path, format!("{head}{MARK}{generated}")).expect("written");
    } else {
        assert_eq!(
            stored, generated,
            "write it anew with ETENDUE_BLESS=1 cargo test -p etendue-cli --test binary explain::"
        );
    }
}
