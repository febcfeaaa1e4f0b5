//! Dark regions of a picture: pixels below the threshold that touch by a side.
//!
//! One pass over the rows: each row's runs of dark pixels are joined with the runs of the row above that they touch
//! (union by the smaller number).

use super::threshold::Threshold;
use crate::Image;

/// Pixels `from..to` of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) row: usize,
    pub(super) from: usize,
    pub(super) to: usize,
}

/// Regions, each as its runs, in the order of their first pixel.
pub(super) fn dark(image: &Image, threshold: &Threshold) -> Vec<Vec<Run>> {
    let mut runs: Vec<Run> = Vec::new();
    let mut parents: Vec<usize> = Vec::new();
    let mut above = 0..0;
    for (row, samples) in image.samples().chunks_exact(image.width().max(1)).enumerate() {
        let first = runs.len();
        add_runs(&mut runs, row, samples, &threshold.row(row, image.width()));
        parents.extend(first..runs.len());
        let mut other = above.start;
        for run in first..runs.len() {
            while other < above.end && runs[other].to <= runs[run].from {
                other += 1;
            }
            let mut touching = other;
            while touching < above.end && runs[touching].from < runs[run].to {
                join(&mut parents, run, touching);
                touching += 1;
            }
        }
        above = first..runs.len();
    }
    gathered(&runs, &mut parents)
}

fn add_runs(runs: &mut Vec<Run>, row: usize, samples: &[f32], thresholds: &[f32]) {
    let mut start = None;
    for (x, (value, threshold)) in samples.iter().zip(thresholds).enumerate() {
        match (value < threshold, start) {
            (true, None) => start = Some(x),
            (false, Some(from)) => {
                runs.push(Run { row, from, to: x });
                start = None;
            }
            _ => {}
        }
    }
    runs.extend(start.map(|from| Run { row, from, to: samples.len() }));
}

fn root(parents: &mut [usize], mut run: usize) -> usize {
    while parents[run] != run {
        parents[run] = parents[parents[run]];
        run = parents[run];
    }
    run
}

fn join(parents: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b)] = a.min(b);
}

fn gathered(runs: &[Run], parents: &mut [usize]) -> Vec<Vec<Run>> {
    let mut regions: Vec<Vec<Run>> = Vec::new();
    let mut numbers = vec![usize::MAX; runs.len()];
    for (i, run) in runs.iter().enumerate() {
        let root = root(parents, i);
        if numbers[root] == usize::MAX {
            numbers[root] = regions.len();
            regions.push(Vec::new());
        }
        regions[numbers[root]].push(*run);
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_that_close_below_are_one() {
        let picture = ["#.#..#", "#.#...", "###.##", "......", ".#.##."];
        let samples = picture.concat().bytes().map(|b| if b == b'#' { 0.0 } else { 1.0 }).collect();
        let image = Image::from_samples(6, 5, samples).expect("30 pixels");
        let regions = dark(&image, &Threshold::of(&image, 8));
        let areas: Vec<usize> = regions.iter().map(|r| r.iter().map(|run| run.to - run.from).sum()).collect();
        assert_eq!(areas, [7, 1, 2, 1, 2]);
    }
}
