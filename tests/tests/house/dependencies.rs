//! What the project takes from others, held to the policy in `deny.toml`: licences, sources, one version of each. Advisories need a network: `just policy`.

use crate::root;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).expect("a file of the repository")
}

/// The texts of a list of the policy.
fn policy(key: &str) -> BTreeSet<String> {
    let text = read("deny.toml");
    let list = text.split_once(&format!("\n{key} = [")).expect("a key of the policy").1;
    let list = list.split_once(']').expect("the end of a list").0;
    let lines = list.lines().map(|line| line.split_once('#').map_or(line, |(before, _)| before));
    lines.flat_map(|line| line.split('"').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()).collect()
}

/// Name, version and source of every package of the lock file; those of the workspace have no source.
fn locked() -> Vec<(String, String, Option<String>)> {
    let text = read("Cargo.lock");
    let value = |package: &str, key: &str| {
        let line = package.lines().find_map(|line| line.strip_prefix(&format!("{key} = \"")))?;
        Some(line.trim_end_matches('"').to_owned())
    };
    let packages = text.split("[[package]]").skip(1);
    let read = |package: &str| Some((value(package, "name")?, value(package, "version")?, value(package, "source")));
    packages.map(|package| read(package).expect("a package")).collect()
}

/// Whether one of the licences of every part of an SPDX expression is allowed. `/` is an old way to write `OR`; an exception (`WITH`) only allows more.
fn is_allowed(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let (is_allowed, rest) = either(&words, allowed);
    is_allowed && rest.is_empty()
}

fn either<'a>(words: &'a [&'a str], allowed: &BTreeSet<String>) -> (bool, &'a [&'a str]) {
    let (mut is_allowed, mut rest) = both(words, allowed);
    while let Some(("OR", after)) = rest.split_first().map(|(word, after)| (*word, after)) {
        let next = both(after, allowed);
        (is_allowed, rest) = (is_allowed | next.0, next.1);
    }
    (is_allowed, rest)
}

fn both<'a>(words: &'a [&'a str], allowed: &BTreeSet<String>) -> (bool, &'a [&'a str]) {
    let (mut is_allowed, mut rest) = one(words, allowed);
    while let Some(("AND", after)) = rest.split_first().map(|(word, after)| (*word, after)) {
        let next = one(after, allowed);
        (is_allowed, rest) = (is_allowed & next.0, next.1);
    }
    (is_allowed, rest)
}

fn one<'a>(words: &'a [&'a str], allowed: &BTreeSet<String>) -> (bool, &'a [&'a str]) {
    match words {
        ["(", inner @ ..] => {
            let (is_allowed, rest) = either(inner, allowed);
            (is_allowed && rest.first() == Some(&")"), rest.get(1..).unwrap_or_default())
        }
        [licence, "WITH", _, rest @ ..] | [licence, rest @ ..] => (allowed.contains(*licence), rest),
        [] => (false, words),
    }
}

#[test]
fn every_licence_is_one_of_the_policy() {
    let allowed = policy("allow");
    assert!(allowed.contains("MIT") && allowed.len() > 2, "{allowed:?}");
    // Only what this machine builds need be there.
    let version = Command::new("rustc").arg("-vV").output().expect("rustc runs").stdout;
    let version = String::from_utf8(version).expect("text");
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline", "--filter-platform", host])
        .current_dir(root())
        .output()
        .expect("cargo metadata runs");
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    let mut violations = Vec::new();
    for package in metadata["packages"].as_array().expect("packages") {
        let licence = package["license"].as_str().unwrap_or("none is stated");
        if !is_allowed(licence, &allowed) {
            violations.push(format!("{}: {licence}", package["name"]));
        }
    }
    assert!(violations.is_empty(), "licences that deny.toml does not allow: {violations:?}");
}

#[test]
fn expressions_of_licences_are_read() {
    let allowed = BTreeSet::from(["MIT", "Zlib"].map(str::to_owned));
    for valid in ["MIT", "MIT/X", "X OR MIT", "(X OR MIT) AND Zlib", "MIT WITH E OR X", "X AND Y OR Zlib"] {
        assert!(is_allowed(valid, &allowed), "{valid}");
    }
    for illegal in ["X", "MIT AND X", "(MIT OR X) AND Y", "", "(MIT", "MIT Zlib"] {
        assert!(!is_allowed(illegal, &allowed), "{illegal}");
    }
}

#[test]
fn everything_comes_from_the_registry_of_the_policy() {
    let allowed: BTreeSet<String> = policy("allow-registry").iter().map(|index| format!("registry+{index}")).collect();
    let strange = |source: &String| !allowed.contains(source);
    let violations: Vec<_> =
        locked().into_iter().filter(|(_, _, source)| source.as_ref().is_some_and(strange)).collect();
    assert!(violations.is_empty(), "{violations:?}");
}

#[test]
fn everything_is_there_in_one_version_but_for_exceptions() {
    let mut versions: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (name, version, _) in locked() {
        versions.entry(name).or_default().push(version);
    }
    let double: BTreeSet<String> =
        versions.into_iter().filter(|(_, all)| all.len() > 1).map(|(name, _)| name).collect();
    assert_eq!(double, policy("skip"), "packages in two versions, and the exceptions of deny.toml");
}
