//! A city street: two lanes, parked and driving cars, houses on both sides, in sunlight.
//!
//! The street runs along +x, the ego car drives on its right lane; y = 0 is the middle of the carriageway. Widths
//! follow German practice for streets of houses (RASt 06, stand-ins within its ranges): lanes of 3.25 m, a parking
//! lane of 2.1 m, kerbs of 0.12 m, pavements of 2.5 m; markings of 0.12 m in dashes of 3 m every 9 m (RMS-1).

mod building;
mod car;
mod curve;
mod drive;
mod fleet;
mod furniture;
mod hours;
mod house;
mod houses;
mod layout;
mod materials;
mod opening;
mod person;
mod road;
mod roof;
mod text;
mod tree;
mod walk;
mod wheel;

use crate::File;
use crate::description::Description;
use crate::luminaire;
use crate::obj::obj;

/// Every generated file of the street.
#[must_use]
pub fn files() -> Vec<File> {
    let street = description();
    let mut files = street.files("street");
    files.push(File::text(String::from("street/scene.toml"), text::scene(&street)));
    files.push(File::text(String::from("street/street.toml"), text::job()));
    files.extend(other_hours());
    files.extend(drive(&street));
    files.extend(walk::files());
    files
}

/// Scenes and jobs of the evening and the night.
fn other_hours() -> Vec<File> {
    let sunset = hours::job("The street in the evening sun.", "scene-sunset.toml", "automotive-evening.toml");
    let night = hours::job("The street at night.", "scene-night.toml", "automotive-night.toml");
    let wet = hours::job("The street at night after rain.", "scene-wet-night.toml", "automotive-night.toml");
    let wet = wet.replace(
        "caustics = false\n",
        "caustics = false\n# Car paint sees the wet road, and the wet road car paint.\nregularize = true\n# Dim walls are lit by way of the road: four lights and four paths for each ray through the lens.\nbranches = 4\n",
    );
    let files = [
        ("scene-sunset.toml", hours::sunset_scene()),
        ("sunset.toml", sunset),
        ("scene-night.toml", hours::night_scene()),
        ("night.toml", night),
        ("scene-wet-night.toml", hours::wet_night_scene()),
        ("wet-night.toml", wet),
        ("street-lamp.ies", luminaire::ies()),
    ];
    files.map(|(name, text)| File::text(format!("street/{name}"), text)).into()
}

/// A drive down the street: its scene and job, and a car in parts, whose wheels turn.
fn drive(street: &Description) -> [File; 5] {
    let part = |name: &str, mesh| File::text(format!("street/meshes/{name}.obj"), obj(&mesh, "street.mtl"));
    let hatchback = fleet::hatchback();
    [
        part("hatchback-body", hatchback.body()),
        part("wheel", wheel::mesh(hatchback.wheel_radius)),
        File::text(String::from("drive/scene.toml"), drive::scene(street)),
        File::text(String::from("drive/drive.toml"), drive::job()),
        File::text(String::from("drive/ego.csv"), drive::ego()),
    ]
}

/// Triangles of the street in its files, and with every instance counted.
#[must_use]
pub fn triangle_counts() -> [usize; 2] {
    description().triangle_counts()
}

fn description() -> Description {
    let mut street = Description { materials: materials::all(), classes: CLASSES.to_vec(), ..Description::default() };
    materials::paint(&mut street);
    layout::ground(&mut street);
    houses::add(&mut street);
    layout::greenery(&mut street);
    layout::furniture(&mut street);
    layout::traffic(&mut street);
    street
}

/// Numbers as in the Cityscapes data set's label ids, with one more for painted markings; what no object covers, the
/// sky, is 0.
const CLASSES: [(&str, u32); 11] = [
    ("road", 7),
    ("sidewalk", 8),
    ("parking", 9),
    ("building", 11),
    ("pole", 17),
    ("traffic-sign", 20),
    ("vegetation", 21),
    ("terrain", 22),
    ("person", 24),
    ("car", 26),
    ("marking", 40),
];
