//! The kinds of pictures in a laboratory folder: the closed list, a folder each.

/// What a folder of pictures shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// No light, two frames or more an exposure time.
    Dark,
    /// Even light on the bare sensor, two frames or more an exposure time.
    Flat,
    /// An evenly lit surface through the lens.
    Field,
    /// Views of a plane chart of points.
    Chart,
    /// Slanted edges.
    Edges,
    /// A ColorChecker.
    Checker,
}

impl Kind {
    /// All of them, in the order in which they are measured.
    pub const ALL: [Self; 6] = [Self::Dark, Self::Flat, Self::Field, Self::Chart, Self::Edges, Self::Checker];

    /// The folder's name.
    #[must_use]
    pub fn folder(self) -> &'static str {
        match self {
            Self::Dark => "dark",
            Self::Flat => "flat",
            Self::Field => "field",
            Self::Chart => "chart",
            Self::Edges => "edges",
            Self::Checker => "checker",
        }
    }

    /// What it shows, in a few words.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Dark => "frames without light",
            Self::Flat => "even light on the bare sensor",
            Self::Field => "an evenly lit surface through the lens",
            Self::Chart => "views of a chart of points",
            Self::Edges => "slanted edges",
            Self::Checker => "a ColorChecker",
        }
    }
}
