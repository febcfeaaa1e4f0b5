//! The script for Slurm, called as by Slurm.

use crate::support::{assert_same, contents, rendered, root, small, text};
use std::path::Path;
use std::process::Command;

/// Runs the script with the variables of an array task: (index, count, largest index); returns its status and output.
fn run(arguments: &[&str], task: Option<(u32, u32, u32)>) -> (i32, String) {
    let mut command = Command::new("bash");
    command
        .current_dir(root())
        .arg("docs/cluster/slurm.sh")
        .args(arguments)
        .env("ETENDUE", env!("CARGO_BIN_EXE_etendue"));
    command.env_remove("SLURM_ARRAY_TASK_ID").env("SLURM_CPUS_PER_TASK", "2");
    if let Some((index, count, last)) = task {
        for (name, value) in [("ID", index), ("COUNT", count), ("MIN", last + 1 - count), ("MAX", last)] {
            command.env(format!("SLURM_ARRAY_TASK_{name}"), value.to_string());
        }
    }
    let output = command.output().expect("bash runs");
    (output.status.code().expect("it ends by itself"), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn an_array_of_tasks_and_a_merge_give_the_bytes_of_one_run() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (small(), text(&place.path().join("with blank/out")));
    // The second task is requeued.
    for index in [2, 1, 0, 1] {
        let (status, output) = run(&[&job, &out, "--spp", "4", "--frames", "0..2"], Some((index, 3, 2)));
        assert_eq!(status, 0, "{output}");
    }
    assert_eq!(run(&[&job, &out], None).0, 0);
    let expected = rendered(&job, &["--spp", "4", "--frames", "0..2"]);
    assert_same(&expected, &contents(Path::new(&out)), "an array of three");
}

#[test]
fn what_the_script_cannot_do_is_refused_with_status_2() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let (job, out) = (small(), text(&place.path().join("out")));
    let first = Some((0, 2, 1));
    for (arguments, task, expected) in [
        (vec![], first, "expected JOB.toml OUT"),
        (vec!["no/job.toml", &out], first, "no/job.toml"),
        (vec![&job, "--spp"], first, "output folder"),
        (vec![&job, &out, "--shard", "0/2"], first, "--shard"),
        (vec![&job, &out], Some((1, 2, 2)), "--array=0-N"),
        (vec![&job, &out], None, "no shards"),
        (vec![&job, &out, "--spp", "4"], None, "--spp"),
    ] {
        let (status, output) = run(&arguments, task);
        assert!(
            status == 2 && output.starts_with("error: ") && output.contains(expected),
            "{arguments:?}: {status}, {output}"
        );
    }
    assert!(!Path::new(&out).exists());
    assert_eq!(run(&[&job, &out, "--spp", "4"], first).0, 0);
    let (status, output) = run(&[&job, &out], None);
    assert!(status == 2 && output.contains("1 of 2 shards"), "{output}");
    assert!(Path::new(&out).join(".shards/0/shard.json").exists(), "what is there is kept");
}
