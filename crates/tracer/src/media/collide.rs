//! Where light is next scattered.

use etendue_core::random::{Draw, PathStream};
use etendue_core::{Ray, Spectral, Wavelengths};

use super::media::{Media, free_flight};
use super::medium::Following;
use super::phase::Phase;

/// Flights, with those that met nothing, that one ray is followed by at most; beyond, its light is taken as lost.
const MAX_FLIGHTS: u32 = 65_536;

/// A place where light is scattered.
#[derive(Clone, Copy, Debug)]
pub struct Collision<'a> {
    /// Where along the ray, in lengths of its direction.
    pub t: f32,
    /// How it is scattered there.
    pub phase: &'a Phase,
}

impl<'a> Media<'a> {
    /// Follows a ray up to `end`, in lengths of its direction, or to where it is scattered; `None` where nothing scatters it. `throughput` is
    /// weighed by what was absorbed and by the chances that were taken, zero where no light is left. `flights` counts the random numbers that
    /// the path has used.
    pub fn collide<const N: usize>(
        &self,
        (ray, following): (&Ray, Following),
        end: f64,
        (stream, flights): (&PathStream, &mut u32),
        wavelengths: &Wavelengths<N>,
        throughput: &mut Spectral<N>,
    ) -> Option<Collision<'a>> {
        let length_m = f64::from(ray.direction.length());
        let last = flights.saturating_add(MAX_FLIGHTS);
        let mut t = 0.0;
        while t < end {
            let piece = self.piece((ray, following), t, end);
            if piece.majorant_per_m <= 0.0 {
                t = piece.end;
                continue;
            }
            t += free_flight(stream.one(Draw::FreeFlight, *flights)) / (piece.majorant_per_m * length_m);
            *flights += 1;
            if t >= piece.end {
                // Exponential flights have no memory: on from the border as if from anew.
                t = piece.end;
                continue;
            }
            let u = stream.one(Draw::Collision, *flights);
            match self.event((ray, following), t, piece.majorant_per_m as f32, u, wavelengths, throughput) {
                Event::Null => {}
                Event::Scattered(phase) => return Some(Collision { t: t as f32, phase }),
                Event::Absorbed => return None,
            }
            if *flights >= last {
                *throughput = Spectral::ZERO;
                return None;
            }
        }
        None
    }

    /// What happens at a tentative collision, drawn by what light counts that is scattered by each medium, or by none.
    fn event<const N: usize>(
        &self,
        (ray, following): (&Ray, Following),
        t: f64,
        majorant_per_m: f32,
        u: f32,
        wavelengths: &Wavelengths<N>,
        throughput: &mut Spectral<N>,
    ) -> Event<'a> {
        let within = |i: usize| {
            let placed = &self.placed[i];
            let inside = self.span(placed, ray, f64::INFINITY).is_some_and(|(from, to)| t >= from && t < to);
            let density = if inside { self.density(placed, ray, t) as f32 } else { 0.0 };
            placed.medium.optics(following).extinction.sample(wavelengths) * density
        };
        let scattered = |i: usize| within(i) * self.placed[i].medium.optics(following).albedo.sample(wavelengths);
        let extinction = (0..self.placed.len()).map(within).fold(Spectral::ZERO, |sum, of| sum + of);
        let null = extinction.map(|extinction| (majorant_per_m - extinction).max(0.0));
        let counts = |of: Spectral<N>| (*throughput * of).mean();
        let by_null = counts(null);
        let whole = by_null + (0..self.placed.len()).map(|i| counts(scattered(i))).sum::<f32>();
        if whole <= 0.0 {
            *throughput = Spectral::ZERO;
            return Event::Absorbed;
        }
        let mut rest = u * whole;
        for i in 0..self.placed.len() {
            let share = counts(scattered(i));
            if rest < share {
                *throughput *= scattered(i) * (whole / share / majorant_per_m);
                return Event::Scattered(&self.placed[i].medium.optics(following).phase);
            }
            rest -= share;
        }
        if by_null <= 0.0 {
            // Rounding has left a rest beyond the last share: as absorbed, which is rarer than any number of samples.
            *throughput = Spectral::ZERO;
            return Event::Absorbed;
        }
        *throughput *= null * (whole / by_null / majorant_per_m);
        Event::Null
    }
}

enum Event<'a> {
    Null,
    Scattered(&'a Phase),
    Absorbed,
}
