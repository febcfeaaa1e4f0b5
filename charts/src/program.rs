//! Runs of the program.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program `etendue`.
pub(crate) struct Program(PathBuf);

impl Program {
    /// The one that the environment names in ETENDUE, or a release build.
    pub(crate) fn found() -> Result<Self, String> {
        if let Some(path) = std::env::var_os("ETENDUE") {
            return Ok(Self(path.into()));
        }
        let built = Command::new(env!("CARGO")).args(["build", "--release", "-q", "-p", "etendue-cli"]).status();
        match built {
            Ok(status) if status.success() => Ok(Self("target/release/etendue".into())),
            _ => Err("the program cannot be built: cargo build --release -p etendue-cli".to_owned()),
        }
    }

    fn output(&self, arguments: &[String]) -> Result<Output, String> {
        let told = |cause| format!("{}: {cause}", self.0.display());
        Command::new(&self.0).args(arguments).output().map_err(told)
    }

    /// What it prints; any status but 0 is an error.
    pub(crate) fn run(&self, arguments: &[String]) -> Result<String, String> {
        self.run_until(arguments, 0)
    }

    fn run_until(&self, arguments: &[String], last_status: i32) -> Result<String, String> {
        let output = self.output(arguments)?;
        if output.status.code().is_some_and(|status| status <= last_status) {
            return String::from_utf8(output.stdout).map_err(|e| e.to_string());
        }
        Err(format!("etendue {}:\n{}", arguments.join(" "), String::from_utf8_lossy(&output.stderr).trim()))
    }

    /// Measures and keeps the report beside: `measure KIND …`.
    pub(crate) fn measured(&self, report: &Path, arguments: &[String]) -> Result<(), String> {
        let printed = self.run(&[words("measure"), arguments.to_vec(), words("--json")].concat())?;
        std::fs::write(report, printed).map_err(|cause| format!("{}: {cause}", report.display()))
    }

    /// Two sides compared; that they differ is no error.
    pub(crate) fn compared(&self, a: &Path, b: &Path, arguments: &[String]) -> Result<Value, String> {
        let sides = [text(a), text(b)].to_vec();
        let printed = self.run_until(&[words("measure compare --json"), sides, arguments.to_vec()].concat(), 1)?;
        serde_json::from_str(&printed).map_err(|cause| format!("measure compare: {cause}"))
    }
}

/// Arguments without spaces of their own.
pub(crate) fn words(text: &str) -> Vec<String> {
    text.split_whitespace().map(str::to_owned).collect()
}

pub(crate) fn text(path: &Path) -> String {
    path.display().to_string()
}

/// A JSON file.
pub(crate) fn json(file: &Path) -> Result<Value, String> {
    let text = std::fs::read_to_string(file).map_err(|cause| format!("{}: {cause}", file.display()))?;
    serde_json::from_str(&text).map_err(|cause| format!("{}: {cause}", file.display()))
}
