//! What a chart is: sheets, inks, and where its features lie.

use glam::DVec2;
use serde_json::{Map, Value};

use crate::{ink::Ink, light::Panel};

/// What there is to be found on a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The centre of a disc.
    Dot,
    /// A corner of squares.
    Corner,
    /// A straight edge from one point to another, darker on its left hand where it is walked along.
    Edge,
    /// The centre of a star or another figure.
    Centre,
    /// A lamp smaller than a pixel.
    Point,
    /// The rim of a round figure, all round.
    Rim,
}

impl Kind {
    /// Its name in the truth.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Dot => "dot",
            Self::Corner => "corner",
            Self::Edge => "edge",
            Self::Centre => "centre",
            Self::Point => "point",
            Self::Rim => "rim",
        }
    }
}

/// Something to be found.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    /// What it is.
    pub kind: Kind,
    /// On which panel.
    pub panel: usize,
    /// Column and row in the chart's order, from 0 at the top left, where it has such.
    pub index: Option<[usize; 2]>,
    /// Where: one point, the two ends of an edge, or the corners of a rim, mm.
    pub points_mm: Vec<DVec2>,
    /// The radius of a disc, mm.
    pub radius_mm: Option<f64>,
}

impl Feature {
    /// A feature of one point on the first panel.
    #[must_use]
    pub fn at(kind: Kind, index: [usize; 2], point_mm: DVec2) -> Self {
        Self { kind, panel: 0, index: Some(index), points_mm: vec![point_mm], radius_mm: None }
    }

    /// An edge on the first panel.
    #[must_use]
    pub fn edge(index: [usize; 2], from_mm: DVec2, to_mm: DVec2) -> Self {
        Self { kind: Kind::Edge, panel: 0, index: Some(index), points_mm: vec![from_mm, to_mm], radius_mm: None }
    }
}

/// An area of one ink.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    /// Its name.
    pub name: String,
    /// On which panel.
    pub panel: usize,
    /// Its ink, by the place in the list.
    pub ink: usize,
    /// Its outline, mm.
    pub outline_mm: Vec<DVec2>,
}

/// A picture of reflectances, 16 bits, linear: 65 535 is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Its name.
    pub name: String,
    /// The name of its file; textures of the same numbers share one.
    pub file: String,
    /// On which panel.
    pub panel: usize,
    /// Where on it the picture lies, by its top left and bottom right corners, mm; it is mirrored beyond.
    pub place_mm: (DVec2, DVec2),
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Row by row from the top.
    pub values: Vec<u16>,
}

/// A dark box behind a hole: its opening, its walls and its bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Cavity {
    /// The panel with the hole.
    pub panel: usize,
    /// Its opening, mm, clockwise as seen.
    pub opening_mm: Vec<DVec2>,
    /// Depth, mm.
    pub depth_mm: f64,
    /// The ink of its inside.
    pub ink: usize,
}

/// A chart, drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The sheets; the first is the chart itself.
    pub panels: Vec<Panel>,
    /// The inks.
    pub inks: Vec<Ink>,
    /// Pictures on inks.
    pub textures: Vec<Texture>,
    /// Boxes behind holes.
    pub cavities: Vec<Cavity>,
    /// Whether even light from everywhere falls on it; otherwise it shines by itself in the dark.
    pub lit: bool,
    /// What is to be found.
    pub features: Vec<Feature>,
    /// Areas of one ink.
    pub patches: Vec<Patch>,
    /// Samples a pixel that serve it.
    pub spp: u32,
    /// Sizes and settings for the truth.
    pub facts: Map<String, Value>,
}

impl Drawing {
    /// A chart of one sheet square before the camera, in even light.
    #[must_use]
    pub fn printed(panel: Panel, inks: Vec<Ink>) -> Self {
        Self {
            panels: vec![panel],
            inks,
            textures: Vec::new(),
            cavities: Vec::new(),
            lit: true,
            features: Vec::new(),
            patches: Vec::new(),
            spp: 64,
            facts: Map::new(),
        }
    }

    /// Whether it can be printed: it is one flat sheet.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.panels.len() == 1
    }

    /// Notes a size or setting for the truth.
    pub fn note(&mut self, key: &str, value: impl Into<Value>) {
        self.facts.insert(key.to_owned(), value.into());
    }
}
