//! A few inputs to every reader, and all that were found before: none may panic, take too long or too much memory.

use etendue_fuzz::attempt::{attempt, keep_panics};
use etendue_fuzz::targets::TARGETS;
use etendue_fuzz::worker::{StopCondition, work};
use etendue_fuzz::{mutate, stored_inputs};
use std::fs;
use std::sync::Mutex;

/// Memory is counted for the whole process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Faults as the error of a test: panics are kept, and their messages with them.
fn none(findings: Vec<String>) -> Result<(), Vec<String>> {
    if findings.is_empty() { Ok(()) } else { Err(findings) }
}

/// Inputs a target: some seconds in all.
const INPUTS: u64 = 100;

#[test]
fn no_reader_fails() -> Result<(), Vec<String>> {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    keep_panics();
    let mut findings = Vec::new();
    for target in TARGETS {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let work = work(target, folder.path(), 20, StopCondition::Inputs(INPUTS));
        assert_eq!(work.inputs, INPUTS);
        findings.extend(work.findings.into_values().map(|(finding, _)| format!("{}: {finding}", target.name)));
    }
    none(findings)
}

#[test]
fn stored_findings_are_fixed() -> Result<(), Vec<String>> {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    keep_panics();
    let (mut findings, mut count) = (Vec::new(), 0);
    for target in TARGETS {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let _ = (target.prepare)(folder.path());
        let file = folder.path().join(target.file);
        for (name, input) in stored_inputs::findings(target.name) {
            fs::write(&file, &input).expect("written");
            let finding = attempt(target, &file).finding(target, input.len());
            findings.extend(finding.map(|finding| format!("{}/{name}: {finding}", target.name)));
            count += 1;
        }
    }
    // Findings of a reader that is not built in are not read.
    let stored = fs::read_dir(stored_inputs::folder()).expect("found").flatten();
    let stored = stored.filter(|folder| cfg!(feature = "usd") || folder.file_name() != "usd");
    let files = stored.flat_map(|folder| fs::read_dir(folder.path()).into_iter().flatten()).count();
    assert_eq!(count, files, "every folder of fuzz/found is that of a target");
    none(findings)
}

#[test]
fn the_same_seed_makes_the_same_inputs() {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let inputs = [b"v 1 2 3\nf 1 2 3\n".to_vec(), b"{\"a\": [1, 2]}".to_vec()];
    let material = mutate::Material { inputs: &inputs, words: &["vt", "nan"], is_text: true };
    let inputs_of_seed = |seed| {
        let mut mutator = mutate::Mutator::new(seed);
        (0..200).map(|_| mutator.next(material)).collect::<Vec<_>>()
    };
    assert_eq!(inputs_of_seed(1), inputs_of_seed(1));
    assert_ne!(inputs_of_seed(1), inputs_of_seed(2));
    let changed = inputs_of_seed(1).iter().filter(|input| !inputs.contains(input)).count();
    assert!(changed > 150, "{changed}");
}
