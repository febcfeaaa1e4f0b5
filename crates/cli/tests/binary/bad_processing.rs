//! Errors of `[isp]`: each is reported with file, line and key, and nothing is written.

use crate::bad_input::ModifiedJob;
use crate::support::{CommandOutput, etendue};

const WHITE_BALANCE: &str = "white_balance = \"D65\"";
const MATRIX: &str = "colour_matrix = { fit = \"D65\" }";

/// The small job with `keys` instead of its white balance.
fn with(keys: &str) -> (ModifiedJob, String) {
    let job = ModifiedJob::new();
    let place = job.replace_first("small.toml", WHITE_BALANCE, keys);
    (job, place)
}

fn plan(job: &ModifiedJob) -> CommandOutput {
    etendue(["plan".to_owned(), job.job()])
}

/// Asserts that the job with this key in its processing is refused at the line of the key, with these phrases.
#[track_caller]
fn refused(keys: &str, phrases: &[&str]) {
    let (job, place) = with(keys);
    let key = keys.split(" =").next().unwrap_or(keys);
    plan(&job).refused(&[&[place.as_str(), "cameras.front.isp", key], phrases].concat());
}

/// The same with a table next to the job.
#[track_caller]
fn table_refused(keys: &str, table: &str, phrases: &[&str]) {
    let (job, place) = with(keys);
    job.write("table.csv", table);
    plan(&job).refused(&[&[place.as_str()], phrases].concat());
}

/// Asserts that a monochrome sensor with this processing is refused.
#[track_caller]
fn mono_refused(keys: &str, phrases: &[&str]) {
    let (job, _) = with(keys);
    job.replace_first("small.toml", &format!("{MATRIX}\n"), "\n");
    job.replace_first("small.toml", "cfa = \"rggb\"", "cfa = \"mono\"");
    job.replace_first("small.toml", "{ camera = \"nikon-d5100\", peak = 0.5 }", "0.5");
    plan(&job).refused(&[&["small.toml:"], phrases].concat());
}

#[test]
fn black_levels_that_cannot_be() {
    refused("black_level = 4095", &["4095", "4024", "below"]);
    refused("black_level = -1", &["-1"]);
    refused("black_level = \"dark\"", &["optical_black"]);
    refused("black_level = \"optical_black\"", &["no optical-black rows"]);
}

#[test]
fn a_black_level_above_white_at_the_smallest_gain() {
    let (job, _) = with("black_level = 3000");
    plan(&job).ok();
    let control = "exposure_s = 1e-6\nauto_exposure = { percentile = 50, target = 0.5, exposure_limits_s = [1e-7, 1e-3], gain_limits = [0.5, 2] }";
    job.replace_first("small.toml", "exposure_s = 1e-6", control);
    plan(&job).refused(&["cameras.front.isp.black_level", "3000", "saturates at"]);
}

#[test]
fn a_dng_of_companded_numbers() {
    let (job, _) = with(WHITE_BALANCE);
    let companding = "exposure_s = 1e-6\ncompanding = { bits = 8, knees = [[100, 100], [4095, 255]] }";
    job.replace_first("small.toml", "exposure_s = 1e-6", companding);
    plan(&job).ok();
    etendue(["plan", &job.job(), "--set", "output.raw_format=\"dng\""]).refused(&["raw_format", "companded"]);
}

#[test]
fn corrections_that_cannot_be() {
    refused("defect_outlier_threshold = 0", &["above 0"]);
    table_refused("defect_map = \"table.csv\"", "x,y\n3,4\n46,4\n", &["defect_map", "outside the image of 46 × 30"]);
    table_refused("defect_map = \"table.csv\"", "x,y\n3,4.5\n", &["defect_map", "whole numbers"]);
    table_refused("defect_map = \"table.csv\"", "x,y,z\n3,4,5\n", &["defect_map", "3 columns", "expected 2"]);
    refused("shading = { radial_gains = [1, 0.9] }", &["0.9", "1"]);
    refused("shading = { radial_gains = [1] }", &["radial_gains"]);
    table_refused("shading = { grid = \"table.csv\" }", "1,1\n1,0.5\n", &["shading", "0.5", "at least 1"]);
    table_refused("shading = { grid = \"table.csv\" }", "1,1,2\n", &["shading", "two by two"]);
    table_refused("shading = { grid = \"table.csv\", centre_px = [1, 2] }", "1,1\n1,1\n", &["centre_px", "no effect"]);
    refused("defect_map = \"none.csv\"", &["none.csv"]);
}

#[test]
fn the_defect_map_is_that_of_the_delivered_picture() {
    let (job, _) = with("defect_map = \"table.csv\"");
    job.write("table.csv", "x,y\n22,14\n");
    job.replace_first("small.toml", "bits = 12", "bits = 12\nbinning = { columns = 1, rows = 3, of = \"numbers\" }");
    plan(&job).refused(&["small.toml:", "defect_map", "46 × 10"]);
    job.write("table.csv", "x,y\n22,9\n");
    plan(&job).ok();
}

#[test]
fn colours_that_cannot_be() {
    refused("white_balance = [0.5, 1, 2]", &["below 1", "divide"]);
    refused("white_balance = [1, 2]", &["2 numbers", "3 channels"]);
    refused("white_balance = \"moonlight\"", &["moonlight", "grey_world"]);
    refused("demosaic = \"best\"", &["best", "hamilton_adams"]);
    let (job, _) = with(WHITE_BALANCE);
    let place = job.replace_first("small.toml", MATRIX, "colour_matrix = [[1, 0], [0, 1], [1, 0]]");
    plan(&job).refused(&[&place, "colour_matrix", "2 numbers", "3 channels"]);
}

#[test]
fn colours_of_a_monochrome_sensor() {
    mono_refused("demosaic = \"malvar\"", &["demosaic", "monochrome", "remove it"]);
    mono_refused(WHITE_BALANCE, &["white_balance", "no effect", "monochrome"]);
}

#[test]
fn other_filter_arrays_than_bayer() {
    let rccb = |keys: &str, matrix: &str| {
        let (job, place) = with(keys);
        job.replace_first("small.toml", MATRIX, matrix);
        job.replace_first("small.toml", "cfa = \"rggb\"", "cfa = \"rccb\"");
        let quantum_efficiency = "{ channels = { red = 0.3, clear = 0.6, blue = 0.25 } }";
        job.replace_first("small.toml", "{ camera = \"nikon-d5100\", peak = 0.5 }", quantum_efficiency);
        (plan(&job), place)
    };
    let (refused, place) = rccb("demosaic = \"malvar\"", "colour_matrix = [[1, 0, 0], [-1, 2, -1], [0, 0, 1]]");
    refused.refused(&[&place, "demosaic", "Bayer", "bilinear"]);
    rccb("white_balance = \"D65\"", "").0.refused(&["small.toml:", "not red, green and blue", "colour_matrix"]);
    rccb("white_balance = \"D65\"", MATRIX).0.refused(&["small.toml:", "colour_matrix", "respond equally"]);
    let own = rccb("white_balance = \"D65\"", "colour_matrix = [[1, 0, 0], [-1, 0, 2], [0, 1, 0]]").0.ok();
    assert!(own.out.contains("colour matrix"), "{}", own.out);
}

#[test]
fn detail_that_cannot_be() {
    refused("noise_reduction = { bilateral_px = 2 }", &["range"]);
    refused("noise_reduction = { median_px = 4 }", &["3"]);
    refused("noise_reduction = { median_px = 1, range = 0.1 }", &["range", "no effect"]);
    refused("sharpening = { amount = 0, radius_px = 1 }", &["amount", "above 0"]);
    refused("sharpening = { amount = 1 }", &["radius_px"]);
    refused("exposure_gain = 0", &["above 0"]);
}

#[test]
fn tone_curves_that_cannot_be() {
    refused("tone_curve = { gamma = 0 }", &["gamma", "above 0"]);
    refused("tone_curve = { contrast = 1.5, midpoint = 1 }", &["midpoint"]);
    refused("tone_curve = { gamma = 2, midpoint = 0.4 }", &["midpoint", "no effect"]);
    let (table, oecf) = ("tone_curve = { table = \"table.csv\" }", "tone_curve = { oecf = \"table.csv\" }");
    table_refused(table, "0,0\n0.6,0.5\n0.5,0.7\n1,1\n", &["tone_curve", "point 3", "must increase"]);
    table_refused(table, "0,0\n0.5,0.7\n1,0.6\n", &["tone_curve", "point 3", "must not decrease"]);
    table_refused(table, "0.1,0\n1,1\n", &["tone_curve", "from input 0 to input 1"]);
    table_refused(table, "0,0,0\n1,1,1\n", &["tone_curve", "3 columns"]);
    table_refused(oecf, "1,10\n2,300\n", &["tone_curve", "largest level"]);
    table_refused(oecf, "0,10\n2,200\n", &["tone_curve", "above 0"]);
}

#[test]
fn pictures_that_cannot_be_written() {
    refused("picture_bits = 9", &["8", "16"]);
    refused("picture_bits = 24", &["8", "16"]);
    refused("picture_format = \"tiff\"", &["png", "jpeg"]);
    refused("picture_bits = 16\npicture_format = \"jpeg\"", &["JPEG", "16 bits", "png"]);
    refused("jpeg_quality = 90", &["no effect", "jpeg"]);
    refused("jpeg_quality = 0\npicture_format = \"jpeg\"", &["1"]);
}

#[test]
fn filters_of_the_paper_that_cannot_be() {
    let filter = |keys: &str, phrases: &[&str]| refused(&format!("image_filters = [{{ type = {keys} }}]"), phrases);
    let drops = "\"drops\", count = 9, scale = 3, blur_px = 2";
    filter(&format!("{drops}, min_radius_px = 5, max_radius_px = 4"), &["min_radius_px", "above max_radius_px = 4"]);
    filter(
        &format!("{drops}, min_radius_px = 4, max_radius_px = 4, flow_px_per_frame = 1"),
        &["no effect", "fade_frames"],
    );
    filter(&drops.replace("count = 9", "count = 0"), &["count"]);
    let blurred = drops.replace("blur_px = 2", "blur_px = 200, min_radius_px = 4, max_radius_px = 4");
    filter(&blurred, &["blur_px", "600 px in the image"]);
    filter("\"pulse_noise\", amplitude_dn = 10, probability = 0.51", &["probability", "0.5"]);
    filter("\"pulse_noise\", amplitude_dn = 256, probability = 0.1", &["amplitude_dn", "255"]);
    filter("\"gaussian_noise\", sigma_dn = -1", &["sigma_dn"]);
    filter("\"uniform_noise\", range = 2.5", &["range", "2"]);
    filter("\"tone_map\", original_factor = 1.1", &["original_factor", "1"]);
    filter("\"tone_map\", original_factor = 0.4, gain = 0", &["gain", "above 0"]);
    filter("\"colour\", operations = []", &["operations"]);
    filter("\"colour\", operations = [{ to = \"rgb_ntsc\" }]", &["RGB NTSC", "linear light", "on"]);
    filter("\"colour\", on = \"linear\", operations = [{ from = \"yuv\" }]", &["YUV", "encoded images"]);
    filter("\"colour\", operations = [{ to = \"cmyk\" }]", &["cmyk", "cmy"]);
    filter("\"colour\", operations = [{ saturation = -1 }]", &["saturation"]);
    filter(
        "\"glow\", percentile = 0.9, target = 1, threshold = 1, radius_px = 1, strength = 1",
        &["percentile", "give 90"],
    );
    filter("\"glow\", percentile = 0, target = 1, threshold = 1, radius_px = 1, strength = 1", &["percentile"]);
    filter("\"sepia\"", &["sepia", "glow"]);
    let late = "\"uniform_noise\", range = 1 }, { type = \"tone_map\", original_factor = 0";
    filter(late, &["filter 2", "linear light", "first"]);
}

#[test]
fn a_picture_wider_than_a_jpeg() {
    let wide = "--set=cameras.front.sensor.width_px=65536";
    let small = ModifiedJob::new();
    let plan = etendue(["plan", &small.job(), wide, "--set=cameras.front.isp.picture_format=jpeg"]);
    plan.refused(&["cameras.front.isp.picture_format", "65535", "png"]);
}
