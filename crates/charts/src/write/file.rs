//! A file of a chart, in memory.

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Contents {
    /// Text.
    Text(String),
    /// A grey picture of 16 bits: columns, rows, values row by row.
    Grey16(usize, usize, Vec<u16>),
}

/// A file and its name below the chart's folder.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartFile {
    /// Its name.
    pub name: String,
    /// What it holds.
    pub contents: Contents,
}
