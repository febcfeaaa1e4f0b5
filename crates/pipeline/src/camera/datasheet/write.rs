//! The camera file of a data sheet, with the origin of every number.

use super::Figures;
use etendue_scene::record::DataSheet;
use etendue_scene::record::datasheet::Points;
use etendue_scene::record::sensor::cfa::Cfa;
use std::fmt::Write as _;

/// Lines of a file, each number with what it rests on above it.
struct Lines(String);

impl Lines {
    fn line(&mut self, text: &str) {
        self.0 += text;
        self.0.push('\n');
    }

    fn key(&mut self, about: &str, key: &str, value: impl std::fmt::Display) {
        // Writing to a string does not fail.
        let _ = writeln!(self.0, "# {about}\n{key} = {value}");
    }
}

pub(super) fn camera(sheet: &DataSheet, figures: Figures, stem: &str) -> String {
    let mut lines = Lines(String::new());
    // A comment ends with its line.
    let name: String = sheet.camera.value.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    lines.line(&format!(
        "# {name}, from its EMVA 1288 data sheet by `etendue datasheet`. \"Stated\" is what the sheet says."
    ));
    lines.line("format = 1\n\n[lens]");
    lines.line("# Not on the sheet: put the lens here. This one sees 53° across and gives light of f/8, as the standard measures.");
    lines.line("type = \"pinhole\"");
    let width_um = sheet.pixel_pitch_um.value * sheet.width_px.value as f64;
    lines.line(&format!("focal_length_mm = {}", width_um.round().max(1.0) / 1e3));
    lines.line("f_number = 8\n\n[sensor]");
    lines.line(&format!("width_px = {}\nheight_px = {}", sheet.width_px.value, sheet.height_px.value));
    lines.line(&format!("pixel_pitch_um = {}", sheet.pixel_pitch_um.value));
    lines.key("Not on the sheet: put the exposure here.", "exposure_s", "0.01");
    lines.line(&format!("cfa = \"{}\"", cfa_name(sheet.filters())));
    let about = "Stated; the standard's efficiency has the fill factor in it, so \"fill_factor\" stays 1.";
    lines.key(about, "quantum_efficiency", efficiency(sheet, stem));
    noises(&mut lines, sheet, figures);
    patterns(&mut lines, sheet);
    lines.0
}

fn noises(lines: &mut Lines, sheet: &DataSheet, figures: Figures) {
    let about = "Stated saturation capacity: where the temporal variance is largest, a little below the well itself.";
    lines.key(about, "full_well_e", sheet.saturation_capacity_e.value);
    let about = match sheet.temporal_dark_noise_e {
        Some(_) => "Stated temporal dark noise, without quantisation.",
        None => "From the stated dark noise in DN: √(σ² − 1/12)/K, so that rounding is not counted twice.",
    };
    lines.key(about, "read_noise_e", figures.dark_noise_e);
    let about = if sheet.dark_current_e_s.is_some() { "Stated." } else { "Not on the sheet." };
    lines.key(about, "dark_current_e_s", sheet.dark_current_e_s.as_ref().map_or(0.0, |i| i.value));
    let about = if sheet.gain_dn_per_e.is_some() { "Stated." } else { "The inverse of the stated 1/K." };
    lines.key(about, "gain_dn_per_e", figures.gain_dn_e);
    let about = match sheet.black_level_dn {
        Some(_) => "Stated.",
        None => "Not on the sheet: five deviations of the dark noise, as far as the converter leaves room.",
    };
    lines.key(about, "black_level_dn", figures.black_level_dn);
    lines.line(&format!("bits = {}", sheet.bits.value));
    if let Some(error) = &sheet.linearity_error_percent {
        lines.line(&format!("# The stated linearity error of {} % is not modelled.", error.value));
    }
}

fn patterns(lines: &mut Lines, sheet: &DataSheet) {
    if sheet.prnu_percent.is_some() || sheet.dsnu_e.is_some() {
        lines.line("\n# Stated.\n[sensor.non_uniformity]");
    }
    if let Some(prnu) = &sheet.prnu_percent {
        lines.line(&format!("prnu = {}", share(prnu.value)));
    }
    if let Some(dsnu) = &sheet.dsnu_e {
        lines.line(&format!("dsnu_e = {}", dsnu.value));
    }
    if let Some(celsius) = sheet.dark_current_at_c.as_ref().map(|t| t.value) {
        lines.line(
            "\n# The temperature of the stated dark current; put the sensor's own in the first line.\n[sensor.dark]",
        );
        lines.line(&format!("temperature_c = {celsius}\nreference_c = {celsius}"));
        if let Some(step) = &sheet.doubling_k {
            lines.line(&format!("doubling_k = {}", step.value));
        }
    }
}

/// A percentage as a share, without the noise of a division.
fn share(percent: f64) -> f64 {
    (percent * 1e9).round() / 1e11
}

/// One number, or a table, of each channel.
fn efficiency(sheet: &DataSheet, stem: &str) -> String {
    let curves = sheet.quantum_efficiency_percent.curves();
    let value = |channel: &str, points: &Points| match points.as_slice() {
        [only] => format!("{}", share(only.value[1])),
        _ => format!("{{ spectrum = \"{}\" }}", table_name(stem, channel)),
    };
    match curves.as_slice() {
        [(channel, points)] => value(channel, points),
        many => {
            let parts: Vec<String> =
                many.iter().map(|(channel, points)| format!("{channel} = {}", value(channel, points))).collect();
            format!("{{ channels = {{ {} }} }}", parts.join(", "))
        }
    }
}

fn table_name(stem: &str, channel: &str) -> String {
    format!("{stem}-{channel}.csv")
}

/// The curves of several points.
pub(super) fn tables(sheet: &DataSheet, stem: &str) -> Vec<(String, String)> {
    let curves = sheet.quantum_efficiency_percent.curves();
    let table = |(channel, points): &(&str, &Points)| {
        let row = |p: &etendue_scene::Placed<[f64; 2]>| format!("{},{}\n", p.value[0], share(p.value[1]));
        let rows: String = points.iter().map(row).collect();
        (table_name(stem, channel), format!("wavelength_nm,quantum_efficiency\n{rows}"))
    };
    curves.iter().filter(|(_, points)| points.len() > 1).map(table).collect()
}

/// The word of a filter array in files.
fn cfa_name(cfa: Cfa) -> &'static str {
    match cfa {
        Cfa::Mono => "mono",
        Cfa::Rggb => "rggb",
        Cfa::Bggr => "bggr",
        Cfa::Grbg => "grbg",
        Cfa::Gbrg => "gbrg",
        Cfa::Rccc => "rccc",
        Cfa::Rccb => "rccb",
        Cfa::Rgwb => "rgwb",
        Cfa::Rgib => "rgib",
        Cfa::Cygm => "cygm",
    }
}
