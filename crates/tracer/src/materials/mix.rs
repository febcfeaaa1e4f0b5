//! Mixes: each light path meets one of two materials, by chance.
//!
//! f = (1 − w)·f_a + w·f_b: parts `a` and `b` side by side, finer than anything resolved, w the share of b. No density
//! of the mix is ever needed: a path draws its material at every vertex, and is then a path over that material. The
//! parts may be mixes themselves, but never, by any way, of themselves.

use super::parameter::{Factor, Parameter};
use crate::MaterialId;

/// Two materials side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mix {
    /// The material of weight 1 − w.
    pub a: MaterialId,
    /// The material of weight w.
    pub b: MaterialId,
    /// w, 0 to 1.
    pub weight: Factor,
}

impl Mix {
    pub(super) fn parameters(&self) -> Vec<Parameter<'_>> {
        vec![Parameter::Factor(self.weight, "a share")]
    }
}

/// The part that `u` in [0, 1) falls on, and where in it, again in [0, 1).
pub(super) fn choose(mix: &Mix, weight: f32, u: f32) -> (MaterialId, f32) {
    let (part, u) = if u < weight { (mix.b, u / weight) } else { (mix.a, (u - weight) / (1.0 - weight)) };
    (part, u.clamp(0.0, 1.0_f32.next_down()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mix(a: u32, b: u32) -> Mix {
        Mix { a: MaterialId(a), b: MaterialId(b), weight: Factor::Number(0.25) }
    }

    #[test]
    fn shares_are_as_stated_and_the_rest_of_the_number_is_uniform() {
        let (mut of_b, mut sum) = (0, 0.0);
        for i in 0..1000 {
            let (part, rest) = choose(&mix(0, 1), 0.25, (i as f32 + 0.5) / 1000.0);
            of_b += u32::from(part == MaterialId(1));
            sum += rest / 1000.0;
        }
        assert_eq!(of_b, 250);
        assert!((sum - 0.5).abs() < 1e-4);
        assert_eq!(choose(&mix(0, 1), 0.0, 0.0).0, MaterialId(0));
        assert_eq!(choose(&mix(0, 1), 1.0, 0.999_999_94).0, MaterialId(1));
        for (weight, u) in [(1e-30, 0.0), (1.0, 0.999_999_94), (0.999_999_94, 0.999_999_94)] {
            assert!((0.0..1.0).contains(&choose(&mix(0, 1), weight, u).1));
        }
    }
}
