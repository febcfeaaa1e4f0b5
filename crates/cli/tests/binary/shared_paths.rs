//! Measurements of images whose pixels shared paths: the side-car states the size of blocks with correlated errors.

use crate::support::{etendue, text};
use etendue_core::Plane;
use etendue_core::quantity::DigitalNumber;
use etendue_io::png::encode_companded16;
use serde_json::Value;
use std::path::Path;

/// A number from 0 to 1 for each block.
fn scatter(x: usize, y: usize) -> f64 {
    let mixed = (x as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (y as u64 + 1).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    (mixed >> 11) as f64 / (1_u64 << 53) as f64
}

/// A dark left half and a bright right one, with errors that blocks of 4 × 4 pixels share.
fn picture(folder: &Path, correlated_block_px: u32) -> String {
    let number = |x: usize, y: usize| (if x < 48 { 2_000.0 } else { 20_000.0 }) + 400.0 * scatter(x / 4, y / 4);
    let samples = (0..96 * 48).map(|i| number(i % 96, i / 96) as u32).collect();
    let plane = Plane::<DigitalNumber>::from_samples(96, 48, samples).expect("a rectangle");
    let file = folder.join("picture.0000.png");
    std::fs::write(&file, encode_companded16(&plane).expect("a picture")).expect("written");
    let sidecar_text = format!(
        r#"{{"program": "etendue", "sampling": {{"correlated_block_px": {correlated_block_px}}}, "files": {{"picture.0000.png": {{"encoding": "linear"}}}}}}"#
    );
    std::fs::write(folder.join("camera.json"), sidecar_text).expect("written");
    text(&file)
}

const TRAP_OPTIONS: [&str; 4] = ["--trap", "2,2,12,12", "--white", "50,2,12,12"];

#[test]
fn means_over_patches_know_the_blocks_and_what_does_not_refuses() {
    let folder = tempfile::tempdir().expect("a folder");
    let flare = |correlated_block_px: u32| {
        let image = picture(folder.path(), correlated_block_px);
        let output = etendue(["measure", "flare", &image, "--json"].into_iter().chain(TRAP_OPTIONS)).ok();
        let report: Value = serde_json::from_str(&output.out).expect("JSON");
        let figure = &report["figures"]["mean_flare_percent"];
        (figure["value"].as_f64().expect("a value"), figure["standard_uncertainty"].as_f64().expect("one"))
    };
    let (shared, alone) = (flare(16), flare(1));
    // Nine blocks with a spread of 400/√12 each: ±38 of the 20 200 of the white.
    let truth = 100.0 * 38.0 / 20_200.0;
    assert!(shared.0 == alone.0 && shared.1 > truth && alone.1 < 0.9 * truth, "{shared:?} {alone:?} {truth}");
    let image = picture(folder.path(), 16);
    for verb in ["vignetting", "shading", "noise", "sfr"] {
        let output = etendue(["measure", verb, &image]);
        output.refused(&["picture.0000.png", "correlated in blocks", "path_reuse_px", "render without sharing"]);
    }
}

#[test]
fn textures_and_photon_transfer_refuse_shared_paths() {
    let folder = tempfile::tempdir().expect("a folder");
    let image = picture(folder.path(), 16);
    let phrases = ["picture.0000.png", "correlated in blocks", "path_reuse_px", "render without sharing"];
    let alone = tempfile::tempdir().expect("a folder");
    let independent = self::picture(alone.path(), 1);
    etendue(["measure", "texture", &image, &independent]).refused(&phrases);
    etendue(["measure", "texture", &independent, &image]).refused(&phrases);
    etendue(["measure", "texture", &independent, &independent, "--even", &image]).refused(&phrases);
    let level = |head: &str| format!("{head}\ni picture.0000.png\ni picture.0000.png\n");
    let descriptor = format!("v 4.0\nn 16 96 48\n{}{}", level("b 1000 10"), level("d 1000"));
    let file = folder.path().join("emva1288.txt");
    std::fs::write(&file, descriptor).expect("written");
    let file = text(&file);
    etendue(["measure", "ptc", &file]).refused(&phrases);
    let at = |celsius: u32| format!("{celsius}:{file}");
    etendue(["measure", "dark-current", &at(20), &at(30), &at(40)]).refused(&phrases);
}
