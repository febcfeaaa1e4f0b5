//! Drops over time: they arrive, dry, slide, coalesce and are wiped away.
//!
//! The drops at a time are a pure function of the parameters and the time. They are simulated from the start in steps of [`STEP_S`] at fixed times,
//! with one shorter step to the requested time. Frames may be computed in any order, on any machine. The cost grows with the time since the start.
//!
//! In a step, drops arrive, shrink, slide, coalesce, are wiped, and leave the rectangle, in this order. A drying drop keeps its contact angle, and
//! the square of its radius falls linearly with time (R. G. Picknett and R. Bexon, J. Colloid Interface Sci. 61, 1977).

use glam::DVec2;

use super::coalescence::{coalesce, reach_factor};
use super::course::{Course, Droplet};
use super::population::{self, Batch, DropsParameters};

/// Time step, s. Usual drops slide less than their radius in it.
const STEP_S: f64 = 0.02;

/// The drops at a time, s; `down` is the direction of gravity along the glass, its length the sine of the slope.
pub(super) fn at(p: &DropsParameters, course: &Course, time_s: f64, down: DVec2) -> Vec<Droplet> {
    let mut drops = population::initial(p);
    coalesce(&mut drops, reach_factor(p.contact_angle_rad));
    let moment = |step: u64| course.start_s + step as f64 * STEP_S;
    let mut step = 0;
    while moment(step + 1) <= time_s {
        advance(&mut drops, p, course, [moment(step), moment(step + 1)], down);
        step += 1;
    }
    if moment(step) < time_s {
        advance(&mut drops, p, course, [moment(step), time_s], down);
    }
    drops
}

/// Advances the drops by a step.
fn advance(drops: &mut Vec<Droplet>, p: &DropsParameters, course: &Course, [from_s, to_s]: [f64; 2], down: DVec2) {
    let [_, max_mm] = p.radius_mm;
    let passed_s = to_s - from_s;
    let mut touches = arrive(drops, p, course, [from_s, to_s]);
    if let Some(drying_s) = course.drying_s {
        let less = max_mm * max_mm * passed_s / drying_s;
        drops.retain_mut(|drop| {
            let square = drop.radius_mm * drop.radius_mm - less;
            drop.radius_mm = square.max(0.0).sqrt();
            square > 0.0
        });
    }
    if let Some(sliding) = course.sliding {
        for drop in drops.iter_mut() {
            let velocity = sliding.velocity_mm_s(*drop, down, max_mm);
            touches |= velocity != DVec2::ZERO;
            drop.centre_mm += velocity * passed_s;
        }
    }
    if touches {
        coalesce(drops, reach_factor(p.contact_angle_rad));
    }
    if let Some(wiper) = &course.wiper {
        wiper.wipe(drops, from_s, to_s);
    }
    drops.retain(|drop| ((drop.centre_mm - p.offset_mm).abs() - drop.radius_mm).cmple(0.5 * p.size_mm).all());
}

/// Adds the drops that arrive after one time and no later than another; returns whether there are any.
fn arrive(drops: &mut Vec<Droplet>, p: &DropsParameters, course: &Course, [from_s, to_s]: [f64; 2]) -> bool {
    if course.arrivals_hz == 0.0 {
        return false;
    }
    let number = |time_s: f64| ((time_s - course.start_s) * course.arrivals_hz).max(0.0) as u64;
    let before = drops.len();
    // Drop number n arrives in its own interval of 1/rate; one more on both sides for rounding.
    for number in number(from_s).saturating_sub(1)..=number(to_s) + 1 {
        let (drop, u) = population::droplet(p, Batch::Later, number);
        let arrival_s = course.start_s + (number as f64 + u) / course.arrivals_hz;
        if from_s < arrival_s && arrival_s <= to_s {
            drops.push(drop);
        }
    }
    drops.len() > before
}

#[cfg(test)]
mod tests {
    use super::super::course::Sliding;
    use super::super::course::Wiper;
    use super::super::tests::parameters;
    use super::super::{Cap, Drops};
    use super::*;
    use etendue_core::maths::f64::{atan2, pow};
    use glam::DVec3;

    const DOWN: DVec2 = DVec2::new(0.0, 0.5);

    fn rain() -> (DropsParameters, Course) {
        let course = Course {
            start_s: 1.0,
            sliding: Some(Sliding { speed_mm_s: 40.0, still_radius_mm: 0.8 }),
            drying_s: Some(30.0),
            arrivals_hz: 60.0,
            wiper: Some(Wiper {
                pivot_mm: DVec2::new(10.0, 60.0),
                blade_mm: [30.0, 100.0],
                angles_rad: [-0.8, 0.7],
                sweep_s: 0.4,
                period_s: 2.0,
                start_s: 1.3,
            }),
        };
        (DropsParameters { course: Some(course), ..parameters() }, course)
    }

    /// The state at a time does not depend on earlier queries, and drops are continuous in time.
    #[test]
    fn the_state_at_a_time_is_its_own_and_continuous() {
        let (p, course) = rain();
        let alone = at(&p, &course, 4.137, DOWN);
        for earlier in [0.2, 1.0, 2.5, 4.1] {
            at(&p, &course, earlier, DOWN);
            assert_eq!(at(&p, &course, 4.137, DOWN), alone);
        }
        assert!(alone.len() > 100);
        assert_eq!(at(&p, &course, 0.5, DOWN), at(&p, &course, 1.0, DOWN), "still before the beginning");
        // Across a step boundary as within a step: no new drop is there 40 µs later, except arrivals and wiped ones.
        for border in [3.0, 3.01] {
            let (before, after) = (at(&p, &course, border - 2e-5, DOWN), at(&p, &course, border + 2e-5, DOWN));
            let moved = before.iter().filter(|b| !after.iter().any(|a| a.centre_mm.distance(b.centre_mm) < 0.01));
            assert!(moved.count() <= 3 && before.len().abs_diff(after.len()) <= 3);
        }
    }

    #[test]
    fn sliding_drops_join_and_lose_no_water() {
        let (p, mut course) = rain();
        (course.drying_s, course.arrivals_hz, course.wiper) = (None, 0.0, None);
        // Far enough inside the rectangle that no drop leaves it.
        let wide = DropsParameters { size_mm: DVec2::splat(1000.0), count: 20_000, ..p };
        let volume = |drops: &[Droplet]| drops.iter().map(|d| Cap::new(d.radius_mm, 1.0).volume_mm3()).sum::<f64>();
        let (first, later) = (at(&wide, &course, 1.0, DOWN), at(&wide, &course, 1.5, DOWN));
        assert!(later.len() < first.len(), "some have joined: {} {}", first.len(), later.len());
        let near =
            |drops: &[Droplet]| -> Vec<Droplet> { drops.iter().copied().filter(|d| d.centre_mm.y < 450.0).collect() };
        // Volume only decreases; drops that left crossed the lower edge.
        assert!(volume(&later) <= volume(&first) * (1.0 + 1e-12));
        assert!((volume(&near(&later)) / volume(&near(&first)) - 1.0).abs() < 0.02);
        let inner = DropsParameters { count: 2_000, ..wide };
        let shifted = at(&inner, &course, 1.0, DOWN);
        let slid = at(&inner, &Course { sliding: None, ..course }, 9.0, DOWN);
        assert_eq!(shifted, slid, "what does not slide stays");
    }

    /// The square of the radius falls linearly: a drop of the largest radius dries in the stated time, smaller ones in proportion to their square.
    #[test]
    fn drops_dry_by_the_law_of_squares() {
        let (p, mut course) = rain();
        (course.sliding, course.arrivals_hz, course.wiper) = (None, 0.0, None);
        let (first, later) = (at(&p, &course, 1.0, DOWN), at(&p, &course, 4.0, DOWN));
        // A tenth of the time: 0.1 · 2² mm².
        let left: Vec<&Droplet> = first.iter().filter(|d| d.radius_mm * d.radius_mm > 0.4 + 1e-9).collect();
        assert_eq!(left.len(), later.len());
        for (a, b) in left.iter().zip(&later) {
            assert!((a.radius_mm * a.radius_mm - b.radius_mm * b.radius_mm - 0.4).abs() < 1e-9);
        }
        let largest = first.iter().map(|d| d.radius_mm).fold(0.0, f64::max);
        assert!(at(&p, &course, 1.0 + 30.0 * pow(largest / 2.0, 2.0) + 0.1, DOWN).is_empty());
    }

    #[test]
    fn drops_arrive_at_their_rate() {
        let (p, mut course) = rain();
        (course.sliding, course.drying_s, course.wiper) = (None, None, None);
        // Small and sparse, so that few coalesce.
        let p = DropsParameters { count: 0, radius_mm: [0.01, 0.02], ..p };
        let drops = at(&p, &course, 6.0, DOWN);
        assert!(drops.len() <= 300 && drops.len() >= 297, "{}", drops.len());
        assert!(at(&p, &course, 1.0, DOWN).is_empty());
    }

    #[test]
    fn nothing_is_left_where_the_wiper_has_just_passed() {
        let (p, mut course) = rain();
        course.arrivals_hz = 0.0;
        let w = course.wiper.expect("a wiper");
        let in_arc = |d: &&Droplet| {
            let from = d.centre_mm - w.pivot_mm;
            let angle = atan2(from.x, -from.y);
            let r = from.length();
            (w.blade_mm[0]..w.blade_mm[1]).contains(&r) && (w.angles_rad[0]..w.angles_rad[1]).contains(&angle)
        };
        let swept = |t: f64| at(&p, &course, t, DOWN).iter().filter(in_arc).count();
        assert!(swept(1.29) > 30, "{}", swept(1.29));
        assert_eq!(swept(1.3 + 0.4), 0);
        let half = swept(1.3 + 0.2);
        assert!(half > 5 && half < swept(1.29) - 5, "half the arc at half the time: {half}");
        // Drops outside the arc stay.
        assert!(at(&p, &course, 1.7, DOWN).len() > 30);
    }

    #[test]
    fn drops_at_a_time_lie_on_the_glass() {
        let (p, course) = rain();
        let plane = |at: DVec2| (at.y < 20.0).then_some((at.extend(5.0), DVec3::Z));
        let upper = DropsParameters { offset_mm: DVec2::new(0.0, -30.0), ..p };
        let drops = Drops::new(upper, &plane).expect("legal drops");
        let later = drops.at(&course, 5.0, DVec3::new(0.0, 0.9, 0.4), &plane).expect("some are there");
        assert!(later.droplets().iter().all(|d| d.centre_mm.y < 20.0) && later.droplets().len() > 50);
    }
}
