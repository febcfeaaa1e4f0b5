//! Why values cannot become an EXR or PNG file.

/// Why values cannot become an EXR or PNG file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EncodeError {
    /// Zero pixels.
    #[error("a picture of {width} × {height} pixels cannot be stored; expected at least one pixel")]
    Empty {
        /// Pixels a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// A digital number that 16 bits do not hold.
    #[error("the digital number {value} does not fit into 16 bits; write the raw as TIFF")]
    Wide {
        /// The number.
        value: u32,
    },
    /// A picture without channels.
    #[error("a picture without channels cannot be stored; expected at least one plane")]
    NoChannels,
    /// Planes of different sizes.
    #[error("plane `{name}` has {found} samples, expected {expected}; all planes of one file have the same size")]
    Size {
        /// The plane.
        name: String,
        /// Its samples.
        found: usize,
        /// The file's pixels.
        expected: usize,
    },
    /// A text outside Latin-1, or a name longer than 31 bytes, which EXR headers do not hold.
    #[error("`{0}` cannot stand in an EXR header: texts are Latin-1 without NUL, attribute names at most 31 bytes")]
    Text(String),
    /// Samples that are kept on the disk cannot be read.
    #[error("{0}")]
    Read(String),
    /// The file cannot be written.
    #[error("{0}")]
    Write(String),
    /// The encoder refused.
    #[error("the encoder failed: {0}")]
    Encoder(String),
}
