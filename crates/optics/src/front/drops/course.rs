//! Drops over time: position and size, sliding down the glass, and removal by a wiper.
//!
//! Sliding on tilted glass.
//!
//! A drop stays in place until its weight along the glass overcomes the hysteresis of its contact angle (C. G. L. Furmidge, J. Colloid Sci. 17,
//! 1962). Beyond that its speed grows linearly with the Bond number (T. Podgorski, J.-M. Flesselles and L. Limat, Phys. Rev. Lett. 87, 2001), for
//! similar drops the square of the radius:
//!
//! v = v₁ (a² sin α − a₀²)/(a₁² − a₀²), never below 0,
//!
//! with the slope α of the glass, the radius a₀ below which a drop stays on upright glass, and the speed v₁ there of a drop of the largest arriving
//! radius a₁. Larger drops, formed by coalescence, are faster. Left out: wind along the glass, trails, winding paths.
//!
//! A wiper that clears drops along its arc.
//!
//! The blade turns at a constant rate from one angle to the other and back, and rests there for the remainder of its period. A drop that it touches
//! disappears. Left out: the visible wiper itself, the film that it leaves, and drops that it pushes on.

use core::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{atan2, sin_cos};
use glam::DVec2;

use crate::error::front::{FrontError, positive};

/// A drop on the glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Droplet {
    /// Centre in the glass's frame, x to the right, y down, mm.
    pub centre_mm: DVec2,
    /// Radius of its base, mm.
    pub radius_mm: f64,
}

/// Parameters of sliding drops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sliding {
    /// Speed on upright glass of a drop of the largest arriving radius, mm/s.
    pub speed_mm_s: f64,
    /// Radius below which a drop stays on upright glass, mm; below the largest radius.
    pub still_radius_mm: f64,
}

impl Sliding {
    pub(super) fn check(&self, max_mm: f64) -> Result<(), FrontError> {
        positive("speed_mm_s", self.speed_mm_s)?;
        let (name, value) = ("still_radius_mm", self.still_radius_mm);
        let right = (0.0..max_mm).contains(&value);
        if right { Ok(()) } else { Err(FrontError::Number { name, value, range: "0 or more and below max_radius_mm" }) }
    }

    /// Velocity of a drop, mm/s; `down` is the direction of gravity along the glass, its length the sine of the slope.
    pub(super) fn velocity_mm_s(&self, drop: Droplet, down: DVec2, max_mm: f64) -> DVec2 {
        let (sine, still) = (down.length(), self.still_radius_mm * self.still_radius_mm);
        let excess = drop.radius_mm * drop.radius_mm * sine - still;
        if !(excess > 0.0 && sine > 0.0) {
            return DVec2::ZERO;
        }
        down / sine * (self.speed_mm_s * excess / (max_mm * max_mm - still))
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wiper {
    /// Pivot in the glass's frame, x to the right, y down, mm.
    pub pivot_mm: DVec2,
    /// Distances of the blade's ends from the pivot, mm.
    pub blade_mm: [f64; 2],
    /// Rest angle and turning angle: from upwards, clockwise as seen by the camera, rad; less than a full turn apart.
    pub angles_rad: [f64; 2],
    /// Duration of a sweep in one direction, s.
    pub sweep_s: f64,
    /// Time from the start of one sweep to that of the next, s; at least twice `sweep_s`.
    pub period_s: f64,
    /// Start of the first sweep, s of simulated time.
    pub start_s: f64,
}

impl Wiper {
    pub(super) fn check(&self) -> Result<(), FrontError> {
        let [inner, outer] = self.blade_mm;
        positive("sweep_s", self.sweep_s)?;
        let number = |name, value, right: bool, range| match right {
            true => Ok(()),
            false => Err(FrontError::Number { name, value, range }),
        };
        number("period_s", self.period_s, self.period_s >= 2.0 * self.sweep_s, "at least twice sweep_s")?;
        number("blade_mm", inner, inner >= 0.0 && inner < outer, "0 or more, and its first number below its second")?;
        let turn = (self.angles_rad[1] - self.angles_rad[0]).abs();
        number(
            "angles_deg",
            turn * 180.0 / PI,
            turn > 0.0 && turn < TAU,
            "two numbers less than 360 apart, and not equal",
        )
    }

    /// The blade's angle at a time, rad.
    #[must_use]
    pub fn angle_rad(&self, time_s: f64) -> f64 {
        let [rest, turn] = self.angles_rad;
        let since_s = time_s - self.start_s;
        if since_s < 0.0 {
            return rest;
        }
        let phase_s = since_s - (since_s / self.period_s).floor() * self.period_s;
        // From 0 to 1 and back.
        let direction = (1.0 - (phase_s / self.sweep_s - 1.0).abs()).max(0.0);
        rest + (turn - rest) * direction
    }

    /// The angles passed by the blade between two times less than a sweep apart, smallest and largest, rad; `None` while it rests.
    fn passed_rad(&self, from_s: f64, to_s: f64) -> Option<[f64; 2]> {
        let first = ((from_s - self.start_s) / self.period_s).floor();
        let turns = [0.0, 1.0].iter().flat_map(|n| {
            let begin_s = self.start_s + (first + n) * self.period_s;
            [begin_s, begin_s + self.sweep_s, begin_s + 2.0 * self.sweep_s]
        });
        let within = turns.filter(|t| (from_s..=to_s).contains(t));
        let angles = [from_s, to_s].into_iter().chain(within).map(|t| self.angle_rad(t));
        let [low, high] = angles.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        (high > low).then_some([low, high])
    }

    /// Removes the drops touched by the blade between two times less than a sweep apart.
    pub(super) fn wipe(&self, drops: &mut Vec<Droplet>, from_s: f64, to_s: f64) {
        let Some(angles) = self.passed_rad(from_s, to_s) else { return };
        drops.retain(|drop| self.gap_mm(drop.centre_mm, angles) > drop.radius_mm);
    }

    /// Distance of a point from the part of the arc between two angles, mm.
    fn gap_mm(&self, point_mm: DVec2, [low, high]: [f64; 2]) -> f64 {
        let from = point_mm - self.pivot_mm;
        let [inner, outer] = self.blade_mm;
        let middle = 0.5 * (low + high);
        let off = atan2(from.x, -from.y) - middle;
        let off = off - (off / TAU).round() * TAU;
        if off.abs() <= 0.5 * (high - low) {
            let r = from.length();
            return (inner - r).max(r - outer).max(0.0);
        }
        let edge = |angle: f64| {
            let (s, c) = sin_cos(angle);
            let along = DVec2::new(s, -c);
            from.distance(along * from.dot(along).clamp(inner, outer))
        };
        edge(low).min(edge(high))
    }
}

/// Changes of drops over time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Course {
    /// Simulated time of the initial drops, s; before it they do not change.
    pub start_s: f64,
    /// Sliding; `None`: drops stay in place.
    pub sliding: Option<Sliding>,
    /// Drying time of a drop of the largest arriving radius, s; `None`: drops do not dry.
    pub drying_s: Option<f64>,
    /// Rate of drops arriving on the rectangle, 1/s; 0 for none.
    pub arrivals_hz: f64,
    /// Wiper; `None` for none.
    pub wiper: Option<Wiper>,
}

impl Course {
    pub(super) fn check(&self, max_mm: f64) -> Result<(), FrontError> {
        self.sliding.map_or(Ok(()), |sliding| sliding.check(max_mm))?;
        self.drying_s.map_or(Ok(1.0), |s| positive("drying_s", s))?;
        self.wiper.map_or(Ok(()), |wiper| wiper.check())?;
        let (value, name) = (self.arrivals_hz, "arrivals_per_s");
        let right = value.is_finite() && value >= 0.0;
        if right { Ok(()) } else { Err(FrontError::Number { name, value, range: "finite and 0 or more" }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_those_of_the_law() {
        let law = Sliding { speed_mm_s: 50.0, still_radius_mm: 1.0 };
        let speed = |radius_mm, down| law.velocity_mm_s(Droplet { centre_mm: DVec2::ZERO, radius_mm }, down, 2.0);
        assert_eq!(speed(2.0, DVec2::Y), DVec2::new(0.0, 50.0));
        assert_eq!(speed(1.0, DVec2::Y), DVec2::ZERO);
        // On a slope of 30° a drop of 2 mm has 4 · 0.5 − 1 of 3 parts.
        assert!((speed(2.0, DVec2::Y * 0.5).y - 50.0 / 3.0).abs() < 1e-12);
        assert_eq!(speed(2.0, DVec2::ZERO), DVec2::ZERO);
        assert!((speed(3.0, DVec2::Y).y - 50.0 * 8.0 / 3.0).abs() < 1e-12);
    }

    fn wiper() -> Wiper {
        let angles_rad = [-1.4, 0.6];
        Wiper {
            pivot_mm: DVec2::new(5.0, 80.0),
            blade_mm: [20.0, 90.0],
            angles_rad,
            sweep_s: 0.5,
            period_s: 1.5,
            start_s: 2.0,
        }
    }

    #[test]
    fn the_blade_goes_there_and_back_and_rests() {
        let w = wiper();
        let near = |t, angle: f64| assert!((w.angle_rad(t) - angle).abs() < 1e-12, "{t}: {}", w.angle_rad(t));
        [(0.0, -1.4), (2.0, -1.4), (2.25, -0.4), (2.5, 0.6), (2.75, -0.4), (3.2, -1.4), (3.75, -0.4)]
            .iter()
            .for_each(|(t, angle)| near(*t, *angle));
        assert_eq!(w.passed_rad(1.0, 1.02), None);
        assert_eq!(w.passed_rad(3.1, 3.2), None);
        let [low, high] = w.passed_rad(2.48, 2.52).expect("it moves");
        assert!((high - 0.6).abs() < 1e-12 && (low - 0.52).abs() < 1e-12, "it turns back in between: {low} {high}");
    }

    #[test]
    fn a_drop_goes_where_its_disc_touches_the_sector() {
        let w = wiper();
        let at = |angle: f64, r: f64| w.pivot_mm + r * DVec2::new(sin_cos(angle).0, -sin_cos(angle).1);
        let gone = |centre_mm, radius_mm| {
            let mut drops = vec![Droplet { centre_mm, radius_mm }];
            w.wipe(&mut drops, 2.1, 2.3);
            drops.is_empty()
        };
        // From −1.0 to −0.2 rad.
        assert!(gone(at(-0.5, 50.0), 0.1) && gone(at(-0.5, 91.0), 1.1) && gone(at(-0.5, 19.0), 1.1));
        assert!(!gone(at(-0.5, 91.0), 0.9) && !gone(at(-0.5, 19.0), 0.9));
        assert!(!gone(at(0.0, 50.0), 1.0) && gone(at(-0.19, 50.0), 1.0) && !gone(at(2.0, 50.0), 1.0));
    }
}
