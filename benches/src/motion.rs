//! The street with fifty objects more that stand, and the same while they move: what motion costs a picture.

use crate::scenes::{STREET, camera, text_of};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::runs::{COUNT, RunStatistics};
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_pipeline::render::{LightRequest, light, light_counts};
use etendue_pipeline::{NullObserver, Plan};
use rayon::ThreadPool;
use std::fmt::Write as _;

const NOTE: &str = "The street by day with 30 vehicles (12 m/s) and 20 people (1.4 m/s) more, 320 × 200 px, 4 samples a pixel, one thread. \
    Start: placing the world about the camera and collecting the lights, once a frame. Ratio: whole frames, run by run over the same with all of \
    them at rest where they are when the exposure begins; the exposure is 10 ms.";

/// What makes the street's picture small, with the same field of view.
const SMALL: [&str; 6] = [
    "cameras.0.sensor.width_px=320",
    "cameras.0.sensor.height_px=200",
    "cameras.0.sensor.pixel_pitch_um=18",
    "cameras.0.sensor.exposure_s=0.01",
    "render.replicates=1",
    "render.spp=4",
];
const SPP: f64 = 4.0;
/// Vehicles, half of them in either lane, and people, half of them on either pavement.
const VEHICLES: usize = 30;
const PEOPLE: usize = 20;

/// How the rows are exposed, and whether anything moves.
const WORLDS: [(&str, bool, &str); 3] = [
    ("at rest", false, "{ type = \"global\" }"),
    ("moving, global shutter", true, "{ type = \"global\" }"),
    ("moving, rolling shutter", true, "{ type = \"rolling\", row_time_us = 60 }"),
];

/// Times of a frame of each world, which take turns.
pub fn table() -> Table {
    let head = ["fifty objects", "start, ms", "µs a path", "frame, s", "ratio", "spread of ratios"];
    let mut table = Table::new("Motion", NOTE, &head);
    let plans = WORLDS.map(|(_, moves, shutter)| plan(moves, shutter));
    let one = pool(1);
    let mut starts: [RunStatistics; 3] = Default::default();
    let mut frames: [RunStatistics; 3] = Default::default();
    for _ in 0..COUNT {
        for (i, plan) in plans.iter().enumerate() {
            starts[i].add(one.install(|| timed(|| light_counts(plan, camera(plan)))).1);
            frames[i].add(frame_s(plan, &one));
        }
    }
    for (i, (name, ..)) in WORLDS.iter().enumerate() {
        let ratio = frames[i].over(&frames[0]);
        let (width, height) = camera(&plans[i]).film_size();
        let paths = f64::from(width) * f64::from(height) * SPP;
        table.row(vec![
            (*name).to_owned(),
            format!("{:.1}", starts[i].median() * 1e3),
            format!("{:.2}", (frames[i].median() - starts[i].median()) / paths * 1e6),
            format!("{:.2}", frames[i].median()),
            format!("{:.2}", ratio.median()),
            ratio.spread_text(),
        ]);
    }
    table
}

/// Processor time of a frame, s.
fn frame_s(plan: &Plan, pool: &ThreadPool) -> f64 {
    let (film, seconds) = pool.install(|| timed(|| light(plan, camera(plan), LightRequest::default(), &NullObserver)));
    std::hint::black_box(film.expect("nobody cancels"));
    seconds
}

/// The street with its fifty objects.
fn plan(moves: bool, shutter: &str) -> Plan {
    let mut scene = text_of("street/scene.toml");
    (0..VEHICLES).for_each(|i| {
        let (lane_m, sign) = if i % 2 == 0 { (-1.6, 1.0) } else { (1.7, -1.0) };
        let mesh = ["saloon", "hatchback", "van"][i % 3];
        add(&mut scene, mesh, [9.0 + 7.0 * (i / 2) as f64, lane_m], if moves { 12.0 * sign } else { 0.0 });
    });
    (0..PEOPLE).for_each(|i| {
        let (side_m, sign) = if i % 2 == 0 { (-6.5, 1.0) } else { (6.5, -1.0) };
        add(&mut scene, "walker", [7.0 + 4.0 * (i / 2) as f64, side_m], if moves { 1.4 * sign } else { 0.0 });
    });
    let shutter = format!("cameras.0.sensor.shutter={shutter}");
    let changes: Vec<&str> = SMALL.into_iter().chain([shutter.as_str()]).collect();
    STREET.with_scene(&scene, &changes)
}

/// An object that is at a place of the road at 0 s.
fn add(scene: &mut String, mesh: &str, [x, y]: [f64; 2], speed_m_s: f64) {
    let number = scene.len();
    writeln!(scene, "[[objects]]\nname = \"more {mesh} {number}\"\nmesh = \"{mesh}\"\nmaterial = \"bollard\"")
        .expect("memory");
    match speed_m_s == 0.0 {
        true => writeln!(scene, "position_m = [{x}, {y}, 0]"),
        false => {
            let key =
                |time_s: f64| format!("{{ time_s = {time_s}, position_m = [{}, {y}, 0] }}", x + time_s * speed_m_s);
            writeln!(scene, "keys = [{}, {}]", key(-1.0), key(1.0))
        }
    }
    .expect("memory");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fifty_objects_move_or_stand() {
        let moving = |plan: &Plan| plan.world.instances().iter().filter(|i| i.to_world.as_constant().is_none()).count();
        let (_, moves, shutter) = WORLDS[2];
        assert_eq!(moving(&plan(moves, shutter)), VEHICLES + PEOPLE);
        assert_eq!(moving(&plan(false, WORLDS[0].2)), 0);
    }
}
