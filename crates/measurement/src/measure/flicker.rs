//! `measure flicker`: modulated light, over rows and over frames.

use std::path::{Path, PathBuf};

use clap::Args;
use etendue_charts::design::{Backlit, FlatField, LedFlicker};
use etendue_io::failure::{Error, ErrorCode};
use etendue_metrology::flicker::{Flicker, FlickerTiming, RowBands, measure_flicker};
use etendue_metrology::{Estimate, Image};

use super::frame_times::{FrameTimes, completed};
use super::pictures::{MeasurementInput, refused};
use super::{readings::Readings, truth::Truth, truth::place::PatchPlace};
use crate::plot::{Axis, Mark, Plot, Series};
use crate::report::{Cell, Report, Table};

/// `etendue measure flicker`
#[derive(Args, Clone, Debug)]
pub struct FlickerRequest {
    /// Frames of a sequence in order, or one frame of a rolling shutter
    #[arg(value_name = "FRAME", required = true)]
    pub frames: Vec<PathBuf>,
    /// Time from one row of the file to the next, µs, of a rolling shutter [default: the side-car's, or all rows are exposed
    /// together]
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    pub row_time_us: Option<f64>,
    /// Frames per second [default: the side-car's, or unknown: each frame is measured separately]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true)]
    pub frame_rate_hz: Option<f64>,
    /// Exposure of a row, µs: adds the light's own modulation and the duty cycle of its pulses [default: the side-car's, or
    /// unknown]
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    pub exposure_us: Option<f64>,
    /// Readings of the image, their meaning, and the chart's ground truth.
    #[command(flatten)]
    pub input: MeasurementInput,
}

impl FlickerRequest {
    /// Creates a request with the program's defaults.
    pub fn new(frames: Vec<PathBuf>) -> Self {
        Self { frames, row_time_us: None, frame_rate_hz: None, exposure_us: None, input: MeasurementInput::default() }
    }
}

/// Charts with one light, and with many.
const UNIFORM_CHARTS: [&str; 2] = [FlatField::NAME, Backlit::NAME];
const CHARTS: [&str; 3] = [FlatField::NAME, Backlit::NAME, LedFlicker::NAME];

const METHOD: &str = "bands over rows and changes over frames, by least squares; modulation as IEEE P2020 defines it (± one standard uncertainty)";

/// Data of the frames.
struct FlickerFrames {
    frames: Vec<Readings>,
    timing: FlickerTiming,
    levels: (f64, Option<f64>),
    name: String,
}

/// Flicker of a uniformly lit region, or of each lamp of a chart.
///
/// # Errors
/// If times are missing, or a region is too small, saturated or dark.
pub fn flicker(request: &FlickerRequest) -> Result<Report, Error> {
    let FlickerRequest { row_time_us, frame_rate_hz, exposure_us, .. } = *request;
    let (times, notes) = completed(&request.frames, FrameTimes { row_time_us, frame_rate_hz, exposure_us })?;
    let FrameTimes { row_time_us, frame_rate_hz, exposure_us } = times;
    let request = &FlickerRequest { row_time_us, frame_rate_hz, exposure_us, ..request.clone() };
    let (sequence, truth) = read(request)?;
    let mut report = Report::new("flicker", METHOD);
    notes.into_iter().for_each(|note| report.note(note));
    match truth.as_ref().filter(|truth| !UNIFORM_CHARTS.contains(&truth.chart())) {
        None => {
            let at = truth.as_ref().map(|truth| truth.middle(&sequence.frames[0])).transpose()?;
            one(&sequence, at, request, &mut report)?;
        }
        Some(truth) => lamps(&sequence, truth, request, &mut report)?,
    }
    sequence.frames.iter().for_each(|frame| report.encoding(&frame.stated));
    for (frame, file) in sequence.frames.iter().zip(&request.frames) {
        report.note_cut(&file.display().to_string(), &frame.image, sequence.levels.1);
    }
    Ok(report)
}

fn read(request: &FlickerRequest) -> Result<(FlickerFrames, Option<Truth>), Error> {
    let input = &request.input;
    let frames = request.frames.iter().map(|file| input.linear(file)).collect::<Result<Vec<_>, _>>()?;
    let Some((first, file)) = frames.first().zip(request.frames.first()) else {
        return Err(Error::coded(ErrorCode::NotMeasurable, "no frame is given; flicker needs one or more"));
    };
    for (frame, file) in frames.iter().zip(&request.frames) {
        frame.independent(file, 1)?;
    }
    let truth = input.truth(&CHARTS, file, first)?;
    let seconds = |us: f64| us * 1e-6;
    let timing = FlickerTiming {
        // For one colour of a mosaic, every second row of the file is read.
        row_time_s: request.row_time_us.map(|us| seconds(us) * first.period.1 as f64),
        frame_rate_hz: request.frame_rate_hz,
        exposure_s: request.exposure_us.map(seconds),
    };
    let levels = (input.levels.black(first), input.levels.full_scale(first));
    Ok((FlickerFrames { timing, levels, name: file.display().to_string(), frames }, truth))
}

impl FlickerFrames {
    fn measured(&self, at: Option<[usize; 4]>) -> Result<Flicker, String> {
        let part = |frame: &Readings| match at {
            None => Ok(frame.image.clone()),
            Some(at) => frame.part(at, &self.name).map_err(|error| error.to_string()),
        };
        let images = self.frames.iter().map(part).collect::<Result<Vec<Image>, _>>()?;
        measure_flicker(&images, &self.timing, self.levels).map_err(|error| error.to_string())
    }
}

fn one(
    sequence: &FlickerFrames,
    at: Option<[usize; 4]>,
    request: &FlickerRequest,
    report: &mut Report,
) -> Result<(), Error> {
    let result = sequence.measured(at).map_err(|error| refused(Path::new(&sequence.name), error))?;
    report.figure("level", "mean reading above black", "", result.level);
    if let Some(rows) = &result.rows {
        match &rows.bands {
            Some(bands) => report_bands(bands, sequence.frames[0].period.1 as f64, report),
            None => {
                let (low, high) = (rows.lowest_hz, rows.highest_hz);
                let range = format!("from {low:.1} to {high:.0} Hz");
                report.note(format!("no bands over the rows {range} that are distinguishable from noise"));
            }
        }
        missing(rows.bands.as_ref(), request, report);
    }
    if let Some(frames) = &result.frames {
        report.figure("modulation_frames", "modulation over frames, (max − min)/(max + min)", "", frames.modulation);
        if let Some(beat) = frames.beat_hz {
            report.figure("beat_frequency_hz", "beat frequency of the bands", "Hz", beat);
        }
        if let Some(frame_frequency) = &frames.frequency {
            report.figure("frame_frequency_hz", "apparent frequency over frames", "Hz", frame_frequency.apparent_hz);
            report.figure("amplitude_frames", "amplitude over mean, over frames", "", frame_frequency.amplitude_ratio);
            if result.rows.as_ref().is_none_or(|rows| rows.bands.is_none()) {
                report.note(alias_list(frame_frequency.aliases(9), frame_frequency.frame_rate_hz));
            }
        }
    }
    plot(sequence, at, report)
}

/// Frequencies that frames at this rate cannot distinguish.
fn alias_list(orders: Vec<(u32, f64)>, rate_hz: f64) -> String {
    let list: Vec<String> = orders.iter().map(|(k, f)| format!("{f:.2} Hz (order {k})")).collect();
    format!(
        "frames at {rate_hz} Hz undersample: the light's frequency is one of {} …; the rows of a rolling shutter determine which (`row_time_us`)",
        list.join(", ")
    )
}

fn report_bands(bands: &RowBands, rows_of_file: f64, report: &mut Report) {
    report.figure("frequency_hz", "frequency of the light", "Hz", bands.frequency_hz);
    report.figure("period_rows", "rows from band to band", "rows", bands.period_rows.scaled(rows_of_file));
    report.figure("modulation_rows", "modulation over rows, (max − min)/(max + min)", "", bands.modulation);
    report.figure("amplitude_rows", "amplitude over mean, over rows", "", bands.amplitude_ratio);
    if let Some(light) = bands.light_amplitude_ratio {
        report.figure("amplitude_light", "amplitude over mean, of the light", "", light);
    }
    if let Some(pulses) = &bands.pulses {
        report.figure("duty_cycle", "duty cycle of the light's pulses", "", pulses.duty);
        report.figure("pulsed_fraction", "pulsed fraction of the light", "", pulses.pulsed_fraction);
    }
    report.fact("harmonics", "harmonics fitted", "", bands.harmonics as f64);
    if !bands.shading {
        report.note("fewer than three periods over the rows: shading of the region counts as flicker");
    }
}

fn missing(bands: Option<&RowBands>, request: &FlickerRequest, report: &mut Report) {
    if bands.is_some() && request.exposure_us.is_none() {
        report.note(
            "without the exposure (`exposure_us`) the light's own modulation and the duty cycle of its pulses are not known",
        );
    }
    if request.frames.len() > 1 && request.frame_rate_hz.is_none() {
        report.note(
            "without the frame rate (`frame_rate_hz`) each frame is measured separately, and the means over all frames are reported",
        );
    }
}

fn plot(sequence: &FlickerFrames, at: Option<[usize; 4]>, report: &mut Report) -> Result<(), Error> {
    let Some(row_time_s) = sequence.timing.row_time_s else { return Ok(()) };
    let first = &sequence.frames[0];
    let image = match at {
        None => first.image.clone(),
        Some(at) => first.part(at, &sequence.name)?,
    };
    let mean = |row: &[f32]| row.iter().map(|v| f64::from(*v)).sum::<f64>() / row.len() as f64 - sequence.levels.0;
    let rows = image.samples().chunks_exact(image.width()).enumerate();
    let points = rows.map(|(y, row)| (1e3 * y as f64 * row_time_s, mean(row)));
    report.plot(Plot {
        title: "rows of the first frame".to_owned(),
        x: Axis::linear("time since the region's first row, ms"),
        y: Axis::linear("reading above black"),
        series: vec![Series::new("", Mark::Line, points)],
    });
    Ok(())
}

/// Each lamp of a chart, with the chart's statement about it.
fn lamps(sequence: &FlickerFrames, truth: &Truth, request: &FlickerRequest, report: &mut Report) -> Result<(), Error> {
    let (patches, left_out) = truth.patches(&sequence.frames[0])?;
    let mut rows = Vec::new();
    for patch in &patches {
        match sequence.measured(Some(patch.at)) {
            Ok(result) => rows.push(row(patch, truth, &result)),
            Err(error) => report.note(format!("omitted: {}: {error}", patch.name)),
        }
    }
    left_out.iter().for_each(|name| report.note(format!("omitted: {name}: not entirely in the image, or too small")));
    if rows.is_empty() {
        return Err(Error::coded(
            ErrorCode::NotMeasurable,
            format!("{}: no lamp of the chart could be measured: {}", sequence.name, report.notes().join("; ")),
        ));
    }
    report.table(Table {
        key: "lamps",
        columns: vec![
            ("lamp", "lamp"),
            ("stated_frequency_hz", "stated Hz"),
            ("stated_duty_cycle", "stated duty cycle"),
            ("frequency_hz", "Hz"),
            ("duty_cycle", "duty"),
            ("modulation_rows", "rows"),
            ("modulation_frames", "frames"),
        ],
        rows,
    });
    missing(None, request, report);
    Ok(())
}

fn row(patch: &PatchPlace, truth: &Truth, result: &Flicker) -> Vec<Cell> {
    let bands = result.rows.as_ref().and_then(|rows| rows.bands.as_ref());
    let cell = |value: Option<Estimate>| value.map_or(Cell::Nothing, Cell::Estimate);
    let stated = truth.lamp(&patch.name);
    let number = |value: Option<f64>| value.map_or(Cell::Nothing, |value| Cell::Number(value, 3));
    vec![
        Cell::Text(patch.name.clone()),
        number(stated.map(|(frequency_hz, _)| frequency_hz)),
        number(stated.map(|(_, duty)| duty)),
        cell(bands.map(|bands| bands.frequency_hz)),
        cell(bands.and_then(|bands| bands.pulses).map(|pulses| pulses.duty)),
        cell(bands.map(|bands| bands.modulation)),
        cell(result.frames.as_ref().map(|frames| frames.modulation)),
    ]
}
