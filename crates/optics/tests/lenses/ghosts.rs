//! Ghosts compared with closed forms, first order and plain sums over rays.

use etendue_core::quantity::Irradiance;
use etendue_core::{Bands, SpectralCube};
use etendue_optics::ghosts::{GhostSettings, layer, strongest};
use etendue_optics::prescription::coating::Coating;
use etendue_optics::prescription::ghost::GhostPair;
use etendue_optics::prescription::surface::Surface;
use etendue_optics::prescription::trace::LensRay;
use etendue_optics::prescription::{Focus, published};
use etendue_optics::{Lens, Prescription, PrescriptionLens, PrescriptionParameters};
use etendue_projection::Raster;
use etendue_spectra::glass::Dispersion;
use glam::{DVec2, DVec3};

const NM: f64 = 587.56;
const NONE: f64 = 0.0;

fn focused(surfaces: Vec<Surface>) -> Prescription {
    let focus = Focus::Sensor { distance_m: f64::INFINITY };
    Prescription::new(PrescriptionParameters::new(surfaces, focus)).expect("a lens")
}

fn double_gauss(coating: Coating) -> Prescription {
    let surfaces = published::named("double-gauss").expect("published").surfaces();
    focused(surfaces.into_iter().map(|s| Surface { coating, ..s }).collect())
}

fn parallel(height_mm: f64, slope: f64) -> LensRay {
    LensRay { point: DVec3::new(height_mm, 0.0, 0.0), direction: DVec3::new(slope, 0.0, 1.0).normalize() }
}

fn settings() -> GhostSettings {
    GhostSettings::new(NONE).expect("legal")
}

#[test]
fn every_two_surfaces_that_refract_are_a_pair() {
    let lens = double_gauss(Coating::Uncoated);
    // Ten surfaces and a stop.
    let pairs = lens.ghost_pairs(false);
    assert_eq!((pairs.len(), lens.ghost_pairs(true).len()), (45, 55));
    assert!(pairs.iter().all(|p| p.front < p.rear && p.front != lens.stop() && p.rear != lens.stop()));
}

/// On the axis a ghost's light is that of the direct ray, times both reflectances, times the squared transmittance of everything between them.
#[test]
fn weights_on_the_axis_are_products() {
    for coating in [Coating::Uncoated, Coating::QuarterWave { design_nm: 550.0 }, Coating::Constant(0.98)] {
        let lens = double_gauss(coating);
        let (_, direct) = lens.to_sensor(parallel(0.0, 0.0), NM).expect("through");
        // A surface's transmittance alone: the whole lens's over that of the lens with this surface fully transmitting.
        let alone = |i: usize| {
            let mut surfaces = lens.surfaces().to_vec();
            surfaces[i].coating = Coating::Constant(1.0);
            direct / focused(surfaces).to_sensor(parallel(0.0, 0.0), NM).expect("through").1
        };
        let through: Vec<f64> = (0..lens.surfaces().len()).map(alone).collect();
        for pair in lens.ghost_pairs(false) {
            let GhostPair { front, rear } = pair;
            let between: f64 = through[front + 1..rear].iter().map(|t| t * t).product();
            let expected = direct * (1.0 - through[front]) * (1.0 - through[rear]) * between;
            let ghost = lens.ghost(pair, parallel(0.0, 0.0), NM).expect("through");
            // Reflectances of 1e-5 are differences from 1: rounding there is 1e-11.
            assert!((ghost.weight / expected - 1.0).abs() < 1e-9, "{pair:?}: {} {expected}", ghost.weight);
            assert!(ghost.weight > 0.0 && ghost.weight < 0.02);
        }
    }
}

#[test]
fn a_plate_sends_r_squared_beside_its_light() {
    let glass = Dispersion::Constant { n: 1.5 };
    let mut surfaces = vec![
        Surface::sphere(f64::INFINITY, 3.0, glass, 20.0),
        Surface::sphere(f64::INFINITY, 5.0, Dispersion::AIR, 20.0),
    ];
    surfaces.extend(published::named("double-gauss").expect("published").surfaces());
    let lens = focused(surfaces);
    let plate = GhostPair { front: 0, rear: 1 };
    let ghost = lens.ghost(plate, parallel(0.0, 0.0), NM).expect("through");
    let (_, direct) = lens.to_sensor(parallel(0.0, 0.0), NM).expect("through");
    assert!((ghost.weight / direct - 0.04 * 0.04).abs() < 1e-12);
    // Both faces reflect the light back into its own direction: the ghost of a source at infinity lies on its image.
    let first = lens.ghost_first_order(plate, NM);
    assert!(first.spread.abs() < 1e-12 && (first.throw_mm / lens.paraxial().focal_length_mm - 1.0).abs() < 1e-12);
    let ray = lens.ghost(plate, parallel(3.0, 0.1), NM).expect("through").ray;
    let (straight, _) = lens.to_sensor(parallel(3.0, 0.1), NM).expect("through");
    assert!((ray.direction.length() - 1.0).abs() < 1e-12 && ray.direction.dot(straight.direction) > 0.99);
}

/// A thin lens of focal length f and index n: light reflected twice inside focuses f (n − 1)/(3n − 1) behind it.
#[test]
fn a_thin_lenss_ghost_focuses_where_it_should() {
    let n = 1.6;
    let glass = Dispersion::Constant { n };
    let thickness = 1e-6;
    let surfaces = vec![
        Surface::stop(1e-6, 4.0),
        Surface::sphere(60.0, thickness, glass, 5.0),
        Surface::sphere(-90.0, 0.0, Dispersion::AIR, 5.0),
    ];
    // Surfaces of a lens this thin would cross: they are spaced as their sags require.
    let sags = 16.0 / 60.0 + 16.0 / 90.0;
    let mut surfaces = surfaces;
    surfaces[1].thickness_mm = sags;
    surfaces.iter_mut().for_each(|s| s.semi_aperture_mm = s.semi_aperture_mm.min(4.0));
    let lens = focused(surfaces);
    let f = lens.paraxial().focal_length_mm;
    let expected = f * (n - 1.0) / (3.0 * n - 1.0);
    let first = lens.ghost_first_order(GhostPair { front: 1, rear: 2 }, NM);
    let behind_lens = lens.sensor_position_mm() + first.focus_mm - sags;
    // The thickness moves the focus by about its own amount.
    assert!((behind_lens - expected).abs() < 1.5 * sags, "{behind_lens} {expected}");
}

#[test]
fn rays_near_the_axis_follow_first_order() {
    for name in ["double-gauss", "wide-angle", "telephoto", "fisheye"] {
        let lens = focused(published::named(name).expect("published").surfaces());
        for pair in lens.ghost_pairs(true) {
            let first = lens.ghost_first_order(pair, NM);
            let step = 1e-6;
            let lands = |ray| {
                let ray: LensRay = lens.ghost(pair, ray, NM).expect("near the axis").ray;
                (ray.point + ray.direction * ((lens.sensor_position_mm() - ray.point.z) / ray.direction.z)).x / step
            };
            // The third order is about 1e-12 of the first at this height and slope.
            let (height, slope) = (lands(parallel(step, 0.0)), lands(parallel(0.0, step)));
            let scale = 1.0 + first.spread.abs();
            assert!((height - first.spread).abs() < 1e-7 * scale, "{name} {pair:?} {height} {}", first.spread);
            let scale = 1.0 + first.throw_mm.abs();
            assert!((slope - first.throw_mm).abs() < 1e-7 * scale, "{name} {pair:?} {slope} {}", first.throw_mm);
        }
    }
}

const PIXELS: usize = 120;
const PITCH_MM: f64 = 0.3;

/// An image of 36 mm with one bright pixel, and its ghosts, for two bands.
fn ghosts_of(lens: &PrescriptionLens, pixel: [usize; 2], sensor: f64) -> SpectralCube<Irradiance> {
    let raster = Raster::centred(PIXELS, PIXELS, PITCH_MM).expect("a raster");
    let bands = Bands::new(560.0, 20.0, 2).expect("bands");
    let mut cube = SpectralCube::new(PIXELS, PIXELS, bands);
    cube.planes_mut().iter_mut().for_each(|plane| plane.set(pixel[0], pixel[1], 1.0));
    layer(&cube, lens, &raster, GhostSettings::new(sensor).expect("legal")).expect("of this size")
}

fn prescribed(lens: Prescription) -> PrescriptionLens {
    PrescriptionLens::new(lens, None, 26.0).expect("lit")
}

/// Light of the pixel's ghosts on the image by a plain sum over a fine grid of rays over the whole front, without tables: its sum and centroid,
/// relative to the light of the pixel.
fn plain_sum(lens: &PrescriptionLens, at_mm: DVec2, nm: f64, sensor: f64) -> (f64, DVec2) {
    const SIDE: i32 = 160;
    let p = lens.prescription();
    let through = Lens::prescription(lens.clone());
    let actual = through.direction(at_mm).expect("a direction");
    // From the camera frame, towards the scene, to the lens frame, towards the sensor.
    let travel = DVec3::new(-actual.x, -actual.y, actual.z).normalize();
    let half = PITCH_MM / 2.0;
    let direction = |x: f64, y: f64| through.direction(at_mm + DVec2::new(x, y)).expect("a direction").normalize();
    let solid =
        (direction(half, 0.0) - direction(-half, 0.0)).cross(direction(0.0, half) - direction(0.0, -half)).length();
    let [u, v] = [travel.any_orthonormal_pair().0, travel.any_orthonormal_pair().1];
    let reach = 1.2 * p.surfaces()[0].semi_aperture_mm;
    let step = 2.0 * reach / f64::from(SIDE);
    let (mut sum, mut moment) = (0.0, DVec2::ZERO);
    let edge = PITCH_MM * PIXELS as f64 / 2.0;
    for pair in p.ghost_pairs(sensor > 0.0) {
        let mirrored = if pair.rear == p.surfaces().len() { sensor } else { 1.0 };
        for i in 0..SIDE * SIDE {
            let point =
                u * (step * (f64::from(i % SIDE) + 0.5) - reach) + v * (step * (f64::from(i / SIDE) + 0.5) - reach);
            let Ok(ghost) = p.ghost(pair, LensRay { point, direction: travel }, nm) else { continue };
            let end = ghost.ray.point
                + ghost.ray.direction * ((p.sensor_position_mm() - ghost.ray.point.z) / ghost.ray.direction.z);
            // The image is erect.
            let end = -end.truncate();
            if ghost.filling <= 1.0 && end.abs().max_element() < edge {
                sum += ghost.weight * mirrored * step * step;
                moment += end * ghost.weight * mirrored * step * step;
            }
        }
    }
    let etendue = through.projected_solid_angle_sr(at_mm);
    (sum * solid / etendue / (PITCH_MM * PITCH_MM), moment / sum)
}

/// Sum and centroid (mm) of a plane.
fn measured(cube: &SpectralCube<Irradiance>) -> (f64, DVec2) {
    let (mut sum, mut moment) = (0.0, DVec2::ZERO);
    for (i, value) in cube.planes()[1].samples().iter().enumerate() {
        let at = DVec2::new((i % PIXELS) as f64 + 0.5, (i / PIXELS) as f64 + 0.5) - PIXELS as f64 / 2.0;
        sum += f64::from(*value);
        moment += at * PITCH_MM * f64::from(*value);
    }
    (sum, moment / sum)
}

#[test]
fn a_layer_holds_the_light_of_a_plain_sum_over_rays() {
    let lens = prescribed(double_gauss(Coating::Uncoated));
    for (pixel, sensor) in [([85, 50], 0.0), ([20, 85], 0.05)] {
        let cube = ghosts_of(&lens, pixel, sensor);
        let at = (DVec2::new(pixel[0] as f64, pixel[1] as f64) + 0.5 - PIXELS as f64 / 2.0) * PITCH_MM;
        let (sum, centre) = measured(&cube);
        let (expected, middle) = plain_sum(&lens, at, 590.0, sensor);
        // 0.5 % of pairs are omitted; grids, edges of the image and tables by angle contribute a similar error.
        assert!((sum / expected - 1.0).abs() < 0.02, "{sum} {expected}");
        assert!((centre - middle).length() < 0.3, "{centre} {middle}");
    }
}

#[test]
fn a_layer_turns_with_its_source_and_grows_with_it() {
    let lens = prescribed(double_gauss(Coating::QuarterWave { design_nm: 550.0 }));
    let [a, b] = [[90, 40], [PIXELS - 1 - 40, 90]].map(|pixel| ghosts_of(&lens, pixel, 0.0));
    let (a, b) = (&a.planes()[0], &b.planes()[0]);
    let maximum = a.samples().iter().copied().fold(0.0, f32::max);
    for y in 0..PIXELS {
        for x in 0..PIXELS {
            // Single-precision rounding of point positions.
            let difference = a.at(x, y) - b.at(PIXELS - 1 - y, x);
            assert!(difference.abs() < 2e-3 * maximum, "{x} {y}: {} {}", a.at(x, y), b.at(PIXELS - 1 - y, x));
        }
    }
}

#[test]
fn coatings_make_ghosts_faint() {
    let light = |coating| strongest(&prescribed(double_gauss(coating)), 8.0, settings(), 100);
    let sum = |coating| light(coating).iter().map(|g| g.light).sum::<f64>();
    let (bare, coated) = (sum(Coating::Uncoated), sum(Coating::QuarterWave { design_nm: 550.0 }));
    // 5 to 8 % of uncoated flints and crowns compared with 1 % or less: a twentieth or less of the product.
    assert!(bare > 10.0 * coated && coated > 0.0, "{bare} {coated}");
    // Only a small fraction of light is reflected twice: Σ R² of 45 pairs of about 5 %.
    assert!(bare < 45.0 * 0.07 * 0.07, "{bare}");
    let reports = light(Coating::Uncoated);
    assert!(reports.windows(2).all(|pair| pair[0].light >= pair[1].light));
    assert!(reports.iter().any(|ghost| ghost.height_mm < 0.0), "some lie on the other side of the axis");
}

#[test]
fn a_sensor_that_mirrors_more_than_all_is_refused() {
    assert!(GhostSettings::new(1.0).is_err() && GhostSettings::new(-0.1).is_err());
    assert!(GhostSettings::new(f64::NAN).is_err() && GhostSettings::new(0.04).is_ok());
}
