//! The package's own tests, in Python (`tests/test_*.py`), of the module that this workspace builds. `ETENDUE_PYTHON` names an interpreter with NumPy and the
//! packages of the extra "test" of `pyproject.toml`; without it they are skipped. `ETENDUE_PYTHON_CLUSTER` and `ETENDUE_PYTHON_NOTEBOOKS` name one that also
//! has the extra of that name.

use etendue_testkit::skip::skipped;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folder of this test's program and of the libraries that it was built with.
fn built() -> PathBuf {
    std::env::current_exe().expect("this program").parent().expect("its folder").to_path_buf()
}

/// Installs the package: the Python files and the module in one folder.
fn install(folder: &Path) {
    let package = folder.join("etendue");
    copy(&Path::new(env!("CARGO_MANIFEST_DIR")).join("python/etendue"), &package);
    let module = built().join(format!("{}_etendue{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
    let name = if cfg!(windows) { "_etendue.pyd" } else { "_etendue.abi3.so" };
    std::fs::copy(&module, package.join(name)).unwrap_or_else(|error| panic!("{}: {error}", module.display()));
}

/// Copies a folder of Python files with its subfolders.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder of the package");
    for entry in std::fs::read_dir(from).expect("the files of Python") {
        let entry = entry.expect("an entry");
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        match entry.file_type().expect("a type").is_dir() {
            false => drop(std::fs::copy(&path, &target).expect("copied")),
            true if entry.file_name() == "__pycache__" => {}
            true => copy(&path, &target),
        }
    }
}

/// Runs the tests with a mark by the interpreter that a variable names; skipped if it names none.
fn passes(test: &str, variable: &str, mark: &str) {
    let Some(python) = std::env::var_os(variable) else {
        return skipped(test, &format!("{variable} names no interpreter"));
    };
    let folder = built().join(format!("python-package-{test}"));
    install(&folder);
    let mut command = Command::new(python);
    command.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", mark, "tests"]);
    command.current_dir(env!("CARGO_MANIFEST_DIR")).env("PYTHONPATH", &folder).env("PYTHONDONTWRITEBYTECODE", "1");
    let program =
        built().parent().expect("the folder of programs").join(format!("etendue{}", std::env::consts::EXE_SUFFIX));
    if program.is_file() {
        command.env("ETENDUE_BINARY", program);
    }
    let output = command.output().expect("Python runs");
    let output_text = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert!(output.status.success(), "{output_text}");
}

#[test]
fn the_package_does_what_its_tests_say() {
    passes("the_package_does_what_its_tests_say", "ETENDUE_PYTHON", "not cluster and not notebooks");
}

#[test]
fn notebooks_run_from_top_to_bottom() {
    passes("notebooks_run_from_top_to_bottom", "ETENDUE_PYTHON_NOTEBOOKS", "notebooks");
}

/// `just cluster`: Ray takes 400 MB of disk and 2.5 minutes.
#[test]
fn a_cluster_gives_the_bytes_of_one_machine() {
    passes("a_cluster_gives_the_bytes_of_one_machine", "ETENDUE_PYTHON_CLUSTER", "cluster");
}
