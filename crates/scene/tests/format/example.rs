//! The examples of the pages are read with the described meaning.

use std::path::Path;

use crate::files::{DescriptionFiles, load};
use glam::DVec3;

use etendue_scene::asset::{AssetKind, Assets};
use etendue_scene::record::{Lens, Light, Surface};
use etendue_scene::{Overrides, load_camera};

fn example() -> DescriptionFiles {
    DescriptionFiles::from_example()
}

#[test]
fn the_example_is_read() {
    let d = load(&example(), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(d.cameras.len(), 2);
    assert_eq!(d.scene.objects[1].instances.len(), 2);
    let Lens::Thin(lens) = &d.cameras[0].camera.lens else { panic!("a thin lens") };
    assert_eq!(lens.f_number, 2.0);
    let Light::Sun(sun) = &d.scene.lights[0] else { panic!("a sun") };
    assert_eq!(sun.name, "sun".to_owned());
    assert!(matches!(d.scene.materials[2].surface.0, Surface::Conductor(_)));
}

#[test]
fn the_small_example_is_read() {
    let d = load(&DescriptionFiles::from_small_example(), &[]).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!((d.cameras.len(), d.scene.objects.len()), (1, 1));
}

#[test]
fn a_camera_renders_and_writes_as_the_job_says_where_it_is_silent() {
    let d = load(&example(), &[]).expect("the example");
    let spp = |i: usize| d.cameras[i].render.samples.spp.as_ref().map(|v| v.value);
    assert_eq!((spp(0), spp(1)), (Some(256), Some(64)));
    let raw = |i: usize| d.cameras[i].output.raw.as_ref().map(|v| v.value);
    assert_eq!((raw(0), raw(1)), (Some(true), Some(false)));
}

#[test]
fn a_value_knows_its_place() {
    let d = load(&example(), &[]).expect("the example");
    let place = &d.scene.objects[2].material.as_ref().expect("a material").place;
    assert_eq!(place.key(), "objects.globe.material");
    let text = example().text("scene.toml");
    let (line, column) = place.line_column().expect("in a file");
    let line = text.lines().nth(line as usize - 1).expect("the line");
    assert_eq!(&line[column as usize - 1..], "\"lamp\"");
}

#[test]
fn a_camera_file_is_read_by_itself() {
    let files = example();
    let camera = load_camera(Path::new("camera.toml"), &|p| files.read(p), &Overrides::default()).expect("the camera");
    assert_eq!(camera.sensor.width_px, 640);
}

#[test]
fn assets_are_listed_once_relative_to_the_job() {
    let mut files = example();
    files.rename("scene.toml", "sub/scene.toml");
    files.edit("job.toml", "scene = \"scene.toml\"", "scene = \"sub/scene.toml\"");
    let d = load(&files, &[]).expect("the example");
    let missing = Assets::default().missing(&d.assets());
    let requests: Vec<_> = missing.iter().map(|r| (r.path.as_path(), r.kind.clone())).collect();
    let expected = [
        (Path::new("sub/lamps/road.ies"), AssetKind::Photometry),
        (Path::new("sub/meshes/car.obj"), AssetKind::Mesh),
        (Path::new("sub/textures/asphalt.png"), AssetKind::Texture),
    ];
    assert_eq!(requests, expected);
}

#[test]
fn overrides_reach_every_file() {
    let sets = [
        "render.spp=16",
        "cameras.front.render.spp=8",
        "cameras.front.lens.f_number=2.8",
        "cameras.1.lens.f_number=4",
        "scene.lights.sun.elevation_deg=10",
        "scene.objects.globe.material=red",
        "output={raw=false}",
    ];
    let d = load(&example(), &sets).unwrap_or_else(|errors| panic!("{errors}"));
    let Lens::Thin(front) = &d.cameras[0].camera.lens else { panic!("a thin lens") };
    let Lens::Pinhole(left) = &d.cameras[1].camera.lens else { panic!("a pinhole") };
    let Light::Sun(sun) = &d.scene.lights[0] else { panic!("a sun") };
    assert_eq!((front.f_number.value, left.f_number.value, sun.elevation_deg.value), (2.8, 4.0, 10.0));
    assert_eq!(d.scene.objects[2].material.as_ref().expect("a material").value, "red");
    assert_eq!(d.cameras[1].render.samples.spp.as_ref().expect("given").value, 16);
    assert_eq!(d.cameras[0].render.samples.spp.as_ref().expect("given").value, 8);
    assert!(d.cameras[0].output.radiance.is_none(), "the table was replaced as a whole");
    assert_eq!(front.f_number.place.to_string(), "`set` cameras.front.lens.f_number=2.8");
}

#[test]
fn an_override_can_name_another_file() {
    let mut files = example();
    files.put("empty.toml", "format = 1\n");
    let d = load(&files, &["scene=empty.toml", "cameras.front.file=camera.toml"]).expect("an empty scene");
    assert!(d.scene.objects.is_empty());
}

#[test]
fn the_last_override_wins() {
    let mut overrides = Overrides::new(["render.spp=16"]);
    overrides.add("render.spp=24");
    let files = example();
    let d =
        etendue_scene::Description::load(Path::new("job.toml"), &|p| files.read(p), &overrides).expect("the example");
    assert_eq!(d.cameras[1].render.samples.spp.as_ref().expect("given").value, 24);
}

#[test]
fn axes_of_meshes() {
    let with = |axes: &str| {
        let mut files = example();
        files.edit("scene.toml", "up_axis = \"z\"", axes);
        load(&files, &[]).map(|d| d.scene.meshes[0].to_object()).map_err(|f| f.to_string())
    };
    let y_up = with("up_axis = \"y\"\nscale = 0.5").expect("legal");
    assert_eq!(y_up * DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.5, 0.5, 1.0), "z forward, x left, y up, half the size");
    let blender = with("up_axis = \"y\"\nforward_axis = \"-z\"").expect("legal");
    assert_eq!(blender * DVec3::new(1.0, 2.0, 3.0), DVec3::new(-3.0, -1.0, 2.0), "x is right");
    assert!(with("up_axis = \"y\"\nforward_axis = \"-y\"").expect_err("parallel").contains("is parallel to"));
}

#[test]
fn where_cameras_look() {
    let d = load(&example(), &["cameras.left.rotation_deg=[90, 0, 0]"]).expect("the example");
    let pose = d.cameras[1].pose.to_camera_pose().expect("a pose");
    assert_eq!(pose.direction_to_world(DVec3::Z), DVec3::Y, "it looks to the left");
    assert_eq!(pose.direction_to_world(DVec3::X), DVec3::X, "its right is ahead");
    assert_eq!(pose.direction_to_world(DVec3::Y), DVec3::NEG_Z, "its down is down");
}

#[test]
fn instances_stand_where_they_say() {
    let d = load(&example(), &[]).expect("the example");
    let at: Vec<_> = d.scene.objects[1].instances.iter().map(|i| i.transform.to_world().translation).collect();
    assert_eq!(at, [DVec3::new(12.0, 3.0, 0.0), DVec3::new(18.0, 3.1, 0.0)]);
}
