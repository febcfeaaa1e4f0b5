//! The three levels of rendering beside one another: three cameras of one job, alike but for their level.

use etendue_core::Plane;
use etendue_core::quantity::Quantity;
use etendue_pipeline::truth::GroundTruth;
use etendue_tests::{FLAT, Job, ONE_BAND, Shot};

const SIDE_PX: usize = 16;

/// A room with a lamp under its ceiling, a block on its floor and a veil in the view; seen by a camera of each level.
fn room() -> Job {
    let camera = |level: &str| {
        format!(
            "[[cameras]]\nname = \"{level}\"\nposition_m = [-1.9, 0.34, 1.23]\nlook_at_m = [2, 0, 0.8]\n\
             lens = {{ type = \"pinhole\", focal_length_mm = 10, f_number = 8 }}\n\
             sensor = {{ width_px = {SIDE_PX}, height_px = {SIDE_PX}, pixel_pitch_um = 1000, fill_factor = 1e-6 }}\n\
             render = {{ integrator = \"{level}\" }}\n"
        )
    };
    let cameras = ["flat", "direct", "path"].map(camera).concat();
    Job::new(format!(
        r#"
        {cameras}
        [render]
        spp = 64
        replicates = 4
        {ONE_BAND}
        [[scene.materials]]
        name = "matt"
        type = "diffuse"
        reflectance = 0.6
        [[scene.materials]]
        name = "veil"
        type = "diffuse"
        reflectance = 0.3
        opacity = 0.6
        [[scene.objects]]
        name = "walls"
        material = "matt"
        shape = {{ type = "quad", size_m = [4, 4] }}
        instances = [
            {{ position_m = [0, 0, 0] }},
            {{ position_m = [0, 0, 3], rotation_deg = [0, 180, 0] }},
            {{ position_m = [2, 0, 1.5], rotation_deg = [0, -90, 0] }},
            {{ position_m = [-2, 0, 1.5], rotation_deg = [0, 90, 0] }},
            {{ position_m = [0, 2, 1.5], rotation_deg = [0, 0, 90] }},
            {{ position_m = [0, -2, 1.5], rotation_deg = [0, 0, -90] }},
        ]
        [[scene.objects]]
        name = "block"
        material = "matt"
        shape = {{ type = "box", size_m = [0.8, 0.8, 0.8] }}
        position_m = [0.8, -0.5, 0.4]
        [[scene.objects]]
        name = "veil"
        material = "veil"
        shape = {{ type = "quad", size_m = [0.7, 0.7] }}
        position_m = [0, 0.9, 1.2]
        rotation_deg = [0, -90, 0]
        [[scene.lights]]
        type = "point"
        name = "lamp"
        position_m = [0.2, 0.2, 2.5]
        intensity_cd = 100
        {FLAT}
        "#
    ))
}

fn bits<Q: Quantity>(plane: &Plane<Q>, sample_bits: impl Fn(&Q::Sample) -> Vec<u32>) -> Vec<u32> {
    plane.samples().iter().flat_map(sample_bits).collect()
}

/// Every plane of a ground truth, bit for bit.
fn all_bits(truth: &GroundTruth) -> Vec<Vec<u32>> {
    let lengths = [&truth.depth, &truth.distance].map(|plane| bits(plane, |v| vec![v.to_bits()]));
    let vectors = [&truth.normal, &truth.position].map(|plane| bits(plane, |v| v.map(f32::to_bits).to_vec()));
    let identities =
        [&truth.instance, &truth.semantic, &truth.material, &truth.ray].map(|plane| bits(plane, |v| vec![*v]));
    lengths.into_iter().chain(vectors).chain(identities).collect()
}

#[test]
fn levels_see_the_same_surfaces_bit_for_bit() {
    let [flat, direct, path] = <[Shot; 3]>::try_from(room().shots()).expect("three cameras").map(|s| s.truth());
    assert_eq!(all_bits(&flat), all_bits(&direct));
    assert_eq!(all_bits(&flat), all_bits(&path));
    let instances: std::collections::BTreeSet<u32> = flat.instance.samples().iter().copied().collect();
    assert!(instances.len() >= 4, "several surfaces are in view: {instances:?}");
}

#[test]
fn each_level_adds_what_it_says() {
    let shots = room().shots();
    let [flat, direct, path] = [0, 1, 2].map(|i: usize| shots[i].radiance().mean);
    let truth = shots[0].truth();
    // The veil (instance 8) lets part of what is behind it through, by chance.
    let solid: Vec<usize> = (0..SIDE_PX * SIDE_PX).filter(|i| truth.instance.samples()[*i] < 8).collect();
    let mut shadowed = 0;
    for i in solid {
        // One lamp without extent and nearly point-like pixels: flat and direct do not scatter but by a pixel's place.
        assert!(flat[i] >= direct[i] * (1.0 - 1e-3), "pixel {i}: a shadow takes light away: {} {}", flat[i], direct[i]);
        assert!(path[i] >= direct[i] * (1.0 - 1e-3), "pixel {i}: walls give light: {} {}", direct[i], path[i]);
        if direct[i] == 0.0 && flat[i] > 0.0 {
            shadowed += 1;
            assert!(path[i] > 0.02 * flat[i], "pixel {i}: the shadow is lit by the walls: {} {}", path[i], flat[i]);
        }
    }
    assert!(shadowed >= 2, "the block's shadow is in view: {shadowed} pixels");
    let sum = |image: &[f32]| image.iter().map(|v| f64::from(*v)).sum::<f64>();
    // Walls of 0.6 give back 0.6/(1 − 0.6) of the direct light in all, a part of it in view.
    assert!(sum(&path) > 1.4 * sum(&direct), "{} {}", sum(&path), sum(&direct));
}
