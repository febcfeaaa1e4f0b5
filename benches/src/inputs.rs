//! The largest inputs: what reading them takes, each in a process of its own.

use crate::child;
use crate::memory::peak_mb;
use etendue::JobRequest;
use etendue_bench_rays::clock::process_cpu_s;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::terrain;
use etendue_bench_rays::threads::pool;
use etendue_core::Plane;
use etendue_core::quantity::Display;
use etendue_io::Provenance;
use etendue_io::exr::{ExrLayer, layers_image};
use etendue_io::jpeg::encode_jpeg;
use etendue_io::mesh::read_mesh;
use etendue_io::photograph::Encoding;
use etendue_io::photometry::read_photometry;
use etendue_io::png::encode_display;
use etendue_io::trajectory::read_trajectory;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The argument that asks a child process for time and memory of reading a file.
pub const CHILD: &str = "--input";

const NOTE: &str = "Files that are made, read as the program reads them by a process with two threads, and removed. Processor time of all threads, and most memory \
    resident at any time (Linux), the program's own 5 MB included. Jobs are loaded and compiled, with their assets; nothing is rendered. Takes 1 GB of the folder \
    for temporary files.";

/// Columns and rows of pictures.
const SIDE: usize = 8192;

/// An input: what it is, the name of its file, how it is made and read.
struct Input {
    name: &'static str,
    file: &'static str,
    make: fn(&mut BufWriter<File>) -> io::Result<()>,
    read: fn(&Path),
}

const INPUTS: [Input; 10] = [
    Input { name: "OBJ, 10 million triangles", file: "hills.obj", make: hills, read: mesh },
    Input { name: "PNG, 8192 × 8192 px of 3 × 8 bits", file: "stripes.png", make: png, read: read_image },
    Input { name: "JPEG, 8192 × 8192 px", file: "stripes.jpg", make: jpeg, read: read_image },
    Input {
        name: "Radiance HDR, 8192 × 8192 px", file: "stripes.hdr", make: |file| hdr(file, SIDE), read: read_image
    },
    Input { name: "EXR, 8192 × 8192 px of 3 × 32 bits", file: "stripes.exr", make: exr, read: read_image },
    Input {
        name: "job under a sky of 8192 × 4096 px (HDR)",
        file: "sky.hdr",
        make: |file| hdr(file, SIDE / 2),
        read: sky,
    },
    Input { name: "job of 16 MB of TOML, 120 000 objects", file: "job.toml", make: objects, read: job },
    Input { name: "trajectory, 3 million rows of CSV", file: "path.csv", make: csv, read: trajectory },
    Input { name: "trajectory, 150 000 places of JSON", file: "path.json", make: json, read: trajectory },
    Input { name: "IES lamp, 3601 × 721 angles", file: "lamp.ies", make: ies, read: lamp },
];

/// Time and memory by the input.
pub fn table() -> Table {
    let folder = Folder(std::env::temp_dir().join(format!("etendue-inputs-{}", std::process::id())));
    std::fs::create_dir_all(&folder.0).expect("the folder of temporary files can be written to");
    let head = ["input", "file, MB", "processor, s", "memory, MB"];
    let mut table = Table::new("Large inputs", NOTE, &head);
    for (i, input) in INPUTS.iter().enumerate() {
        let path = folder.0.join(input.file);
        let created = File::create(&path).and_then(|file| {
            let mut file = BufWriter::new(file);
            (input.make)(&mut file)?;
            file.flush()
        });
        created.expect("the folder of temporary files can be written to");
        let bytes = path.metadata().map_or(0, |facts| facts.len());
        let path_text = path.to_str().expect("a folder of temporary files whose name is text");
        let mut row = child::row(input.name, &[CHILD, &i.to_string(), path_text]);
        row.insert(1, format!("{:.1}", bytes as f64 / 1e6));
        table.row(row);
        let _ = std::fs::remove_file(&path);
    }
    table
}

/// Reads a file as an input; processor time, s, and megabytes at most.
pub fn child(input: &str, path: &str) -> String {
    let input = &INPUTS[input.parse::<usize>().expect("the number of an input")];
    pool(2).install(|| (input.read)(Path::new(path)));
    format!("{:.2} {}", process_cpu_s(), peak_mb())
}

/// A folder that is removed at the end.
struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn mesh(file: &Path) {
    std::hint::black_box(read_mesh(file).expect("readable"));
}

fn read_image(file: &Path) {
    std::hint::black_box(etendue_io::picture::read_image(file).expect("readable"));
}

fn trajectory(file: &Path) {
    std::hint::black_box(read_trajectory(file).expect("readable"));
}

fn lamp(file: &Path) {
    std::hint::black_box(read_photometry(file).expect("readable"));
}

fn job(file: &Path) {
    std::hint::black_box(JobRequest::new(file).open().unwrap_or_else(|errors| panic!("{errors}")));
}

/// A job beside the sky's picture.
fn sky(file: &Path) {
    let path = file.with_extension("toml");
    let environment = "[scene.environment]\ntype = \"image\"\nfile = \"sky.hdr\"\nluminance_cd_m2_per_unit = 100\n";
    std::fs::write(&path, format!("{HEAD}{environment}")).expect("the folder of temporary files can be written to");
    job(&path);
}

const HEAD: &str = "format = 1\n[[cameras]]\nname = \"front\"\nposition_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\n\
    lens = { type = \"pinhole\", focal_length_mm = 6, f_number = 2 }\nsensor = { width_px = 64, height_px = 40, pixel_pitch_um = 12 }\n\
    [[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n";

fn hills(file: &mut BufWriter<File>) -> io::Result<()> {
    let (positions, triangles) = terrain::grid(10_000_000);
    positions.iter().try_for_each(|p| writeln!(file, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z))?;
    triangles.iter().try_for_each(|[a, b, c]| writeln!(file, "f {} {} {}", a + 1, b + 1, c + 1))
}

/// A value of stripes that pack neither well nor badly, from 16 to 215.
fn byte(x: usize, y: usize, channel: usize) -> u8 {
    (16 + (x * (3 + channel) + y * 6 + (x * y) / 64) % 200) as u8
}

fn stripes() -> Plane<Display> {
    let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    let samples = places.map(|(x, y)| [0, 1, 2].map(|c| f32::from(byte(x, y, c)) / 255.0)).collect();
    Plane::from_samples(SIDE, SIDE, samples).expect("as many as it takes")
}

fn png(file: &mut BufWriter<File>) -> io::Result<()> {
    file.write_all(&encode_display(&stripes(), &Encoding::Srgb).expect("encodable"))
}

fn jpeg(file: &mut BufWriter<File>) -> io::Result<()> {
    file.write_all(&encode_jpeg(&stripes(), 90).expect("encodable"))
}

fn exr(file: &mut BufWriter<File>) -> io::Result<()> {
    let places = || (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    let planes = [0, 1, 2].map(|c| places().map(|(x, y)| f32::from(byte(x, y, c))).collect::<Vec<f32>>());
    let layers = ["R", "G", "B"].iter().zip(&planes).map(|(name, plane)| ((*name).to_owned(), ExrLayer::Float(plane)));
    let layers: Vec<_> = layers.collect();
    layers_image(SIDE, SIDE, &layers, &Provenance::default()).write_to(file).map_err(io::Error::other)
}

/// Without run lengths: four bytes a pixel.
fn hdr(file: &mut BufWriter<File>, rows: usize) -> io::Result<()> {
    write!(file, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X {SIDE}\n")?;
    let mut places = (0..rows).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    places.try_for_each(|(x, y)| file.write_all(&[byte(x, y, 0), byte(x, y, 1), byte(x, y, 2), 136]))
}

fn objects(file: &mut BufWriter<File>) -> io::Result<()> {
    file.write_all(HEAD.as_bytes())?;
    writeln!(file, "[scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 100\nilluminant = \"D65\"")?;
    (0..120_000).try_for_each(|i| {
        writeln!(
            file,
            "[[scene.objects]]\nname = \"ball {i}\"\nmaterial = \"grey\"\nshape = {{ type = \"sphere\", radius_m = 0.1 }}\nposition_m = [{}, {}, 3.5]",
            i % 400,
            i / 400
        )
    })
}

fn csv(file: &mut BufWriter<File>) -> io::Result<()> {
    writeln!(file, "time_s,x_m,y_m,z_m,qw,qx,qy,qz")?;
    (0..3_000_000)
        .try_for_each(|i| writeln!(file, "{:.3},{:.3},0.25,1.5,1,0,0,0", f64::from(i) * 1e-3, f64::from(i) * 0.01))
}

fn json(file: &mut BufWriter<File>) -> io::Result<()> {
    write!(file, "[")?;
    for i in 0..150_000 {
        let comma = if i == 0 { "" } else { ",\n" };
        let (time_s, x_m) = (f64::from(i) * 1e-3, f64::from(i) * 0.01);
        write!(
            file,
            "{comma}{{\"time_s\": {time_s:.3}, \"x_m\": {x_m:.3}, \"y_m\": 0.25, \"z_m\": 1.5, \"yaw_deg\": 10, \"pitch_deg\": 0, \"roll_deg\": 0}}"
        )?;
    }
    writeln!(file, "]")
}

fn ies(file: &mut BufWriter<File>) -> io::Result<()> {
    let (down, around) = (3601, 721);
    write!(file, "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {down} {around} 1 2 0 0 0\n1 1 42\n")?;
    (0..down).try_for_each(|i| writeln!(file, "{}", f64::from(i) / 20.0))?;
    (0..around).try_for_each(|i| writeln!(file, "{}", f64::from(i) / 2.0))?;
    (0..around).try_for_each(|_| (0..down).try_for_each(|i| writeln!(file, "{}", 1000 - i / 4)))
}
