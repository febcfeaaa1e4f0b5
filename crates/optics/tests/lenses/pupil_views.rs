//! The at-the-pupil route in six views, and for every lens with a single viewpoint.

use core::f64::consts::PI;
use etendue_core::WavelengthRange;
use etendue_core::maths::f64::{atan2, cos, sin};
use etendue_core::plane::{Plane, SpectralCube};
use etendue_core::quantity::{Length, Radiance};
use etendue_core::wavelength::Bands;
use etendue_optics::prescription::coating::InterferenceFilter;
use etendue_optics::prescription::{Focus, published};
use etendue_optics::{
    BandEtendue, CalibratedParameters, Cube, Face, LateralColour, Lens, OpticsError, PinholeParameters, Prescription,
    PrescriptionLens, PrescriptionParameters, PupilProjection, Resampling, ThinParameters, Window, irradiance,
};
use etendue_projection::model::{Ideal, KannalaBrandt, Panorama, Perspective};
use etendue_projection::{Calibration, CameraMatrix, DistortionDirection, Model, RadialDistortion, Raster};
use etendue_spectra::{Extrapolation, Spectrum};
use glam::{DVec2, DVec3};

const PITCH_MM: f64 = 0.01;
const RANGE: WavelengthRange = WavelengthRange::new(500.0, 600.0);

fn bands() -> Bands {
    Bands::new(500.0, 50.0, 2).expect("legal")
}

/// A calibrated camera of `width` × `height` pixels, its axis at the centre.
fn camera(model: Model, f_px: f64, size_px: [usize; 2]) -> (Lens, Raster) {
    limited(model, f_px, size_px, PI)
}

/// The same, limited to directions below a field angle.
fn limited(model: Model, f_px: f64, [width, height]: [usize; 2], angle_rad: f64) -> (Lens, Raster) {
    let (cx, cy) = (0.5 * width as f64, 0.5 * height as f64);
    let matrix = CameraMatrix { fx: f_px, fy: f_px, skew: 0.0, cx, cy };
    let parameters = CalibratedParameters {
        calibration: Calibration::new(model, matrix, [width, height])
            .and_then(|calibration| calibration.with_max_angle(angle_rad))
            .expect("a calibration"),
        pixel_pitch_mm: PITCH_MM,
        f_number: 2.0,
        transmittance: 0.9,
        focus_distance_m: None,
        pupil: None,
        relative_illumination: None,
    };
    (Lens::calibrated(parameters).expect("a camera"), Raster::centred(width, height, PITCH_MM).expect("a raster"))
}

fn prescription(name: &str, radius_mm: f64) -> (Lens, Raster) {
    filtered(name, radius_mm, None)
}

fn filtered(name: &str, radius_mm: f64, filter: Option<InterferenceFilter>) -> (Lens, Raster) {
    let surfaces = published::named(name).expect("a published lens").surfaces();
    let focus = Focus::Sensor { distance_m: f64::INFINITY };
    let lens = Prescription::new(PrescriptionParameters::new(surfaces, focus));
    let lens = Lens::prescription(PrescriptionLens::new(lens.expect("a lens"), filter, radius_mm).expect("lit"));
    (lens, Raster::centred(72, 48, radius_mm / 43.3).expect("a raster"))
}

fn equidistant(angle: f64) -> (Lens, Raster) {
    // The image circle of a full angle touches the sides of 96 pixels.
    limited(Model::Ideal(Ideal::Equidistant), 96.0 / angle, [96, 96], 0.5 * angle)
}

/// Wide and narrow cameras of every kind.
fn cameras() -> Vec<(&'static str, Lens, Raster)> {
    let pinhole = PinholeParameters { focal_length_mm: 0.1, f_number: 2.0, transmittance: 1.0 };
    let wide = (Lens::pinhole(pinhole).expect("legal"), Raster::centred(60, 40, PITCH_MM).expect("legal"));
    let fisheye = KannalaBrandt::new([-0.01, 0.002, 0.0, 0.0]).expect("finite");
    let named = [
        ("pinhole of 143°", wide),
        ("undistorted", camera(Model::Perspective(Perspective::pinhole()), 80.0, [96, 64])),
        ("equidistant 180°", equidistant(PI)),
        ("equidistant 360°", equidistant(2.0 * PI)),
        ("equisolid 250°", camera(Model::Ideal(Ideal::Equisolid), 24.0, [60, 80])),
        ("stereographic", camera(Model::Ideal(Ideal::Stereographic), 24.0, [80, 60])),
        ("orthographic", camera(Model::Ideal(Ideal::Orthographic), 40.0, [80, 80])),
        ("Kannala–Brandt", camera(Model::KannalaBrandt(fisheye), 40.0, [100, 80])),
        ("equirectangular", camera(Model::Panorama(Panorama::Equirectangular), 128.0 / (2.0 * PI), [128, 64])),
        ("cylindrical", camera(Model::Panorama(Panorama::Cylindrical), 128.0 / (2.0 * PI), [128, 40])),
        ("double Gauss", prescription("double-gauss", 21.6)),
        ("fisheye lens", prescription("fisheye", 12.75)),
    ];
    named.into_iter().map(|(name, (lens, raster))| (name, lens, raster)).collect()
}

/// A stored image of a radiance field; pixels outside all views are NaN and must never be read.
fn stored(geometry: &PupilProjection, value: impl Fn(DVec3) -> f64) -> SpectralCube<Radiance> {
    let mut plane = Plane::<Radiance>::new(geometry.width(), geometry.height());
    for y in 0..geometry.height() {
        for x in 0..geometry.width() {
            let direction = geometry.direction(DVec2::new(x as f64 + 0.5, y as f64 + 0.5));
            plane.set(x, y, direction.map_or(f32::NAN, |d| value(d) as f32));
        }
    }
    SpectralCube::from_planes(bands(), vec![plane.clone(), plane]).expect("two planes")
}

fn centres(raster: &Raster) -> impl Iterator<Item = (usize, usize, DVec2)> {
    let (raster, width) = (*raster, raster.width());
    let centre = move |x: usize, y: usize| raster.sensor_mm(DVec2::new(x as f64, y as f64) + 0.5);
    (0..raster.height()).flat_map(move |y| (0..width).map(move |x| (x, y, centre(x, y))))
}

#[test]
fn uniform_radiance_stays_uniform_whatever_the_lens() {
    for (name, lens, raster) in cameras() {
        for margin_px in [0, 5] {
            let geometry = PupilProjection::covering(&lens, &raster, [margin_px; 2], RANGE).expect(name);
            let resampling = Resampling::new(geometry, &lens, &raster, [margin_px; 2], bands()).expect(name);
            let image = resampling.apply(&stored(&geometry, |_| 7.0)).expect(name);
            let mut count = 0;
            for (x, y, at) in centres(resampling.raster()) {
                let value = image.planes()[0].at(x, y);
                // Weights of f64 sum to one within some 1e-14; the sum is rounded to f32 once.
                let uniform = (f64::from(value) / 7.0 - 1.0).abs() < 1.2e-7;
                if lens.direction(at).is_some() {
                    count += 1;
                    // The last step of a prescription's table may lie inside a pixel at the image circle's edge.
                    let last = matches!(lens, Lens::Prescription(_)) && value == 0.0;
                    assert!(uniform || last, "{name} ({x}, {y}): {value}");
                } else {
                    assert!(uniform || value == 0.0, "{name} ({x}, {y}): {value}");
                }
            }
            assert!(count > 1000, "{name}: {count} pixels");
        }
    }
}

/// Smooth over the whole sphere; its gradient is at most 2.3 per radian.
fn smooth(d: DVec3) -> f64 {
    4.0 + d.x + 0.8 * d.y - 0.6 * d.z + d.x * d.z + 0.5 * d.y * d.x
}

#[test]
fn a_smooth_radiance_has_no_seams() {
    for (name, lens, raster) in cameras() {
        let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect(name);
        let resampling = Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect(name);
        let image = resampling.apply(&stored(&geometry, smooth)).expect(name);
        for (x, y, at) in centres(&raster) {
            let half = 0.5 * raster.pitch_mm().x;
            let corners = [(-half, -half), (half, -half), (-half, half), (half, half)];
            let corners = corners.map(|(x, y)| lens.direction(at + DVec2::new(x, y)));
            let (Some(direction), true) = (lens.direction(at), corners.iter().all(Option::is_some)) else { continue };
            let direct = smooth(direction.normalize());
            let spread = corners.iter().flatten().map(|d| (d.normalize() - direction.normalize()).length());
            // Stored pixels count as uniform: a footprint some stored pixels wide reads a slope to an eighth of a stored pixel's step on each axis at
            // worst; the error by the pixel's own curvature is below its spread squared.
            let spread = spread.fold(0.0, f64::max);
            let allowed = 2.3 * 0.25 * geometry.pitch_tan() + 2.0 * spread * spread;
            let value = f64::from(image.planes()[0].at(x, y));
            if matches!(lens, Lens::Prescription(_)) && value == 0.0 {
                continue;
            }
            assert!((value - direct).abs() < allowed, "{name} ({x}, {y}): {value}, not {direct} ± {allowed}");
        }
    }
}

#[test]
fn narrow_images_take_one_view_and_wide_ones_only_the_faces_they_see() {
    let views = |(lens, raster): (Lens, Raster)| {
        let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal");
        (matches!(geometry, PupilProjection::Cube(_)), geometry.views().count())
    };
    assert_eq!(views(camera(Model::Perspective(Perspective::pinhole()), 80.0, [96, 64])), (false, 1));
    assert_eq!(views(prescription("double-gauss", 21.6)), (false, 1));
    assert_eq!(views(equidistant(PI)), (true, 5));
    assert_eq!(views(equidistant(2.0 * PI)), (true, 6));
    // 128 columns around, 40 pixels of 1/20.4: elevations to ±44.5°.
    assert_eq!(views(camera(Model::Panorama(Panorama::Cylindrical), 128.0 / (2.0 * PI), [128, 40])).1, 6);
}

#[test]
fn stored_pixels_are_no_wider_than_the_image_s() {
    let (lens, raster) = equidistant(PI);
    let PupilProjection::Cube(cube) = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal") else {
        panic!("six views")
    };
    // π/96 rad per pixel; the finest of the survey's differences may round below it.
    let needed = 2.0 * 96.0 / PI;
    assert!((needed..needed + 4.0).contains(&(cube.face_px() as f64)), "{} for {needed}", cube.face_px());
    // The back half of the side views is not stored: front, 4 halves, and borders.
    let front = cube.face_px() + 8;
    // A window ends some three pixels beyond the visible part, on one side of four halves.
    assert!(cube.width() <= front + 8 && cube.height() <= 3 * front + 8, "{} × {}", cube.width(), cube.height());
}

#[test]
fn pixels_belong_to_one_view_and_look_where_they_are_found() {
    let window = |left, top, width, height| Some(Window { left, top, width, height });
    let windows = [
        window(-4, -4, 40, 40),
        window(-4, -4, 20, 40),
        window(16, -4, 20, 40),
        None,
        window(-4, -4, 40, 17),
        window(3, 5, 7, 9),
    ];
    let cube = Cube::new(32, windows).expect("legal");
    assert_eq!(cube.windows(), windows, "they read back");
    // Front; right and left side by side; bottom and back.
    assert_eq!((cube.width(), cube.height()), (47, 40 + 40 + 17));
    let geometry = PupilProjection::Cube(cube);
    let mut count = 0;
    for y in 0..cube.height() {
        for x in 0..cube.width() {
            let px = DVec2::new(x as f64, y as f64) + 0.5;
            let Some(direction) = geometry.direction(px) else { continue };
            count += 1;
            let view = geometry.views().find(|view| {
                let ([x0, y0], [w, h]) = (view.first(), view.size());
                (x0..x0 + w).contains(&x) && (y0..y0 + h).contains(&y)
            });
            let back = view.and_then(|view| view.px(direction)).expect("it looks ahead in its view");
            assert!((back - px).length() < 1e-12, "{px} {back}");
        }
    }
    assert_eq!(count, 1600 + 800 + 800 + 680 + 63);
    for face in Face::ALL {
        let [right, down, ahead] = face.axes();
        assert_eq!((right.cross(down), Face::towards(ahead)), (ahead, face));
    }
    assert!(matches!(Cube::new(32, [None; 6]), Err(OpticsError::NoViews)));
    assert!(matches!(Cube::new(32, [window(0, 0, 0, 4); 6]), Err(OpticsError::NoViews)));
}

#[test]
fn a_wider_image_than_the_stored_views_is_refused_and_overscan_helps() {
    let (narrow, small) = equidistant(PI);
    let geometry = PupilProjection::covering(&narrow, &small, [0, 0], RANGE).expect("legal");
    let (wide, large) = limited(Model::Ideal(Ideal::Equidistant), 96.0 / PI, [104, 104], 0.5 * PI * 104.0 / 96.0);
    let refused = Resampling::new(geometry, &wide, &large, [0, 0], bands()).expect_err("8.5° more on each side");
    assert!(matches!(refused, OpticsError::MissingDirections { .. }), "{refused}");
    let more = geometry.overscanned(0.25);
    assert!(Resampling::new(more, &wide, &large, [0, 0], bands()).is_ok());
    let (sphere, full) = equidistant(2.0 * PI);
    let refused = Resampling::new(geometry, &sphere, &full, [0, 0], bands()).expect_err("it looks back");
    assert!(refused.to_string().contains("back view") || refused.to_string().contains("edge"), "{refused}");
}

#[test]
fn distances_are_taken_and_never_averaged() {
    let (lens, raster) = equidistant(PI);
    let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect("legal");
    // The inside of a box about the pupil, with a hole to the sky.
    let distance = |d: DVec3| if d.y < -0.8 { f64::INFINITY } else { 2.0 / d.abs().max_element() };
    let cube = stored(&geometry, distance);
    let mut plane = Plane::<Length>::new(geometry.width(), geometry.height());
    plane.samples_mut().copy_from_slice(cube.planes()[0].samples());
    let resampling = Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect("covered");
    let nearest = resampling.nearest(&plane, f32::NAN).expect("size");
    let mut sky = 0;
    for (x, y, at) in centres(&raster) {
        let value = f64::from(nearest.at(x, y));
        let Some(direction) = lens.direction(at) else {
            assert!(value.is_nan());
            continue;
        };
        sky += u32::from(value.is_infinite());
        if value.is_finite() {
            // Half a stored pixel's diagonal off, at a slope of at most tan 54.7° · d (the box's corner).
            let allowed = 0.71 * geometry.pitch_tan() * 1.42 * value + 1e-6;
            assert!((value - distance(direction.normalize())).abs() < allowed || direction.y < -0.75, "({x}, {y})");
        }
    }
    assert!(sky > 100);
}

/// The directions from a table of field angles equal those traced through the lens.
#[test]
fn a_prescription_is_resampled_by_its_own_chief_rays() {
    for (name, radius_mm) in [("double-gauss", 21.6), ("fisheye", 12.75)] {
        let (lens, raster) = prescription(name, radius_mm);
        let geometry = PupilProjection::covering(&lens, &raster, [0, 0], RANGE).expect(name);
        // A radiance equal to the field angle, which a linear interpolation preserves.
        let angle = |d: DVec3| atan2(d.truncate().length(), d.z);
        let image = Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect(name);
        let image = image.apply(&stored(&geometry, angle)).expect(name);
        for (x, y, at) in centres(&raster).filter(|(_, _, at)| at.length() < 0.97 * radius_mm && at.length() > 2.0) {
            let direct = angle(lens.direction(at).expect("seen"));
            // A quarter of a stored pixel (flat pixels), and the distortion's curvature over a pixel.
            let value = f64::from(image.planes()[1].at(x, y));
            assert!((value - direct).abs() < 0.35 * geometry.pitch_tan(), "{name} ({x}, {y}): {value}, not {direct}");
        }
    }
}

#[test]
fn sides_of_the_cube_are_where_the_axes_point() {
    for angle in [0.0, 0.4, 1.0, 2.0, 3.1] {
        let d = DVec3::new(sin(angle), 0.0, cos(angle));
        let face = Face::towards(d);
        let tangent = face.tangent(d).expect("ahead");
        assert!(tangent.abs().max_element() <= 1.0 + 1e-15 && (face.direction(tangent) - d).length() < 1e-15);
    }
    assert_eq!(Face::towards(DVec3::new(0.1, -0.9, 0.2)), Face::Top, "y points down");
}

/// Both routes have the same dispersion: each pixel of a band equals the view of the rays of its wavelength.
#[test]
fn lateral_colour_moves_each_band_as_its_rays_are_moved() {
    let table = LateralColour::new(vec![(450.0, 1.02), (650.0, 0.98)]).expect("a table");
    let thin = ThinParameters { focal_length_mm: 0.5, f_number: 2.0, focus_distance_m: 3.0, transmittance: 1.0 };
    let barrel = RadialDistortion::new(DistortionDirection::IdealToObserved, -0.1, 0.0, 0.5).expect("legal");
    let raster = Raster::centred(60, 40, PITCH_MM).expect("legal");
    let thin = Lens::thin(thin).and_then(|lens| lens.with_distortion(barrel)).expect("legal");
    let cameras = [
        (thin.with_lateral_colour(table.clone()).expect("legal"), raster),
        {
            let (lens, raster) = equidistant(PI);
            (lens.with_lateral_colour(table.clone()).expect("legal"), raster)
        },
        prescription("wide-angle", 19.2),
    ];
    for (lens, raster) in cameras {
        assert!(lens.disperses() && lens.spreads_colours());
        let range = bands().range();
        let geometry = PupilProjection::covering(&lens, &raster, [0, 0], range).expect("legal");
        let resampling = Resampling::new(geometry, &lens, &raster, [0, 0], bands()).expect("covered");
        let image = resampling.apply(&stored(&geometry, smooth)).expect("size");
        let mut apart = 0.0_f64;
        for (x, y, at) in centres(&raster).filter(|(x, y, _)| (x + y) % 3 == 0) {
            let directions: Vec<Option<f64>> = (0..2).map(|band| through(&lens, at, bands().centre_nm(band))).collect();
            let [Some(a), Some(b)] = directions[..] else { continue };
            apart = apart.max((a - b).abs());
            for (band, direct) in [a, b].into_iter().enumerate() {
                let value = f64::from(image.planes()[band].at(x, y));
                // As above; the mean over a pupil of f/2 and more differs from its centre by the field's curvature.
                let spread = 2.0 * PI / 96.0;
                let allowed = 2.3 * 0.25 * geometry.pitch_tan() + 2.0 * spread * spread;
                assert!(value == 0.0 || (value - direct).abs() < allowed, "({x}, {y}) {band}: {value}, not {direct}");
            }
        }
        assert!(apart > 1e-4, "the bands part by {apart}");
    }
    let (traced, _) = prescription("telephoto", 6.3);
    assert!(matches!(traced.with_lateral_colour(table), Err(OpticsError::OwnColour { .. })));
}

/// The smooth field as the chief ray of a wavelength sees it.
fn through(lens: &Lens, at: DVec2, nm: f64) -> Option<f64> {
    let direction = match lens {
        // The centre of the directions that pass: for a wide-angle lens, within the field's curvature of the chief ray.
        Lens::Prescription(_) => {
            let rays: Vec<DVec3> = (0..64).filter_map(|i| Some(lens.ray(at, pupil_point(i), nm)?.direction)).collect();
            if rays.len() < 32 {
                return None;
            }
            rays.into_iter().sum::<DVec3>()
        }
        _ => lens.ray(at, DVec2::splat(0.5), nm)?.direction,
    };
    Some(smooth(direction.normalize()))
}

fn pupil_point(i: u32) -> DVec2 {
    (DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3) * f64::from(i) + 0.5).fract()
}

/// Films on disk are processed band by band.
#[test]
fn irradiance_band_by_band_is_that_of_the_whole_cube() {
    let edge = Spectrum::from_points(&[(500.0, 1.0), (600.0, 0.2)], Extrapolation::Hold).expect("a spectrum");
    let filter = InterferenceFilter::new(edge, 1.8).expect("a filter");
    let (lens, raster) = filtered("double-gauss", 21.6, Some(filter));
    for (name, lens, raster) in cameras().into_iter().chain([("double Gauss behind a filter", lens, raster)]) {
        let plane = |scale: f64| {
            let mut plane = Plane::<Radiance>::new(raster.width(), raster.height());
            centres(&raster).for_each(|(x, y, at)| plane.set(x, y, (scale * (1.0 + at.length())) as f32));
            plane
        };
        let cube = SpectralCube::from_planes(bands(), vec![plane(1.0), plane(3.0)]).expect("two planes");
        let full_cube = irradiance(&cube, &lens, &raster).expect(name);
        let band = BandEtendue::new(&lens, &raster);
        for (i, radiance) in cube.planes().iter().enumerate() {
            let alone = band.irradiance(radiance, bands().centre_nm(i)).expect(name);
            assert_eq!(alone.samples(), full_cube.planes()[i].samples(), "{name}, band {i}");
        }
        if name.ends_with("filter") {
            let [first, second] = [0, 1].map(|i| full_cube.planes()[i].samples()[raster.width() * raster.height() / 2]);
            assert!(second < 2.5 * first, "the filter takes from the second band: {first} {second}");
        }
    }
}
