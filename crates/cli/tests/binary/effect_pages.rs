//! A page for each effect of weather, lens, sensor and processing (docs/effects).

use crate::support::{etendue, root};
use serde_json::Value;

/// The job whose camera has electronics and processing, so that its plan lists all their effects.
const JOB: &str = "scenes/effects/effects.toml";

fn page(name: &str) -> Option<String> {
    std::fs::read_to_string(root().join(format!("docs/effects/{name}.md"))).ok()
}

#[test]
fn every_effect_that_the_plan_knows_has_a_page() {
    let plan: Value = serde_json::from_str(&etendue(["plan", JOB, "--json"]).ok().out).expect("JSON");
    let effects = plan["cameras"][0]["effects"].as_array().expect("a list");
    let is_reported = |effect: &&Value| {
        ["weather", "lens", "sensor", "processing"].contains(&effect["group"].as_str().expect("a group"))
            && effect["reason"] != "not modelled by this program"
    };
    let index = page("README").expect("the index");
    let mut count = 0;
    for effect in effects.iter().filter(is_reported) {
        let name = effect["id"].as_str().expect("an id").replace('_', "-");
        let text =
            page(&name).unwrap_or_else(|| panic!("docs/effects/{name}.md is missing: see docs/effects/README.md"));
        assert!(index.contains(&format!("]({name}.md)")), "{name} is not in docs/effects/README.md");
        for part in ["\n**Equation.** ", "\n**Keys.** ", "\n**Left out.** "] {
            assert!(text.contains(part), "docs/effects/{name}.md has no {part:?}");
        }
        assert!(text.lines().count() <= 40, "docs/effects/{name}.md is longer than 40 lines");
        count += 1;
    }
    assert!(count >= 49, "{count} effects");
}

/// The commands of the pages refer to jobs of the repository, with keys that also fit the small one; plans of the others take seconds.
#[test]
fn the_commands_of_the_pages_make_plans() {
    let mut commands = 0;
    for entry in std::fs::read_dir(root().join("docs/effects")).expect("a folder") {
        let path = entry.expect("readable").path();
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        for line in text.lines().filter(|line| line.starts_with("etendue tradeoff ")) {
            let words = words(line);
            let (job, of) = (&words[2], |name: &str| values(&words, name));
            commands += 1;
            assert!(root().join(job).is_file(), "{}: {job} is not there", path.display());
            if job != JOB {
                continue;
            }
            let vary = of("--vary").remove(0);
            let sets = of("--set").into_iter().chain(vary.split("; ").map(str::to_owned));
            let sets = sets.flat_map(|set| ["--set".to_owned(), set]);
            let camera = ["--camera".to_owned(), of("--camera").remove(0)];
            etendue(["plan".to_owned(), job.clone()].into_iter().chain(camera).chain(sets)).ok();
        }
    }
    assert!(commands >= 45, "{commands}");
}

/// Words of a shell command, without single quotes.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().expect("one at least").push(c),
        }
    }
    words
}

fn values(words: &[String], name: &str) -> Vec<String> {
    words.windows(2).filter(|pair| pair[0] == name).map(|pair| pair[1].clone()).collect()
}
