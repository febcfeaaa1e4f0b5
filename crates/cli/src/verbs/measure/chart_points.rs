//! The chart of points that is photographed.

use super::encoding::EncodingArgs;
use super::truth::TruthArgs;
use crate::args::choice::{Word, choice};
use crate::args::words::{grid, region, size, tile};
use clap::Args;
use etendue::measure::{ChartInput, Target};

const TARGETS: [Word<Target>; 2] = [
    (Target::Checkerboard, "checkerboard", "Squares, dark and bright"),
    (Target::Dots, "dots", "A square grid of discs"),
];

/// The chart that is photographed.
#[derive(Clone, Debug, Args)]
pub struct ChartPointsArgs {
    /// The chart [default: whichever shows more points]
    #[arg(long, value_parser = choice(TARGETS))]
    pub target: Option<Target>,
    /// Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found]
    #[arg(long, value_name = "NxM", value_parser = grid)]
    pub grid: Option<[usize; 2]>,
    /// The channel to look at: R, G, B or Y of a picture, an EXR channel by its full name, a colour of a raw mosaic,
    /// or "balanced" for all its pixels with its colours balanced to one grey [default: the luminance]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB
    #[arg(long, value_name = "TILE", value_parser = tile)]
    pub cfa: Option<String>,
    #[command(flatten)]
    pub encoding: EncodingArgs,
    /// Look for the chart in this part of the picture only: left column, top row, width and height, pixels of the picture
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub region: Option<[usize; 4]>,
    /// Of lists of points (CSV) in place of pictures: columns and rows of the pictures in which they were seen
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size_px: Option<[usize; 2]>,
    #[command(flatten)]
    pub truth: TruthArgs,
    /// List every point of the chart in the text, too; JSON has them anyway
    #[arg(long)]
    pub points: bool,
}

impl From<&ChartPointsArgs> for ChartInput {
    fn from(a: &ChartPointsArgs) -> Self {
        Self {
            target: a.target,
            grid: a.grid,
            channel: a.channel.clone(),
            cfa: a.cfa.clone(),
            encoding: (&a.encoding).into(),
            region: a.region,
            size_px: a.size_px,
            truth: (&a.truth).into(),
            points: a.points,
        }
    }
}
