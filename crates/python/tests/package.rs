//! The package's own tests, in Python (`tests/test_*.py`), of the module that this workspace builds. `ETENDUE_PYTHON` names an interpreter that has NumPy and
//! what the extra "test" of `pyproject.toml` lists; without it they are skipped.

use etendue_testkit::skip::skipped;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of this test's program and of the libraries that it was built with.
fn built() -> PathBuf {
    std::env::current_exe().expect("this program").parent().expect("its folder").to_path_buf()
}

/// The package as it is installed: the files of Python with the module beside them.
fn install(folder: &Path) {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("python/etendue");
    let package = folder.join("etendue");
    std::fs::create_dir_all(&package).expect("a folder of the package");
    for file in std::fs::read_dir(sources).expect("the files of Python") {
        let file = file.expect("a file");
        if file.file_type().expect("a type").is_file() {
            std::fs::copy(file.path(), package.join(file.file_name())).expect("copied");
        }
    }
    let module = built().join(format!("{}_etendue{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX));
    let name = if cfg!(windows) { "_etendue.pyd" } else { "_etendue.abi3.so" };
    std::fs::copy(&module, package.join(name)).unwrap_or_else(|cause| panic!("{}: {cause}", module.display()));
}

#[test]
fn the_package_does_what_its_tests_say() {
    let Some(python) = std::env::var_os("ETENDUE_PYTHON") else {
        return skipped("the_package_does_what_its_tests_say", "ETENDUE_PYTHON names no interpreter");
    };
    let folder = built().join("python-package");
    install(&folder);
    let mut command = Command::new(python);
    command.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", "tests"]);
    command.current_dir(env!("CARGO_MANIFEST_DIR")).env("PYTHONPATH", &folder).env("PYTHONDONTWRITEBYTECODE", "1");
    let program =
        built().parent().expect("the folder of programs").join(format!("etendue{}", std::env::consts::EXE_SUFFIX));
    if program.is_file() {
        command.env("ETENDUE_BINARY", program);
    }
    let output = command.output().expect("Python runs");
    let told = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert!(output.status.success(), "{told}");
}
