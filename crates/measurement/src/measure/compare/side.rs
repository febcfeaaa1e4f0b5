//! One side of a comparison: what is known of a camera, measured or declared.

use super::curve::Curve;
use std::collections::BTreeMap;

/// A number with its unit; without an uncertainty where the measurement states none.
#[derive(Clone, Debug)]
pub(crate) struct Quantity {
    pub value: f64,
    pub standard_uncertainty: Option<f64>,
    pub unit: String,
}

impl Quantity {
    /// What a camera file states: exact by itself.
    pub(crate) fn declared(value: f64, unit: &str) -> Self {
        Self { value, standard_uncertainty: Some(0.0), unit: unit.to_owned() }
    }
}

/// What is known of a camera on one side.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    pub kind: String,
    pub settings: BTreeMap<String, String>,
    pub quantities: BTreeMap<String, Quantity>,
    pub curves: Vec<Curve>,
    /// Angles of slanted edges to rows or columns, degrees, by their place.
    pub angles_deg: BTreeMap<String, f64>,
}
