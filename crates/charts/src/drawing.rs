//! Contents of a chart: sheets, inks, and positions of its features.

use glam::DVec2;
use serde_json::{Map, Value};

use crate::{ink::Ink, light::Panel};

/// Kind of a feature of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    /// The centre of a disc.
    Dot,
    /// A corner of squares.
    Corner,
    /// A straight edge from one point to another, with the darker side on the left of its direction.
    Edge,
    /// The centre of a star or another figure.
    Centre,
    /// A lamp smaller than a pixel.
    Point,
    /// The outline of a round figure.
    Outline,
}

impl FeatureKind {
    /// Name in the ground truth.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Dot => "dot",
            Self::Corner => "corner",
            Self::Edge => "edge",
            Self::Centre => "centre",
            Self::Point => "point",
            Self::Outline => "rim",
        }
    }
}

/// A feature that measurements detect.
#[derive(Clone, Debug, PartialEq)]
pub struct Feature {
    pub kind: FeatureKind,
    /// Index of the panel.
    pub panel: usize,
    /// Column and row in the chart's order, from 0 at the top left, if any.
    pub index: Option<[usize; 2]>,
    /// Positions: one point, the two ends of an edge, or the corners of an outline, mm.
    pub points_mm: Vec<DVec2>,
    /// The radius of a disc, mm.
    pub radius_mm: Option<f64>,
}

impl Feature {
    /// A feature of one point on the first panel.
    #[must_use]
    pub fn at(kind: FeatureKind, index: [usize; 2], point_mm: DVec2) -> Self {
        Self { kind, panel: 0, index: Some(index), points_mm: vec![point_mm], radius_mm: None }
    }

    /// An edge on the first panel.
    #[must_use]
    pub fn edge(index: [usize; 2], from_mm: DVec2, to_mm: DVec2) -> Self {
        Self { kind: FeatureKind::Edge, panel: 0, index: Some(index), points_mm: vec![from_mm, to_mm], radius_mm: None }
    }
}

/// An area of one ink.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    pub name: String,
    /// Index of the panel.
    pub panel: usize,
    /// Index of its ink in the list.
    pub ink: usize,
    pub outline_mm: Vec<DVec2>,
}

/// An image of reflectances, 16 bits, linear: 65 535 is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    pub name: String,
    /// Name of its file; textures of the same numbers share one.
    pub file: String,
    /// Index of the panel.
    pub panel: usize,
    /// Position of the image on the panel: top left and bottom right corners, mm; it is mirrored beyond.
    pub position_mm: (DVec2, DVec2),
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Values, row by row from the top.
    pub values: Vec<u16>,
}

/// A dark box behind a hole: its opening, its walls and its bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Cavity {
    /// The panel with the hole.
    pub panel: usize,
    /// Opening, mm, clockwise as seen.
    pub opening_mm: Vec<DVec2>,
    pub depth_mm: f64,
    /// Ink of its inside.
    pub ink: usize,
}

/// A drawn chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// The sheets; the first is the chart itself.
    pub panels: Vec<Panel>,
    pub inks: Vec<Ink>,
    /// Images used as inks.
    pub textures: Vec<Texture>,
    /// Boxes behind holes.
    pub cavities: Vec<Cavity>,
    /// True if uniform light from all directions falls on it; otherwise it is self-luminous in the dark.
    pub is_illuminated: bool,
    pub features: Vec<Feature>,
    /// Areas of one ink.
    pub patches: Vec<Patch>,
    /// Sufficient samples per pixel.
    pub spp: u32,
    /// Sizes and settings for the ground truth.
    pub facts: Map<String, Value>,
}

impl Drawing {
    /// A chart of one sheet perpendicular to the camera axis, in uniform light.
    #[must_use]
    pub fn printed(panel: Panel, inks: Vec<Ink>) -> Self {
        Self {
            panels: vec![panel],
            inks,
            textures: Vec::new(),
            cavities: Vec::new(),
            is_illuminated: true,
            features: Vec::new(),
            patches: Vec::new(),
            spp: 64,
            facts: Map::new(),
        }
    }

    /// True if it can be printed: it is one flat sheet.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.panels.len() == 1
    }

    /// Adds a size or setting to the ground truth.
    pub fn note(&mut self, key: &str, value: impl Into<Value>) {
        self.facts.insert(key.to_owned(), value.into());
    }
}
