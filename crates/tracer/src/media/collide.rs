//! Sampling of the next scattering point of a ray.

use etendue_core::random::{Draw, PathStream};
use etendue_core::{Spectral, Wavelengths};

use super::media::{Media, MediaRay, free_flight};
use super::phase::Phase;

/// Maximum number of flights of one ray, including those that hit nothing; beyond, its light counts as lost.
const MAX_FLIGHTS: u32 = 65_536;

/// Random numbers of free flights.
#[derive(Debug)]
pub struct FlightRandom<'s> {
    pub stream: &'s PathStream,
    /// Number of random numbers that the path has used.
    pub counter: &'s mut u32,
}

/// A place where light is scattered.
#[derive(Clone, Copy, Debug)]
pub struct Collision<'a> {
    /// Ray parameter, in lengths of its direction.
    pub t: f32,
    /// Phase function there.
    pub phase: &'a Phase,
}

impl<'a> Media<'a> {
    /// Follows a ray up to `end`, in lengths of its direction, or to the point where it is scattered; `None` if nothing scatters it.
    /// `throughput` is weighted by absorption and by the sampled probabilities; it is zero if no light is left.
    pub fn collide<const N: usize>(
        &self,
        media_ray: MediaRay<'_>,
        end: f64,
        random: FlightRandom<'_>,
        wavelengths: &Wavelengths<N>,
        throughput: &mut Spectral<N>,
    ) -> Option<Collision<'a>> {
        let FlightRandom { stream, counter: flights } = random;
        let length_m = f64::from(media_ray.ray.direction.length());
        let last = flights.saturating_add(MAX_FLIGHTS);
        let mut t = 0.0;
        while t < end {
            let piece = self.piece(media_ray, t, end);
            if piece.majorant_per_m <= 0.0 {
                t = piece.end;
                continue;
            }
            t += free_flight(stream.one(Draw::FreeFlight, *flights)) / (piece.majorant_per_m * length_m);
            *flights += 1;
            if t >= piece.end {
                // Exponential flights have no memory: the flight starts again at the border.
                t = piece.end;
                continue;
            }
            let u = stream.one(Draw::Collision, *flights);
            match self.event(media_ray, t, piece.majorant_per_m as f32, u, wavelengths, throughput) {
                CollisionEvent::Null => {}
                CollisionEvent::Scattered(phase) => return Some(Collision { t: t as f32, phase }),
                CollisionEvent::Absorbed => return None,
            }
            if *flights >= last {
                *throughput = Spectral::ZERO;
                return None;
            }
        }
        None
    }

    /// Samples the event at a tentative collision, by the light that each medium scatters, or that none does.
    fn event<const N: usize>(
        &self,
        media_ray: MediaRay<'_>,
        t: f64,
        majorant_per_m: f32,
        u: f32,
        wavelengths: &Wavelengths<N>,
        throughput: &mut Spectral<N>,
    ) -> CollisionEvent<'a> {
        let MediaRay { ray, peak } = media_ray;
        let within = |i: usize| {
            let placed = &self.placed[i];
            let inside = self.span(placed, ray, f64::INFINITY).is_some_and(|span| t >= span.from && t < span.to);
            let density = if inside { self.density(placed, ray, t) as f32 } else { 0.0 };
            placed.medium.optics(peak).extinction.sample(wavelengths) * density
        };
        let scattered = |i: usize| within(i) * self.placed[i].medium.optics(peak).albedo.sample(wavelengths);
        let extinction = (0..self.placed.len()).map(within).fold(Spectral::ZERO, |sum, of| sum + of);
        let null = extinction.map(|extinction| (majorant_per_m - extinction).max(0.0));
        let counts = |of: Spectral<N>| (*throughput * of).mean();
        let by_null = counts(null);
        let total = by_null + (0..self.placed.len()).map(|i| counts(scattered(i))).sum::<f32>();
        if total <= 0.0 {
            *throughput = Spectral::ZERO;
            return CollisionEvent::Absorbed;
        }
        let mut rest = u * total;
        for i in 0..self.placed.len() {
            let fraction = counts(scattered(i));
            if rest < fraction {
                *throughput *= scattered(i) * (total / fraction / majorant_per_m);
                return CollisionEvent::Scattered(&self.placed[i].medium.optics(peak).phase);
            }
            rest -= fraction;
        }
        if by_null <= 0.0 {
            // Rounding has left a remainder beyond the last probability: treated as absorbed, which is rarer than any number of samples.
            *throughput = Spectral::ZERO;
            return CollisionEvent::Absorbed;
        }
        *throughput *= null * (total / by_null / majorant_per_m);
        CollisionEvent::Null
    }
}

enum CollisionEvent<'a> {
    Null,
    Scattered(&'a Phase),
    Absorbed,
}
