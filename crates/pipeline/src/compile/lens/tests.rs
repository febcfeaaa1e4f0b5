//! Lenses of descriptions: their models, and the places of their errors.

use crate::compile::{Choices, compile};
use crate::plan::{CameraPlan, Plan};
use crate::render::rays::ray_table;
use etendue_optics::Lens;
use etendue_scene::asset::{
    ASPHERE_TERMS, Assets, GlassAsset, LensFields, LensOpening, NamedGlass, PrescriptionAsset, SurfaceAsset,
};
use etendue_scene::{Description, Overrides};
use etendue_spectra::glass::by_name;
use std::path::Path;

fn plan_with(lens: &str, further: &str, assets: &Assets) -> Result<Plan, String> {
    let text = format!(
        "format = 1\nscene = {{}}\n[[cameras]]\nname = \"a\"\nposition_m = [0, 0, 1]\nlook_at_m = [10, 0, 1]\n\
         sensor = {{ width_px = 64, height_px = 48, pixel_pitch_um = 100 }}\n[cameras.lens]\n{lens}\n{further}"
    );
    let read = |_: &Path| Ok(text.clone());
    let job = Description::load(Path::new("job.toml"), &read, &Overrides::default()).map_err(|f| f.to_string())?;
    let errors = |list: Vec<etendue_scene::DescriptionError>| list.iter().map(|f| format!("{f}\n")).collect::<String>();
    compile(&job, assets, &Choices::default()).map_err(errors)
}

fn camera(lens: &str) -> CameraPlan {
    plan_with(lens, "", &Assets::default()).unwrap_or_else(|errors| panic!("{errors}")).cameras.remove(0)
}

fn refused(lens: &str, further: &str, words: &[&str]) {
    let text = plan_with(lens, further, &Assets::default()).map(|_| ()).expect_err(lens);
    assert!(words.iter().all(|word| text.contains(word)), "{words:?} in {text}");
}

const GAUSS: &str = "type = \"prescription\"\npublished = \"double-gauss\"\nfocus_distance_m = \"infinity\"\n";

/// A biconvex singlet with its stop in front.
fn singlet(front: &str) -> String {
    format!(
        "type = \"prescription\"\nfocus_distance_m = \"infinity\"\nsurfaces = [\n\
         {{ thickness_mm = 1, semi_aperture_mm = 2, stop = true }},\n{{ radius_mm = 30, {front} }},\n\
         {{ radius_mm = -30, semi_aperture_mm = 5 }},\n]\n"
    )
}

#[test]
fn a_published_lens_is_traced_and_carries_one_wavelength_a_path() {
    let camera = camera(&format!("{GAUSS}f_number = 4\n"));
    let Lens::Prescription(lens) = &camera.body.lens else { panic!("a prescription") };
    assert!((lens.prescription().paraxial().f_number() - 4.0).abs() < 1e-9);
    assert_eq!(camera.settings.wavelengths, 1);
    refused(GAUSS, "[render]\nwavelengths_per_path = 8", &["wavelengths_per_path", "remove the key"]);
    // At the pupil each band is resampled by its own chief rays: paths carry four wavelengths.
    let pupil = plan_with(GAUSS, "[render]\nroute = \"pupil\"", &Assets::default()).expect("a plan");
    assert_eq!(pupil.cameras[0].settings.wavelengths, 4);
}

#[test]
fn glasses_are_given_by_name_or_numbers() {
    let focal = |glass: &str| {
        let camera = camera(&singlet(&format!("thickness_mm = 3, semi_aperture_mm = 5, glass = {glass}")));
        (camera.body.lens.focal_length_mm(), camera.settings.wavelengths)
    };
    // N-BK7 by its name, by Schott's Sellmeier coefficients, by n_d and V_d, and without dispersion.
    let by_name = focal("\"N-BK7\"");
    let sellmeier = "{ sellmeier_b = [1.03961212, 0.231792344, 1.01046945], sellmeier_c_um2 = [0.00600069867, 0.0200179144, 103.560653] }";
    for (glass, wavelengths) in [(sellmeier, 1), ("{ index = 1.5168, abbe = 64.17 }", 1), ("{ index = 1.5168 }", 4)] {
        let actual = focal(glass);
        // n_d is given to five digits: 1e-6 / (n − 1).
        assert!((actual.0 / by_name.0 - 1.0).abs() < 1e-5 && actual.1 == wavelengths, "{glass}: {actual:?}");
    }
}

#[test]
fn faults_of_prescriptions_name_their_place() {
    refused(
        "type = \"prescription\"\npublished = \"biotar\"\nfocus_distance_m = 1\n",
        "",
        &["published", "double-gauss"],
    );
    refused(&singlet("thickness_mm = 3, semi_aperture_mm = 5, glass = \"BK8\""), "", &["surfaces", "glass", "BK8"]);
    refused(&singlet("thickness_mm = 0.1, semi_aperture_mm = 5, glass = \"N-BK7\""), "", &["overlap", "surfaces"]);
    refused(&singlet("semi_aperture_mm = 5, glass = \"N-BK7\""), "", &["thickness_mm"]);
    refused(&GAUSS.replace("\"infinity\"", "0"), "", &["focus_distance_m", "above 0"]);
    refused(&format!("{GAUSS}f_number = 1\n"), "", &["f_number", "opens to"]);
    refused(&format!("{GAUSS}focus_by = [3, 90]\n"), "", &["focus_by", "range"]);
    refused(&format!("{GAUSS}semi_apertures_mm = [3]\n"), "", &["semi_apertures_mm", "no effect"]);
    let filter = "ir_cut = { edge_nm = 650, effective_index = 1.8 }\n";
    refused(&format!("{GAUSS}{filter}"), "", &["edge_width_nm"]);
}

fn file_surface(radius_mm: f64, semi_aperture_mm: Option<f64>, glass: GlassAsset, stop: bool) -> SurfaceAsset {
    let (conic, asphere, thickness_mm, line) = (0.0, [0.0; ASPHERE_TERMS], 3.0, 12);
    SurfaceAsset {
        mirror: false,
        thin_lens_mm: None,
        radius_mm,
        conic,
        asphere,
        semi_aperture_mm,
        obscured_radius_mm: 0.0,
        clips_light: false,
        thickness_mm,
        glass,
        stop,
        line,
    }
}

#[test]
fn a_file_without_apertures_is_refused_by_line_and_served_by_a_list() {
    let mut assets = Assets::default();
    let glass = GlassAsset::Named(Box::new(NamedGlass::built_in(by_name("N-BK7").expect("a glass"))));
    let surfaces = vec![file_surface(30.0, None, glass, true), file_surface(-30.0, Some(5.0), GlassAsset::Air, false)];
    let asset = PrescriptionAsset {
        title: String::new(),
        surfaces,
        object_distance_mm: f64::INFINITY,
        back_focus_mm: 28.0,
        defocus_mm: 0.0,
        opening: None,
        opening_line: 0,
        fields: None,
        vignetting: [Vec::new(), Vec::new()],
        wavelengths_nm: Vec::new(),
        primary_nm: None,
        notes: Vec::new(),
        hash: [0; 32],
    };
    assets.prescriptions.insert(("lens.zmx".into(), Vec::new()), asset);
    let lens = "type = \"prescription\"\nfile = \"lens.zmx\"\nfocus_distance_m = \"infinity\"\n";
    let text = plan_with(lens, "", &assets).map(|_| ()).expect_err("no aperture");
    assert!(text.contains("1 (line 12)") && text.contains("semi_apertures_mm"), "{text}");
    let served = plan_with(&format!("{lens}semi_apertures_mm = [2, 5]\n"), "", &assets);
    assert!(served.is_ok(), "{:?}", served.map(|_| ()));
}

/// A singlet before its stop, with unknown apertures.
fn open_asset(opening: Option<LensOpening>, fields: Option<LensFields>) -> PrescriptionAsset {
    let glass = GlassAsset::Abbe { index: 1.5168, abbe: 64.17 };
    let surfaces = vec![
        file_surface(12.0, None, glass, false),
        file_surface(-9.5, None, GlassAsset::Air, false),
        file_surface(f64::INFINITY, None, GlassAsset::Air, true),
    ];
    PrescriptionAsset {
        title: String::new(),
        surfaces,
        object_distance_mm: f64::INFINITY,
        back_focus_mm: 0.0,
        defocus_mm: 0.0,
        opening,
        opening_line: 3,
        fields,
        vignetting: [Vec::new(), Vec::new()],
        wavelengths_nm: Vec::new(),
        primary_nm: None,
        notes: Vec::new(),
        hash: [0; 32],
    }
}

fn plan_of_file(asset: PrescriptionAsset) -> Result<Plan, String> {
    let mut assets = Assets::default();
    assets.prescriptions.insert(("lens.seq".into(), Vec::new()), asset);
    plan_with("type = \"prescription\"\nfile = \"lens.seq\"\n", "", &assets)
}

fn found_apertures(asset: PrescriptionAsset) -> (Vec<f64>, f64) {
    let plan = plan_of_file(asset).unwrap_or_else(|errors| panic!("{errors}"));
    let Lens::Prescription(lens) = &plan.cameras[0].body.lens else { panic!("a prescription") };
    let lens = lens.prescription();
    (lens.surfaces().iter().map(|s| s.semi_aperture_mm).collect(), lens.paraxial().entrance_radius_mm)
}

#[test]
fn clear_apertures_that_a_file_leaves_open_are_those_of_its_fields() {
    let pupil = Some(LensOpening::EntrancePupil { diameter_mm: 0.02 });
    let fields = |list: &[f64]| Some(LensFields::AnglesDeg(list.to_vec()));
    // Narrow enough that the heights are those of the chief rays, and small enough for first order.
    let [[near, _, _], [distant, _, _]] = [1.0, 2.0]
        .map(|deg| <[f64; 3]>::try_from(found_apertures(open_asset(pupil, fields(&[0.0, deg]))).0).expect("three"));
    assert!(near > 0.05 && (distant / near - 2.0).abs() < 0.1, "{near} {distant}");
    let (axis, entrance_mm) = found_apertures(open_asset(pupil, fields(&[0.0])));
    assert!((entrance_mm - 0.01).abs() < 1e-9 && (axis[0] - 0.01).abs() < 1e-6, "{axis:?}");
    // Vignetting factors remove the outer rays.
    let wide = Some(LensOpening::EntrancePupil { diameter_mm: 2.0 });
    let mut vignetted = open_asset(wide, fields(&[0.0, 8.0]));
    let unvignetted = found_apertures(vignetted.clone()).0;
    vignetted.vignetting = [vec![0.0, 0.5], vec![0.0, 0.5]];
    let clipped = found_apertures(vignetted).0;
    assert!(unvignetted[0] - clipped[0] > 0.3 && unvignetted[2] == clipped[2], "{unvignetted:?} {clipped:?}");
}

/// A baffle of 0.8 of the pupil's radius before the lens transmits 0.64 of the light on the axis.
#[test]
fn a_baffle_of_a_file_takes_light_on_the_axis() {
    let light = |baffle: bool| {
        let pupil = Some(LensOpening::EntrancePupil { diameter_mm: 0.1 });
        let mut asset = open_asset(pupil, Some(LensFields::AnglesDeg(vec![0.0])));
        asset.surfaces.rotate_right(1);
        asset.surfaces[0].semi_aperture_mm = Some(0.05);
        let mut plane = file_surface(f64::INFINITY, Some(0.04), GlassAsset::Air, false);
        plane.clips_light = true;
        if baffle {
            asset.surfaces.insert(0, plane);
        }
        let lens = plan_of_file(asset).unwrap_or_else(|errors| panic!("{errors}")).cameras.remove(0).body.lens;
        (lens.projected_solid_angle_sr(glam::DVec2::ZERO), lens.f_number())
    };
    let ([open_sr, n], [clipped_sr, clipped_n]) = (<[f64; 2]>::from(light(false)), <[f64; 2]>::from(light(true)));
    assert!((clipped_sr / open_sr - 0.64).abs() < 1e-4, "{clipped_sr} of {open_sr}");
    assert!((clipped_n / n - 1.25).abs() < 1e-9, "{clipped_n} for {n}");
}

#[test]
fn a_file_that_says_too_little_of_its_light_is_refused() {
    let pupil = Some(LensOpening::EntrancePupil { diameter_mm: 2.0 });
    let message = |opening, fields| plan_of_file(open_asset(opening, fields)).map(|_| ()).expect_err("refused");
    let angles = |deg: f64| Some(LensFields::AnglesDeg(vec![deg]));
    assert!(message(pupil, None).contains("1 (line 12)") && message(pupil, None).contains("no fields"));
    assert!(message(None, angles(5.0)).contains("no aperture (EPD, FNO, NA)"));
    assert!(message(pupil, angles(85.0)).contains("field 1 does not pass the lens"));
    assert!(message(pupil, Some(LensFields::ObjectMm(vec![5.0]))).contains("an object at infinity"));
}

#[test]
fn the_cone_to_the_image_opens_the_lens_for_its_object() {
    let cone = |sine: f64, object_distance_mm: f64| {
        let fields = Some(LensFields::AnglesDeg(vec![0.0]));
        PrescriptionAsset { object_distance_mm, ..open_asset(Some(LensOpening::ImageCone { sine }), fields) }
    };
    let distant = plan_of_file(cone(0.05, f64::INFINITY)).expect("a lens");
    let Lens::Prescription(lens) = &distant.cameras[0].body.lens else { panic!("a prescription") };
    let [f_mm, n] = [lens.prescription().paraxial().focal_length_mm, lens.prescription().paraxial().f_number()];
    assert!((n - 10.0).abs() < 1e-9, "{n}");
    // At unit magnification the object's cone is the image's.
    let near = found_apertures(cone(0.05, 2.0 * f_mm - lens.prescription().paraxial().front_principal_mm));
    let distance_mm = 2.0 * f_mm - lens.prescription().paraxial().front_principal_mm
        + lens.prescription().paraxial().entrance_pupil_position_mm;
    let expected_mm = 0.05 / (1.0_f64 - 0.05 * 0.05).sqrt() * distance_mm;
    assert!((near.1 / expected_mm - 1.0).abs() < 1e-6, "{near:?} {expected_mm}");
    let message = plan_of_file(cone(0.9, 11.0)).map(|_| ()).expect_err("too large a cone");
    assert!(message.contains("(line 3)") && message.contains("cone of half-angle sine"), "{message}");
}

/// 64 × 48 px: outside the image, and as with a calibration of an image a third of the size.
#[test]
fn principal_points_far_from_the_middle_are_warned_of() {
    let warnings = |cx: f64, cy: f64| {
        let lens = format!(
            "type = \"calibrated\"\nf_number = 2\nprojection = {{ type = \"opencv\", fx_px = 60, cx_px = {cx}, cy_px = {cy} }}\n"
        );
        plan_with(&lens, "", &Assets::default()).unwrap_or_else(|errors| panic!("{errors}")).warnings().join("\n")
    };
    assert!(warnings(70.0, 24.0).contains("outside the image"));
    assert!(warnings(11.0, 8.0).contains("far from the centre of the image of 64 × 48 px"));
    assert!(!warnings(38.0, 20.0).contains("principal point"));
}

#[test]
fn calibrated_cameras_take_their_numbers_as_they_are_written() {
    let lens = "type = \"calibrated\"\nf_number = 2\n\
                projection = { type = \"kannala_brandt\", fx_px = 20, fy_px = 21, cx_px = 30, cy_px = 25, k = [0.01, 0, 0, 0] }\n";
    let plan = camera(lens);
    assert_eq!(plan.body.raster.principal_px().to_array(), [30.0, 25.0]);
    let Lens::Calibrated(lens) = &plan.body.lens else { panic!("calibrated") };
    assert_eq!(lens.parameters().calibration.matrix().fy, 21.0);
    let prism = camera(
        "type = \"calibrated\"\nf_number = 2\nprojection = { type = \"thin_prism_fisheye\", fx_px = 20, k = [0.01, 0, 0, 0, 0, 0], \
         p = [0.001, 0.002], s = [0.003, 0, 0.004, 0] }\n",
    );
    let Lens::Calibrated(lens) = &prism.body.lens else { panic!("calibrated") };
    // r = θ (1 + k1 θ²) = 1.01 along x at θ = 1: x′ = r + 3 p2 r² + s1 r², y′ = p1 r² + s3 r².
    let (sin, cos) = etendue_core::maths::f64::sin_cos(1.0);
    let image_mm = lens.parameters().calibration.project(glam::DVec3::new(sin, 0.0, cos)).expect("seen");
    let square = 1.01 * 1.01;
    let expected = glam::DVec2::new(1.01 + 0.009 * square, 0.005 * square) * 20.0 + glam::DVec2::new(32.0, 24.0);
    assert!((image_mm - expected).length() < 1e-12, "{image_mm} for {expected}");
    let full = camera(
        "type = \"calibrated\"\nf_number = 2\nprojection = { type = \"equirectangular\", field_of_view_deg = 360 }\n",
    );
    let Lens::Calibrated(lens) = &full.body.lens else { panic!("calibrated") };
    assert!((lens.parameters().calibration.matrix().fx * 2.0 * core::f64::consts::PI / 64.0 - 1.0).abs() < 1e-11);
}

#[test]
fn faults_of_calibrations_name_their_place() {
    let camera = |projection: &str| format!("type = \"calibrated\"\nf_number = 2\nprojection = {{ {projection} }}\n");
    refused(&camera("type = \"rectilinear\", field_of_view_deg = 200"), "", &["field_of_view_deg", "180"]);
    refused(&camera("type = \"kannala_brandt\", fx_px = 20, k = [-0.5, 0, 0, 0]"), "", &["folds", "radius"]);
    refused(&camera("type = \"equidistant\", focal_length_mm = 2, fy_px = 20"), "", &["fy_px", "no effect"]);
    refused(&camera("type = \"opencv\", fx_px = 60, distortion = [0.1, 0.2]"), "", &["lens"]);
    let parallel = "type = \"telecentric\"\nfield_width_m = 3\nf_number = 2\n";
    refused(parallel, "[render]\nroute = \"pupil\"", &["render.route", "telecentric camera"]);
}

/// The ray table inverts any pixel: it has the calibration's own direction, and NaN where nothing is seen.
#[test]
fn the_ray_table_is_the_calibration() {
    let plan = camera(
        "type = \"calibrated\"\nf_number = 2\ngreatest_angle_deg = 60\nprojection = { type = \"equidistant\", fx_px = 25 }\n",
    );
    let table = ray_table(&plan.body);
    let Lens::Calibrated(lens) = &plan.body.lens else { panic!("calibrated") };
    let mut dark = 0;
    for (i, direction) in table.direction.samples().iter().enumerate() {
        let px = glam::DVec2::new((i % 64) as f64 + 0.5, (i / 64) as f64 + 0.5);
        match lens.parameters().calibration.unproject(px) {
            Some(exact) => assert!((exact.as_vec3() - glam::Vec3::from_array(*direction)).length() < 1e-6),
            None => assert!(direction[0].is_nan() && table.ray.samples()[i] == 0),
        }
        dark += usize::from(direction[0].is_nan());
    }
    // 60° is a circle of 25 π/3 = 26.2 px around the centre of 64 × 48: it excludes some of the corners.
    let lit = 64 * 48 - dark;
    assert!((1700..2154).contains(&lit), "{lit}");
}

#[test]
fn no_lens_is_faster_than_half() {
    let models = [
        "type = \"pinhole\"\nfocal_length_mm = 6\n",
        "type = \"thin\"\nfocal_length_mm = 6\nfocus_distance_m = 5\n",
        "type = \"thick\"\nfocal_length_mm = 6\nfocus_distance_m = 5\nconstant_pupil = \"exit\"\n",
        "type = \"calibrated\"\nprojection = { type = \"equidistant\", fx_px = 25 }\n",
        "type = \"telecentric\"\nfield_width_m = 1\n",
    ];
    for model in models {
        refused(&format!("{model}f_number = 0.001\n"), "", &["f_number", "0.5"]);
        // Light on the axis is at most that of the whole half space: E/L = π.
        let light = camera(&format!("{model}f_number = 0.5\n")).body.lens.projected_solid_angle_sr(glam::DVec2::ZERO);
        assert!(light <= core::f64::consts::PI * (1.0 + 1e-12), "{model}: {light}");
    }
    refused("type = \"pinhole\"\nfocal_length_mm = 1e-9\nf_number = 2\n", "", &["focal lengths", "sideways"]);
}

#[test]
fn fields_whose_edge_lies_at_infinity_are_refused() {
    let view = |kind: &str, deg: f64| {
        let projection = format!("projection = {{ type = \"{kind}\", field_of_view_deg = {deg} }}\n");
        format!("type = \"calibrated\"\nf_number = 2\n{projection}")
    };
    refused(&view("rectilinear", 180.0), "", &["does not reach 180°", "less than 180"]);
    refused(&view("rectilinear", 360.0), "", &["does not reach 360°", "less than 180"]);
    refused(&view("stereographic", 360.0), "", &["does not reach 360°", "less than 360"]);
    for (kind, deg) in [("rectilinear", 178.0), ("stereographic", 358.0), ("equidistant", 360.0), ("equisolid", 360.0)]
    {
        camera(&view(kind, deg));
    }
    let tiny = "type = \"calibrated\"\nf_number = 2\nprojection = { type = \"rectilinear\", fx_px = 1e-6 }\n";
    refused(tiny, "", &["focal lengths", "sideways"]);
}

#[test]
fn a_distortion_that_is_none_of_a_lens_is_refused() {
    for k1 in ["1e308", "-1e308", "1e30", "-1e30"] {
        for direction in ["ideal_to_observed", "observed_to_ideal"] {
            let distortion = format!("k1 = {k1}, direction = \"{direction}\", radius_unit = \"focal_lengths\"");
            let lens =
                format!("type = \"pinhole\"\nfocal_length_mm = 6\nf_number = 2\ndistortion = {{ {distortion} }}\n");
            refused(&lens, "", &["distortion"]);
        }
        let models = [
            format!("type = \"opencv\", fx_px = 25, distortion = [{k1}, 0, 0, 0]"),
            format!("type = \"kannala_brandt\", fx_px = 25, k = [{k1}, 0, 0, 0]"),
            format!("type = \"radial\", fx_px = 25, k1 = {k1}, direction = \"ideal_to_observed\""),
            format!("type = \"radial\", fx_px = 25, k1 = {k1}, direction = \"observed_to_ideal\""),
            format!("type = \"division\", fx_px = 25, k = {k1}"),
        ];
        for model in models {
            let lens = format!("type = \"calibrated\"\nf_number = 2\nprojection = {{ {model} }}\n");
            refused(&lens, "", &["lens"]);
        }
    }
    camera(
        "type = \"pinhole\"\nfocal_length_mm = 6\nf_number = 2\ndistortion = { k1 = -0.2, k2 = 0.05, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }\n",
    );
}
