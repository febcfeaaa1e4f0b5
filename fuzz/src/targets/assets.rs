//! Meshes, lamps, lenses, tables, trajectories.

use super::seeds::{repository, stored, write};
use super::target::{NUMBERS as PER_NUMBER, RECORDS, SCANNED, TREE, Target, result_text};
use etendue_io::lens_table::{read_lens_table, read_point_spread};
use etendue_io::mesh::{read_mesh, read_mesh_frame};
use etendue_io::photometry::read_photometry;
use etendue_io::prescription::read_prescription;
use etendue_io::ray_transfer::read_ray_transfer;
use etendue_io::spectrum::read_spectrum;
use etendue_io::table::{read_complex_index, read_numbers, read_retro_table};
use etendue_io::trajectory::read_trajectory;
use etendue_scene::asset::LensQuantity;
use std::path::Path;

const CONSTANT: u64 = 16 << 20;

/// A reader of text.
pub(super) const fn text_target(
    name: &'static str,
    file: &'static str,
    prepare: fn(&Path) -> Vec<Vec<u8>>,
    read: fn(&Path) -> String,
    words: &'static [&'static str],
) -> Target {
    Target { name, file, prepare, read, words, is_text: true, times: PER_NUMBER, constant_bytes: CONSTANT }
}

const MESH_WORDS: &[&str] = &[
    "v",
    "vt",
    "vn",
    "f",
    "o",
    "g",
    "s",
    "l",
    "p",
    "usemtl",
    "mtllib a.mtl",
    "1//1",
    "-1/-1/-1",
    "1/1/1",
    "2147483648/1",
    "f 1 2 3",
    "v 1e38 -1e38 1e38",
    "f -1 -2 -3",
    "\\\n",
];

fn tower(folder: &Path) {
    let [obj, mtl] = repository(["crates/cli/tests/jobs/small/tower.obj", "crates/cli/tests/jobs/small/tower.mtl"])
        .try_into()
        .expect("two files");
    write(folder, "tower.obj", obj);
    write(folder, "tower.mtl", mtl);
}

fn meshes(folder: &Path) -> Vec<Vec<u8>> {
    tower(folder);
    let mut seeds = repository([
        "crates/cli/tests/jobs/small/tower.obj",
        "scenes/street/meshes/earth.obj",
        "scenes/street/meshes/post.obj",
        "scenes/weather/spray.obj",
    ]);
    seeds.extend(stored("obj"));
    seeds
}

pub(super) const OBJ: Target = text_target("obj", "a.obj", meshes, |file| result_text(read_mesh(file)), MESH_WORDS);
const GLTF_WORDS: &[&str] = &[
    "\"meshes\"",
    "\"nodes\"",
    "\"children\":[0]",
    "\"skins\"",
    "\"joints\":[0]",
    "\"sparse\"",
    "\"byteStride\":4",
    "\"count\":4294967295",
    "\"byteOffset\":18446744073709551615",
    "\"mode\":5",
    "\"scale\":[1e38,1e38,1e38]",
    "\"uri\":\"data:;base64,AAAA\"",
    "\"extensionsRequired\":[\"KHR_x\"]",
    "KHR_texture_transform",
    "KHR_materials_transmission",
    "KHR_materials_volume",
];

/// A few bytes of JSON may name an object of some hundred bytes.
const GLTF_TREE: u64 = 320;

pub(super) const GLB: Target = Target {
    is_text: false,
    times: GLTF_TREE,
    ..text_target(
        "glb",
        "a.glb",
        |_| repository(["tests/oracles/figures/gltf/scene.glb"]),
        |file| result_text(read_mesh(file)),
        GLTF_WORDS,
    )
};
pub(super) const GLTF: Target = Target {
    times: GLTF_TREE,
    ..text_target("gltf", "a.gltf", |_| stored("gltf"), |file| result_text(read_mesh(file)), GLTF_WORDS)
};
const PLY_WORDS: &[&str] = &[
    "format binary_big_endian 1.0",
    "format binary_little_endian 1.0",
    "format ascii 1.0",
    "element tristrips 1",
    "element face 4294967295",
    "property list uchar uchar vertex_indices",
    "property list char double texcoord",
    "property list uint uint vertex_index",
    "property uchar x",
    "property double texture_u",
    "property short nx",
    "end_header",
    "4294967296",
    "-1",
    "1e39",
];
pub(super) const PLY: Target = Target {
    is_text: false,
    ..text_target(
        "ply",
        "a.ply",
        |_| {
            let mut seeds = repository(["tests/oracles/figures/ply/little.ply", "tests/oracles/figures/ply/text.ply"]);
            seeds.extend(stored("ply"));
            seeds
        },
        |file| result_text(read_mesh(file)),
        PLY_WORDS,
    )
};
pub(super) const MESH_FRAME: Target =
    text_target("mesh-frame", "a.obj", meshes, |file| result_text(read_mesh_frame(file)), MESH_WORDS);
pub(super) const MTL: Target = Target {
    times: RECORDS,
    ..text_target(
        "mtl",
        "tower.mtl",
        |folder| {
            tower(folder);
            let mut seeds = repository(["crates/cli/tests/jobs/small/tower.mtl"]);
            seeds.extend(stored("mtl"));
            seeds
        },
        |file| result_text(read_mesh(&file.with_file_name("tower.obj"))),
        &[
            "newmtl",
            "Kd",
            "Ks",
            "Ke",
            "Ns",
            "Ni",
            "d",
            "Tr",
            "illum",
            "map_Kd",
            "map_Ks",
            "bump",
            "-o",
            "-s",
            "-clamp on",
            "-bm",
            "Kd spectral",
        ],
    )
};

const LAMP_WORDS: &[&str] = &[
    "TILT=NONE",
    "TILT=INCLUDE",
    "TILT=a.ies",
    "IESNA:LM-63-2002",
    "IESNA91",
    "[MORE]",
    "[_X]",
    "36001",
    "360",
    "90",
    "-90",
    "180",
    "1e9",
];

pub(super) const IES: Target = Target {
    times: RECORDS,
    ..text_target(
        "ies",
        "a.ies",
        |_| {
            let mut seeds =
                repository(["tests/oracles/figures/lamps/round.ies", "tests/oracles/figures/lamps/quadrants.ies"]);
            seeds.extend(stored("ies"));
            seeds
        },
        |file| result_text(read_photometry(file)),
        LAMP_WORDS,
    )
};
pub(super) const LDT: Target = Target {
    times: RECORDS,
    ..text_target(
        "ldt",
        "a.ldt",
        |_| repository(["tests/oracles/figures/lamps/round.ldt", "tests/oracles/figures/lamps/quadrants.ldt"]),
        |file| result_text(read_photometry(file)),
        LAMP_WORDS,
    )
};

pub(super) const ZMX: Target = Target {
    times: RECORDS,
    ..text_target(
        "zmx",
        "a.zmx",
        |_| {
            let mut seeds = stored("zmx");
            let wide: Vec<u8> = core::iter::once(0xfeff)
                .chain(String::from_utf8_lossy(&seeds[0]).encode_utf16())
                .flat_map(u16::to_le_bytes)
                .collect();
            seeds.push(wide);
            seeds
        },
        |file| result_text(read_prescription(file)),
        &[
            "SURF",
            "STOP",
            "TYPE EVENASPH",
            "TYPE COORDBRK",
            "GLAS MIRROR",
            "DISZ INFINITY",
            "PARM 8",
            "CONI",
            "CLAP",
            "UNIT IN",
            "FNUM 2 0",
            "WAVM 1 0.55 1",
        ],
    )
};
pub(super) const SEQ: Target = Target {
    times: RECORDS,
    ..text_target(
        "seq",
        "a.seq",
        |_| stored("seq"),
        |file| result_text(read_prescription(file)),
        &[
            "S", "SO", "SI", "STO", "ASP", "K", "A", "PRV", "PWL", "END", "CIR", "&", ";", "REFL", "GO", "RDM", "CUY",
            "THI", "FNO", "NAO",
        ],
    )
};

pub(super) const FIELD_TABLE: Target = Target {
    times: RECORDS,
    ..text_target(
        "field-table",
        "a.txt",
        |_| stored("field-table"),
        |file| {
            let quantities = [LensQuantity::RelativeIllumination, LensQuantity::Distortion, LensQuantity::Modulation];
            let tables = quantities.map(|quantity| result_text(read_lens_table(file, quantity)));
            [tables.join("; "), result_text(read_point_spread(file))].join("; ")
        },
        &[
            "Relative Illumination",
            "Rel. Ill.",
            "Field values are in millimeters",
            "Field units are degrees",
            "object height",
            "Wavelength: 1e9",
            "-0.0 1",
            "1e308 1e-308",
            "0 0",
            "%",
            "F-Theta distortion",
            "Distortion focal length = 1e-300",
            "MTF, cycles per mm",
            "Huygens PSF",
            "FFT PSF",
            "0.5500 µm at 0.0000, 14.0000 (deg).",
            "Data spacing is 0.250 µm.",
            "Center point is: row 2, column 2",
            "Image grid size: 2 by 2",
            "diffraction limit",
        ],
    )
};
pub(super) const RAY_TRANSFER: Target = Target {
    times: SCANNED,
    ..text_target(
        "ray-transfer",
        "a.json",
        |_| repository(["scenes/lenses/dgauss28deg-zemax-poly6-raytransfer.json"]),
        |file| result_text(read_ray_transfer(file)),
        &[
            "\"planeoffset\": 0.1",
            "\"raypass\"",
            "\"circles\"",
            "\"radii\": [1]",
            "\"sensitivities\": [0]",
            "\"circleRadii\": 1",
            "\"termu\": []",
            "\"coeff\": [1e999]",
            "\"useDZpolynomial\": true",
            "\"polynomials\": {}",
            "[0,0]",
        ],
    )
};

fn tables(_: &Path) -> Vec<Vec<u8>> {
    let mut seeds = repository([
        "crates/spectra/data/nk_cr.csv",
        "scenes/cornell/light.csv",
        "scenes/processing/defects.csv",
        "scenes/processing/oecf.csv",
    ]);
    seeds.push(b"observation_deg \\ entrance_deg, 5, 30, 40\n0.2, 250, 150, 110\n0.33, 180, 100, 95\n".to_vec());
    seeds
}

const TABLE_WORDS: &[&str] = &[",", ";", "\t", "wavelength_nm,value", "#", "300", "1100", "-0.0"];

pub(super) const SPECTRUM: Target = text_target(
    "spectrum",
    "a.csv",
    tables,
    |file| result_text(read_spectrum(file)) + &result_text(etendue_io::inspect::inspect(file)),
    TABLE_WORDS,
);
pub(super) const COMPLEX_INDEX: Target =
    text_target("complex-index", "a.csv", tables, |file| result_text(read_complex_index(file)), TABLE_WORDS);
pub(super) const RETRO_TABLE: Target =
    text_target("retro-table", "a.csv", tables, |file| result_text(read_retro_table(file)), TABLE_WORDS);
pub(super) const NUMBERS: Target =
    text_target("numbers", "a.csv", tables, |file| result_text(read_numbers(file)), TABLE_WORDS);

const TRAJECTORY_WORDS: &[&str] = &[
    "time_s",
    "x_m",
    "y_m",
    "z_m",
    "qw",
    "qx",
    "qy",
    "qz",
    "yaw_deg",
    "pitch_deg",
    "roll_deg",
    ",",
    "[",
    "{",
    "}",
    "]",
];

pub(super) const TRAJECTORY_CSV: Target = text_target(
    "trajectory-csv",
    "a.csv",
    |_| {
        let mut seeds = repository(["scenes/drive/ego.csv"]);
        seeds[0].truncate(600);
        seeds.push(b"# a drive\nspeed_m_s, z_m, time_s, y_m, x_m, roll_deg, pitch_deg, yaw_deg, note\n3.5, 0.5, 10.25, -2, 1, 0, 0, 90, start\n3.6, 0.5, 11, -2, 4.5, 0, 0, 0, # no\n".to_vec());
        seeds.push(b"time_s x_m y_m z_m qx qy qz qw\n10.25 1 -2 0.5 0 0 0.7071067811865475 0.7071067811865475\n11 4.5 -2 0.5 0 0 0 1\n".to_vec());
        seeds
    },
    |file| result_text(read_trajectory(file)),
    TRAJECTORY_WORDS,
);
pub(super) const TRAJECTORY_JSON: Target = Target {
    times: TREE,
    ..text_target(
        "trajectory-json",
        "a.json",
        |_| {
            vec![b"[{\"time_s\": 10.25, \"x_m\": 1, \"y_m\": -2.0, \"z_m\": 0.5, \"speed_m_s\": {\"a\": 1},\n\"note\": \"}[\\\"{\",\n\"qw\": 0.7, \"qx\": 0, \"qy\": 0, \"qz\": 0.7},\n{\"time_s\": 11, \"x_m\": 4.5, \"y_m\": -2, \"z_m\": 0.5, \"qw\": 1, \"qx\": 0, \"qy\": 0, \"qz\": 0}]".to_vec()]
        },
        |file| result_text(read_trajectory(file)),
        TRAJECTORY_WORDS,
    )
};
