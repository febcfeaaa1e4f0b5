//! The nearest valid word to a misspelt one.

/// Returns the word nearest to `found` (optimal string alignment distance), if at most a third of its letters and one differ. Case is ignored.
pub(crate) fn nearest<'w>(name: &str, words: &[&'w str]) -> Option<&'w str> {
    let name = name.to_lowercase();
    let scored = words.iter().map(|w| (distance(&name, &w.to_lowercase()), *w));
    scored.filter(|(d, w)| *d <= w.chars().count() / 3 + 1).min_by_key(|(d, _)| *d).map(|(_, w)| w)
}

/// Number of insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`.
fn distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let row = next_row(&a, &b, i, &rows);
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

fn next_row(a: &[char], b: &[char], i: usize, rows: &[Vec<usize>]) -> Vec<usize> {
    let mut row = vec![i];
    for j in 1..=b.len() {
        let differ = usize::from(a[i - 1] != b[j - 1]);
        let mut best = (rows[i - 1][j] + 1).min(row[j - 1] + 1).min(rows[i - 1][j - 1] + differ);
        if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
            best = best.min(rows[i - 2][j - 2] + 1);
        }
        row.push(best);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_known_pairs() {
        assert_eq!(distance("kitten", "sitting"), 3, "the textbook pair");
        assert_eq!(distance("f_nmuber", "f_number"), 1, "a swap counts once");
        assert_eq!(distance("", "abc"), 3);
    }

    #[test]
    fn far_words_are_not_suggested() {
        assert_eq!(nearest("exposure", &["exposure_s", "width_px"]), Some("exposure_s"));
        assert_eq!(nearest("PRNU", &["seed", "prnu"]), Some("prnu"));
        assert_eq!(nearest("d65", &["A", "D50", "D65"]), Some("D65"));
        assert_eq!(nearest("banana", &["exposure_s", "width_px"]), None);
    }
}
