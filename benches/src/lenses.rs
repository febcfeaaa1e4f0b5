//! Time of a ray through each kind of lens.

use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::{COUNT, RunStatistics};
use etendue_bench_rays::table::Table;
use etendue_core::quantity::Irradiance;
use etendue_core::{Bands, SpectralCube};
use etendue_optics::Lens;
use etendue_optics::ghosts::{GhostSettings, layer};
use etendue_pipeline::compile_camera;
use etendue_pipeline::plan::CameraBody;
use etendue_projection::Raster;
use etendue_scene::asset::Assets;
use etendue_scene::{Overrides, load_camera};
use glam::DVec2;
use std::path::Path;

const NOTE: &str = "One thread. Rays of pixels all over the picture, through points all over the pupil, from 400 to 700 nm; \
    \"open\" is the share that comes through.";

const RAYS: u32 = 200_000;

const LENSES: [(&str, &str); 12] = [
    ("pinhole", "type = \"pinhole\"\nfocal_length_mm = 50\nf_number = 4"),
    ("thin", "type = \"thin\"\nfocal_length_mm = 50\nf_number = 2\nfocus_distance_m = 5"),
    ("thick", "type = \"thick\"\nfocal_length_mm = 50\nf_number = 2\nfocus_distance_m = 5\nconstant_pupil = \"exit\""),
    ("parallel", "type = \"telecentric\"\nf_number = 4\nfield_width_m = 2"),
    (
        "equidistant",
        "type = \"calibrated\"\nf_number = 4\nprojection = { type = \"equidistant\", focal_length_mm = 20 }",
    ),
    (
        "OpenCV, five coefficients",
        "type = \"calibrated\"\nf_number = 4\nprojection = { type = \"opencv\", focal_length_mm = 50, \
         distortion = [-0.2, 0.05, 0.0005, -0.0005, 0] }",
    ),
    (
        "Kannala-Brandt",
        "type = \"calibrated\"\nf_number = 4\nprojection = { type = \"kannala_brandt\", focal_length_mm = 20, \
         k = [0.01, -0.002, 0.0003, 0] }",
    ),
    ("double Gauss, f/2.03", "type = \"prescription\"\npublished = \"double-gauss\"\nfocus_distance_m = 5"),
    (
        "pinhole behind a windscreen",
        "type = \"pinhole\"\nfocal_length_mm = 50\nf_number = 4\n[external_optics.windscreen]\ndistance_mm = 100\ntilt_deg = 60\n\
         radius_across_mm = 3000\nradius_upright_mm = 8000",
    ),
    (
        "pinhole behind a flat pane",
        "type = \"pinhole\"\nfocal_length_mm = 50\nf_number = 4\n[external_optics.windscreen]\ndistance_mm = 100\n\
         layers = [{ thickness_mm = 5, index = 1.52 }]\ndouble_image = false",
    ),
    (
        "pinhole at a hyperbolic mirror",
        "type = \"pinhole\"\nfocal_length_mm = 50\nf_number = 4\n[external_optics.mirror]\ntype = \"hyperboloid\"\nradius_mm = 30\n\
         conic = -1.69\nrim_radius_mm = 40\nreflectance = 0.9",
    ),
    ("telephoto, f/5.6", "type = \"prescription\"\npublished = \"telephoto\"\nfocus_distance_m = 5"),
];

/// Nanoseconds of a ray, for every kind of lens.
pub fn table() -> Table {
    let bodies = LENSES.map(|(_, keys)| body(keys));
    let mut times = LENSES.map(|_| RunStatistics::default());
    let mut open = LENSES.map(|_| 0);
    for _ in 0..COUNT {
        for ((body, times), open) in bodies.iter().zip(&mut times).zip(&mut open) {
            let (passed, seconds) = timed(|| rays(body));
            times.add(1e9 * seconds / f64::from(RAYS));
            *open = passed;
        }
    }
    let mut table = Table::new("Rays through lenses", NOTE, &["lens", "ns a ray", "open", "spread"]);
    for (((name, _), times), open) in LENSES.iter().zip(&times).zip(open) {
        let percent = 100.0 * f64::from(open) / f64::from(RAYS);
        let cells =
            [format!("{:.0}", times.median()), format!("{percent:.0} %"), format!("± {:.0} %", 100.0 * times.spread())];
        table.row([(*name).to_owned()].into_iter().chain(cells));
    }
    table
}

const GHOSTS_NOTE: &str = "A picture of 450 × 300 px in 8 bands with a lamp of 60 pixels, processor time of one thread: the \
    double Gauss's ghosts, by what its surfaces are.";

/// Milliseconds of a layer of ghosts.
pub fn ghosts() -> Table {
    let mut table = Table::new("Ghosts", GHOSTS_NOTE, &["surfaces", "ms a picture", "light of the picture", "spread"]);
    for (name, coating) in [("bare", "\"uncoated\""), ("a quarter wave", "{ quarter_wave_nm = 550 }")] {
        let lens = "type = \"prescription\"\npublished = \"double-gauss\"\nfocus_distance_m = \"infinity\"";
        let body = body(&format!("{lens}\ncoating = {coating}"));
        let (mut times, mut ratio) = (RunStatistics::default(), 0.0);
        for _ in 0..COUNT {
            let (light, seconds) = alone(|| timed(|| light_of_ghosts(&body)));
            times.add(1e3 * seconds);
            ratio = light;
        }
        let cells =
            [format!("{:.0}", times.median()), format!("{ratio:.1e}"), format!("± {:.0} %", 100.0 * times.spread())];
        table.row([name.to_owned()].into_iter().chain(cells));
    }
    table
}

/// `work` on one thread alone.
fn alone<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("one thread").install(work)
}

/// Light of the ghosts of a lamp before a dim ground, over that of the picture.
fn light_of_ghosts(body: &CameraBody) -> f64 {
    let Lens::Prescription(lens) = &body.lens else { panic!("a lens of surfaces") };
    let raster = Raster::centred(450, 300, 0.08).expect("a raster");
    let bands = Bands::new(400.0, 40.0, 8).expect("bands");
    let mut image = SpectralCube::new(450, 300, bands);
    for plane in image.planes_mut() {
        plane.samples_mut().fill(1.0);
        (0..60).for_each(|i| plane.set(100 + i % 8, 70 + i / 8, 1e5));
    }
    let layer = layer(&image, lens, &raster, GhostSettings::default()).expect("of the raster's size");
    let sum = |cube: &SpectralCube<Irradiance>| {
        cube.planes().iter().flat_map(|plane| plane.samples()).map(|v| f64::from(*v)).sum::<f64>()
    };
    sum(&layer) / sum(&image)
}

/// A camera with a picture of 36 × 24 mm.
fn body(lens: &str) -> CameraBody {
    let text = format!("format = 1\n[sensor]\nwidth_px = 900\nheight_px = 600\npixel_pitch_um = 40\n[lens]\n{lens}\n");
    let camera = load_camera(Path::new("camera.toml"), &|_| Ok(text.clone()), &Overrides::default());
    let camera = camera.unwrap_or_else(|errors| panic!("{errors}"));
    compile_camera(&camera, &Assets::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// How many rays come through.
fn rays(body: &CameraBody) -> u32 {
    let step = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
    let turn = DVec2::new(0.819_172_513_396_164, 0.671_043_606_703_789_2);
    let size = DVec2::new(900.0, 600.0);
    let passes = |i: u32| {
        let (at, pupil) = ((step * f64::from(i)).fract() * size, (turn * f64::from(i)).fract());
        let nm = 400.0 + 300.0 * (0.618_033_988_749_895 * f64::from(i)).fract();
        let at_mm = body.raster.sensor_mm(at);
        match &body.front {
            None => std::hint::black_box(body.lens.ray(at_mm, pupil, nm)).is_some(),
            Some(front) => std::hint::black_box(front.ray(&body.lens, at_mm, pupil, nm)).is_some(),
        }
    };
    (0..RAYS).map(|i| u32::from(passes(i))).sum()
}
