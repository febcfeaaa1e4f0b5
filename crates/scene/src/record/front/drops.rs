//! Drops of water on a wind-screen.

use crate::fault::Faults;
use crate::place::Placed;
use crate::reader::{flag, keyed, number, record, vector, whole};
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
    }
}

keyed! {
    /// How many drops fell, before those that touch joined.
    pub enum DropAmount {
        /// Drops in the rectangle, 1 … 1 000 000.
        count => Count(Placed<u64>) = whole(1, 1_000_000);
        /// Drops a square decimetre, above 0; 1 … 1 000 000 in all.
        count_per_dm2 => Density(Placed<f64>) = number("").above(0.0);
    }
}

fn check(drops: &Drops, faults: &mut Faults) {
    let (least, greatest) = (&drops.min_radius_mm, &drops.max_radius_mm);
    if least.value > greatest.value {
        let problem = format!("{} mm is above max_radius_mm = {} mm", least.value, greatest.value);
        faults.add(&least.place, problem, "make the least radius no larger than the greatest");
    }
    if let DropAmount::Density(density) = &drops.amount {
        let [width, height] = drops.size_mm.value;
        let count = density.value * width * height * 1e-4;
        if !(0.5..1_000_000.5).contains(&count) {
            let problem = format!("gives {count:.3} drops in size_mm = [{width}, {height}]");
            faults.add(&density.place, problem, "choose it so that there are 1 to 1 000 000");
        }
    }
}
