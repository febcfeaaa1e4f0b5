//! A few inputs to every reader, and all that were found before: none may panic, take too long or too much memory.

use etendue_fuzz::attempt::{attempt, keep_panics};
use etendue_fuzz::targets::TARGETS;
use etendue_fuzz::worker::{Until, work};
use etendue_fuzz::{found, mutate};
use std::fs;
use std::sync::Mutex;

/// Memory is counted for the whole process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

/// Faults as the error of a test: panics are kept, and their messages with them.
fn none(faults: Vec<String>) -> Result<(), Vec<String>> {
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// Inputs a target: some seconds in all.
const INPUTS: u64 = 100;

#[test]
fn no_reader_is_brought_down() -> Result<(), Vec<String>> {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    keep_panics();
    let mut faults = Vec::new();
    for target in TARGETS {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let work = work(target, folder.path(), 20, Until::Inputs(INPUTS));
        assert_eq!(work.inputs, INPUTS);
        faults.extend(work.findings.into_values().map(|(fault, _)| format!("{}: {fault}", target.name)));
    }
    none(faults)
}

#[test]
fn what_was_found_is_mended() -> Result<(), Vec<String>> {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    keep_panics();
    let (mut faults, mut count) = (Vec::new(), 0);
    for target in TARGETS {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let _ = (target.prepare)(folder.path());
        let file = folder.path().join(target.file);
        for (name, input) in found::of(target.name) {
            fs::write(&file, &input).expect("written");
            let fault = attempt(target, &file).fault(target, input.len());
            faults.extend(fault.map(|fault| format!("{}/{name}: {fault}", target.name)));
            count += 1;
        }
    }
    // Findings of a reader that is not built in are not read.
    let stored = fs::read_dir(found::folder()).expect("found").flatten();
    let stored = stored.filter(|folder| cfg!(feature = "usd") || folder.file_name() != "usd");
    let files = stored.flat_map(|folder| fs::read_dir(folder.path()).into_iter().flatten()).count();
    assert_eq!(count, files, "every folder of fuzz/found is that of a target");
    none(faults)
}

#[test]
fn the_same_seed_makes_the_same_inputs() {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let inputs = [b"v 1 2 3\nf 1 2 3\n".to_vec(), b"{\"a\": [1, 2]}".to_vec()];
    let material = mutate::Material { inputs: &inputs, words: &["vt", "nan"], is_text: true };
    let of = |seed| {
        let mut mutator = mutate::Mutator::new(seed);
        (0..200).map(|_| mutator.next(material)).collect::<Vec<_>>()
    };
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
    let changed = of(1).iter().filter(|input| !inputs.contains(input)).count();
    assert!(changed > 150, "{changed}");
}
