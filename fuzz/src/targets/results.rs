//! Files of this program and of measurements: side-cars, descriptors, lists of points, truths, films of shards.

use super::seeds::{repository, stored, write};
use super::target::{RECORDS, TREE, Target, result_text};
use etendue::measure::{DistortionRequest, SfrRequest, distortion, sfr};
use etendue::{ExistingFiles, Job, NullObserver, RenderOptions, ShardRequest, ShardSpec, Simd, merge};
use etendue_io::emva_descriptor::read_emva_descriptor;
use etendue_io::inspect::inspect;
use etendue_io::photograph::read_photograph;
use std::fs;
use std::path::Path;

const CONSTANT: u64 = 16 << 20;

pub(super) const SIDE_CAR: Target = Target {
    name: "side-car",
    file: "camera.json",
    prepare: |folder| {
        let [image] = repository(["crates/cli/tests/jobs/small/checker.png"]).try_into().expect("one file");
        write(folder, "raw.0000.png", image);
        stored("side-car")
    },
    read: |file| {
        result_text(read_photograph(&file.with_file_name("raw.0000.png"))) + "; " + &result_text(inspect(file))
    },
    words: &[
        "{",
        "}",
        "[",
        "]",
        "null",
        "\"files\":",
        "\"raw.0000.png\":",
        "\"encoding\":",
        "\"gamma\":",
        "\"table\":[[0,0],[1,1]]",
        "\"cfa\":",
        "\"columns\":",
    ],
    is_text: true,
    times: TREE,
    constant_bytes: CONSTANT,
};

pub(super) const EMVA: Target = Target {
    name: "emva",
    file: "list.txt",
    prepare: |_| {
        vec![b"v 4.0\n# light\nn 12 64 48\nb 1000000,0 250.5\ni images\\a 1.png\ni images/b.png\nd 1000000.0\ni c.png\ni d.png\ni e.png\n".to_vec()]
    },
    read: |file| result_text(read_emva_descriptor(file)),
    words: &["v", "n", "b", "d", "i", "#"],
    is_text: true,
    times: RECORDS,
    constant_bytes: CONSTANT,
};

pub(super) const POINTS: Target = Target {
    name: "points",
    file: "points.csv",
    prepare: |_| {
        let mut list = "column,row,x_px,y_px,uncertainty_px\n".to_owned();
        for (column, row) in (0..9).flat_map(|i| (0..6).map(move |j| (i, j))) {
            list +=
                &format!("{column},{row},{},{},0.02\n", 20.5 + 30.0 * f64::from(column), 15.25 + 30.1 * f64::from(row));
        }
        vec![list.into_bytes()]
    },
    read: |file| {
        let mut request = DistortionRequest::new(file);
        request.chart.size_px = Some([320, 200]);
        result_text(distortion(&request))
    },
    words: &["column", "row", "x_px", "y_px", "uncertainty_px", "9999", "10000"],
    is_text: true,
    // Fits of up to a few thousand points.
    times: RECORDS,
    constant_bytes: 64 << 20,
};

pub(super) const TRUTH: Target = Target {
    name: "truth",
    file: "truth.json",
    prepare: |folder| {
        let [image] = repository(["crates/cli/tests/jobs/small/checker.png"]).try_into().expect("one file");
        write(folder, "edge.png", image);
        stored("truth")
    },
    read: |file| {
        let mut request = SfrRequest::new(file.with_file_name("edge.png"));
        request.input.truth.truth = Some(file.to_owned());
        result_text(sfr(&request))
    },
    words: &[
        "null",
        "[",
        "]",
        "{",
        "}",
        "\"features_px\":",
        "\"picture_px\":[8,8]",
        "\"kind\":\"edge\"",
        "\"chart\":\"slanted-edge\"",
    ],
    is_text: true,
    times: TREE,
    constant_bytes: 64 << 20,
};

/// A job whose film is a few pixels.
const JOB: &str = "format = 1\n[scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 30\nilluminant = \"D65\"\n[[cameras]]\nname = \"front\"\n\
    position_m = [0, 0, 1]\nrotation_deg = [0, 0, 0]\n[cameras.lens]\ntype = \"pinhole\"\nfocal_length_mm = 6\nf_number = 8\n[cameras.sensor]\nwidth_px = 5\n\
    height_px = 4\npixel_pitch_um = 100\n[render]\nspp = 2\nreplicates = 1\nband_width_nm = 100\nwavelength_range_nm = [400, 800]\n[output]\nradiance = true\n";

/// A shard of the job in the folder; gives its film and manifest.
fn shard(folder: &Path) -> [Vec<u8>; 2] {
    write(folder, "job.toml", JOB);
    let job = Job::open(folder.join("job.toml")).expect("the job is legal");
    let all_frames = ShardRequest::all_films(ShardSpec { index: 0, count: 1 }, 0..1);
    job.save_shard(&all_frames, RenderOptions::default().simd, folder, ExistingFiles::Replace, &NullObserver)
        .expect("a shard");
    ["front.film.exr", "shard.json"].map(|name| fs::read(folder.join(name)).expect("of the shard"))
}

fn merged(file: &Path) -> String {
    let folder = file.parent().expect("a folder");
    let out = folder.join("out");
    let text =
        result_text(merge(&[folder.to_owned()], None, Simd::Scalar, &out, ExistingFiles::Replace, &NullObserver));
    let _ = fs::remove_dir_all(&out);
    text
}

pub(super) const FILM: Target = Target {
    name: "film",
    file: "front.film.exr",
    prepare: |folder| {
        let [film, _] = shard(folder);
        vec![film]
    },
    read: merged,
    words: &["weight", "samples", "not_finite", "band.0000.mean", "band.0003.variance", "etendue:plan_hash"],
    is_text: false,
    times: 8,
    constant_bytes: 64 << 20,
};

pub(super) const MANIFEST: Target = Target {
    name: "manifest",
    file: "shard.json",
    prepare: |folder| {
        let [_, manifest] = shard(folder);
        vec![manifest]
    },
    read: merged,
    words: &[
        "null",
        "\"set\":[\"render.spp=2\"]",
        "\"frames\":{\"start\":0,\"end\":4294967295}",
        "\"count\":4294967295",
        "\"spp\":1",
        "\"time_s\":10",
    ],
    is_text: true,
    times: TREE,
    constant_bytes: 64 << 20,
};
