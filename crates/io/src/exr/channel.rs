//! Sources of the samples of an EXR file: planes in memory, bands on the disk, or strips of rows computed while they are written. Also encoding errors.

use std::{borrow::Cow, ops::Range};

use ::exr::prelude::FlatSamples;
use etendue_core::storage::BandReader;

/// The samples of a channel.
pub(crate) enum ChannelSource<'a> {
    /// 32-bit floats, row by row.
    Float(Cow<'a, [f32]>),
    /// 32-bit unsigned integers, row by row.
    Uint(Cow<'a, [u32]>),
    /// One component of vectors, row by row.
    Component(&'a [[f32; 3]], usize),
    /// Band on the disk.
    Band(&'a dyn BandReader, usize),
    /// Floats at this position of a strip.
    StripFloat(usize),
    /// Integers at this position of a strip.
    StripUint(usize),
}

/// Rows of a channel.
pub(crate) enum SampleRows {
    /// 32-bit floats.
    Float(Vec<f32>),
    /// 32-bit unsigned integers.
    Uint(Vec<u32>),
}

/// Channels whose rows are computed together.
pub(crate) trait Strips: Send + Sync {
    /// Returns whole rows of all these channels.
    ///
    /// # Errors
    /// If they cannot be read, in a sentence for the user.
    fn rows(&self, rows: Range<usize>) -> Result<Vec<SampleRows>, String>;
}

impl ChannelSource<'_> {
    /// Number of samples, if they are in memory.
    pub(super) fn len(&self) -> Option<usize> {
        match self {
            Self::Float(samples) => Some(samples.len()),
            Self::Uint(samples) => Some(samples.len()),
            Self::Component(samples, _) => Some(samples.len()),
            Self::Band(..) | Self::StripFloat(_) | Self::StripUint(_) => None,
        }
    }

    /// Sample type of a channel, for the encoder.
    pub(super) fn sample_type(&self) -> FlatSamples {
        match self {
            Self::Uint(_) | Self::StripUint(_) => FlatSamples::U32(Vec::new()),
            _ => FlatSamples::F32(Vec::new()),
        }
    }
}

/// Channels of an image, sorted by name.
pub(super) struct ImageRows<'a> {
    pub(super) width: usize,
    pub(super) channels: Vec<ChannelSource<'a>>,
    pub(super) strips: Option<Box<dyn Strips + 'a>>,
}

/// Rows of a channel.
enum RowSource<'a> {
    Float(Cow<'a, [f32]>),
    Uint(Cow<'a, [u32]>),
}

impl ImageRows<'_> {
    /// Bytes per row.
    pub(super) fn row_bytes(&self) -> usize {
        self.width * self.channels.len() * size_of::<f32>()
    }

    /// Bytes of rows in the encoder's layout: line by line, channel by channel within a line, in native byte order.
    pub(super) fn bytes(&self, rows: Range<usize>) -> Result<Vec<u8>, EncodeError> {
        let strip = self.strips.as_ref().map(|strips| strips.rows(rows.clone())).transpose();
        let strip = strip.map_err(EncodeError::Read)?.unwrap_or_default();
        let channels = self.channels.iter().map(|channel| self.row_source(channel, &strip, rows.clone()));
        let channels = channels.collect::<Result<Vec<_>, String>>().map_err(EncodeError::Read)?;
        let mut bytes = vec![0; self.row_bytes() * rows.len()];
        let mut rest = bytes.as_mut_slice();
        for line in 0..rows.len() {
            let at = line * self.width..(line + 1) * self.width;
            for channel in &channels {
                let (to, after) = rest.split_at_mut(self.width * size_of::<f32>());
                let (numbers, _) = to.as_chunks_mut::<4>();
                match channel {
                    RowSource::Float(samples) => {
                        numbers.iter_mut().zip(&samples[at.clone()]).for_each(|(to, value)| *to = value.to_ne_bytes());
                    }
                    RowSource::Uint(samples) => {
                        numbers.iter_mut().zip(&samples[at.clone()]).for_each(|(to, value)| *to = value.to_ne_bytes());
                    }
                }
                rest = after;
            }
        }
        Ok(bytes)
    }

    fn row_source<'s>(
        &'s self,
        channel: &'s ChannelSource<'_>,
        strip: &'s [SampleRows],
        rows: Range<usize>,
    ) -> Result<RowSource<'s>, String> {
        let at = rows.start * self.width..rows.end * self.width;
        Ok(match channel {
            ChannelSource::Float(samples) => RowSource::Float(Cow::Borrowed(&samples[at])),
            ChannelSource::Uint(samples) => RowSource::Uint(Cow::Borrowed(&samples[at])),
            ChannelSource::Component(vectors, axis) => RowSource::Float(vectors[at].iter().map(|v| v[*axis]).collect()),
            ChannelSource::Band(reader, band) => {
                let mut samples = vec![0.0; at.len()];
                reader.read(*band, rows, &mut samples)?;
                RowSource::Float(samples.into())
            }
            ChannelSource::StripFloat(place) | ChannelSource::StripUint(place) => match &strip[*place] {
                SampleRows::Float(samples) => RowSource::Float(samples.as_slice().into()),
                SampleRows::Uint(samples) => RowSource::Uint(samples.as_slice().into()),
            },
        })
    }
}

/// Reason for which values cannot become an EXR or PNG file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EncodeError {
    /// Zero pixels.
    #[error("an image of {width} × {height} pixels cannot be stored; expected at least one pixel")]
    Empty {
        /// Pixels per row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Digital number that does not fit into 16 bits.
    #[error("the digital number {value} does not fit into 16 bits; write the raw image as TIFF")]
    Wide {
        /// The number.
        value: u32,
    },
    /// An image without channels.
    #[error("an image without channels cannot be stored; expected at least one plane")]
    NoChannels,
    /// Planes of different sizes.
    #[error("plane `{name}` has {actual} samples, expected {expected}; all planes of a file must have the same size")]
    Size {
        /// Name of the plane.
        name: String,
        /// Number of its samples.
        actual: usize,
        /// Number of pixels of the file.
        expected: usize,
    },
    /// Text outside Latin-1, or name longer than 31 bytes, which EXR headers do not support.
    #[error("`{0}` cannot be stored in an EXR header; texts are Latin-1 without NUL, attribute names at most 31 bytes")]
    Text(String),
    /// Samples on the disk cannot be read.
    #[error("{0}")]
    Read(String),
    /// The file cannot be written.
    #[error("{0}")]
    Write(String),
    /// The encoder failed.
    #[error("the encoder failed: {0}")]
    Encoder(String),
}
