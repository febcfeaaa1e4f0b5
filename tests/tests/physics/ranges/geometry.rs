//! Scenes far away, tiny, huge, degenerate, and cameras where no camera stands: depth and light there.

use etendue_pipeline::truth::ground_truth;
use etendue_scene::asset::{MeshAsset, SlotMaterial};
use etendue_testkit::page::{Row, check, figure, worst};
use etendue_tests::Job;
use etendue_tracer::accel::Simd;
use glam::{DVec3, Vec3};

const WIDTH: usize = 32;
const HEIGHT: usize = 24;
/// Focal length and pixel pitch, mm: rows see the floor from cos θ = 0.01 (0.05 mm below the horizon) to 0.6.
const FOCAL_MM: f64 = 10.0;
const PITCH_MM: f64 = 0.6;

/// A camera that looks along x at a height of `scale` over a floor, its horizon a little above the middle; all of it `scale` in size and at `at_m`.
fn floor(scale: f64, at_m: [f64; 3], objects: &str) -> Job {
    let [x, y, z] = at_m;
    let size = 4e3 * scale;
    Job::new(format!(
        r#"
        [[cameras]]
        name = "eye"
        position_m = [{x:?}, {y:?}, {eye:?}]
        rotation_deg = [0, 0, 0]
        lens = {{ type = "pinhole", focal_length_mm = {FOCAL_MM}, f_number = 8 }}
        sensor = {{ width_px = {WIDTH}, height_px = {HEIGHT}, pixel_pitch_um = {pitch}, principal_point_px = [16, 0.4] }}
        [render]
        spp = 16
        wavelength_range_nm = [500, 600]
        band_width_nm = 100
        [output]
        irradiance = true
        [scene]
        materials = [{{ name = "matt", type = "diffuse", reflectance = 0.5 }}]
        environment = {{ type = "uniform", radiance_w_m2_sr_nm = 1 }}
        [[scene.objects]]
        name = "floor"
        material = "matt"
        position_m = [{x:?}, {y:?}, {z:?}]
        shape = {{ type = "quad", size_m = [{size:?}, {size:?}] }}
        {objects}
        "#,
        eye = z + scale,
        pitch = PITCH_MM * 1e3,
    ))
}

/// The greatest relative error of the depth of the floor; NaN where it is not seen.
fn depth_error(job: &Job, scale: f64) -> f64 {
    let plan = job.plan();
    let truth = ground_truth(&plan, &plan.cameras[0], 0, Simd::Auto);
    let error = |(row, column): (usize, usize)| {
        let below_mm = (row as f64 + 0.5 - 0.4) * PITCH_MM;
        let expected = scale * FOCAL_MM / below_mm;
        (f64::from(truth.depth.at(column, row)) / expected - 1.0).abs()
    };
    worst((0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |column| (row, column))).map(error))
}

/// The greatest distance, m, of the places on the floor that the ground truth tells from where they are.
fn position_error_m(at_m: [f64; 3]) -> f64 {
    let plan = floor(1.0, at_m, "").plan();
    let truth = ground_truth(&plan, &plan.cameras[0], 0, Simd::Auto);
    let low = truth.position_low.expect("a camera far away");
    let distance = |(row, column): (usize, usize)| {
        let depth_m = FOCAL_MM / ((row as f64 + 0.5 - 0.4) * PITCH_MM);
        let right_m = (column as f64 + 0.5 - 16.0) * PITCH_MM / FOCAL_MM * depth_m;
        let expected = DVec3::from(at_m) + DVec3::new(depth_m, -right_m, 0.0);
        let positions = [&truth.position, &low].map(|plane| Vec3::from(plane.at(column, row)).as_dvec3());
        (positions[0] + positions[1]).distance(expected)
    };
    worst((0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |column| (row, column))).map(distance))
}

const DEPTH: &str = "depth error ≤ 10⁻⁶";

fn places() -> Vec<Row> {
    let moved = [1e3, 1e5, 1e7, 1e8].map(|m: f64| {
        let error = depth_error(&floor(1.0, [m, -m, 0.5 * m], ""), 1.0);
        Row::at_most(&format!("scene and camera moved by {} m along each axis", figure(m)), DEPTH, error, 1e-6)
    });
    let scaled = [1e-6, 1e-3, 1e3, 1e6].map(|scale: f64| {
        let error = depth_error(&floor(scale, [0.0; 3], ""), scale);
        Row::at_most(&format!("scene and camera scaled by {}", figure(scale)), DEPTH, error, 1e-6)
    });
    let placed = [1e4, 1e7].map(|m: f64| {
        let extreme = format!("the same, moved by {} m: positions of ground truth, `P` + `P_low`", figure(m));
        Row::at_most(
            &extreme,
            "exact to 1 mm (10⁻⁶ of the distance from the camera, 170 m)",
            position_error_m([m, -m, 0.5 * m]),
            1e-3,
        )
    });
    moved.into_iter().chain(scaled).chain(placed).collect()
}

/// Edges of a micrometre beside edges of 10⁶ m: the near one from 20 µm, the far one behind it.
fn small_beside_large() -> Row {
    let tiny = "[[scene.objects]]\nname = \"grain\"\nmaterial = \"matt\"\nposition_m = [2e-5, 0, 0.9999999]\nshape = { type = \"box\", size_m = [1e-6, 1e-6, 1e-6] }\n\
        [[scene.objects]]\nname = \"wall\"\nmaterial = \"matt\"\nposition_m = [1e6, 0, 0]\nrotation_deg = [0, -90, 0]\nshape = { type = \"quad\", size_m = [1e6, 1e6] }";
    // The horizon in the middle of the picture, so that its middle looks at the grain and its edges at the wall.
    let job = floor(1.0, [0.0; 3], tiny)
        .replaced("principal_point_px = [16, 0.4]", "principal_point_px = [16.5, 12.5]")
        .replaced("pixel_pitch_um = 600", "pixel_pitch_um = 100");
    let plan = job.plan();
    let truth = ground_truth(&plan, &plan.cameras[0], 0, Simd::Auto);
    let (grain, wall) = (f64::from(truth.depth.at(16, 12)), f64::from(truth.depth.at(2, 2)));
    let error = worst([(grain / (2e-5 - 5e-7) - 1.0).abs(), (wall / 1e6 - 1.0).abs()]);
    Row::at_most(
        "a grain of 1 µm at 20 µm in front of a wall of 10⁶ m at 10⁶ m",
        "both are visible, depth error ≤ 10⁻⁶",
        error,
        1e-6,
    )
}

fn mesh(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> MeshAsset {
    let slots = vec![0; triangles.len()];
    let slot_materials = vec![SlotMaterial { name: String::new(), surface: None }];
    MeshAsset { positions, triangles, slots, slot_materials, ..MeshAsset::default() }
}

/// A floor with a mesh of its own on it.
fn with_mesh(mesh: MeshAsset) -> Job {
    let named = "[[scene.meshes]]\nname = \"mesh\"\nfile = \"mesh.obj\"\nup_axis = \"z\"\n[[scene.objects]]\nname = \"thing\"\nmaterial = \"matt\"\n\
        position_m = [3, 0, 0]\nmesh = \"mesh\"";
    floor(1.0, [0.0; 3], named).with_mesh("mesh.obj", mesh)
}

/// Pixels without light, or with light that is no finite number.
fn unlit_or_not_finite(job: &Job) -> usize {
    let irradiance = job.shot().irradiance();
    irradiance.mean.iter().filter(|v| !v.is_finite() || **v <= 0.0).count()
}

fn degenerate() -> Vec<Row> {
    // A good triangle, one without area, one that is a line, and needles of a millionth of their length.
    let positions = vec![
        [0.0, -0.5, 0.1],
        [0.0, 0.5, 0.1],
        [0.0, 0.0, 0.9],
        [0.5, 0.0, 0.5],
        [0.5, 1e-6, 1.5],
        [0.5, 0.0, 2.5],
        [0.5, 0.0, 0.5],
    ];
    let needles = with_mesh(mesh(positions, vec![[0, 1, 2], [3, 3, 3], [3, 6, 5], [3, 4, 5], [0, 0, 1]]));
    // Each of vertices of its own: triangles of the same vertices are dropped as duplicates when they are read.
    let coincident = |n: u32| {
        let corners = [[0.0, -0.5, 0.1], [0.0, 0.5, 0.1], [0.0, 0.0, 0.9]];
        let positions = (0..n).flat_map(|_| corners).collect();
        with_mesh(mesh(positions, (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()))
    };
    let one = coincident(1).shot().irradiance().mean;
    let many = coincident(100_000).shot().irradiance().mean;
    let differing = one.iter().zip(&many).filter(|(a, b)| a != b).count();
    let twice =
        "[[scene.objects]]\nname = \"floor2\"\nmaterial = \"matt\"\nshape = { type = \"quad\", size_m = [4e3, 4e3] }";
    let twice = floor(1.0, [0.0; 3], twice);
    let plain = floor(1.0, [0.0; 3], "").shot().irradiance().mean;
    let changed = |job: &Job, reference: &[f32]| {
        let irradiance = job.shot().irradiance().mean;
        worst(irradiance.iter().zip(reference).map(|(a, b)| f64::from((a / b - 1.0).abs())))
    };
    let dark = |n: usize| format!("{n} pixels");
    vec![
        Row {
            extreme: "triangles without area, collinear, needles of 10⁻⁶ of their length".to_owned(),
            expected: "hit or miss; no pixel is dark or not finite".to_owned(),
            actual: dark(unlit_or_not_finite(&needles)),
            holds: unlit_or_not_finite(&needles) == 0,
        },
        Row {
            extreme: "10⁵ coincident triangles".to_owned(),
            expected: "the image of one: hit once, no self-shadowing".to_owned(),
            actual: format!("{differing} pixels differ"),
            holds: differing == 0,
        },
        Row::at_most(
            "two coincident floors",
            "the light of one: neither shadows the other",
            changed(&twice, &plain),
            1e-6,
        ),
    ]
}

/// Rays of pixels' centres through the corners of a wall of squares, each of which six triangles share; and rays within a box's top.
fn edges() -> Vec<Row> {
    const WALL_M: f32 = 16.0;
    let square = |i: u32| (i % 40, i / 40);
    let corner = |x: u32, y: u32| y * 41 + x;
    let positions = (0..41 * 41).map(|i| [0.0, (i % 41) as f32 - 20.0, (i / 41) as f32 - 20.0]).collect();
    let triangles = (0..1600).map(square).flat_map(|(x, y)| {
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
        [[a, b, c], [a, c, d]]
    });
    // Pixels of 0.625 mm at 10 mm are a metre at 16 m.
    let job = with_mesh(mesh(positions, triangles.collect()))
        .replaced("position_m = [0.0, 0.0, 0.0]", "position_m = [0.0, 0.0, -100.0]")
        .replaced("position_m = [3, 0, 0]", "position_m = [16, 0, 1]")
        .replaced("pixel_pitch_um = 600", "pixel_pitch_um = 625")
        .replaced("principal_point_px = [16, 0.4]", "principal_point_px = [16.5, 12.5]");
    let plan = job.plan();
    let truth = ground_truth(&plan, &plan.cameras[0], 0, Simd::Auto);
    let missed = truth.depth.samples().iter().filter(|depth| ((**depth / WALL_M - 1.0).abs()) > 1e-6).count();
    let shelf = "[[scene.objects]]\nname = \"shelf\"\nmaterial = \"matt\"\nposition_m = [5, 0, 0.5]\nshape = { type = \"box\", size_m = [4, 2, 1] }";
    let along =
        floor(1.0, [0.0; 3], shelf).replaced("principal_point_px = [16, 0.4]", "principal_point_px = [16, 12.5]");
    vec![
        Row::at_most(
            "a wall of 3 200 triangles, each ray through a vertex that six of them share, one along the axis",
            "no ray passes through (pixels with depth error > 10⁻⁶)",
            missed as f64,
            0.0,
        ),
        Row::at_most(
            "rays in the plane of a box's top",
            "hit or miss; light in every pixel (pixels that are dark or not finite)",
            unlit_or_not_finite(&along) as f64,
            0.0,
        ),
    ]
}

/// Places where no camera stands.
fn strange_places() -> Vec<Row> {
    let eye = "position_m = [0.0, 0.0, 1.0]";
    let on_floor = floor(1.0, [0.0; 3], "").replaced(eye, "position_m = [0.0, 0.0, 0.0]");
    let ball = |material: &str, radius: f64| {
        format!(
            "[[scene.objects]]\nname = \"ball\"\nmaterial = \"{material}\"\nposition_m = [0, 0, 1]\nshape = {{ type = \"sphere\", radius_m = {radius} }}"
        )
    };
    let materials = |job: Job, more: &str| job.replaced("materials = [", &format!("materials = [{more}, "));
    let glass = "{ name = \"glass\", type = \"dielectric\", index = 1.5 }";
    let lamp = "{ name = \"lamp\", type = \"emitter\", emission = { radiance_w_m2_sr_nm = 3 } }";
    let in_glass = materials(floor(1.0, [0.0; 3], &ball("glass", 0.5)), glass);
    let in_lamp = materials(floor(1.0, [0.0; 3], &ball("lamp", 0.5)), lamp);
    let inside = in_lamp.shot().irradiance().mean;
    let finite = |job: &Job| job.shot().irradiance().mean.iter().filter(|v| !v.is_finite()).count();
    vec![
        Row::at_most(
            "the camera on the floor, looking along it",
            "finite light (pixels not finite)",
            finite(&on_floor) as f64,
            0.0,
        ),
        Row::at_most(
            "the camera in the centre of a glass sphere",
            "light in every pixel (pixels without)",
            unlit_or_not_finite(&in_glass) as f64,
            0.0,
        ),
        Row {
            extreme: "the camera in a sphere that emits outwards only".to_owned(),
            expected: "black: such a light is opaque and dark inside".to_owned(),
            actual: format!("brightest pixel {}", figure(f64::from(inside.iter().copied().fold(0.0, f32::max)))),
            holds: inside.iter().all(|v| *v == 0.0),
        },
    ]
}

#[test]
fn geometry() {
    let mut rows = places();
    rows.push(small_beside_large());
    rows.extend(edges());
    rows.extend(degenerate());
    rows.extend(strange_places());
    let introduction = "A camera one unit above a floor, from nearly vertical to grazing rays, compared with the closed form; 32-bit planes of ground truth. Depth errors are relative, down to cos θ = 0.01.";
    check("Geometry", introduction, &rows);
}
