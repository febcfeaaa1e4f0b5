//! Inspection of measured lamps.

pub mod passing_beam;
mod plot;

use std::path::Path;

use etendue_scene::asset::{OpeningShape, PhotometryAsset, PhotometryAxes, Tilt};

use super::{FileReport, report::ChannelReport};
use crate::{Error, photometry::read_photometry};

pub(super) fn report(file: &Path) -> Result<FileReport, Error> {
    let lamp = read_photometry(file)?;
    let mut report = FileReport::new(file, format!("photometric file, {}", lamp.format));
    texts(&lamp, &mut report);
    report.state("angles", axes(lamp.axes));
    report.state("vertical angles", angles(&lamp.vertical_deg));
    report.state("horizontal angles", format!("{} (symmetries expanded)", angles(&lamp.horizontal_deg)));
    light(&lamp, &mut report);
    report.state("luminous opening", opening(&lamp));
    report.state("lamps", format!("{}, {} W", lamp.lamps, lamp.watts));
    tilt(&lamp, &mut report);
    passing_beam::state(&lamp, &mut report);
    report.channels.push(ChannelReport::new("intensity (cd)", "text", lamp.candela.iter().copied()));
    report.notes.extend(lamp.report.iter().cloned());
    report.preview = Some(plot::draw(&lamp));
    Ok(report)
}

fn texts(lamp: &PhotometryAsset, report: &mut FileReport) {
    for (name, text) in lamp.texts.iter().filter(|(_, text)| !text.is_empty()) {
        report.state(if name.is_empty() { "text" } else { name }, text);
    }
}

fn axes(axes: PhotometryAxes) -> &'static str {
    match axes {
        PhotometryAxes::A => "type A: vertical axis, zero ahead, H to the right, V up",
        PhotometryAxes::B => "type B: horizontal axis, zero ahead, H to the right, V up",
        PhotometryAxes::C => "type C: vertical axis, V from the nadir, C counter-clockwise from above",
    }
}

fn angles(grid: &[f64]) -> String {
    format!("{} from {}° to {}°", grid.len(), grid[0], grid[grid.len() - 1])
}

fn light(lamp: &PhotometryAsset, report: &mut FileReport) {
    let (peak, h, v) = lamp.peak();
    report.state("maximum intensity", format!("{peak:.1} cd at H {h}°, V {v}°"));
    report.state("factor applied", lamp.factor);
    let flux = lamp.flux_lm();
    report.state("flux from the intensities", format!("{flux:.1} lm"));
    report.state("stated flux", stated(lamp, flux));
    for (name, [beam, field]) in plot::beam_and_field(lamp) {
        report.state(&format!("beam angle, {name}"), format!("{beam:.1}° at 50 %, field angle {field:.1}° at 10 %"));
    }
}

fn stated(lamp: &PhotometryAsset, flux: f64) -> String {
    match (lamp.rated_lumens, lamp.output_ratio, lamp.stated_flux_lm()) {
        (Some(rated), Some(fraction), Some(stated)) => {
            format!(
                "{stated:.1} lm ({rated} lm of the lamps × light output ratio {fraction}); ratio {:.4}",
                flux / stated
            )
        }
        (Some(rated), None, _) => format!("{rated} lm of the lamps; ratio {:.4}", flux / rated),
        _ => "none: absolute photometry".to_owned(),
    }
}

fn opening(lamp: &PhotometryAsset) -> String {
    let opening = &lamp.opening;
    let shape = match opening.shape {
        OpeningShape::Point => return "point".to_owned(),
        OpeningShape::Rectangular => "rectangular",
        OpeningShape::Round => "round",
        OpeningShape::Ball => "sphere",
        OpeningShape::Lying | OpeningShape::LyingAcross => "horizontal cylinder",
    };
    format!("{shape}, {} m long (C0), {} m wide (C90), {} m high", opening.length_m, opening.width_m, opening.height_m)
}

fn tilt(lamp: &PhotometryAsset, report: &mut FileReport) {
    match &lamp.tilt {
        Tilt::None => {}
        Tilt::Measured(degrees) => report.state("tilt during measurement", format!("{degrees}°")),
        Tilt::Table { geometry, factors } => {
            let entries: Vec<String> =
                factors.iter().map(|(degrees, factor)| format!("{degrees}°: {factor}")).collect();
            report.state("tilt", format!("lamp-to-luminaire geometry {geometry}; {}", entries.join(", ")));
        }
    }
}
