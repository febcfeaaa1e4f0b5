//! A wiper that clears drops along its arc.
//!
//! The blade turns at an even rate from one angle to the other, back again, and rests there for the rest of its period. A drop that it
//! touches is gone. Left out: the wiper itself, which is not seen, the film that it leaves, and drops that it pushes on.

use super::droplet::Droplet;
use crate::error::front::{FrontError, positive};
use core::f64::consts::{PI, TAU};
use etendue_core::maths::f64::{atan2, sin_cos};
use glam::DVec2;

/// A wiper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wiper {
    /// Its axis in the glass's frame, x to the right, y down, mm.
    pub pivot_mm: DVec2,
    /// Where the blade begins and ends, from the axis, mm.
    pub blade_mm: [f64; 2],
    /// Where it rests and where it turns back: from upwards, clockwise as the camera sees it, rad; less than a full turn apart.
    pub angles_rad: [f64; 2],
    /// How long one way takes, s.
    pub sweep_s: f64,
    /// From the beginning of one sweep to that of the next, s; at least twice `sweep_s`.
    pub period_s: f64,
    /// When the first sweep begins, s of simulated time.
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
        let way = (1.0 - (phase_s / self.sweep_s - 1.0).abs()).max(0.0);
        rest + (turn - rest) * way
    }

    /// What the blade passes between two times less than a sweep apart, least and greatest angle, rad; `None` while it rests.
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

    /// Takes away what the blade touches between two times less than a sweep apart.
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

#[cfg(test)]
mod tests {
    use super::*;

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
