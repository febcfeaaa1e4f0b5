//! `etendue measure cdp`: contrast detection probability of pairs of patches.

use super::readings::{Levels, Selection, part, region};
use super::report::{Cell, Report, Table, Telling};
use crate::failure::Failure;
use clap::Args;
use etendue_metrology::contrast::measure_contrast;
use std::path::PathBuf;

/// `etendue measure cdp`
#[derive(Debug, Args)]
pub struct Cdp {
    /// A picture of grey patches
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// The darker patch of a pair: left column, top row, width, height; once a pair
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required = true)]
    pub darker: Vec<[usize; 4]>,
    /// The brighter patch of a pair, in the same order
    #[arg(long, value_name = "X,Y,W,H", value_parser = region, required = true)]
    pub brighter: Vec<[usize; 4]>,
    /// The scene's Weber contrast of a pair: brighter over darker luminance, less 1; in the same order
    #[arg(long, value_name = "K", required = true, allow_negative_numbers = true)]
    pub contrast: Vec<f64>,
    /// How much a measured contrast may differ from the scene's, share
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, allow_negative_numbers = true)]
    pub tolerance: f64,
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    pub levels: Levels,
    #[command(flatten)]
    pub telling: Telling,
}

pub(super) fn run(arguments: &Cdp) -> Result<(), Failure> {
    let (darker, brighter, contrasts) = (&arguments.darker, &arguments.brighter, &arguments.contrast);
    if darker.len() != brighter.len() || darker.len() != contrasts.len() {
        return Err(Failure::input("--darker, --brighter and --contrast: expected each of them once a pair"));
    }
    let readings = arguments.selection.linear(&arguments.picture)?;
    let black = arguments.levels.black(&readings);
    let row = |((dark, light), contrast): ((&[usize; 4], &[usize; 4]), &f64)| {
        let (low, high) = (part(&readings.image, *dark, "--darker")?, part(&readings.image, *light, "--brighter")?);
        let pair = measure_contrast(&low, &high, black, *contrast, arguments.tolerance).map_err(Failure::input)?;
        Ok(vec![
            Cell::Text(format!("{},{} {},{}", dark[0], dark[1], light[0], light[1])),
            Cell::Number(*contrast, 4),
            Cell::Estimate(pair.measured),
            Cell::Estimate(pair.detection),
            Cell::Estimate(pair.transfer),
            Cell::Estimate(pair.contrast_snr),
        ])
    };
    let rows = darker.iter().zip(brighter).zip(contrasts).map(row).collect::<Result<Vec<_>, Failure>>()?;
    let method = "contrast detection probability after IEEE P2020 (Weber contrast; ± one standard uncertainty)";
    let mut report = Report::new("cdp", method);
    report.table(Table {
        key: "pairs",
        columns: vec![
            ("at_px", "patches at px"),
            ("scene_contrast", "scene"),
            ("measured_contrast", "measured"),
            ("cdp", "CDP"),
            ("cta", "CTA"),
            ("csnr", "CSNR"),
        ],
        rows,
    });
    report.tell(&arguments.telling)
}
