//! Drops of water on a windscreen.

use etendue_core::ExactTime;

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{flag, integer, keyed, number, record, time, vector};
use crate::record::render::MAX_SEED;

record! {
    /// Drops of water on the outer face of a windscreen: spherical caps at random positions in a rectangle. Each refracts the scene behind it;
    /// touching drops merge into one of their total volume. Ground truth ignores them.
    pub struct Drops check(check) {
        /// Width and height of the rectangle with drops, centred on the camera's axis.
        required size_mm: Placed<[f64; 2]> = vector::<2>(number("mm").above(0.0));
        /// Offset of the rectangle's middle, right and down along the glass. Default: 0.
        optional offset_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// Number of drops on the glass.
        inside amount: DropCount;
        /// Smallest base radius.
        required min_radius_mm: Placed<f64> = number("mm").above(0.0);
        /// Largest base radius before merging. Real drops stay caps up to about 2.7 mm.
        required max_radius_mm: Placed<f64> = number("mm").above(0.0);
        /// Number falls as a^(−size_exponent) with base radius a. Default: 8/3 (Le Fevre and Rose 1966).
        optional size_exponent: Placed<f64> = number("").at_least(0.0).at_most(6.0);
        /// Contact angle: below 30 on clean glass, 100 and more on water-repellent glass. Default: 60.
        optional contact_angle_deg: Placed<f64> = number("°").at_least(5.0).at_most(150.0);
        /// Dispersion of water (one wavelength per path); without it the index at 587.56 nm. Default: true.
        optional dispersion: Placed<bool> = flag();
        /// Seed of positions and sizes. Default: 0.
        optional seed: Placed<u64> = integer(0, MAX_SEED);
        /// Simulated time at which the drops lie as they fell; later states are simulated from it. Default: 0.
        optional start_s: Placed<ExactTime> = time();
        /// Drying time of a drop of "max_radius_mm"; r² falls linearly. Default: no drying.
        optional drying_s: Placed<f64> = number("s").above(0.0);
        /// Rate of new drops after "start_s".
        optional arrivals_per_s: Placed<f64> = number("1/s").above(0.0).at_most(10_000.0);
        /// Sliding down the glass.
        optional sliding: Sliding = record();
        /// Wiper.
        optional wiper: Wiper = record();
    }
}

record! {
    /// Sliding of drops down tilted glass: v = speed_mm_s (a² sin α − still_radius_mm²)/(max_radius_mm² − still_radius_mm²) for a drop of radius a on
    /// a slope α, never below 0, along gravity in the plane tangent to the glass at its middle, for the camera's pose at "start_s".
    pub struct Sliding {
        /// Speed of a drop of "max_radius_mm" on vertical glass.
        required speed_mm_s: Placed<f64> = number("mm/s").above(0.0).at_most(10_000.0);
        /// Radius below which drops on vertical glass stay; 1 to 2 mm on used glass.
        required still_radius_mm: Placed<f64> = number("mm").at_least(0.0);
    }
}

record! {
    /// A wiper, itself invisible: drops that its blade touches are removed.
    pub struct Wiper check(check_wiper) {
        /// Position of the axis, as "offset_mm" of drops.
        required pivot_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// Distances from the axis between which the blade wipes, increasing.
        required blade_mm: Placed<[f64; 2]> = vector::<2>(number("mm").at_least(0.0));
        /// Rest and turning angles of the blade, clockwise from up as seen from the camera.
        required angles_deg: Placed<[f64; 2]> = vector::<2>(number("°").at_least(-360.0).at_most(360.0));
        /// Duration of one stroke.
        required sweep_s: Placed<f64> = number("s").at_least(0.1);
        /// Time between the starts of sweeps, at least twice "sweep_s".
        required period_s: Placed<f64> = number("s").above(0.0);
        /// Simulated time of the first sweep. Default: "start_s" of the drops.
        optional start_s: Placed<ExactTime> = time();
    }
}

keyed! {
    /// Number of fallen drops, before touching drops merge.
    pub enum DropCount {
        /// Drops in the rectangle; 0 only with "arrivals_per_s".
        count => Count(Placed<u64>) = integer(0, 1_000_000);
        /// Drops per dm²; 1 … 1 000 000 in all.
        count_per_dm2 => Density(Placed<f64>) = number("").above(0.0);
    }
}

fn check(drops: &Drops, errors: &mut DescriptionErrors) {
    let (min, greatest) = (&drops.min_radius_mm, &drops.max_radius_mm);
    if min.value > greatest.value {
        let problem = format!("{} mm is above max_radius_mm = {} mm", min.value, greatest.value);
        errors.add(ErrorCode::WrongOrder, &min.place, problem, "give a minimum of at most the maximum");
    }
    if let (DropCount::Count(count), None) = (&drops.amount, &drops.arrivals_per_s)
        && count.value == 0
    {
        errors.add(
            ErrorCode::Empty,
            &count.place,
            "there are no drops, and none are added",
            "give 1 or more, or \"arrivals_per_s\"",
        );
    }
    check_course(drops, errors);
    if let DropCount::Density(density) = &drops.amount {
        let [width, height] = drops.size_mm.value;
        let count = density.value * width * height * 1e-4;
        if !(0.5..1_000_000.5).contains(&count) {
            let problem = format!("this density gives {count:.3} drops in size_mm = [{width}, {height}]");
            errors.add(ErrorCode::OutOfRange, &density.place, problem, "choose it to give 1 to 1 000 000 drops");
        }
    }
}

impl Drops {
    /// True if the drops change over time.
    #[must_use]
    pub fn changes(&self) -> bool {
        self.drying_s.is_some() || self.arrivals_per_s.is_some() || self.sliding.is_some() || self.wiper.is_some()
    }
}

fn check_course(drops: &Drops, errors: &mut DescriptionErrors) {
    if let (Some(start), false) = (&drops.start_s, drops.changes()) {
        let problem = "\"start_s\" has no effect here: nothing changes the drops";
        errors.add(
            ErrorCode::NoEffect,
            &start.place,
            problem,
            "remove it, or add \"drying_s\", \"arrivals_per_s\", \"sliding\" or \"wiper\"",
        );
    }
    let too_still = |s: &&Sliding| s.still_radius_mm.value >= drops.max_radius_mm.value;
    if let Some(sliding) = drops.sliding.as_ref().filter(too_still) {
        let (still, greatest) = (&sliding.still_radius_mm, drops.max_radius_mm.value);
        let problem = format!("{} mm is not below max_radius_mm = {greatest} mm", still.value);
        errors.add(ErrorCode::WrongOrder, &still.place, problem, "make it smaller, or remove \"sliding\"");
    }
}

fn check_wiper(wiper: &Wiper, errors: &mut DescriptionErrors) {
    let [inner, outer] = wiper.blade_mm.value;
    if inner >= outer {
        let problem = format!("the blade ends at {outer} mm, but begins at {inner} mm");
        errors.add(ErrorCode::WrongOrder, &wiper.blade_mm.place, problem, "give the smaller distance first");
    }
    let [rest, turn] = wiper.angles_deg.value;
    if rest == turn || (rest - turn).abs() >= 360.0 {
        let problem = format!("the wiper turns from {rest}° to {turn}°");
        errors.add(
            ErrorCode::OutOfRange,
            &wiper.angles_deg.place,
            problem,
            "give two angles that differ by more than 0° and less than 360°",
        );
    }
    let min_period_s = 2.0 * wiper.sweep_s.value;
    if wiper.period_s.value < min_period_s {
        let problem = format!("{} s is shorter than one sweep there and back, {min_period_s} s", wiper.period_s.value);
        errors.add(ErrorCode::OutOfRange, &wiper.period_s.place, problem, "make it at least twice \"sweep_s\"");
    }
}
