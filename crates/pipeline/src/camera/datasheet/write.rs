//! The camera file of a data sheet, with the origin of every number.

use super::SheetFigures;
use etendue_scene::record::datasheet::CurvePoints;
use etendue_scene::record::lens::Pinhole;
use etendue_scene::record::sensor::QuantumEfficiency;
use etendue_scene::record::sensor::cfa::CfaSource;
use etendue_scene::record::sensor::charge::{Dark, NonUniformity};
use etendue_scene::record::{Camera, Curve, DataSheet, Electronics, Lens, Sensor};
use etendue_scene::written::File;

pub(super) fn camera(sheet: &DataSheet, figures: SheetFigures, stem: &str) -> String {
    let width_um = sheet.pixel_pitch_um.value * sheet.width_px.value as f64;
    let lens = Lens::Pinhole(Pinhole::new(width_um.round().max(1.0) / 1e3, 8.0));
    let (width, height, pitch) = (sheet.width_px.value, sheet.height_px.value, sheet.pixel_pitch_um.value);
    let sensor = Sensor { electronics: Some(electronics(sheet, figures, stem)), ..Sensor::new(width, height, pitch) };
    let name = &sheet.camera.value;
    let head =
        format!("{name}, from its EMVA 1288 data sheet by `etendue datasheet`. \"Stated\": given on the data sheet.");
    // A comment of several lines would not belong to the name.
    let file = File::new(Camera::new(lens, sensor).to_table()).head(head.replace('\n', " "));
    let file = origins(sheet).into_iter().fold(file, |file, (key, comment)| file.above(key, comment));
    match &sheet.linearity_error_percent {
        Some(error) => {
            file.above("sensor", format!("The stated linearity error of {} % is not modelled.", error.value))
        }
        None => file,
    }
    .to_string()
}

fn electronics(sheet: &DataSheet, figures: SheetFigures, stem: &str) -> Electronics {
    let dark_current_e_s = sheet.dark_current_e_s.as_ref().map_or(0.0, |i| i.value);
    let needed = Electronics::new(
        0.01,
        CfaSource::Named(sheet.filters().into()),
        efficiency(sheet, stem),
        sheet.saturation_capacity_e.value,
        figures.dark_noise_e,
        figures.gain_dn_e,
        figures.black_level_dn,
        sheet.bits.value,
    );
    let dark_current_e_s = Some(dark_current_e_s.into());
    Electronics { dark_current_e_s, non_uniformity: pattern(sheet), dark: dark(sheet), ..needed }
}

/// Source of each number, by its key.
fn origins(sheet: &DataSheet) -> [(&'static str, &'static str); 10] {
    let stated_or = |is_stated: bool, otherwise: &'static str| if is_stated { "Stated." } else { otherwise };
    let noise = match sheet.temporal_dark_noise_e {
        Some(_) => "Stated temporal dark noise, without quantisation.",
        None => "From the stated dark noise in DN: √(σ² − 1/12)/K, so that rounding is not counted twice.",
    };
    let black =
        "Not on the sheet: five standard deviations of the dark noise, or less if the range of the ADC requires it.";
    [
        (
            "lens.type",
            "Not on the sheet: set the lens here. This one has a horizontal field of view of 53° and the standard's \
             f/8.",
        ),
        ("sensor.exposure_s", "Not on the sheet: set the exposure here."),
        (
            "sensor.quantum_efficiency",
            "Stated; the standard's efficiency includes the fill factor, so \"fill_factor\" is 1.",
        ),
        (
            "sensor.full_well_e",
            "Stated saturation capacity: where the temporal variance is largest, slightly below the full well.",
        ),
        ("sensor.read_noise_e", noise),
        ("sensor.dark_current_e_s", stated_or(sheet.dark_current_e_s.is_some(), "Not on the sheet.")),
        ("sensor.gain_dn_per_e", stated_or(sheet.gain_dn_per_e.is_some(), "The inverse of the stated 1/K.")),
        ("sensor.black_level_dn", stated_or(sheet.black_level_dn.is_some(), black)),
        ("sensor.non_uniformity", "Stated."),
        ("sensor.dark", "The temperature of the stated dark current; set that of the sensor in the first line."),
    ]
}

fn pattern(sheet: &DataSheet) -> Option<NonUniformity> {
    let prnu = sheet.prnu_percent.as_ref().map(|prnu| fraction(prnu.value).into());
    let dsnu_e = sheet.dsnu_e.as_ref().map(|dsnu| dsnu.value.into());
    (prnu.is_some() || dsnu_e.is_some()).then(|| NonUniformity { prnu, dsnu_e, ..NonUniformity::default() })
}

fn dark(sheet: &DataSheet) -> Option<Dark> {
    let celsius = sheet.dark_current_at_c.as_ref()?.value;
    Some(Dark {
        temperature_c: Some(celsius.into()),
        reference_c: Some(celsius.into()),
        doubling_k: sheet.doubling_k.as_ref().map(|step| step.value.into()),
        ..Dark::default()
    })
}

/// A percentage as a fraction, without the rounding error of a division.
fn fraction(percent: f64) -> f64 {
    (percent * 1e9).round() / 1e11
}

/// One number, or a table, for each channel.
fn efficiency(sheet: &DataSheet, stem: &str) -> QuantumEfficiency {
    let value = |channel: &str, points: &CurvePoints| match points.as_slice() {
        [only] => Curve::Constant(fraction(only.value[1]).into()),
        _ => Curve::File(table_name(stem, channel).as_str().into()),
    };
    let curves = sheet.quantum_efficiency_percent.curves();
    match curves.as_slice() {
        [(channel, points)] => QuantumEfficiency::Same(value(channel, points)),
        many => QuantumEfficiency::Named(
            many.iter().map(|(channel, points)| ((*channel).into(), value(channel, points))).collect(),
        ),
    }
}

fn table_name(stem: &str, channel: &str) -> String {
    format!("{stem}-{channel}.csv")
}

/// The curves with several points.
pub(super) fn tables(sheet: &DataSheet, stem: &str) -> Vec<(String, String)> {
    let curves = sheet.quantum_efficiency_percent.curves();
    let table = |(channel, points): &(&str, &CurvePoints)| {
        let row = |p: &etendue_scene::Placed<[f64; 2]>| format!("{},{}\n", p.value[0], fraction(p.value[1]));
        let rows: String = points.iter().map(row).collect();
        (table_name(stem, channel), format!("wavelength_nm,quantum_efficiency\n{rows}"))
    };
    curves.iter().filter(|(_, points)| points.len() > 1).map(table).collect()
}
