//! The points of a chart in picture files.

use crate::failure::Failure;
use clap::{Args, ValueEnum};
use etendue_io::photograph::{Photograph, read_photograph};
use etendue_metrology::Image;
use etendue_metrology::target::{Grid, Sought, Target, find};
use etendue_spectra::colour::XYZ_FROM_SRGB;
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
    /// The channel to look at: R, G, B or Y of a picture, an EXR channel by its full name [default: the luminance]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
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
}

impl ChartArguments {
    pub(super) fn sought(&self) -> Sought {
        let target = self.target.map(|t| match t {
            TargetArgument::Checkerboard => Target::Checkerboard,
            TargetArgument::Dots => Target::Dots,
        });
        Sought { target, size: self.grid }
    }

    /// The chart in a picture.
    pub(super) fn seen(&self, file: &Path) -> Result<Seen, Failure> {
        let photograph = read(file)?;
        let image = match &self.channel {
            Some(name) => channel(file, &photograph, name)?,
            None => luminance(file, &photograph)?,
        };
        self.seen_in(file, &image)
    }

    /// The chart in one channel.
    pub(super) fn seen_in(&self, file: &Path, image: &Image) -> Result<Seen, Failure> {
        let told = |error| Failure::input(format!("{}: {error}", file.display()));
        let grid = find(image, self.sought()).map_err(told)?;
        Ok(Seen { file: file.to_owned(), size_px: [image.width(), image.height()], grid })
    }
}

/// A picture without a mosaic: its points would lie in other places in each colour.
pub(super) fn read(file: &Path) -> Result<Photograph, Failure> {
    let photograph = read_photograph(file).map_err(Failure::input)?;
    let mosaic = photograph.raw.as_ref().is_some_and(|raw| raw.filters.channels.len() > 1);
    if mosaic {
        let file = file.display();
        return Err(Failure::input(format!("{file}: a raw mosaic of colours; give the developed picture instead")));
    }
    Ok(photograph)
}

/// A channel in proportion to light.
pub(super) fn channel(file: &Path, photograph: &Photograph, name: &str) -> Result<Image, Failure> {
    let found = photograph.channel(name).ok_or_else(|| {
        let (file, names) = (file.display(), photograph.names().join(", "));
        Failure::input(format!("{file}: no channel '{name}'; it has {names}"))
    })?;
    Ok(image(photograph, photograph.linear(found)))
}

fn image(photograph: &Photograph, samples: Vec<f32>) -> Image {
    Image::from_samples(photograph.width, photograph.height, samples).expect("a photograph's channels fill it")
}

fn luminance(file: &Path, photograph: &Photograph) -> Result<Image, Failure> {
    if photograph.channel("R").is_none() {
        let grey: Vec<&str> = photograph.names().into_iter().filter(|n| *n != "A").collect();
        return match grey[..] {
            [only] => channel(file, photograph, only),
            _ => {
                let (file, names) = (file.display(), grey.join(", "));
                Err(Failure::input(format!("{file}: say which of its channels to look at with --channel: {names}")))
            }
        };
    }
    let mut sum = vec![0.0_f32; photograph.width * photograph.height];
    for (name, weight) in ["R", "G", "B"].iter().zip(XYZ_FROM_SRGB[1]) {
        let part = channel(file, photograph, name)?;
        sum.iter_mut().zip(part.samples()).for_each(|(s, v)| *s += weight as f32 * v);
    }
    Ok(image(photograph, sum))
}

/// The charts of several pictures of one size; a picture that is there twice is refused.
pub(super) fn all(chart: &ChartArguments, files: &[PathBuf]) -> Result<Vec<Seen>, Failure> {
    let mut views: Vec<Seen> = Vec::new();
    let mut faults = Vec::new();
    for file in files {
        match chart.seen(file) {
            Ok(view) => match views.iter().find_map(|other| contradiction(other, &view)) {
                Some(fault) => faults.push(fault),
                None => views.push(view),
            },
            Err(Failure::Input(more)) => faults.extend(more),
            Err(other) => return Err(other),
        }
    }
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
