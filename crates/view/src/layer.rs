//! A layer of a result: planes of numbers, and their display.

use serde_json::{Map, Value, json};

/// The numbers of a plane, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Samples {
    /// Whole numbers of 8 bits.
    Bytes(Vec<u8>),
    /// Whole numbers of 16 bits.
    Words(Vec<u16>),
    /// Identifiers and counts.
    Integers(Vec<u32>),
    /// Numbers stored exactly.
    Exact(Vec<f32>),
    /// Numbers rounded to 11 binary digits.
    Rounded(Vec<f32>),
}

impl Samples {
    /// Bytes of a number on the page.
    pub(crate) fn width(&self) -> usize {
        match self {
            Self::Bytes(_) => 1,
            Self::Words(_) | Self::Rounded(_) => 2,
            Self::Integers(_) | Self::Exact(_) => 4,
        }
    }

    /// The numbers one by one.
    pub(crate) fn numbers(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match self {
            Self::Bytes(samples) => Box::new(samples.iter().map(|v| f64::from(*v))),
            Self::Words(samples) => Box::new(samples.iter().map(|v| f64::from(*v))),
            Self::Integers(samples) => Box::new(samples.iter().map(|v| f64::from(*v))),
            Self::Exact(samples) | Self::Rounded(samples) => Box::new(samples.iter().map(|v| f64::from(*v))),
        }
    }
}

/// Relation of a plane to the others of its layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Value,
    /// The standard error of the value plane with the same index.
    Error,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NamedPlane {
    pub(crate) name: String,
    pub(crate) role: Role,
    pub(crate) samples: Samples,
}

impl NamedPlane {
    pub(crate) fn value(name: impl Into<String>, samples: Samples) -> Self {
        Self { name: name.into(), role: Role::Value, samples }
    }
}

/// An identifier in a plane.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NamedIdentifier {
    pub(crate) id: u32,
    pub(crate) name: String,
    pub(crate) colour: [u8; 3],
}

/// Display of a layer.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum LayerKind {
    /// An image for display: numbers up to `full`, with this encoding.
    Picture { full: f64, encoding: String },
    /// Digital numbers of a sensor; with the filters of a tile, if known.
    Raw { black: f64, white: f64, filters: Option<(usize, Vec<String>)> },
    /// Band means at these wavelengths, and the contribution of each band to linear sRGB.
    Spectrum { centres_nm: Vec<f64>, width_nm: f64, weights: Vec<[f64; 3]> },
    /// Linear red, green and blue.
    Colour,
    /// Lengths, on a logarithmic scale.
    Length,
    /// Identifiers.
    Identity { names: Vec<NamedIdentifier> },
    /// Vectors in the image.
    Flow,
    /// Vectors in space; unit vectors or others.
    Vector { is_unit: bool },
    /// Components of one number, one plane each.
    Parts,
    /// One number per pixel.
    Number,
    /// Boxes of objects, drawn over images of the same size.
    Boxes { objects: Vec<Value> },
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layer {
    /// Name within the file.
    pub(crate) name: String,
    pub(crate) kind: LayerKind,
    /// Unit of its values; empty for a ratio or a name.
    pub(crate) unit: String,
    /// Meaning of its numbers, if it is not obvious.
    pub(crate) meaning: String,
    /// Columns and rows.
    pub(crate) size: (usize, usize),
    pub(crate) planes: Vec<NamedPlane>,
}

impl Layer {
    /// Bytes per pixel on the page.
    pub(crate) fn pixel_bytes(&self) -> usize {
        self.planes.iter().map(|plane| plane.samples.width()).sum()
    }

    /// True if a pixel of a downsampled layer is the mean of several; otherwise it is one of them.
    pub(crate) fn has_means(&self) -> bool {
        self.kind.has_means() && !self.planes.iter().any(|plane| matches!(plane.samples, Samples::Integers(_)))
    }
}

impl LayerKind {
    /// True if the mean over pixels is a value of the same kind; otherwise one pixel represents several.
    pub(crate) fn has_means(&self) -> bool {
        matches!(self, Self::Picture { .. } | Self::Spectrum { .. } | Self::Colour | Self::Parts | Self::Number)
    }

    /// The kind in the form that the page's script reads; `thinned`: one pixel represents several.
    pub(crate) fn to_json(&self, reduced: bool) -> Map<String, Value> {
        let object = match self {
            Self::Picture { full, encoding } => json!({ "kind": "picture", "full": full, "encoding": encoding }),
            Self::Raw { black, white, filters } => {
                let filters = filters.as_ref().filter(|_| !reduced);
                let filters = filters.map(|(columns, names)| json!({ "columns": columns, "channels": names }));
                json!({ "kind": "raw", "black": black, "white": white, "filters": filters })
            }
            Self::Spectrum { centres_nm, width_nm, weights } => {
                json!({ "kind": "spectrum", "centres_nm": centres_nm, "width_nm": width_nm, "weights": weights })
            }
            Self::Colour => json!({ "kind": "colour" }),
            Self::Length => json!({ "kind": "length" }),
            Self::Identity { names } => {
                let name = |n: &NamedIdentifier| json!([n.id, n.name, n.colour]);
                json!({ "kind": "identity", "names": names.iter().map(name).collect::<Vec<_>>() })
            }
            Self::Flow => json!({ "kind": "flow" }),
            Self::Vector { is_unit } => json!({ "kind": "vector", "is_unit": is_unit }),
            Self::Parts => json!({ "kind": "parts" }),
            Self::Number => json!({ "kind": "number" }),
            Self::Boxes { objects } => json!({ "kind": "boxes", "objects": objects }),
        };
        let Value::Object(map) = object else { return Map::new() };
        map
    }
}
