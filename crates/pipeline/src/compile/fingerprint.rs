//! Hash of a plan: of everything that determines its result. It excludes paths, comments, the number of threads, the size of tiles and the quality of trees.
//!
//! A plan is made from a description, the contents of the files that it names, the caller's choices, and a version of the program with its built-in data and
//! defaults. These are hashed. The description is hashed by the bytes of its records ([`Table::feed`]), so that no key that can be read is omitted. Built-in
//! data is represented by [`RESULTS_REVISION`], because the description contains only its names (a metal) or nothing (a default).
//!
//! The hash is stricter than the result. A default stated explicitly, an effect of zero strength, an unused material, mesh or texture, and the quality when
//! all of its keys are stated give another plan of the same image. To exclude these, this module would have to know a second time which settings have no
//! effect, and a mistake would give two images one hash.
//!
//! Samples in passes are the exception: a schedule or a time makes passes that no description states. The passes and the replicates are then hashed instead
//! of the keys that determine samples: equal passes have one hash whatever their origin.

use super::choices::Choices;
use crate::plan::CameraPasses;
use etendue_core::{Quality, Word as _};
use etendue_scene::asset::Assets;
use etendue_scene::record::Render;
use etendue_scene::record::samples::SampleKeys;
use etendue_scene::written::Table;
use etendue_scene::{CameraSetup, Description};
use sha2::{Digest, Sha256};

/// Increased whenever the same description gives other bits: with every update of golden images and every change of built-in data or of a default.
const RESULTS_REVISION: u32 = 10;

/// SHA-256 of everything that determines the plan's result, including the program's version and revision. Every file that the description uses is among the
/// assets.
pub(super) fn fingerprint(
    description: &Description,
    assets: &Assets,
    choices: &Choices,
    passes: &[CameraPasses],
) -> [u8; 32] {
    // The refinement of films is represented by their passes.
    let Choices { quality, refinement: _ } = choices;
    let in_passes = |place: usize| passes.get(place).is_some_and(|camera| camera.passes.is_some());
    let cameras: Vec<_> =
        description.cameras.iter().enumerate().map(|(i, setup)| camera(setup, in_passes(i))).collect();
    let table = Table::new()
        .with("version", env!("CARGO_PKG_VERSION"))
        .with("results_revision", RESULTS_REVISION)
        .with("quality", quality.unwrap_or(Quality::Standard).word())
        .with("scene", description.scene.to_table())
        .with("cameras", cameras);
    let table = match &description.sequence {
        Some(sequence) => table.with("sequence", sequence.to_table()),
        None => table,
    };
    let mut hash = Sha256::new();
    table.feed(&|path| assets.hashes(path), &mut |bytes| hash.update(bytes));
    hash.finalize().into()
}

/// The size of a tile and the trees do not change the result, nor do the keys that passes replace.
fn camera(setup: &CameraSetup, in_passes: bool) -> Table {
    let mut render = Render { tile_px: None, accelerator: None, ..setup.render.clone() };
    if in_passes {
        render.samples = SampleKeys::default();
    }
    CameraSetup { render, ..setup.clone() }.to_table()
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_scene::Overrides;
    use etendue_scene::asset::SpectrumAsset;
    use std::path::{Path, PathBuf};

    const JOB: &str = "format = 1\n[scene]\nmaterials = [{ name = \"m\", type = \"diffuse\", reflectance = { spectrum = \
                       \"paint.csv\" } }]\n[[cameras]]\nname = \"c\"\nposition_m = [0, 0, 1]\nlook_at_m = [1, 0, 1]\n\
                       lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 2 }\n\
                       sensor = { width_px = 8, height_px = 6, pixel_pitch_um = 6 }\n[render]\nspp = 4\n";

    /// Hash of a job in a folder with a paint file of this content.
    fn job_fingerprint(folder: &str, job: &str, sets: &[&str], paint: u8, quality: Option<Quality>) -> [u8; 32] {
        let read = |_: &Path| Ok(job.to_owned());
        let file = Path::new(folder).join("job.toml");
        let description = Description::load(&file, &read, &Overrides::new(sets.iter().copied()));
        let spectrum = SpectrumAsset { points: vec![(400.0, 0.5)], hash: [paint; 32] };
        let spectra = [(PathBuf::from(folder).join("paint.csv"), spectrum)].into();
        let assets = Assets { spectra, ..Assets::default() };
        fingerprint(
            &description.unwrap_or_else(|errors| panic!("{errors}")),
            &assets,
            &Choices { quality, ..Choices::default() },
            &[],
        )
    }

    #[test]
    fn one_plan_has_one_hash_however_and_wherever_it_is_written() {
        let plain = job_fingerprint("", JOB, &[], 1, None);
        let spaced = JOB.replace(" = ", "  =  ").replace("[render]", "# How.\n\n[render] # so");
        let turned = JOB.replace("spp = 4", "seed = 3\nspp = 4");
        let other = JOB.replace("spp = 4", "spp = 4\nseed = 3");
        assert_eq!(
            plain,
            job_fingerprint(
                "elsewhere",
                &spaced,
                &["render.spp=4", "render.tile_px=8", "render.accelerator=best"],
                1,
                Some(Quality::Standard)
            )
        );
        assert_eq!(job_fingerprint("", &turned, &[], 1, None), job_fingerprint("", &other, &[], 1, None));
        assert_ne!(plain, job_fingerprint("", &turned, &[], 1, None));
    }

    #[test]
    fn what_is_stated_chosen_or_read_changes_the_hash() {
        let plain = job_fingerprint("", JOB, &[], 1, None);
        for set in
            ["render.spp=8", "output.ghosts=false", "cameras.c.sensor.width_px=9", "cameras.c.position_m=[0, 0, 2]"]
        {
            assert_ne!(plain, job_fingerprint("", JOB, &[set], 1, None), "{set}");
        }
        assert_ne!(plain, job_fingerprint("", JOB, &[], 2, None), "another content of a file");
        assert_ne!(plain, job_fingerprint("", JOB, &[], 1, Some(Quality::Draft)), "another preset");
    }
}
