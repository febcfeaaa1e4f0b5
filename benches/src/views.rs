//! A wide picture by six views and through its lens.

use crate::scenes::STREET;
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_optics::PupilProjection;
use etendue_pipeline::photograph::Light;
use etendue_pipeline::plan::{CameraPlan, Plan, Route};
use etendue_pipeline::render::{LightRequest, light};
use etendue_pipeline::stored::StoredRadianceImage;
use etendue_pipeline::{NullObserver, compile_camera};
use etendue_scene::asset::Assets;
use etendue_scene::{Overrides, load_camera};
use std::path::Path;

const NOTE: &str = "The street, 16 samples a pixel in bands of 50 nm, one thread. Through the lens every sample's ray is asked of the \
    lens; at the pupil views are rendered and resampled, which another lens or sensor need not render again.";

const CAMERAS: [(&str, &str); 2] = [
    (
        "fisheye of 180°, 240 × 240 px",
        "width_px = 240\nheight_px = 240\npixel_pitch_um = 10\n[lens]\ntype = \"calibrated\"\nf_number = 4\n\
         greatest_angle_deg = 90\nprojection = { type = \"equidistant\", fx_px = 76.4 }",
    ),
    (
        "panorama of 360°, 320 × 160 px",
        "width_px = 320\nheight_px = 160\npixel_pitch_um = 10\n[lens]\ntype = \"calibrated\"\nf_number = 4\n\
         projection = { type = \"equirectangular\", field_of_view_deg = 360 }",
    ),
];

/// Seconds of a picture by either route.
pub fn table() -> Table {
    let one = pool(1);
    let head = [
        "camera",
        "through the lens, s",
        "six views, s",
        "resampling of it, s",
        "stored pixels by the picture's",
        "spread",
    ];
    let mut table = Table::new("Wide pictures by two routes", NOTE, &head);
    for (name, keys) in CAMERAS {
        let plan = STREET.plan();
        let (direct, pupil) = (camera(&plan, keys, false), camera(&plan, keys, true));
        let Route::Pupil(projection) = &pupil.settings.route else { unreachable!("made so") };
        let film = one.install(|| shot(&plan, &pupil));
        let radiance = film.radiance().expect("a cube").mean;
        let stored = StoredRadianceImage { projection, radiance: &radiance, distance: None };
        let (mut lens, mut views, mut last) =
            (RunStatistics::default(), RunStatistics::default(), RunStatistics::default());
        for _ in 0..etendue_bench_rays::runs::COUNT {
            lens.add(one.install(|| timed(|| std::hint::black_box(shot(&plan, &direct))).1));
            views.add(one.install(|| timed(|| std::hint::black_box(shot(&plan, &pupil))).1));
            last.add(one.install(|| {
                timed(|| std::hint::black_box(Light::at_pupil(&pupil.body, &stored, &pupil.depth_of_field))).1
            }));
        }
        let pixels = (direct.body.raster.width() * direct.body.raster.height()) as f64;
        let view_pixels: usize = projection.views().map(|v| v.size()[0] * v.size()[1]).sum();
        table.row([
            name.to_owned(),
            format!("{:.2}", lens.median()),
            format!("{:.2}", views.median() + last.median()),
            format!("{:.3}", last.median()),
            format!("{:.2}", view_pixels as f64 / pixels),
            lens.spread_text(),
        ]);
    }
    table
}

fn shot(plan: &Plan, camera: &CameraPlan) -> etendue_pipeline::film::Film {
    light(plan, camera, LightRequest::default(), &NullObserver).expect("nobody cancels")
}

/// The street's camera with another body, by one of the routes.
fn camera(plan: &Plan, keys: &str, at_pupil: bool) -> CameraPlan {
    let text = format!("format = 1\n[sensor]\n{keys}\n");
    let body = load_camera(Path::new("camera.toml"), &|_| Ok(text.clone()), &Overrides::default());
    let body = compile_camera(&body.unwrap_or_else(|errors| panic!("{errors}")), &Assets::default());
    let body = body.unwrap_or_else(|errors| panic!("{errors:?}"));
    let mut camera = plan.cameras[0].clone();
    let range = etendue_core::WavelengthRange::new(400.0, 700.0);
    if at_pupil {
        let projection = PupilProjection::covering(&body.lens, &body.raster, [0, 0], range).expect("a wide camera");
        camera.settings.route = Route::Pupil(projection);
    }
    camera.body = body;
    camera.settings.range = range;
    camera.settings.bands = etendue_core::Bands::covering(range.low_nm, range.high_nm, 50.0);
    camera.settings.accumulates_electrons = false;
    camera.settings.spp = 16;
    camera.settings.replicates = 2;
    camera
}
