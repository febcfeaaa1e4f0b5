//! Rolling wheels.
//!
//! A wheel of radius r that rolls without slipping turns about its axle (y) by φ(t) = (1/r) ∫ v·x̂ dt, with the velocity v of its centre in the world and the
//! unit direction x̂ in which its hub points forward. Between two moments without a key of any track that carries the hub the integrand is analytic; it is
//! integrated by five-point Gaussian quadrature, and φ is kept as cubic Hermite polynomials with the exact rate at both ends. Their number is doubled until the
//! error of φ is below 1e-6 rad at the quarters of each. Beyond 4096 only those that miss it are halved. A single one is exact along straight lines at constant
//! speed.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::span::{Cubic, Pose, Span};
use super::turn::{Turn, rolled};
use super::{KeyedTrack, Track, TrackState};

/// Maximum error of φ at the quarters of a polynomial, rad.
const TOLERANCE_RAD: f64 = 1e-6;
/// Maximum number of polynomials of equal length between two keys; beyond it they are halved where needed.
const MAX_UNIFORM_PIECES: u32 = 4096;
/// Largest angle that can be followed, rad. The tolerance requires ten thousands of polynomials there. At an angle of 1e16 rad rounding is 1 rad, and no number
/// of polynomials would meet the tolerance.
const MAX_TURN_RAD: f64 = 1e12;
/// Maximum number of polynomials between two keys. A motion that needs more turns to and fro beyond the largest angle.
const MAX_PIECES: usize = 1 << 20;

/// Reason for which a wheel is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RollingError {
    /// The hub never moves.
    #[error("the wheel never moves; give its hub keys, or attach it to a moving frame")]
    Still,
    /// The wheel turns by more than can be followed.
    #[error(
        "the wheel would turn by {turned_rad:.3e} rad, but at most 1e12 can be traced; give it a larger radius or a shorter path"
    )]
    TooFar {
        /// Angle between two keys, rad, as far as it was computed.
        turned_rad: f64,
    },
}

impl Track {
    /// Returns the rotation about y of a wheel: 0 until the first of `times_s`, which increase, then the integral of `rate_rad_s`. The arguments of
    /// `rate_rad_s` are a time, and a time strictly between the same two of `times_s`: at these themselves the rate may jump.
    pub(crate) fn rolling(times_s: &[f64], rate_rad_s: impl Fn(f64, f64) -> f64) -> Result<Self, RollingError> {
        let (mut knots_s, mut spans, mut angle) = (Vec::new(), Vec::new(), 0.0);
        for pair in times_s.windows(2) {
            let within_s = pair[0] + 0.5 * (pair[1] - pair[0]);
            for piece in pieces(pair[0], pair[1], &|time_s| rate_rad_s(time_s, within_s))? {
                knots_s.push(piece.start_s);
                spans.push(turning(piece.cubic(angle)));
                angle += piece.turns;
            }
            check_turn(angle)?;
        }
        if spans.iter().all(Span::is_constant) {
            return Ok(Self::constant(DAffine3::IDENTITY));
        }
        knots_s.extend(times_s.last());
        let last = Pose { position: DVec3::ZERO, rotation: rolled(angle), scale: DVec3::ONE };
        Ok(Self(TrackState::Moving(Arc::new(KeyedTrack { times_s: knots_s, spans, last, first: DAffine3::IDENTITY }))))
    }
}

/// Refuses an angle that is too large or not finite.
fn check_turn(turned_rad: f64) -> Result<(), RollingError> {
    match turned_rad.abs() <= MAX_TURN_RAD {
        true => Ok(()),
        false => Err(RollingError::TooFar { turned_rad: turned_rad.abs() }),
    }
}

/// Refuses pieces whose summed angles, to and fro, are too large.
fn check_pieces(pieces: &[RollingPiece]) -> Result<(), RollingError> {
    check_turn(pieces.iter().map(|piece| piece.turns.abs()).sum())
}

fn turning(angle: [f64; 4]) -> Span {
    let still = |at: DVec3| Cubic::straight(at, at);
    Span { position: still(DVec3::ZERO), scale: still(DVec3::ONE), turn: Turn::Rolling { angle } }
}

/// Rotation during a time.
struct RollingPiece {
    start_s: f64,
    /// Total angle, rad.
    turns: f64,
    /// Rates at both ends, rad per length of the piece.
    rates: [f64; 2],
    /// Angles at the quarters, rad.
    quarters: [f64; 2],
}

impl RollingPiece {
    fn new(start_s: f64, end_s: f64, rate_rad_s: &impl Fn(f64) -> f64) -> Self {
        let length_s = end_s - start_s;
        let at = |u: f64| start_s + u * length_s;
        let first = gauss(at(0.0), at(0.25), rate_rad_s);
        let third = first + gauss(at(0.25), at(0.75), rate_rad_s);
        let turns = third + gauss(at(0.75), end_s, rate_rad_s);
        let rates = [start_s, end_s].map(|time_s| rate_rad_s(time_s) * length_s);
        Self { start_s, turns, rates, quarters: [first, third] }
    }

    /// Coefficients of the Hermite polynomial that begins at `angle`.
    fn cubic(&self, angle: f64) -> [f64; 4] {
        let [leaves, arrives] = self.rates;
        // Rounding gives no curvature to a constant rate.
        if (leaves - arrives).abs().max((leaves - self.turns).abs()) <= 1e-13 * leaves.abs() {
            return [angle, self.turns, 0.0, 0.0];
        }
        [angle, leaves, 3.0 * self.turns - 2.0 * leaves - arrives, leaves + arrives - 2.0 * self.turns]
    }

    fn is_met(&self) -> bool {
        let [_, b, c, d] = self.cubic(0.0);
        let off = |u: f64, exact: f64| (((d * u + c) * u + b) * u - exact).abs();
        off(0.25, self.quarters[0]).max(off(0.75, self.quarters[1])) <= TOLERANCE_RAD
    }
}

/// Returns the smallest number of pieces of equal length that meets the tolerance. If that is too large, only the pieces that miss it are halved.
fn pieces(start_s: f64, end_s: f64, rate_rad_s: &impl Fn(f64) -> f64) -> Result<Vec<RollingPiece>, RollingError> {
    let mut finished = vec![RollingPiece::new(start_s, end_s, rate_rad_s)];
    check_pieces(&finished)?;
    while !finished.iter().all(RollingPiece::is_met) {
        let count = 2 * finished.len() as u32;
        let end_of = |i: u32| start_s + (end_s - start_s) * (f64::from(i) / f64::from(count));
        let ends_s: Vec<f64> = (0..count).map(end_of).chain([end_s]).collect();
        if count > MAX_UNIFORM_PIECES || ends_s.windows(2).any(|pair| pair[0] >= pair[1]) {
            return halved(finished, end_s, rate_rad_s);
        }
        finished = ends_s.windows(2).map(|pair| RollingPiece::new(pair[0], pair[1], rate_rad_s)).collect();
        check_pieces(&finished)?;
    }
    Ok(finished)
}

/// Halves the pieces that miss the tolerance, as long as the times of their ends can be distinguished.
fn halved(
    pieces: Vec<RollingPiece>,
    end_s: f64,
    rate_rad_s: &impl Fn(f64) -> f64,
) -> Result<Vec<RollingPiece>, RollingError> {
    let mut ends_s: Vec<f64> = pieces.iter().skip(1).map(|piece| piece.start_s).chain([end_s]).collect();
    ends_s.reverse();
    let (mut waiting, mut finished) = (pieces, Vec::new());
    waiting.reverse();
    while let Some((piece, end_s)) = waiting.pop().zip(ends_s.pop()) {
        if finished.len() + waiting.len() >= MAX_PIECES {
            let turned_rad = finished.iter().chain(&waiting).map(|piece| piece.turns.abs()).sum();
            return Err(RollingError::TooFar { turned_rad });
        }
        let middle_s = piece.start_s + 0.5 * (end_s - piece.start_s);
        if piece.is_met() || middle_s <= piece.start_s || middle_s >= end_s {
            finished.push(piece);
            continue;
        }
        waiting.extend([
            RollingPiece::new(middle_s, end_s, rate_rad_s),
            RollingPiece::new(piece.start_s, middle_s, rate_rad_s),
        ]);
        ends_s.extend([end_s, middle_s]);
    }
    Ok(finished)
}

/// Integral from `a` to `b` by five points: exact for polynomials of degree nine.
fn gauss(a: f64, b: f64, f: &impl Fn(f64) -> f64) -> f64 {
    const NODES: [f64; 2] = [0.538_469_310_105_683_1, 0.906_179_845_938_664];
    const WEIGHTS: [f64; 3] = [0.568_888_888_888_888_9, 0.478_628_670_499_366_47, 0.236_926_885_056_189_08];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let pair = |node: f64| f(middle - half * node) + f(middle + half * node);
    half * (WEIGHTS[0] * f(middle) + WEIGHTS[1] * pair(NODES[0]) + WEIGHTS[2] * pair(NODES[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// φ = A (1 − cos ωt): a cubic over h misses it at its quarters by 9/6144 A ω⁴ h⁴ times the cosine, which with A = 10¹⁰ rad and ω = π/s requires 6 100
    /// pieces per second where that is 1, and fewer than 4 096 where it is below 0.2.
    #[test]
    fn a_wheel_of_very_many_turns_is_met_wherever_one_looks() {
        let amplitude = 1e10;
        let omega = core::f64::consts::PI;
        let rate = |time_s: f64, _: f64| amplitude * omega * crate::maths::f64::sin(omega * time_s);
        let turns_of_pieces = pieces(0.0, 1.0, &|time_s| rate(time_s, 0.5)).expect("below the greatest angle");
        assert!(
            turns_of_pieces.len() > MAX_UNIFORM_PIECES as usize
                && turns_of_pieces.len() < 2 * MAX_UNIFORM_PIECES as usize,
            "{}",
            turns_of_pieces.len()
        );
        assert!(turns_of_pieces.iter().all(RollingPiece::is_met));
        assert!(turns_of_pieces.windows(2).all(|pair| pair[0].start_s < pair[1].start_s));
        let turned: f64 = turns_of_pieces.iter().map(|piece| piece.turns).sum();
        // Rounding of some 7 000 sums of up to 2·10¹⁰ rad, half of 4·10⁻⁶ each.
        assert!((turned - 2.0 * amplitude).abs() < 1.5e-2, "{turned}");
    }

    /// No number of polynomials meets the tolerance where angles are rounded by more than it: halving would continue to the resolution of time.
    #[test]
    fn a_wheel_that_turns_by_more_than_can_be_followed_is_refused() {
        let turn = |amplitude: f64| pieces(0.0, 1.0, &|time_s| amplitude * time_s * (1.0 - time_s));
        assert!(turn(5.9e12).is_ok_and(|pieces| pieces.len() <= MAX_PIECES));
        for amplitude in [1e14, 1e30, 1e300, f64::INFINITY, f64::NAN] {
            assert!(matches!(turn(amplitude), Err(RollingError::TooFar { .. })), "{amplitude}");
        }
        // To and fro, with a total angle of zero.
        let fro = |amplitude: f64| pieces(0.0, 1.0, &|time_s| amplitude * crate::maths::f64::sin(40.0 * time_s));
        assert!(fro(1e10).is_ok() && fro(1e30).is_err());
    }
}
