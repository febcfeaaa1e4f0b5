//! Invalid sensors: each is reported with file, line and key, and nothing is written.

use crate::bad_input::ModifiedJob;
use crate::support::etendue;

const EFFICIENCY: &str = "quantum_efficiency = { camera = \"nikon-d5100\", peak = 0.5 }";
const BITS: &str = "bits = 12";

/// Asserts that the job with `from` replaced by `to` is refused `below` lines further, with all of `phrases`.
#[track_caller]
fn refused_below(below: usize, from: &str, to: &str, phrases: &[&str]) {
    let job = ModifiedJob::new();
    let place = job.replace_first("small.toml", from, to);
    refused(&job, &place, below, phrases);
}

#[track_caller]
fn refused(job: &ModifiedJob, place: &str, below: usize, phrases: &[&str]) {
    let (file, line) = place.split_once(':').expect("a line");
    let line = format!("{file}:{}:", line.parse::<usize>().expect("a number") + below);
    let phrases: Vec<&str> = [line.as_str()].into_iter().chain(phrases.iter().copied()).collect();
    job.render(&[]).refused(&phrases);
}

#[test]
fn an_efficiency_below_nothing_or_above_all() {
    for (value, phrase) in [("-0.1", "-0.1"), ("1.5", "1.5"), ("[0.5, 1.2, 0.3]", "1.2")] {
        let to = format!("quantum_efficiency = {value}");
        refused_below(0, EFFICIENCY, &to, &["cameras.front.sensor.quantum_efficiency", phrase, "at most 1"]);
    }
    let to = EFFICIENCY.replace("0.5", "1.01");
    refused_below(0, EFFICIENCY, &to, &["cameras.front.sensor.quantum_efficiency.peak", "1.01"]);
}

#[test]
fn a_table_of_efficiencies_above_all() {
    for (table, phrase) in [("400,0.5\n550,1.4\n700,0.2\n", "1.4"), ("400,0.5\n550,-0.4\n700,0.2\n", "-0.4")] {
        let job = ModifiedJob::new();
        job.write("efficiency.csv", table);
        let place =
            job.replace_first("small.toml", EFFICIENCY, "quantum_efficiency = { spectrum = \"efficiency.csv\" }");
        refused(&job, &place, 0, &["cameras.front.sensor.quantum_efficiency", phrase, "550 nm", "from 0 to 1"]);
    }
}

#[test]
fn a_converter_without_gain() {
    // Without a gain it is unknown whether the ADC or the well saturates first: no value is assumed.
    let job = ModifiedJob::new();
    job.replace_first("small.toml", "full_well_e = 12_000", "full_well_e = 1_000");
    let table = job.replace_first("small.toml", "[cameras.sensor]", "[cameras.sensor]");
    job.replace_first("small.toml", "gain_dn_per_e = 0.33\n", "");
    refused(&job, &table, 0, &["cameras.front.sensor", "\"gain_dn_per_e\" is missing"]);
}

#[test]
fn a_tile_that_does_not_tile_the_sensor() {
    refused_below(
        5,
        "width_px = 46",
        "width_px = 45",
        &["cameras.front.sensor.cfa", "2 × 2", "45 × 30", "no multiple"],
    );
    let tile = "cfa = { columns = 3, channels = [\"red\", \"green\", \"blue\", \"green\"] }";
    refused_below(0, "cfa = \"rggb\"", tile, &["cameras.front.sensor", "3"]);
}

#[test]
fn captures_that_do_not_go_together() {
    let hdr = |bits: u32, more: &str| {
        format!(
            "{BITS}\n[cameras.sensor.hdr]\nmerged_bits = {bits}\ncaptures = [{{ exposure_ratio = 0.1 }}, {more}]\n#"
        )
    };
    let more = "{ exposure_ratio = 0.5 }";
    refused_below(3, BITS, &hdr(20, more), &["cameras.front.sensor.hdr", "entry 1 (from 0) is more sensitive"]);
    let more = "{ exposure_ratio = 0.1, dual_conversion_gain = true }";
    refused_below(
        3,
        BITS,
        &hdr(20, more),
        &["cameras.front.sensor.hdr", "entry 1 (from 0): the second readout of a charge"],
    );
    let more = "{ exposure_ratio = 0.1, read_noise_e = 1 }";
    refused_below(3, BITS, &hdr(20, more), &["cameras.front.sensor.hdr", "entry 1 (from 0) reaches no further"]);
    let more = "{ exposure_ratio = 0.01 }";
    refused_below(2, BITS, &hdr(13, more), &["cameras.front.sensor.hdr.merged_bits", "13 bits end at 8191"]);
}

#[test]
fn tables_that_say_nothing() {
    let with = |table: &str| format!("{BITS}\n{table}");
    refused_below(
        1,
        BITS,
        &with("optical_black = {}"),
        &["cameras.front.sensor.optical_black", "neither rows nor columns"],
    );
    let binning = "binning = { columns = 1, rows = 1, of = \"charge\" }";
    refused_below(1, BITS, &with(binning), &["cameras.front.sensor.binning", "1 × 1", "remove it"]);
    refused_below(1, BITS, &with("skipping = {}"), &["cameras.front.sensor.skipping", "1 × 1", "remove it"]);
}

#[test]
fn skipped_rows_that_cannot_be() {
    let with = |more: &str| format!("{BITS}\n{more}");
    refused_below(1, BITS, &with("skipping = { rows = 65 }"), &["cameras.front.sensor.skipping.rows", "found 65"]);
    // 30 rows of tiles of two.
    let left_over = ["cameras.front.sensor.skipping", "8 rows"];
    refused_below(1, BITS, &with("skipping = { rows = 4 }"), &left_over);
    let both = "skipping = { rows = 3 }\nbinning = { columns = 1, rows = 3, of = \"charge\" }";
    refused_below(1, BITS, &with(both), &["cameras.front.sensor.skipping", "not both", "\"binning\""]);
    let region = "skipping = { rows = 3 }\nroi_px = [0, 2, 46, 24]";
    refused_below(2, BITS, &with(region), &["cameras.front.sensor.roi_px", "6 rows"]);
}

#[test]
fn an_error_of_the_job_is_reported_once_for_all_cameras() {
    let output = etendue(["plan", "scenes/sensors/sensors.toml", "--spp", "7", "--set", "render.replicates=4"]);
    let output = output.refused(&["7 samples cannot be divided equally among 4 replicates"]);
    assert_eq!(output.err.matches("cannot be divided equally").count(), 1, "{output:?}");
}

#[test]
fn a_sensor_below_absolute_zero() {
    let dark = format!("{BITS}\ndark = {{ temperature_c = -273.16, reference_c = 20 }}");
    refused_below(1, BITS, &dark, &["cameras.front.sensor.dark.temperature_c", "-273.16", "above -273.15"]);
}

#[test]
fn a_converter_of_no_bits_or_too_many() {
    for bits in ["0", "33"] {
        let to = format!("bits = {bits}");
        refused_below(0, BITS, &to, &["cameras.front.sensor.bits", &format!("found {bits}"), "1 to 24"]);
    }
}
