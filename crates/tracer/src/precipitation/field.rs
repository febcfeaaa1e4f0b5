//! The set of particles and their places: a pure function of seed and time.
//!
//! Each class has a lattice of cubes that moves with the class's velocity, over all of space. The particles of a cube are hashed from the cube's
//! place, the class and the seed: a Poisson number of mean four, uniform places, sizes by the law. Nothing is stored; a query for a part of space
//! lists its cubes.

use etendue_core::TimeInterval;
use etendue_core::maths::f64::{cbrt, exp};
use etendue_core::random::{philox4x32, unit_f64};
use glam::{DVec3, I64Vec3};

use super::change_over::{ChangeOver, VisibleRegion};
use super::size_law::{SizeClass, SizeLaw};

/// Mean number of particles of a cube.
const MEAN_PARTICLES: f64 = 4.0;

/// Maximum number of particles of a cube: a Poisson number of mean 4 is larger once in 10¹⁶ cubes.
const MAX_PARTICLES: u32 = 40;

/// Rain or snow.
#[derive(Clone, Debug, PartialEq)]
pub struct PrecipitationField {
    law: SizeLaw,
    classes: Vec<SizeClass>,
    wind_mps: DVec3,
    seed: u32,
    top_m: f64,
}

/// A drop or flake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    pub class: u32,
    /// Its centre at the time 0, in the world, m.
    pub start_m: DVec3,
    /// Its velocity, m/s.
    pub velocity_mps: DVec3,
    /// Its size by the law, mm.
    pub size_mm: f64,
}

impl Particle {
    /// Its centre at a simulated time, in the world, m.
    #[must_use]
    pub fn at(&self, time_s: f64) -> DVec3 {
        self.start_m + self.velocity_mps * time_s
    }
}

impl PrecipitationField {
    /// Rain or snow by a law, in a wind, below the height `top_m`.
    #[must_use]
    pub fn new(law: SizeLaw, wind_mps: DVec3, top_m: f64, seed: u32) -> Self {
        Self { classes: SizeClass::all(&law), law, wind_mps, seed, top_m }
    }

    /// The law of sizes.
    #[must_use]
    pub fn law(&self) -> &SizeLaw {
        &self.law
    }

    /// The law in classes, from the smallest.
    #[must_use]
    pub fn classes(&self) -> &[SizeClass] {
        &self.classes
    }

    /// Height of the upper end in the world, m.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        self.top_m
    }

    /// Extinction of an image by all particles, 1/m.
    #[must_use]
    pub fn extinction_per_m(&self) -> f64 {
        self.classes.iter().map(|class| class.extinction_per_m).sum()
    }

    /// Velocity of a class, m/s.
    #[must_use]
    pub fn velocity_mps(&self, class: usize) -> DVec3 {
        self.wind_mps - DVec3::Z * self.classes[class].speed_mps
    }

    /// The particles that may be visible at some time of an interval from near `origin_m` (world), within the distances of a change-over;
    /// some others may be included. Their order depends only on the arguments.
    #[must_use]
    pub fn particles_near(
        &self,
        origin_m: DVec3,
        interval: TimeInterval,
        region: &VisibleRegion,
        change_over: &ChangeOver,
    ) -> Vec<Particle> {
        let mut particles = vec![];
        for (class, radius_m) in change_over.radii_m.iter().enumerate() {
            if *radius_m > change_over.clear_m {
                ParticleSearch { field: self, class, origin_m, interval, region, radius_m: *radius_m }
                    .run(&mut particles);
            }
        }
        particles
    }

    /// The edge of a class's cubes, m.
    fn edge_m(&self, class: usize) -> f64 {
        cbrt(MEAN_PARTICLES / self.classes[class].number_per_m3)
    }

    /// The particles of one cube.
    fn cube(&self, class: usize, place: I64Vec3, mut emit: impl FnMut(Particle)) {
        let words = |sub: u32| {
            let key = [self.seed, (class as u32) << 16 | sub];
            let [x, y, z] = place.to_array();
            // The upper halves keep lattices from repeating.
            let high = (x >> 32) as u32 ^ ((y >> 32) as u32).rotate_left(11) ^ ((z >> 32) as u32).rotate_left(22);
            philox4x32([x as u32, y as u32, z as u32, high], key)
        };
        let [a, b, ..] = words(0);
        let count = poisson(unit(a, b));
        let edge_m = self.edge_m(class);
        for i in 0..count {
            let [a, b, c, d] = words(1 + i);
            let low = |word: u32| f64::from(word) / 4_294_967_296.0;
            let start_m = (place.as_dvec3() + DVec3::new(low(a), low(b), low(c))) * edge_m;
            let size_mm = self.classes[class].size_mm(&self.law, (f64::from(d) + 0.5) / 4_294_967_296.0);
            emit(Particle { class: class as u32, start_m, velocity_mps: self.velocity_mps(class), size_mm });
        }
    }
}

fn unit(a: u32, b: u32) -> f64 {
    unit_f64(u64::from(a) << 32 | u64::from(b))
}

/// A Poisson number of mean [`MEAN_PARTICLES`] by inversion.
fn poisson(u: f64) -> u32 {
    let (mut count, mut chance) = (0, exp(-MEAN_PARTICLES));
    let mut below = chance;
    while u >= below && count < MAX_PARTICLES {
        count += 1;
        chance *= MEAN_PARTICLES / f64::from(count);
        below += chance;
    }
    count
}

/// The fractions of a displacement `way` from a point between which it lies within a ball about the origin; `None` if no part of it does.
fn within(from: DVec3, displacement: DVec3, radius_m: f64) -> Option<[f64; 2]> {
    let length2 = displacement.length_squared();
    if length2 == 0.0 {
        return (from.length() <= radius_m).then_some([0.0, 1.0]);
    }
    let nearest = -from.dot(displacement) / length2;
    let half2 = (radius_m * radius_m - (from + displacement * nearest).length_squared()) / length2;
    let [enter, leave] = [(nearest - half2.max(0.0).sqrt()).max(0.0), (nearest + half2.max(0.0).sqrt()).min(1.0)];
    (half2 >= 0.0 && enter <= leave).then_some([enter, leave])
}

/// One class about one view.
struct ParticleSearch<'a> {
    field: &'a PrecipitationField,
    class: usize,
    origin_m: DVec3,
    interval: TimeInterval,
    region: &'a VisibleRegion,
    radius_m: f64,
}

impl ParticleSearch<'_> {
    fn run(&self, particles: &mut Vec<Particle>) {
        let reach = DVec3::splat(self.radius_m) + self.swept_m().abs();
        let middle = self.origin_m - self.velocity() * self.interval.middle_s();
        let edge_m = self.field.edge_m(self.class);
        let low = ((middle - reach) / edge_m).floor().as_i64vec3();
        let size = ((middle + reach) / edge_m).floor().as_i64vec3() - low + I64Vec3::ONE;
        let side = (size.max_element() as u64).next_power_of_two() as i64;
        self.block(low, side, low + size, particles);
    }

    fn velocity(&self) -> DVec3 {
        self.field.velocity_mps(self.class)
    }

    /// Half of the displacement during the interval, m.
    fn swept_m(&self) -> DVec3 {
        self.velocity() * (0.5 * self.interval.length_s())
    }

    /// A block of cubes, below `end`.
    fn block(&self, low: I64Vec3, side: i64, end: I64Vec3, particles: &mut Vec<Particle>) {
        let edge_m = self.field.edge_m(self.class);
        let half_m = 0.5 * side as f64 * edge_m;
        let centre = low.as_dvec3() * edge_m + DVec3::splat(half_m);
        if low.cmpge(end).any() || !self.may_hold(centre, half_m * 3.0_f64.sqrt()) {
            return;
        }
        if side == 1 {
            let mut add_particle = |particle: Particle| {
                let radius_m = self.field.law.diameter_mm(particle.size_mm) * 1e-3;
                if self.may_hold(particle.start_m, radius_m) && self.is_below_top(&particle) {
                    particles.push(particle);
                }
            };
            self.field.cube(self.class, low, &mut add_particle);
            return;
        }
        let half = side / 2;
        for corner in 0..8_i64 {
            let step = I64Vec3::new(corner & 1, corner >> 1 & 1, corner >> 2) * half;
            self.block(low + step, half, end, particles);
        }
    }

    fn is_below_top(&self, particle: &Particle) -> bool {
        particle.at(self.interval.middle_s()).z <= self.field.top_m
    }

    /// True if the content of a ball of the lattice at the time 0 may be visible in the interval. The test uses the part of its path near
    /// the camera, if there is one, in a ball of its own.
    fn may_hold(&self, centre_m: DVec3, radius_m: f64) -> bool {
        let middle = centre_m + self.velocity() * self.interval.middle_s() - self.origin_m;
        let (from, displacement) = (middle - self.swept_m(), 2.0 * self.swept_m());
        let Some([enter, leave]) = within(from, displacement, self.radius_m + radius_m) else { return false };
        let (centre, half_m) =
            (from + displacement * (0.5 * (enter + leave)), 0.5 * (leave - enter) * displacement.length());
        self.region.may_see(centre, radius_m + half_m)
    }
}
