//! Lines of a text by places in it.

/// Where lines begin, bytes.
pub(super) struct Lines(Vec<usize>);

impl Lines {
    pub(super) fn of(text: &str) -> Self {
        Self(text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at + 1).collect())
    }

    /// The line of a byte, counted from 1.
    pub(super) fn line(&self, at: usize) -> usize {
        self.0.partition_point(|begin| *begin <= at) + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_their_lines() {
        let lines = Lines::of("ab\n\nc");
        assert_eq!([0, 2, 3, 4].map(|at| lines.line(at)), [1, 1, 2, 3]);
    }
}
