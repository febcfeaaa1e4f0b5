//! Ground truth against geometry.

use etendue_core::maths::f64::{sin_cos, tan};
use etendue_pipeline::summary::Summary;
use etendue_scene::asset::{MeshAsset, SlotMaterial};
use etendue_tests::{Job, Shot};
use glam::{DVec2, DVec3};

/// f32 storage rounds by 6e-8; the solution itself is f64. The specification grants 1e-6.
const RELATIVE: f64 = 1e-6;

fn camera(height_m: f64, lens: &str, side_px: usize, pitch_um: f64) -> String {
    format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [0, 0, {height_m}]
        rotation_deg = [0, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = 10, f_number = 8{lens} }}
        sensor = {{ width_px = {side_px}, height_px = {side_px}, pixel_pitch_um = {pitch_um} }}
        [render]
        spp = 1
        replicates = 1
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        "#
    )
}

/// Unit direction in the world of a pixel's centre, from the camera matrix and the distortion that side-cars state
/// (ideal = observed where there is none). The camera looks along +x: its x is −y of the world, its y is −z.
fn direction(shot: &Shot, pixel: usize) -> DVec3 {
    let body = &shot.camera().body;
    let matrix = body.raster.camera_matrix(body.lens.principal_distance_mm());
    let width = body.raster.width();
    let px = DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
    let observed = DVec2::new((px.x - matrix.cx) / matrix.fx, (px.y - matrix.cy) / matrix.fy);
    let ideal = body.lens.distortion().map_or(observed, |d| {
        let [k1, k2] = d.coefficients();
        undistorted(observed, k1, k2)
    });
    DVec3::new(1.0, -ideal.x, -ideal.y).normalize()
}

/// The ideal point whose image is `observed`, r′ = r (1 + k₁ r² + k₂ r⁴) in focal lengths, by bisection.
fn undistorted(observed: DVec2, k1: f64, k2: f64) -> DVec2 {
    let target = observed.length();
    let (mut low, mut high) = (0.0, 2.0 * target);
    for _ in 0..200 {
        let r = 0.5 * (low + high);
        if r * (1.0 + k1 * r * r + k2 * r * r * r * r) < target { low = r } else { high = r }
    }
    if target == 0.0 { observed } else { observed * (low / target) }
}

fn relative(actual: f32, truth: f64) -> f64 {
    (f64::from(actual) / truth - 1.0).abs()
}

const GROUND: &str = r#"
    [classes]
    road = 7
    ball = 3
    [[materials]]
    name = "other"
    type = "diffuse"
    reflectance = 0.2
    [[materials]]
    name = "grey"
    type = "diffuse"
    reflectance = 0.5
"#;

fn scene(objects: &str) -> String {
    let text = GROUND.replace("[[", "[[scene.").replace("[classes]", "[scene.classes]");
    format!("{text}\n{objects}")
}

fn assert_same_vector(actual: [f32; 3], truth: DVec3, tolerance: f64, subject: &str) {
    let error = (DVec3::from_array(actual.map(f64::from)) - truth).length();
    assert!(error <= tolerance, "{subject}: {actual:?} for {truth}, off by {error:e}");
}

#[test]
fn a_plane_is_where_it_is_up_to_grazing_incidence() {
    let ground = "[[scene.objects]]\nname = \"road\"\nclass = \"road\"\nmaterial = \"grey\"\nshape = { type = \"quad\", size_m = [4000, 4000] }";
    let (side, height) = (64, 1.3);
    // The rows below the middle look down by 0.5 … 31.5 pitches of tan 0.6°: incidence from 89.7° to about 71°.
    let pitch_um = 1e4 * tan(0.6_f64.to_radians());
    let shot = Job::new(camera(height, "", side, pitch_um) + &scene(ground)).shot();
    let truth = shot.truth();
    let mut steepest: f64 = 0.0;
    for pixel in 0..side * side {
        let (x, y) = (pixel % side, pixel / side);
        let ray = direction(&shot, pixel);
        if y < side / 2 {
            assert_eq!((truth.depth.at(x, y), truth.distance.at(x, y)), (f32::INFINITY, f32::INFINITY));
            assert_eq!((truth.instance.at(x, y), truth.semantic.at(x, y), truth.material.at(x, y)), (0, 0, 0));
            assert_eq!((truth.normal.at(x, y), truth.position.at(x, y)), ([0.0; 3], [0.0; 3]));
            continue;
        }
        let distance = -height / ray.z;
        let hit = ray * distance;
        let incidence = etendue_core::maths::f64::acos(-ray.z).to_degrees();
        steepest = steepest.max(incidence);
        assert!(relative(truth.distance.at(x, y), distance) < RELATIVE, "{incidence}°: {}", truth.distance.at(x, y));
        assert!(relative(truth.depth.at(x, y), hit.x) < RELATIVE, "{incidence}°: {}", truth.depth.at(x, y));
        assert_same_vector(truth.position.at(x, y), hit + DVec3::Z * height, RELATIVE * distance, "position");
        assert_eq!(truth.normal.at(x, y), [0.0, 0.0, 1.0]);
        assert_eq!((truth.instance.at(x, y), truth.semantic.at(x, y), truth.material.at(x, y)), (1, 7, 2));
    }
    assert!(steepest > 89.4, "the steepest incidence was {steepest}°");
}

/// Distance to a sphere along a unit direction from the origin, without cancellation; `None` where it passes by.
fn sphere_distance(ray: DVec3, centre: DVec3, radius: f64) -> Option<f64> {
    let along = ray.dot(centre);
    let lateral = (centre - ray * along).length();
    (lateral < radius).then(|| along - ((radius - lateral) * (radius + lateral)).sqrt())
}

#[test]
fn spheres_are_where_they_are_up_to_their_limbs() {
    let side = 96;
    let centres = [DVec3::new(10.0, 0.7, -0.4), DVec3::new(500.0, -30.0, 40.0)];
    let radii = [1.5, 60.0];
    let object = |i: usize| {
        let c = centres[i];
        format!(
            "[[scene.objects]]\nname = \"ball {i}\"\nclass = \"ball\"\nmaterial = \"other\"\nposition_m = [{}, {}, {}]\nrotation_deg = [10, 20, 30]\n\
             shape = {{ type = \"sphere\", radius_m = {} }}\n",
            c.x, c.y, c.z, radii[i]
        )
    };
    let shot = Job::new(camera(0.0, "", side, 50.0) + &scene(&(object(0) + &object(1)))).shot();
    let truth = shot.truth();
    let (mut counts, mut steepest) = ([0; 3], 0.0_f64);
    for pixel in 0..side * side {
        let (x, y) = (pixel % side, pixel / side);
        let ray = direction(&shot, pixel);
        let hits = [0, 1].map(|i| sphere_distance(ray, centres[i], radii[i]));
        let nearest = [0, 1].into_iter().filter_map(|i| Some((hits[i]?, i))).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((distance, i)) = nearest else {
            assert_eq!((truth.depth.at(x, y), truth.instance.at(x, y)), (f32::INFINITY, 0));
            counts[2] += 1;
            continue;
        };
        counts[i] += 1;
        let normal = (ray * distance - centres[i]) / radii[i];
        let incidence = etendue_core::maths::f64::acos(-normal.dot(ray)).to_degrees();
        let label = format!("pixel {x}, {y}, ball {i}, incidence {incidence}°");
        assert_eq!((truth.instance.at(x, y), truth.semantic.at(x, y), truth.material.at(x, y)), (i as u32 + 1, 3, 1));
        if incidence <= 89.4 {
            steepest = steepest.max(incidence);
            assert!(relative(truth.distance.at(x, y), distance) < RELATIVE, "{label}");
            assert!(relative(truth.depth.at(x, y), distance * ray.x) < RELATIVE, "{label}");
            // f32 storage: half a unit in the last place of each component below 1, together below 1e-7.
            assert_same_vector(truth.normal.at(x, y), normal, 1e-7, &label);
            assert_same_vector(truth.position.at(x, y), ray * distance, RELATIVE * distance, &label);
        }
    }
    assert!(counts.iter().all(|n| *n > 200) && steepest > 85.0, "{counts:?}, steepest {steepest}°");
}

#[test]
fn back_projection_through_matrix_and_distortion_lands_on_the_geometry() {
    let lens =
        ", distortion = { k1 = -0.12, k2 = 0.03, direction = \"ideal_to_observed\", radius_unit = \"focal_lengths\" }";
    let wall = "[[scene.objects]]\nname = \"wall\"\nmaterial = \"grey\"\nposition_m = [5, 0, 0]\nrotation_deg = [0, -90, 0]\nshape = { type = \"quad\", size_m = [100, 100] }";
    let side = 48;
    let shot = Job::new(camera(0.2, lens, side, 200.0) + &scene(wall)).shot();
    let truth = shot.truth();
    for pixel in 0..side * side {
        let (x, y) = (pixel % side, pixel / side);
        let ray = direction(&shot, pixel);
        let (position, camera_m) = (ray * (5.0 / ray.x), DVec3::Z * 0.2);
        assert!(relative(truth.depth.at(x, y), 5.0) < RELATIVE);
        assert!(relative(truth.distance.at(x, y), position.length()) < RELATIVE, "{x}, {y}");
        assert_same_vector(truth.position.at(x, y), position + camera_m, 2.0 * RELATIVE * 5.0, "position");
    }
    let (matrix, plain) = (shot.camera().body.raster.camera_matrix(10.0), 10.0 / 0.2);
    assert!(
        (matrix.fx - plain).abs() < 1e-9 && (matrix.cx - 24.0).abs() < 1e-12,
        "the matrix is f/pitch and the middle"
    );
}

#[test]
fn a_mesh_far_from_the_origin_keeps_its_digits() {
    // A box seen from 3 m, all of it a thousand kilometres from the world's origin: f64 holds 1e-10 m there.
    let far = 1e6;
    let cube = format!(
        "[[scene.objects]]\nname = \"box\"\nclass = \"ball\"\nmaterial = \"grey\"\nposition_m = [{}, {far}, {far}]\nshape = {{ type = \"box\", size_m = [1, 1, 1] }}",
        far + 3.5
    );
    let text = camera(0.0, "", 16, 100.0) + &scene(&cube);
    let shot =
        Job::new(text).replacing("position_m = [0, 0, 0]", &format!("position_m = [{far}, {far}, {far}]")).shot();
    let truth = shot.truth();
    for pixel in 0..256 {
        // The box's face stands square to the view at 3 m.
        assert!(
            relative(truth.depth.at(pixel % 16, pixel / 16), 3.0) < RELATIVE,
            "{}",
            truth.depth.at(pixel % 16, pixel / 16)
        );
        assert!(relative(truth.distance.at(pixel % 16, pixel / 16), 3.0 / direction(&shot, pixel).x) < RELATIVE);
    }
}

#[test]
fn a_panorama_tells_positions_behind_the_camera() {
    // 64 × 32 px of the whole sphere: the longitude grows to the right from −180°, the latitude falls from 90° to −90°.
    let ground = "[[scene.objects]]\nname = \"road\"\nclass = \"road\"\nmaterial = \"grey\"\nshape = { type = \"quad\", size_m = [4000, 4000] }";
    let pinhole = "{ type = \"pinhole\", focal_length_mm = 10, f_number = 8 }";
    let panorama =
        "{ type = \"calibrated\", f_number = 8, projection = { type = \"equirectangular\", field_of_view_deg = 360 } }";
    let output = "\n[output]\nground_truth = true\ncamera_space_position = true\n";
    let job = Job::new(camera(1.3, "", 64, 10.0) + output + &scene(ground));
    let shot = job.replacing(pinhole, panorama).replacing("height_px = 64", "height_px = 32").shot();
    let truth = shot.truth();
    let position = truth.camera_space_position.as_ref().expect("asked for");
    for (x, y) in (0..32).flat_map(|y| (0..64).map(move |x| (x, y))) {
        let step = core::f64::consts::TAU / 64.0;
        let ((sin_lon, cos_lon), (down, level)) =
            (sin_cos((x as f64 - 31.5) * step), sin_cos((y as f64 - 15.5) * step));
        let expected =
            if down > 0.0 { DVec3::new(sin_lon * level, down, cos_lon * level) * (1.3 / down) } else { DVec3::ZERO };
        assert_same_vector(position.at(x, y), expected, RELATIVE * expected.length(), "camera space");
        assert_eq!(
            truth.depth.at(x, y).is_nan(),
            cos_lon < 0.0,
            "depth along the axis means nothing behind the camera"
        );
    }
    let plan = Summary(&shot.plan).to_string();
    assert!(!plan.contains("NaN"), "the signed z is asked for: {plan}");
}

#[test]
fn the_plan_says_where_depth_along_the_axis_means_nothing() {
    let pinhole = "{ type = \"pinhole\", focal_length_mm = 10, f_number = 8 }";
    let fisheye = "{ type = \"calibrated\", f_number = 8, greatest_angle_deg = 100, projection = { type = \"equidistant\", fx_px = 15 } }";
    let ball = "[[scene.objects]]\nname = \"ball\"\nmaterial = \"grey\"\nshape = { type = \"sphere\", radius_m = 1 }\nposition_m = [5, 0, 0]";
    let job = || Job::new(camera(0.0, "", 64, 10.0) + &scene(ball));
    let mentions_nan = |job: Job| Summary(&job.shot().plan).to_string().contains("depth along the axis is NaN");
    assert!(!mentions_nan(job()));
    assert!(mentions_nan(job().replacing(pinhole, fisheye)));
}

/// A square of 1.1 m that stands across the axis, as a survey's file has it, with its middle taken off.
fn surveyed() -> MeshAsset {
    let corners = [[-0.55, -0.55], [0.55, -0.55], [0.55, 0.55], [-0.55, 0.55]];
    MeshAsset {
        origin: [500_004.45, 5_400_000.3, 100.7],
        positions: corners.iter().map(|[y, z]| [0.0, *y, *z]).collect(),
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        slots: vec![0, 0],
        slot_materials: vec![SlotMaterial { name: String::new(), surface: None }],
        ..MeshAsset::default()
    }
}

#[test]
fn a_mesh_in_map_coordinates_is_where_its_file_says() {
    let mesh = "[[scene.meshes]]\nname = \"m\"\nfile = \"m.obj\"\nup_axis = \"z\"\nforward_axis = \"x\"\n";
    // As it stands in the world; and turned, enlarged and moved before a camera at the origin: 1 000 013.3 − 2 · 500 004.45.
    let turned = "rotation_deg = [180, 0, 0]\nscale = 2\nposition_m = [1000013.3, 10800000.6, -201.4]\n";
    let cases = [("", "[500000, 5400000.3, 100.7]", 4.45), (turned, "[0, 0, 0]", 4.4)];
    for (place, eye, expected) in cases {
        let object = format!("[[scene.objects]]\nname = \"o\"\nmaterial = \"grey\"\nmesh = \"m\"\n{place}");
        let eye = camera(0.0, "", 8, 50.0).replace("position_m = [0, 0, 0]", &format!("position_m = {eye}"));
        let shot = Job::new(eye + &scene(&(mesh.to_owned() + &object))).with_mesh("m.obj", surveyed()).shot();
        let depth = f64::from(shot.truth().depth.at(4, 4));
        // f32 at 4.45, f64 at 1e7.
        assert!((depth - expected).abs() < 4e-7, "{depth}, {expected}");
    }
}
