//! Drops of water on a wind-screen.

use etendue_core::ExactTime;

use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{flag, keyed, number, record, time, vector, whole};
use crate::record::render::MAX_SEED;

record! {
    /// Drops of water on the outer face of a wind-screen: spherical caps, at random in a rectangle. Each refracts what is behind it;
    /// those that touch have become one of their joint volume. Ground truth does not see them.
    pub struct Drops check(check) {
        /// Width and height of the rectangle that they lie in, in the plane that touches the glass in its middle (where the camera's axis
        /// meets it), mm, above 0.
        required size_mm: Placed<[f64; 2]> = vector::<2>(number("mm").above(0.0));
        /// How far its middle lies aside of that point, to the right and down along the glass, mm. Default: not at all.
        optional offset_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// How many fell on the glass.
        inside amount: DropAmount;
        /// Least radius of a drop's base, mm, above 0.
        required min_radius_mm: Placed<f64> = number("mm").above(0.0);
        /// Greatest radius of a drop's base, mm, above 0; those that join grow larger. Real drops keep the shape of a cap up to some 2.7 mm.
        required max_radius_mm: Placed<f64> = number("mm").above(0.0);
        /// The size law: numbers by base radius a fall as a^(−size_exponent) from the least to the greatest, 0 … 6. Default: 8/3, of drops that
        /// condense and join (Le Fevre and Rose 1966).
        optional size_exponent: Placed<f64> = number("").at_least(0.0).at_most(6.0);
        /// Contact angle: between glass and surface, within the water, degrees, 5 … 150. Less than 30 on clean glass, some 60 on used, 100
        /// and more where it is treated against water. Default: 60.
        optional contact_angle_deg: Placed<f64> = number("°").at_least(5.0).at_most(150.0);
        /// Whether the water's index depends on the wavelength (Hale and Querry 1973), so that a path carries one wavelength; else it is that at
        /// 587.56 nm. Default: true.
        optional dispersion: Placed<bool> = flag();
        /// Seed of places and sizes. Default: 0.
        optional seed: Placed<u64> = whole(0, MAX_SEED);
        /// Simulated time at which they lie on the glass as they fell, s; until then they do not change. Frames long after it take longer: each is
        /// followed from there. Default: 0.
        optional start_s: Placed<ExactTime> = time();
        /// How long a drop of "max_radius_mm" takes to dry, s, above 0; the square of a radius falls evenly with time. Default: they do not dry.
        optional drying_s: Placed<f64> = number("s").above(0.0);
        /// Drops that fall on the rectangle after "start_s", 1/s, above 0 … 10 000. Default: none.
        optional arrivals_per_s: Placed<f64> = number("1/s").above(0.0).at_most(10_000.0);
        /// How they slide down the glass. Default: they stay.
        optional sliding: Sliding = record();
        /// What wipes them away. Default: nothing.
        optional wiper: Wiper = record();
    }
}

record! {
    /// How drops slide down tilted glass: v = speed_mm_s (a² sin α − still_radius_mm²)/(max_radius_mm² − still_radius_mm²) for a drop of radius a on a
    /// slope α, never below 0, along gravity on the plane that touches the glass in its middle, as the camera stands at "start_s".
    pub struct Sliding {
        /// Speed of a drop of "max_radius_mm" on upright glass, mm/s, above 0; those that joined can be faster.
        required speed_mm_s: Placed<f64> = number("mm/s").above(0.0).at_most(10_000.0);
        /// Radius below which drops stay on upright glass, mm, 0 or more and below "max_radius_mm"; some 1 to 2 mm on glass in use.
        required still_radius_mm: Placed<f64> = number("mm").at_least(0.0);
    }
}

record! {
    /// A wiper, which is not seen itself: each drop that its blade touches is gone.
    pub struct Wiper check(check_wiper) {
        /// Its axis, as "offset_mm" of drops, mm.
        required pivot_mm: Placed<[f64; 2]> = vector::<2>(number("mm"));
        /// Distances from the axis between which the blade wipes, mm, the smaller first.
        required blade_mm: Placed<[f64; 2]> = vector::<2>(number("mm").at_least(0.0));
        /// Where the blade rests and where it turns back: degrees from upwards, clockwise as the camera sees it, −360 … 360, not equal and less than
        /// 360 apart.
        required angles_deg: Placed<[f64; 2]> = vector::<2>(number("°").at_least(-360.0).at_most(360.0));
        /// Time of one way, at an even rate, s, at least 0.1.
        required sweep_s: Placed<f64> = number("s").at_least(0.1);
        /// From the beginning of one sweep to that of the next, s, at least twice "sweep_s"; the blade rests in between.
        required period_s: Placed<f64> = number("s").above(0.0);
        /// Simulated time of the first sweep, s. Default: "start_s" of the drops.
        optional start_s: Placed<ExactTime> = time();
    }
}

keyed! {
    /// How many drops fell, before those that touch joined.
    pub enum DropAmount {
        /// Drops in the rectangle, 1 … 1 000 000, or 0 with "arrivals_per_s".
        count => Count(Placed<u64>) = whole(0, 1_000_000);
        /// Drops a square decimetre, above 0; 1 … 1 000 000 in all.
        count_per_dm2 => Density(Placed<f64>) = number("").above(0.0);
    }
}

fn check(drops: &Drops, faults: &mut Faults) {
    let (least, greatest) = (&drops.min_radius_mm, &drops.max_radius_mm);
    if least.value > greatest.value {
        let problem = format!("{} mm is above max_radius_mm = {} mm", least.value, greatest.value);
        faults.add(ErrorCode::WrongOrder, &least.place, problem, "make the least radius no larger than the greatest");
    }
    if let (DropAmount::Count(count), None) = (&drops.amount, &drops.arrivals_per_s)
        && count.value == 0
    {
        faults.add(
            ErrorCode::Empty,
            &count.place,
            "there are no drops, and none arrive",
            "give 1 or more, or \"arrivals_per_s\"",
        );
    }
    check_course(drops, faults);
    if let DropAmount::Density(density) = &drops.amount {
        let [width, height] = drops.size_mm.value;
        let count = density.value * width * height * 1e-4;
        if !(0.5..1_000_000.5).contains(&count) {
            let problem = format!("gives {count:.3} drops in size_mm = [{width}, {height}]");
            faults.add(ErrorCode::OutOfRange, &density.place, problem, "choose it so that there are 1 to 1 000 000");
        }
    }
}

impl Drops {
    /// Whether anything changes them over time.
    #[must_use]
    pub fn changes(&self) -> bool {
        self.drying_s.is_some() || self.arrivals_per_s.is_some() || self.sliding.is_some() || self.wiper.is_some()
    }
}

fn check_course(drops: &Drops, faults: &mut Faults) {
    if let (Some(start), false) = (&drops.start_s, drops.changes()) {
        let problem = "\"start_s\" has no effect here: nothing changes the drops";
        faults.add(
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
        faults.add(ErrorCode::WrongOrder, &still.place, problem, "make it smaller, or remove \"sliding\"");
    }
}

fn check_wiper(wiper: &Wiper, faults: &mut Faults) {
    let [inner, outer] = wiper.blade_mm.value;
    if inner >= outer {
        let problem = format!("the blade ends at {outer} mm, before it begins at {inner} mm");
        faults.add(ErrorCode::WrongOrder, &wiper.blade_mm.place, problem, "give the smaller distance first");
    }
    let [rest, turn] = wiper.angles_deg.value;
    if rest == turn || (rest - turn).abs() >= 360.0 {
        let problem = format!("the blade goes from {rest}° to {turn}°");
        faults.add(
            ErrorCode::OutOfRange,
            &wiper.angles_deg.place,
            problem,
            "give two angles that differ, by less than 360°",
        );
    }
    let least = 2.0 * wiper.sweep_s.value;
    if wiper.period_s.value < least {
        let problem = format!("{} s is shorter than the way there and back, {least} s", wiper.period_s.value);
        faults.add(ErrorCode::OutOfRange, &wiper.period_s.place, problem, "make it at least twice \"sweep_s\"");
    }
}
