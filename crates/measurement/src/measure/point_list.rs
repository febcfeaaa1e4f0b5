//! Points of a chart: from image files, or from a list (CSV) in place of an image.
//!
//! The first line names the columns, in any order: `column` and `row`, whole numbers from 0, the point's position on the chart in
//! steps; `x_px` and `y_px`, its observed position in raster coordinates (pixel centres at + 0.5); `uncertainty_px`, the standard
//! uncertainty of each of these, optional (0). Lines that begin with # and empty lines are skipped.

use std::path::{Path, PathBuf};
use std::{collections::BTreeMap, sync::atomic::AtomicUsize};

use clap::Args;
use etendue_arguments::{Word, choice, grid, region, size, tile};
use etendue_core::observer::Observer;
use etendue_io::failure::{Error, ErrorCode, InputError};
use etendue_io::photograph::{Photograph, SourcedEncoding};
use etendue_io::source::text_of;
use etendue_metrology::calibrate::MIN_VIEWS;
use etendue_metrology::target::{Grid, Node, Target, TargetError, TargetQuery, find};
use glam::DVec2;

use super::encoding::EncodingChoice;
use super::pictures::{ImageProgress, refused};
use super::readings::{Readings, Selection};
use super::truth::points::{CHARTS, PointChart};
use super::truth::{Truth, TruthInput};

const COLUMNS: [&str; 5] = ["column", "row", "x_px", "y_px", "uncertainty_px"];
const MIN_COLUMNS: usize = 4;
/// Maximum columns or rows of a chart; more are taken for a typing error.
const MAX_GRID: f64 = 10_000.0;

/// True if a file is a list of points.
fn is_list(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
}

/// Reads the points of a list.
pub(crate) fn read(file: &Path) -> Result<Grid, Error> {
    let text = text_of(file)?;
    let refused = |line: usize, problem: String| {
        Error::coded(ErrorCode::MalformedFile, format!("{}:{}: {problem}", file.display(), line + 1))
    };
    let lines = text.lines().enumerate().map(|(i, line)| (i, line.trim_start_matches('\u{feff}').trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let expected =
        format!("expected a header line with the columns {} (uncertainty_px is optional)", COLUMNS.join(","));
    let (first, heading) = lines.next().ok_or_else(|| refused(0, expected.clone()))?;
    let places = places(heading).ok_or_else(|| refused(first, format!("{expected}, not '{heading}'")))?;
    let mut nodes: BTreeMap<[usize; 2], (usize, Node)> = BTreeMap::new();
    for (i, line) in lines {
        let node = node(line, &places.0, places.1).map_err(|problem| refused(i, problem))?;
        let [column, row] = node.index;
        if let Some((other, _)) = nodes.insert([row, column], (i, node)) {
            return Err(refused(i, format!("column {column}, row {row} is already in line {}", other + 1)));
        }
    }
    let size = [0, 1].map(|axis| nodes.values().map(|(_, n)| n.index[axis] + 1).max().unwrap_or(0));
    Ok(Grid { nodes: nodes.into_values().map(|(_, node)| node).collect(), size, disc_radius_steps: None })
}

/// Position of each column in a line, and number of columns.
fn places(heading: &str) -> Option<(Vec<Option<usize>>, usize)> {
    let names: Vec<&str> = heading.split(',').map(str::trim).collect();
    let place = |wanted_name: &&str| names.iter().position(|name| name == wanted_name);
    let places: Vec<Option<usize>> = COLUMNS.iter().map(place).collect();
    let complete = places[..MIN_COLUMNS].iter().all(Option::is_some) && names.iter().all(|name| COLUMNS.contains(name));
    (complete && places.iter().flatten().count() == names.len()).then_some((places, names.len()))
}

fn node(line: &str, places: &[Option<usize>], count: usize) -> Result<Node, String> {
    let words: Vec<&str> = line.split(',').map(str::trim).collect();
    if words.len() != count {
        return Err(format!("expected {count} numbers, one per column of the header, not '{line}'"));
    }
    let number = |k: usize| {
        let Some(place) = places[k] else { return Ok(0.0) };
        let number = words[place].parse::<f64>().ok().filter(|v| v.is_finite());
        number.ok_or_else(|| format!("{}: expected a number, not '{}'", COLUMNS[k], words[place]))
    };
    let index = |k: usize| {
        let index = number(k)?;
        let is_index = index.fract() == 0.0 && (0.0..MAX_GRID).contains(&index);
        if is_index {
            Ok(index as usize)
        } else {
            Err(format!("{}: expected a whole number from 0, not {index}", COLUMNS[k]))
        }
    };
    let uncertainty_px = number(4)?;
    if uncertainty_px < 0.0 {
        return Err(format!("uncertainty_px: expected a number from 0, not {uncertainty_px}"));
    }
    Ok(Node { index: [index(0)?, index(1)?], at: DVec2::new(number(2)?, number(3)?), uncertainty_px })
}

const TARGETS: [Word<Target>; 2] = [
    (Target::Checkerboard, "checkerboard", "Squares, dark and bright"),
    (Target::Dots, "dots", "A square grid of discs"),
];

/// The chart in the image.
#[derive(Args, Clone, Debug, Default)]
pub struct ChartInput {
    /// The chart [default: the one that shows more points]
    #[arg(long, value_parser = choice(TARGETS))]
    pub target: Option<Target>,
    /// Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found]
    #[arg(long, value_name = "NxM", value_parser = grid)]
    pub grid: Option<[usize; 2]>,
    /// Channel: R, G, B or Y of an image, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its
    /// pixels with colours balanced to one grey [default: the luminance]
    #[arg(long, value_name = "NAME")]
    pub channel: Option<String>,
    /// Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB
    #[arg(long, value_name = "TILE", value_parser = tile)]
    pub cfa: Option<String>,
    /// Conversion from numbers to light.
    #[command(flatten)]
    pub encoding: EncodingChoice,
    /// Part of the image to search for the chart: left column, top row, width and height, pixels of the image
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub region: Option<[usize; 4]>,
    /// For lists of points (CSV) in place of images: columns and rows of the images in which they were seen
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub size_px: Option<[usize; 2]>,
    /// The chart and its position.
    #[command(flatten)]
    pub truth: TruthInput,
    /// List every point of the chart in the text, too; JSON always has them
    #[arg(long)]
    pub points: bool,
}

/// A chart as seen in an image.
#[derive(Clone, Debug)]
pub(crate) struct DetectedChart {
    pub file: PathBuf,
    pub size_px: [usize; 2],
    pub grid: Grid,
    /// Conversion of the image's numbers to light.
    pub stated: Option<SourcedEncoding>,
}

impl ChartInput {
    /// Ground truth, if given.
    pub(crate) fn truth_and_chart(&self) -> Result<Option<(Truth, PointChart)>, Error> {
        let Some(truth) = self.truth.read(&CHARTS)? else { return Ok(None) };
        let point_chart = truth.points()?;
        Ok(Some((truth, point_chart)))
    }

    fn query(&self, point_chart: Option<&PointChart>) -> TargetQuery {
        TargetQuery { target: self.target.or(point_chart.map(|point_chart| point_chart.target)), size: self.grid }
    }

    pub(crate) fn selection(&self, channel: Option<&str>) -> Selection {
        let (channel, cfa, encoding) = (channel.map(str::to_owned), self.cfa.clone(), self.encoding.clone());
        Selection { channel, cfa, region: None, encoding }
    }

    /// Finds the chart in an image.
    pub(crate) fn detect(&self, file: &Path) -> Result<DetectedChart, Error> {
        Ok(self.detect_in_file(file)?)
    }

    fn detect_in_file(&self, file: &Path) -> Result<DetectedChart, DetectionFailure> {
        if is_list(file) {
            return Ok(self.listed(file)?);
        }
        let photograph = self.encoding.photograph(file)?;
        self.detect_in_photograph(file, &photograph, self.channel.as_deref())
    }

    /// Reads the points of a list.
    fn listed(&self, file: &Path) -> Result<DetectedChart, Error> {
        let truth_and_points = self.truth_and_chart()?;
        let size_px = self
            .size_px
            .ok_or_else(|| refused(file, "a list of points does not state the image size; add `size_px` WxH"))?;
        truth_and_points.iter().try_for_each(|(truth, _)| truth.fits_size(file, size_px))?;
        if self.encoding.chosen.is_some() {
            return Err(refused(file, "a list of points has no readings; leave `encoding` out"));
        }
        let unused_options = [
            ("`region`", self.region.is_some()),
            ("`channel`", self.channel.is_some()),
            ("`cfa`", self.cfa.is_some()),
            ("`target`", self.target.is_some()),
            ("`grid`", self.grid.is_some()),
        ];
        if let Some((name, _)) = unused_options.iter().find(|(_, is_present)| *is_present) {
            return Err(refused(file, format!("a list of points: {name} has no effect; leave it out")));
        }
        Ok(DetectedChart { file: file.to_owned(), size_px, grid: read(file)?, stated: None })
    }

    /// Finds the chart in one channel. For a colour with several places in the mosaic's tile, each point is the mean over these
    /// places: the places sample the image between each other's pixels.
    pub(crate) fn detect_in_channel(
        &self,
        file: &Path,
        photograph: &Photograph,
        channel: Option<&str>,
    ) -> Result<DetectedChart, Error> {
        Ok(self.detect_in_photograph(file, photograph, channel)?)
    }

    fn detect_in_photograph(
        &self,
        file: &Path,
        photograph: &Photograph,
        channel: Option<&str>,
    ) -> Result<DetectedChart, DetectionFailure> {
        let planes = self.selection(channel).planes(file, photograph)?;
        let truth_and_points = self.truth_and_chart()?;
        let (width, height) = planes[0].picture_px;
        if self.size_px.is_some_and(|stated| stated != [width, height]) {
            let message = format!("{width} × {height} pixels, which differs from `size_px`; leave it out");
            return Err(refused(file, message).into());
        }
        truth_and_points.iter().try_for_each(|(truth, _)| truth.fits_size(file, [width, height]))?;
        let query = self.query(truth_and_points.as_ref().map(|(_, point_chart)| point_chart));
        let grids = planes.iter().map(|plane| self.grid(file, plane, query));
        let grid = Grid::mean(&grids.collect::<Result<Vec<_>, _>>()?);
        if grid.orientation().is_some_and(|orientation| orientation.mirrored) {
            return Err(refused(file, MIRRORED).into());
        }
        Ok(DetectedChart {
            file: file.to_owned(),
            size_px: [width, height],
            grid,
            stated: Some(photograph.stated.clone()),
        })
    }

    /// Finds the chart among readings, in the image's raster coordinates.
    fn grid(&self, file: &Path, plane: &Readings, query: TargetQuery) -> Result<Grid, DetectionFailure> {
        let part =
            self.region.map(|region| plane.part_of("region", region).map(|image| (image, region))).transpose()?;
        let (image, first) = match &part {
            None => (&plane.image, [0, 0]),
            Some((image, region)) => (image, plane.first_of(*region)),
        };
        let mut grid = find(image, query).map_err(|error| DetectionFailure::Chart(file.to_owned(), error))?;
        let scale = 0.5 * (plane.period.0 + plane.period.1) as f64;
        for node in &mut grid.nodes {
            let at = [0, 1].map(|axis| node.at[axis] + first[axis] as f64);
            node.at = plane.in_image(at).into();
            node.uncertainty_px *= scale;
        }
        Ok(grid)
    }
}

/// Error of an image whose chart's marks have the wrong handedness.
const MIRRORED: &str = "shows its chart mirrored, according to its three missing dots: one axis of the image is reversed; give \
                        the image as captured, or mirror it back";

/// Reason why an image gives no points.
enum DetectionFailure {
    /// A valid image without such a chart.
    Chart(PathBuf, TargetError),
    /// The image, or the statements about it, cannot be used.
    Failed(Error),
}

impl From<Error> for DetectionFailure {
    fn from(failure: Error) -> Self {
        Self::Failed(failure)
    }
}

impl From<DetectionFailure> for Error {
    fn from(unseen: DetectionFailure) -> Self {
        match unseen {
            DetectionFailure::Chart(file, error) => refused(&file, error),
            DetectionFailure::Failed(failure) => failure,
        }
    }
}

/// An image without a visible chart, and the reason.
pub(crate) type RejectedImage = (PathBuf, TargetError);

/// The charts of several images of one size, and the images without one, with the reason. Refuses duplicate images; refuses all
/// if fewer than [`MIN_VIEWS`] of several show the chart.
pub(crate) fn all(
    chart: &ChartInput,
    files: &[PathBuf],
    observer: &dyn Observer,
) -> Result<(Vec<DetectedChart>, Vec<RejectedImage>), Error> {
    let (mut views, mut without, mut errors) = (Vec::<DetectedChart>::new(), Vec::new(), Vec::new());
    let progress = ImageProgress { heading: "charts", done: AtomicUsize::new(0), total: files.len(), observer };
    for file in files {
        let detected = chart.detect_in_file(file);
        progress.step();
        match detected {
            Ok(view) => match views.iter().find_map(|other| contradiction(other, &view)) {
                Some(failure) => errors.push(InputError::new(ErrorCode::NotMeasurable, failure)),
                None => views.push(view),
            },
            Err(DetectionFailure::Chart(file, error)) => without.push((file, error)),
            Err(DetectionFailure::Failed(Error::Input(more))) => errors.extend(more),
            Err(DetectionFailure::Failed(other)) => return Err(other),
        }
    }
    if views.len() < MIN_VIEWS {
        errors.extend(
            too_few(&without, views.len()).into_iter().map(|words| InputError::new(ErrorCode::NotMeasurable, words)),
        );
    }
    if errors.is_empty() { Ok((views, without)) } else { Err(Error::Input(errors)) }
}

/// Messages if views without a chart cannot be left out: the first reason if none shows it, otherwise every reason.
fn too_few(without: &[RejectedImage], left: usize) -> Vec<String> {
    let line = |(file, error): &RejectedImage| format!("{}: {error}", file.display());
    match without {
        [first, _, ..] if left == 0 => {
            vec![format!("{}; none of the {} images shows the chart", line(first), without.len())]
        }
        some => some.iter().map(line).collect(),
    }
}

fn contradiction(a: &DetectedChart, b: &DetectedChart) -> Option<String> {
    let (first, second) = (a.file.display(), b.file.display());
    if a.size_px != b.size_px {
        let [[w, h], [v, g]] = [a.size_px, b.size_px];
        return Some(format!(
            "{second}: {v} × {g} pixels, but {first} has {w} × {h}; give images of one camera and size"
        ));
    }
    (a.grid == b.grid).then(|| format!("{second}: identical view to {first}; give each view once"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_points(text: &str) -> Result<Grid, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("points.csv");
        std::fs::write(&file, text).expect("written");
        read(&file).map_err(|failure| match failure {
            Error::Input(errors) => errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "),
            Error::Run(_) => "a failed run".to_owned(),
        })
    }

    #[test]
    fn points_are_read_by_the_names_of_their_columns() {
        let grid = read_points("# seen\nx_px,y_px,row,column\n10.5,20.25,0,1\n\n1,2,3,0\n").expect("two points");
        assert_eq!((grid.size, grid.nodes.len()), ([2, 4], 2));
        let first = Node { index: [1, 0], at: DVec2::new(10.5, 20.25), uncertainty_px: 0.0 };
        assert_eq!(grid.node([1, 0]), Some(&first));
    }

    #[test]
    fn wrong_lines_are_reported_by_number() {
        let head = "column,row,x_px,y_px,uncertainty_px\n";
        for (text, line, part) in [
            (String::new(), 1, "expected a header line"),
            ("column,row,x,y\n".to_owned(), 1, "x_px"),
            (format!("{head}0,0,1,2\n"), 2, "expected 5 numbers"),
            (format!("{head}0,0,1,2,0\n0.5,0,1,2,0\n"), 3, "whole number"),
            (format!("{head}0,0,1,nan,0\n"), 2, "y_px: expected a number"),
            (format!("{head}0,0,1,2,-1\n"), 2, "uncertainty_px"),
            (format!("{head}0,0,1,2,0\n1,0,1,2,0\n0,0,3,2,0\n"), 4, "already in line 2"),
        ] {
            let error = read_points(&text).expect_err("refused");
            assert!(error.contains(&format!("points.csv:{line}: ")) && error.contains(part), "{error}");
        }
    }
}
