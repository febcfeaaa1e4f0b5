//! The points of a chart in picture files.

use super::encoding::EncodingArguments;
use super::inquiry::refused;
use super::readings::{Readings, Selection, tile};
use crate::failure::Failure;
use crate::progress::PictureBar;
use clap::{Args, ValueEnum};
use etendue_io::photograph::{Photograph, Stated};
use etendue_metrology::target::{Grid, Sought, Target, TargetError, find};
use std::path::{Path, PathBuf};

/// The chart that is photographed.
#[derive(Clone, Debug, Args)]
pub struct ChartArguments {
    /// The chart [default: whichever shows more points]
    #[arg(long, value_enum)]
    pub target: Option<TargetArgument>,
    /// Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found]
    #[arg(long, value_name = "NxM", value_parser = grid)]
    pub grid: Option<[usize; 2]>,
    /// The channel to look at: R, G, B or Y of a picture, an EXR channel by its full name, a colour of a raw mosaic [default:
    /// the luminance]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB
    #[arg(long, value_name = "TILE", value_parser = tile)]
    pub cfa: Option<String>,
    #[command(flatten)]
    pub encoding: EncodingArguments,
    /// List every point of the chart in the text, too; JSON has them anyway
    #[arg(long)]
    pub points: bool,
}

/// Kinds of charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TargetArgument {
    /// Squares, dark and bright
    Checkerboard,
    /// A square grid of discs
    Dots,
}

pub(super) fn grid(text: &str) -> Result<[usize; 2], String> {
    let expected = || format!("expected COLUMNSxROWS, e.g. 11x8, not '{text}'");
    let (columns, rows) = text.split_once(['x', '×']).ok_or_else(expected)?;
    let number = |s: &str| s.trim().parse::<usize>().ok().filter(|n| (2..=1000).contains(n)).ok_or_else(expected);
    Ok([number(columns)?, number(rows)?])
}

/// A chart as a picture shows it.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub file: PathBuf,
    pub size_px: [usize; 2],
    pub grid: Grid,
    /// How light was found from the picture's numbers.
    pub stated: Stated,
}

impl ChartArguments {
    pub(super) fn sought(&self) -> Sought {
        let target = self.target.map(|t| match t {
            TargetArgument::Checkerboard => Target::Checkerboard,
            TargetArgument::Dots => Target::Dots,
        });
        Sought { target, size: self.grid }
    }

    pub(super) fn selection(&self, channel: Option<&str>) -> Selection {
        let (channel, cfa, encoding) = (channel.map(str::to_owned), self.cfa.clone(), self.encoding.clone());
        Selection { channel, cfa, region: None, encoding }
    }

    /// The chart in a picture.
    pub(super) fn seen(&self, file: &Path) -> Result<Seen, Failure> {
        let photograph = self.encoding.photograph(file)?;
        self.seen_in(file, &photograph, self.channel.as_deref())
    }

    /// The chart in one channel. In the mosaic of a colour that has several places in the tile, each point is the mean of where
    /// these show it: what each of them misses between its pixels the others see.
    pub(super) fn seen_in(&self, file: &Path, photograph: &Photograph, channel: Option<&str>) -> Result<Seen, Failure> {
        let planes = self.selection(channel).planes(file, photograph)?;
        let grids = planes.iter().map(|plane| self.grid(plane).map_err(|error| refused(file, error)));
        let grid = Grid::mean(&grids.collect::<Result<Vec<_>, _>>()?);
        let (width, height) = planes[0].picture_px;
        Ok(Seen { file: file.to_owned(), size_px: [width, height], grid, stated: photograph.stated.clone() })
    }

    /// The chart among readings, in the picture's raster coordinates.
    fn grid(&self, plane: &Readings) -> Result<Grid, TargetError> {
        let mut grid = find(&plane.image, self.sought())?;
        let scale = 0.5 * (plane.period.0 + plane.period.1) as f64;
        for node in &mut grid.nodes {
            node.at = plane.in_picture(node.at.to_array()).into();
            node.uncertainty_px *= scale;
        }
        Ok(grid)
    }
}

/// The charts of several pictures of one size; a picture that is there twice is refused.
pub(super) fn all(chart: &ChartArguments, files: &[PathBuf]) -> Result<Vec<Seen>, Failure> {
    let mut views: Vec<Seen> = Vec::new();
    let mut faults = Vec::new();
    let bar = PictureBar::new("charts", files.len());
    for file in files {
        let seen = chart.seen(file);
        bar.step();
        match seen {
            Ok(view) => match views.iter().find_map(|other| contradiction(other, &view)) {
                Some(fault) => faults.push(fault),
                None => views.push(view),
            },
            Err(Failure::Input(more)) => faults.extend(more),
            Err(other) => return Err(other),
        }
    }
    bar.finish();
    if faults.is_empty() { Ok(views) } else { Err(Failure::Input(faults)) }
}

fn contradiction(a: &Seen, b: &Seen) -> Option<String> {
    let (first, second) = (a.file.display(), b.file.display());
    if a.size_px != b.size_px {
        let [[w, h], [v, g]] = [a.size_px, b.size_px];
        return Some(format!(
            "{second}: {v} × {g} pixels, where {first} has {w} × {h}; give pictures of one camera and size"
        ));
    }
    (a.grid == b.grid).then(|| format!("{second}: shows the chart exactly as {first}; give each view once"))
}
