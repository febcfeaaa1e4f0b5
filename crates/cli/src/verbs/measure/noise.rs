//! `etendue measure noise`: temporal and fixed-pattern noise of a patch.

use super::readings::{Levels, Selection};
use super::report::{Report, Telling};
use crate::failure::Failure;
use clap::Args;
use etendue_metrology::noise::measure_noise;
use etendue_metrology::photon_transfer::Stack;
use std::path::PathBuf;

/// `etendue measure noise`
#[derive(Debug, Args)]
pub struct NoiseArguments {
    /// Eight or more frames of one even surface
    #[arg(value_name = "FRAME", required = true)]
    pub frames: Vec<PathBuf>,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub levels: Levels,
    #[command(flatten)]
    pub telling: Telling,
}

pub(super) fn run(arguments: &NoiseArguments) -> Result<(), Failure> {
    let mut stack: Option<Stack> = None;
    let mut black = 0.0;
    for file in &arguments.frames {
        let readings = arguments.selection.linear(file)?;
        black = arguments.levels.black(&readings);
        let (width, height) = (readings.image.width(), readings.image.height());
        let named = |error| Failure::input(format!("{}: {error}", file.display()));
        stack.get_or_insert_with(|| Stack::new(width, height)).push(&readings.image).map_err(named)?;
    }
    let stack = stack.expect("at least one frame is asked for");
    let noise = measure_noise(&stack, black).map_err(Failure::input)?;
    let mut report = Report::new("noise", "noise of an even surface after ISO 15739 (± one standard uncertainty)");
    report.figure("signal", "signal less black", "", noise.signal);
    report.figure("total_noise", "total noise", "", noise.total);
    report.figure("temporal_noise", "temporal noise", "", noise.temporal);
    report.figure("fixed_pattern_noise", "fixed-pattern noise", "", noise.fixed);
    let [total, temporal, fixed] = noise.snr();
    report.figure("snr", "signal over total noise", "", total);
    report.figure("snr_temporal", "signal over temporal noise", "", temporal);
    report.figure("snr_fixed_pattern", "signal over fixed-pattern noise", "", fixed);
    report.tell(&arguments.telling)
}
