//! Which readings of a picture are measured.

use super::encoding::EncodingArgs;
use crate::args::words::{region, tile};
use clap::Args;
use etendue::measure::{Selection, SignalLevels};

/// Choice of a part of a picture.
#[derive(Clone, Debug, Args)]
pub struct SelectionArgs {
    /// The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only
    /// one, or the luminance]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB
    #[arg(long, value_name = "TILE", value_parser = tile)]
    pub cfa: Option<String>,
    /// Measure this part only: left column, top row, width and height, pixels of the file
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub region: Option<[usize; 4]>,
    #[command(flatten)]
    pub encoding: EncodingArgs,
}

impl From<&SelectionArgs> for Selection {
    fn from(a: &SelectionArgs) -> Self {
        Self { channel: a.channel.clone(), cfa: a.cfa.clone(), region: a.region, encoding: (&a.encoding).into() }
    }
}

/// What a picture's numbers mean, where the file does not say.
#[derive(Debug, Args)]
pub struct LevelsArgs {
    /// The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0]
    #[arg(long, value_name = "READING", allow_negative_numbers = true)]
    pub black: Option<f64>,
    /// The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold]
    #[arg(long, value_name = "READING", allow_negative_numbers = true)]
    pub full_scale: Option<f64>,
}

impl From<&LevelsArgs> for SignalLevels {
    fn from(a: &LevelsArgs) -> Self {
        Self { black: a.black, full_scale: a.full_scale }
    }
}
