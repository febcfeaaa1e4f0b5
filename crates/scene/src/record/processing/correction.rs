//! Corrections before colours are computed.

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{Rule, choice, either, keyed, list, number, path, record, variant, vector, words};
use std::path::PathBuf;

#[derive(Clone, Debug)]
pub enum BlackLevel {
    /// A digital number.
    Dn(Placed<f64>),
    Rule(Placed<BlackLevelRule>),
}

words! {
    /// Source of the black level.
    pub enum BlackLevelRule {
        /// The black level of the sensor.
        "sensor" => Sensor,
        /// From the sensor's shielded rows, frame by frame.
        "optical_black" => OpticalBlack,
    }
}

pub(super) fn black_level() -> impl Rule<Out = BlackLevel> {
    either(variant!(number("DN").at_least(0.0), BlackLevel::Dn), variant!(choice(), BlackLevel::Rule))
}

keyed! {
    /// Gains of a shading correction.
    pub enum ShadingTable {
        /// Two or more gains at equal steps from the centre to the farthest corner.
        radial_gains => Radial(Vec<Placed<f64>>) = list(number("").at_least(1.0), 2);
        /// Table of gains (1 or more), two by two or more, outer entries on the corners.
        grid => Grid(Placed<PathBuf>) = path(&["csv"]);
    }
}

record! {
    /// A shading correction.
    pub struct Shading check(check_shading) {
        /// Its gains.
        inside table: ShadingTable;
        /// With "radial_gains": centre, raster coordinates. Default: the principal point.
        optional centre_px: Placed<[f64; 2]> = vector::<2>(number("px"));
    }
}

fn check_shading(shading: &Shading, errors: &mut DescriptionErrors) {
    if let (ShadingTable::Grid(_), Some(centre)) = (&shading.table, &shading.centre_px) {
        errors.add(
            ErrorCode::NoEffect,
            &centre.place,
            "\"centre_px\" has no effect here, it belongs to \"radial_gains\"",
            "remove it",
        );
    }
}

impl Shading {
    /// The table's file.
    pub(super) fn file(&self) -> Option<&Placed<PathBuf>> {
        match &self.table {
            ShadingTable::Grid(file) => Some(file),
            ShadingTable::Radial(_) => None,
        }
    }
}
