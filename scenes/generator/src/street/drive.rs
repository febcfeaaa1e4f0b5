//! A drive down the street at dusk: what moves in it, and the rig of cameras that goes along.
//!
//! The scene builds on the street at night and replaces what drives and walks there. One second at 20 frames a second.

use core::fmt::Write as _;

use super::hours::{ONCOMING, street_lamps};
use super::{fleet, walk};
use crate::description::Description;
use crate::mesh::Mesh;
use crate::obj::number;

/// A car under way: the object of the street that it replaces, where it is at the beginning (m), its heading (degrees) and speed (m/s).
struct Driver {
    object: &'static str,
    at: [f64; 2],
    heading_deg: f64,
    speed_m_s: f64,
}

/// As they stand in the street's still pictures; the white hatchback turns its wheels.
const DRIVERS: [Driver; 5] = [
    Driver { object: "saloon-blue-driving", at: [29.5, -1.6], heading_deg: 0.0, speed_m_s: 9.0 },
    Driver { object: "hatchback-white-driving", at: [25.5, 1.7], heading_deg: 180.0, speed_m_s: 10.0 },
    Driver { object: "van-white-driving", at: [52.0, 1.65], heading_deg: 180.0, speed_m_s: 10.5 },
    Driver { object: "saloon-black-driving", at: [74.0, 1.7], heading_deg: 180.0, speed_m_s: 9.5 },
    Driver { object: "saloon-red-driving", at: [66.0, -1.65], heading_deg: 0.0, speed_m_s: 9.0 },
];

/// Walkers: the object, where it is at the beginning (m), its heading (degrees) and speed (m/s).
const WALKERS: [(&str, [f64; 3], f64, f64); 4] = [
    ("person-1", [13.4, -6.6, 0.12], 0.0, 1.4),
    ("person-2", [18.4, 3.75, 0.12], -90.0, 1.2),
    ("person-3", [31.0, 6.0, 0.12], 180.0, 1.3),
    ("person-4", [38.0, -6.9, 0.12], 180.0, 1.5),
];

/// How long the ways are, s: longer than the sequence.
const LENGTH_S: f64 = 4.0;

/// The scene, of the objects of the street.
pub(super) fn scene(street: &Description) -> String {
    let mut text = String::from(
        "# A drive down the street at dusk, past street lamps dimmed by pulses. Made by scenes/generator.\n\
         format = 1\n\
         base = \"../street/scene-night.toml\"\n\n\
         # The sun four degrees below the horizon: civil twilight, some 20 lx on the road, as many as the lamps give.\n\
         [environment]\ntype = \"sky\"\nturbidity = 3\nground_albedo = 0.15\nsun_elevation_deg = -4\nsun_azimuth_deg = 174\n\n\
         # The car with the cameras, as its logger wrote it.\n\
         [[frames]]\nname = \"ego\"\ninterpolation = \"smooth\"\ntrajectory = { file = \"ego.csv\" }\n\n\
         [[meshes]]\nname = \"hatchback-body\"\nfile = \"../street/meshes/hatchback-body.obj\"\nup_axis = \"z\"\n\n\
         [[meshes]]\nname = \"wheel\"\nfile = \"../street/meshes/wheel.obj\"\nup_axis = \"z\"\n",
    );
    DRIVERS.iter().for_each(|driver| car(driver, street, &mut text));
    wheels(&mut text);
    WALKERS.iter().for_each(|walker| person(*walker, street, &mut text));
    lamps(&mut text);
    text
}

/// A car in a frame of its own.
fn car(driver: &Driver, street: &Description, text: &mut String) {
    let Driver { object, at: [x, y], heading_deg, speed_m_s } = driver;
    let sign = if *heading_deg == 0.0 { 1.0 } else { -1.0 };
    let end = x + sign * speed_m_s * LENGTH_S;
    let _ = write!(
        text,
        "\n[[frames]]\nname = \"{object}\"\nkeys = [\n  \
         {{ time_s = 0, position_m = [{x}, {y}, 0], rotation_deg = [{heading_deg}, 0, 0] }},\n  \
         {{ time_s = {LENGTH_S}, position_m = [{end}, {y}, 0], rotation_deg = [{heading_deg}, 0, 0] }},\n]\n"
    );
    let body = (*object == ROLLING).then(|| fleet::hatchback().body());
    let _ = write!(text, "\n{}frame = \"{object}\"\n", head(object, body.as_ref(), street));
}

/// The car whose wheels turn.
const ROLLING: &str = "hatchback-white-driving";

fn wheels(text: &mut String) {
    let shape = fleet::hatchback();
    let _ = write!(
        text,
        "\n[[objects]]\nname = \"hatchback-wheel\"\nmesh = \"wheel\"\nclass = \"car\"\n\
         materials = {{ rubber = \"rubber\", alloy = \"alloy\", trim = \"trim\" }}\n\
         rolls = {{ radius_m = {} }}\ninstances = [\n",
        shape.wheel_radius
    );
    for [x, y, z] in shape.hubs() {
        let _ = writeln!(text, "  {{ frame = \"{ROLLING}\", position_m = [{x:.3}, {y:.3}, {z:.3}] }},");
    }
    text.push_str("]\n");
}

fn person((name, at, heading_deg, speed_m_s): (&str, [f64; 3], f64, f64), street: &Description, text: &mut String) {
    let [x, y, z] = at;
    let (dx, dy) = match heading_deg {
        0.0 => (1.0, 0.0),
        180.0 => (-1.0, 0.0),
        _ => (0.0, -1.0),
    };
    let distance = speed_m_s * LENGTH_S;
    let mesh = format!("walk-{name}");
    let rate_hz = number(walk::rate_hz(speed_m_s));
    let _ = write!(
        text,
        "\n[[meshes]]\nname = \"{mesh}\"\nup_axis = \"z\"\nvertex_animation = {{ files = \"../street/meshes/walk-%d.obj\", \
         count = {}, rate_hz = {rate_hz}, repeat = \"loop\" }}\n",
        walk::PHASES
    );
    let _ = write!(
        text,
        "\n{}keys = [\n  {{ time_s = 0, position_m = [{x}, {y}, {z}], rotation_deg = [{heading_deg}, 0, 0] }},\n  \
         {{ time_s = {LENGTH_S}, position_m = [{:.2}, {:.2}, {z}], rotation_deg = [{heading_deg}, 0, 0] }},\n]\n",
        walking(name, &mesh, street),
        x + dx * distance,
        y + dy * distance
    );
}

/// The head of an object of the street: name, mesh, class and materials; of a car without wheels those of its `body`.
fn head(name: &str, body: Option<&Mesh>, street: &Description) -> String {
    let object = street.objects.iter().find(|object| object.name == name).expect("an object of the street");
    street.object_head(
        object,
        if body.is_some() { "hatchback-body" } else { object.mesh },
        body.map(|mesh| &mesh.slots[..]),
    )
}

/// The head of a walker of the street, with another mesh.
fn walking(name: &str, mesh: &str, street: &Description) -> String {
    let object = street.objects.iter().find(|object| object.name == name).expect("a walker of the street");
    street.object_head(object, mesh, None)
}

fn lamps(text: &mut String) {
    text.push_str(
        "\n# Dimmed by pulses of 120 Hz, each lamp with a phase of its own: rows of a rolling shutter see them by turns.\n",
    );
    text.push_str(&street_lamps(
        "../street/street-lamp.ies",
        "modulation = { type = \"pwm\", frequency_hz = 120, duty_cycle = 0.25, phases = \"random\" }\n",
    ));
    text.push_str(
        "\n# The own car: low beam.\n\
         [[lights]]\nname = \"own-low-beam\"\ntype = \"head_lamp\"\nbeam = \"low_beam\"\ntraffic = \"right\"\n\
         illuminant = \"LED-B5\"\nframe = \"ego\"\n\
         instances = [\n  { position_m = [1.9, 0.63, 0.65] },\n  { position_m = [1.9, -0.63, 0.65] },\n]\n\n\
         # Those that come towards it.\n\
         [[lights]]\nname = \"other-low-beam\"\ntype = \"head_lamp\"\nbeam = \"low_beam\"\ntraffic = \"right\"\n\
         illuminant = \"LED-B5\"\ninstances = [\n",
    );
    let oncoming = DRIVERS.iter().filter(|driver| driver.heading_deg == 180.0);
    for (driver, [_, _, ahead, spacing, height]) in oncoming.zip(ONCOMING) {
        for side in [0.5, -0.5] {
            let _ = writeln!(
                text,
                "  {{ frame = \"{}\", position_m = [{:.3}, {:.3}, {height}] }},",
                driver.object,
                ahead + 0.05,
                side * spacing
            );
        }
    }
    text.push_str("]\n");
}

/// Where the own car is, as a logger of 20 Hz would write it: it accelerates from 9 m/s by 0.5 m/s², nose up by a third of a degree.
pub(super) fn ego() -> String {
    let mut text = String::from("# Made by scenes/generator.\ntime_s,x_m,y_m,z_m,yaw_deg,pitch_deg,roll_deg\n");
    for i in -4..=80 {
        let t = f64::from(i) / 20.0;
        let _ = writeln!(text, "{t:.2},{:.6},-1.6,0,0,-0.3,0", 9.0 * t + 0.25 * t * t);
    }
    text
}

/// The job.
pub(super) fn job() -> String {
    let camera = |name: &str, file: &str, at: &str, turned: &str, more: &str| {
        format!(
            "[[cameras]]\nname = \"{name}\"\nfile = \"../cameras/{file}\"\nframe = \"ego\"\nposition_m = {at}\n\
             rotation_deg = {turned}\n{more}\n"
        )
    };
    [
        "# A second of a drive down the street at dusk, by a stereo pair to the front and a fisheye to the rear. Made by scenes/generator.\n\
         # etendue render drive.toml -o out --frames 0..20\n\
         format = 1\n\
         scene = \"scene.toml\"\n\n\
         [sequence]\nframe_rate_hz = 20\n\n"
            .to_owned(),
        "# A pair of 0.3 m, parallel, their exposures together.\n".to_owned(),
        camera("left", "rig-front.toml", "[0, 0.15, 1.35]", "[0, 0.5, 0]", "output = { disparity_to = \"right\" }\n"),
        camera("right", "rig-front.toml", "[0, -0.15, 1.35]", "[0, 0.5, 0]", ""),
        camera("rear", "rig-rear.toml", "[-2.6, 0, 1.0]", "[180, 15, 0]", ""),
        "[render]\n# Half a minute a frame and camera on two cores.\nspp = 64\nmax_bounces = 6\ncaustics = false\npath_reuse_px = 4\nseed = 1\n\n[output]\noptical_flow = \"exr\"\nboxes = true\ntracks = true\nvideo = \"y4m\"\ncalibration_files = true\n"
            .to_owned(),
    ]
    .concat()
}
