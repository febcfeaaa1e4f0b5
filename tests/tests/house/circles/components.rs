//! Strongly connected components of the arrows between files.

use std::collections::BTreeSet;

use super::house::ImportedNames;

/// Groups of two files or more, each of which leads to every other.
pub(crate) fn circles(arrows: &ImportedNames) -> Vec<Vec<String>> {
    let mut placed = BTreeSet::new();
    let mut circles = Vec::new();
    for file in arrows.keys() {
        if placed.contains(file) {
            continue;
        }
        let back = |other: &&String| reached(arrows, other).contains(file);
        let circle: Vec<String> = reached(arrows, file).iter().filter(back).cloned().collect();
        if circle.len() > 1 {
            placed.extend(circle.iter().cloned());
            circles.push(circle);
        }
    }
    circles
}

/// The files to which the arrows lead from one, itself only by a circle.
fn reached(arrows: &ImportedNames, from: &str) -> BTreeSet<String> {
    let mut visited = BTreeSet::new();
    let mut open = vec![from.to_owned()];
    while let Some(file) = open.pop() {
        for to in arrows.get(&file).into_iter().flat_map(|to| to.keys()) {
            if visited.insert(to.clone()) {
                open.push(to.clone());
            }
        }
    }
    visited
}
