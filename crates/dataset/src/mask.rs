//! Masks in COCO's run lengths.
//!
//! Pixels are taken column by column; runs of pixels outside and inside take turns, beginning outside. The text of the runs is that of COCO's API (`rleToString`, Lin et al. 2014): from
//! the fourth run on the difference to the run two before, in groups of five bits from the lowest, each with a bit that says whether more follow, plus 48.

use std::collections::BTreeMap;

/// The run lengths of every identity but 0, of `width` columns.
pub(crate) fn run_lengths(ids: &[u32], width: usize) -> BTreeMap<u32, Vec<u32>> {
    let height = ids.len().checked_div(width).unwrap_or(0);
    let mut found: BTreeMap<u32, Runs> = BTreeMap::new();
    for at in 0..ids.len() {
        let id = ids[(at % height) * width + at / height];
        if id > 0 {
            found.entry(id).or_default().add(at);
        }
    }
    found.into_iter().map(|(id, runs)| (id, runs.ended(ids.len()))).collect()
}

/// Runs so far.
#[derive(Default)]
struct Runs {
    lengths: Vec<u32>,
    /// One past the last pixel inside.
    end: usize,
}

impl Runs {
    /// A pixel inside, behind all others.
    fn add(&mut self, at: usize) {
        match self.lengths.last_mut() {
            Some(inside) if at == self.end => *inside += 1,
            _ => self.lengths.extend([(at - self.end) as u32, 1]),
        }
        self.end = at + 1;
    }

    fn ended(mut self, pixels: usize) -> Vec<u32> {
        if self.end < pixels {
            self.lengths.push((pixels - self.end) as u32);
        }
        self.lengths
    }
}

/// The text of run lengths.
pub(crate) fn text(runs: &[u32]) -> String {
    let mut text = String::new();
    for (i, run) in runs.iter().enumerate() {
        let before = if i > 2 { i64::from(runs[i - 2]) } else { 0 };
        let mut left = i64::from(*run) - before;
        loop {
            let bits = (left & 0x1f) as u8;
            left >>= 5;
            let ends = if bits & 0x10 != 0 { left == -1 } else { left == 0 };
            text.push(char::from(48 + if ends { bits } else { bits | 0x20 }));
            if ends {
                break;
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_go_down_the_columns_and_begin_outside() {
        // Columns: 1 1, 2 0, 1 2.
        let found = run_lengths(&[1, 2, 1, 1, 0, 2], 3);
        assert_eq!(found[&1], [0, 2, 2, 1, 1]);
        assert_eq!(found[&2], [2, 1, 2, 1]);
        assert!(run_lengths(&[], 0).is_empty());
    }

    #[test]
    fn texts_are_those_of_coco_s_api() {
        // By pycocotools 2.0.11, mask.frPyObjects of the same counts.
        assert_eq!(text(&[0, 2, 2, 1, 1]), "022OO");
        assert_eq!(text(&[6, 1, 40, 4, 5, 4, 5, 4, 21]), "61X13mN000`0");
    }
}
