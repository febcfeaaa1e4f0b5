//! What became of what: each sentence once, with how often it holds and where first.

use std::collections::HashMap;

/// Sentences in the order in which they came.
#[derive(Debug, Default)]
pub(crate) struct Report {
    order: Vec<String>,
    counts: HashMap<String, (usize, String)>,
    /// The file and line that is being read.
    place: String,
}

impl Report {
    /// What follows stands here.
    pub(crate) fn at(&mut self, place: String) {
        self.place = place;
    }

    pub(crate) fn note(&mut self, sentence: impl Into<String>) {
        let (sentence, place) = (sentence.into(), &self.place);
        match self.counts.get_mut(&sentence) {
            Some((count, _)) => *count += 1,
            None => {
                self.order.push(sentence.clone());
                self.counts.insert(sentence, (1, place.clone()));
            }
        }
    }

    pub(crate) fn lines(&self) -> Vec<String> {
        let line = |sentence: &String| {
            let (count, place) = &self.counts[sentence];
            match (count, place.as_str()) {
                (_, "") => sentence.clone(),
                (1, place) => format!("{sentence} ({place})"),
                (count, place) => format!("{sentence} ({count} times, first {place})"),
            }
        };
        self.order.iter().map(line).collect()
    }
}
