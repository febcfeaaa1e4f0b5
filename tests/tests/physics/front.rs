//! What stands in front of a lens: the light and the ground truth that come by it.

use etendue_pipeline::rays::ray_table;
use etendue_tests::Job;
use glam::DVec3;

fn job(scene: &str, front: &str, render: &str) -> Job {
    Job::new(format!(
        r#"
        [scene]
        {scene}
        [[cameras]]
        name = "eye"
        position_m = [0.3, -0.2, 1.9]
        look_at_m = [0.3, -0.2, 2.9]
        up = [1, 0, 0]
        lens = {{ type = "thin", focal_length_mm = 5.3, f_number = 4, focus_distance_m = 0.115 }}
        sensor = {{ width_px = 16, height_px = 16, pixel_pitch_um = 220 }}
        {front}
        [render]
        spp = 256
        replicates = 16
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        {render}
        [output]
        irradiance = true
        "#
    ))
}

const UNIFORM: &str = "environment = { type = \"uniform\", radiance_w_m2_sr_nm = 1 }";
const GROUND: &str = "[[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[scene.objects]]\n\
                      name = \"road\"\nmaterial = \"grey\"\nshape = { type = \"quad\", size_m = [4000, 4000] }";
const MIRROR: &str = "[cameras.external_optics.mirror]\ntype = \"hyperboloid\"\nradius_mm = 30\nconic = -1.69\n\
                      rim_radius_mm = 40\nreflectance = 0.75";

/// The camera looks up at a mirror that shows the ground, all of it on the plane z = 0.
#[test]
fn ground_truth_by_a_mirror_is_where_the_ray_table_says() {
    let shot = job(GROUND, MIRROR, "").shot();
    let (truth, rays) = (shot.truth(), ray_table(&shot.camera().body));
    let (mirror, path) = (truth.mirror.as_ref().expect("a mirror"), rays.path.as_ref().expect("a mirror"));
    let pose = shot.camera().path.at(0.0);
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let mut hits = 0;
    for (x, y) in (0..256).map(|i| (i % 16, i / 16)) {
        if mirror.at(x, y)[0].is_nan() {
            assert_eq!((truth.depth.at(x, y), path.at(x, y)), (f32::INFINITY, 0.0), "past the mirror is the sky");
            continue;
        }
        assert!(truth.depth.at(x, y).is_nan());
        let (origin, direction) = (vector(rays.origin.at(x, y)), vector(rays.direction.at(x, y)));
        assert_eq!(mirror.at(x, y), rays.origin.at(x, y));
        // The pupil is the origin of the camera frame.
        assert!((f64::from(path.at(x, y)) - origin.length()).abs() < 1e-8);
        if truth.instance.at(x, y) != 1 {
            continue;
        }
        hits += 1;
        let rest = f64::from(truth.distance.at(x, y)) - f64::from(path.at(x, y));
        let world = pose.position_m + pose.direction_to_world(origin + direction * rest);
        // f32 planes: 6e-8 of the distance, and of the direction times it.
        let tolerance = 3e-7 * (2.0 + rest);
        assert!(world.z.abs() < tolerance && (world - vector(truth.position.at(x, y))).length() < 2.0 * tolerance);
    }
    assert!(hits > 60, "{hits} pixels see the ground");
}

/// A single viewpoint: what the middle shows is the camera's own place, and the picture is mirrored.
#[test]
fn a_mirror_mirrors() {
    let shot = job(GROUND, MIRROR, "").shot();
    let truth = shot.truth();
    // The camera looks up, the top of its picture is +x of the world: looking up so, its right is −y … of the world seen
    // directly; reflected straight down, points right of the middle are on the side of the camera's right.
    let right = DVec3::from_array(truth.position.at(11, 8).map(f64::from)) - DVec3::new(0.3, -0.2, 0.0);
    let camera_right = shot.camera().path.at(0.0).direction_to_world(DVec3::X);
    assert!(right.dot(camera_right) > 0.1, "{right}");
    let up = DVec3::from_array(truth.position.at(8, 4).map(f64::from)) - DVec3::new(0.3, -0.2, 0.0);
    assert!(up.x > 0.1, "{up}");
}

#[test]
fn a_uniform_surround_is_as_bright_by_a_mirror_as_it_reflects() {
    let (direct, mirrored) = (job(UNIFORM, "", "").shot().irradiance(), job(UNIFORM, MIRROR, "").shot().irradiance());
    // The corner looks past the mirror; the middle sees it by every ray. Same samples of the same pupil.
    assert!((mirrored.mean[0] / direct.mean[0] - 1.0).abs() < 1e-6);
    assert!((mirrored.mean[8 * 16 + 8] / direct.mean[8 * 16 + 8] - 0.75).abs() < 1e-6);
}

#[test]
fn dirt_is_the_same_by_both_routes() {
    let front = "[cameras.external_optics.dirt]\nmask = \"dirt.png\"\nsize_mm = [4, 4]\ndistance_mm = 6";
    let row = (0..64).map(|x| [if x < 32 { 1.0 } else { 0.1 }; 3]);
    let job = |render: &str| {
        let job = job(UNIFORM, front, render).replacing("spp = 256", "spp = 4096");
        job.with_image("dirt.png", 64, 1, row.clone().collect()).shot().light().irradiance
    };
    let [lens, pupil] =
        ["", "route = \"pupil\""].map(|render| job(render).expect("irradiance").load().expect("in memory"));
    let brightest = lens.planes()[0].samples().iter().fold(0.0_f32, |a, b| a.max(*b));
    for (a, b) in lens.planes()[0].samples().iter().zip(pupil.planes()[0].samples()) {
        // 4 096 samples across an edge, σ at most 0.8 % were they not stratified, and a wide pixel, of which the operator
        // looks at the centre: 2 % of the light.
        assert!((a - b).abs() < 0.02 * brightest, "{a} and {b} of {brightest}");
    }
    let min = lens.planes()[0].samples().iter().fold(brightest, |a, b| a.min(*b));
    assert!(min < 0.2 * brightest, "the right is dark: {min} of {brightest}");
}
