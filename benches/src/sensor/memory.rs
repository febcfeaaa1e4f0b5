//! Most memory that a frame needs above its means, in a process of its own.

use super::sensors::kinds;
use super::{PIXELS, expose, scene};
use crate::child;
use etendue_bench_rays::threads::pool;
use etendue_sensor::Sensor;

/// The argument that makes this program a child that measures the sensor named next.
pub const CHILD: &str = "--peak-memory-of-sensor";

/// Bytes a pixel of the sensor of a name.
pub(super) fn bytes_a_pixel(name: &str) -> String {
    child::answer(&[CHILD, name])
}

/// Takes a frame with the sensor of a name; bytes a pixel above the means.
///
/// # Panics
/// Where there is no such sensor.
#[must_use]
pub fn child(name: &str) -> String {
    let (_, parameters) = kinds().into_iter().find(|(known, _)| *known == name).expect("a sensor of the table");
    let sensor = Sensor::new(parameters).expect("a legal sensor");
    let means = scene();
    let two = pool(2);
    let before = peak_bytes();
    let frame = two.install(|| expose(&sensor, &means));
    let after = peak_bytes();
    std::hint::black_box((frame, means));
    before.zip(after).map_or_else(|| "unknown".to_owned(), |(a, b)| format!("{:.1}", (b - a) / PIXELS))
}

/// Most memory resident so far, bytes (Linux).
fn peak_bytes() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let kib = text.lines().find_map(|line| line.strip_prefix("VmHWM:")?.split_whitespace().next()?.parse::<f64>().ok());
    kib.map(|kib| kib * 1024.0)
}
