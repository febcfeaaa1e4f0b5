//! A camera in code: one scene seen by cameras of increasing pixel size, without camera files.
//!
//! `cargo run --release -p etendue --example own_camera`

// A program prints; the library does not.
#![allow(clippy::print_stdout)]

use etendue::{Error, JobRequest, MemoryFiles, NullObserver, RenderOptions};

/// Mean electrons of the central pixel for each pixel pitch in µm: they increase with its area.
pub(crate) fn run(pitches_um: &[f64]) -> Result<Vec<f64>, Error> {
    let furnace = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/furnace/furnace.toml");
    let scene = std::fs::read_to_string(furnace).map_err(Error::input)?;
    // The scene of the furnace, without its own camera.
    let scene: String = scene.split("[[cameras]]").take(1).collect();
    pitches_um.iter().map(|pitch_um| middle_electrons(&scene, *pitch_um)).collect()
}

fn middle_electrons(scene: &str, pitch_um: f64) -> Result<f64, Error> {
    let camera = format!(
        "format = 1\n\
         [lens]\ntype = \"thin\"\nfocal_length_mm = 8\nf_number = 4\nfocus_distance_m = 3\n\
         [sensor]\nwidth_px = 17\nheight_px = 17\npixel_pitch_um = {pitch_um}\ncfa = \"mono\"\n\
         exposure_s = 0.001\nquantum_efficiency = 0.5\nfull_well_e = 1e6\nread_noise_e = 2\ndark_current_e_s = 0\n\
         gain_dn_per_e = 0.01\nblack_level_dn = 16\nbits = 14\n"
    );
    let mut files = MemoryFiles::new();
    files.add_text("camera.toml", camera);
    let camera =
        "\n[[cameras]]\nname = \"own\"\nfile = \"camera.toml\"\nposition_m = [-3, 0, 0]\nlook_at_m = [0, 0, 0]\n";
    files.add_text("job.toml", format!("{scene}{camera}"));
    let job = JobRequest { spp: Some(64), ..JobRequest::new("job.toml") }.open_in(&files)?;
    let results = job.render(&RenderOptions::default(), &NullObserver)?;
    let electrons = results.cameras()[0].electrons().expect("the camera has electronics");
    Ok(f64::from(electrons.samples()[17 * 8 + 8]))
}

fn main() -> Result<(), Error> {
    let pitches_um = [2.0, 4.0, 8.0];
    for (pitch_um, electrons) in pitches_um.iter().zip(run(&pitches_um)?) {
        println!("{pitch_um} µm: {electrons:.1} electrons");
    }
    Ok(())
}
