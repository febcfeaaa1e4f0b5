//! Depth of field three ways: the blur of a point against the formula of the lens, and the time of a picture.

use crate::scenes::{camera, plan_of_text};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_core::SpectralCube;
use etendue_core::quantity::Radiance;
use etendue_optics::{DepthOfField, FastBlend, FastParameters};
use etendue_pipeline::defocus::pupil_mean_radiance;
use etendue_pipeline::plan::Route;
use etendue_pipeline::pupil_depth::pupil_depth;
use etendue_pipeline::render::{LightRequest, light};
use etendue_pipeline::stored::StoredRadianceImage;
use etendue_pipeline::{NullObserver, Plan};
use etendue_tracer::accel::Simd;
use glam::DVec2;
use rayon::ThreadPool;

const NOTE: &str = "Thick lens, 50 mm f/2 at 2 m; a picture of 161 × 121 px of 40 µm and 20 bands of a glowing dot of nine \
    tenths of a pixel. Diameter: four standard deviations of the dot's light, without the dot's and the pixel's own; \
    error against 2 a c |1/z - 1/F|. Through the lens 256 samples a pixel; the fast blend is set to what is sharp to \
    a pixel (1.91 to 2.10 m) and has the blur of infinity from 1.2 m and 20 m on. Time: of the picture through the lens, and \
    of the filter alone behind a stored picture. One thread.";

/// Distances of the dot, m.
const DEPTHS_M: [f64; 5] = [1.0, 1.5, 3.0, 8.0, 50.0];
const FOCUS_M: f64 = 2.0;
const PITCH_MM: f64 = 0.04;
const DOT_PX: f64 = 0.9;
const SIZE_PX: [usize; 2] = [161, 121];
const SPP: u32 = 256;

/// Error and time of the three.
pub fn table() -> Table {
    let one = pool(1);
    let depths = DEPTHS_M.map(|m| format!("{m} m"));
    let head: Vec<&str> = core::iter::once("blur of a dot at").chain(depths.iter().map(String::as_str)).collect();
    let mut table = Table::new("Depth of field", NOTE, &[head.as_slice(), &["time, ms"]].concat());
    let formula_px = DEPTHS_M.map(|m| expected_px(&plan("pupil", m), m));
    table.row(row("formula, px", formula_px.map(|px| format!("{px:.2}")), "–".to_owned()));
    let methods: [(&str, BlurMethod); 3] = [
        ("through the lens", through_lens),
        ("physical", |plan, pool| at_pupil(plan, pool, DepthOfField::Physical)),
        ("fast", |plan, pool| at_pupil(plan, pool, DepthOfField::Fast(blend(plan)))),
    ];
    for (name, method) in methods {
        let mut time_s = RunStatistics::default();
        let errors = core::array::from_fn(|i| {
            let route = if name == "through the lens" { "lens" } else { "pupil" };
            let (image, seconds) = method(&plan(route, DEPTHS_M[i]), &one);
            time_s.add(seconds);
            let dot = if route == "lens" { DOT_PX * DOT_PX } else { 0.0 };
            format!("{:+.1} %", 100.0 * (diameter_px(&image, dot) / formula_px[i] - 1.0))
        });
        table.row(row(name, errors, format!("{:.0}", 1e3 * time_s.median())));
    }
    table
}

/// A picture and the seconds that its blur took.
type BlurMethod = fn(&Plan, &ThreadPool) -> (SpectralCube<Radiance>, f64);

fn row(name: &str, cells: [String; DEPTHS_M.len()], time: String) -> Vec<String> {
    core::iter::once(name.to_owned()).chain(cells).chain([time]).collect()
}

fn plan(route: &str, depth_m: f64) -> Plan {
    let side_m = DOT_PX * depth_m * PITCH_MM / principal_distance_mm();
    let [width, height] = SIZE_PX;
    let spp = if route == "lens" { SPP } else { 16 };
    plan_of_text(&format!(
        "format = 1\n[scene]\nmaterials = [{{ name = \"glow\", type = \"emitter\", emission = {{ luminance_cd_m2 = 1000, \
         illuminant = \"E\" }} }}]\n[[scene.objects]]\nname = \"dot\"\nshape = {{ type = \"quad\", size_m = [{side_m}, \
         {side_m}] }}\nmaterial = \"glow\"\nposition_m = [{depth_m}, 0, 0]\nrotation_deg = [0, -90, 0]\n[[cameras]]\n\
         name = \"eye\"\nposition_m = [0, 0, 0]\nlook_at_m = [1, 0, 0]\n[cameras.lens]\ntype = \"thick\"\n\
         focal_length_mm = 50\nf_number = 2\nfocus_distance_m = {FOCUS_M}\nconstant_pupil = \"exit\"\n[cameras.sensor]\n\
         width_px = {width}\nheight_px = {height}\npixel_pitch_um = {}\n[render]\nspp = {spp}\nreplicates = 1\n\
         wavelength_range_nm = [400, 700]\nband_width_nm = 15\nroute = \"{route}\"\n[output]\nradiance = true\n\
         ground_truth = false\n",
        1e3 * PITCH_MM
    ))
}

/// 50 mm at 2 m: f F/(F - f).
fn principal_distance_mm() -> f64 {
    50.0 * FOCUS_M / (FOCUS_M - 0.05)
}

fn expected_px(plan: &Plan, depth_m: f64) -> f64 {
    camera(plan).body.lens.circle_of_confusion_mm(depth_m) / PITCH_MM
}

fn blend(plan: &Plan) -> FastBlend {
    FastBlend::new(FastParameters {
        sharp_near_m: 1.91,
        sharp_far_m: 2.10,
        blurred_near_m: 1.2,
        blurred_far_m: 20.0,
        blur_px: expected_px(plan, f64::INFINITY),
    })
    .expect("in order")
}

fn through_lens(plan: &Plan, pool: &ThreadPool) -> (SpectralCube<Radiance>, f64) {
    let (film, seconds) = pool.install(|| timed(|| light(plan, camera(plan), LightRequest::default(), &NullObserver)));
    (film.expect("nobody cancels").radiance().expect("a cube is kept").mean, seconds)
}

fn at_pupil(plan: &Plan, pool: &ThreadPool, method: DepthOfField) -> (SpectralCube<Radiance>, f64) {
    let Route::Pupil(projection) = &camera(plan).settings.route else { panic!("the route at the pupil") };
    let (stored, _) = through_lens(plan, pool);
    let depth = pupil_depth(plan, camera(plan), 0, Simd::Auto).expect("the route at the pupil");
    let stored = StoredRadianceImage { projection, radiance: &stored, distance: Some(&depth.distance) };
    let filtered = |method| pupil_mean_radiance(&stored, &camera(plan).body, &method).expect("the picture is covered");
    let (_, resampling_s) = pool.install(|| timed(|| filtered(DepthOfField::None)));
    let (image, seconds) = pool.install(|| timed(|| filtered(method)));
    (image, seconds - resampling_s)
}

/// The diameter of the disc that has the spread of a picture's light, px; `dot` is the square of the dot's side.
fn diameter_px(image: &SpectralCube<Radiance>, dot: f64) -> f64 {
    let at = |i: usize| DVec2::new((i % image.width()) as f64, (i / image.width()) as f64);
    let light: Vec<f64> = image.planes()[image.planes().len() / 2].samples().iter().map(|l| f64::from(*l)).collect();
    let sum: f64 = light.iter().sum();
    let mean = light.iter().enumerate().map(|(i, l)| at(i) * *l).sum::<DVec2>() / sum;
    let square: f64 = light.iter().enumerate().map(|(i, l)| at(i).distance_squared(mean) * l).sum();
    4.0 * (0.5 * square / sum - (1.0 + dot) / 12.0).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_filter_has_the_diameter_of_the_formula() {
        // 8 px: the pixel's square meets the rim of a disc in few pixels, which leaves a hundredth of the diameter.
        let plan = plan("pupil", 3.0);
        let (image, _) = at_pupil(&plan, &pool(1), DepthOfField::Physical);
        assert!((diameter_px(&image, 0.0) / expected_px(&plan, 3.0) - 1.0).abs() < 0.02);
    }
}
