//! Mixes: each light path meets one of two materials, by chance.
//!
//! f = (1 − w)·f_a + w·f_b: parts `a` and `b` side by side, finer than anything resolved, w the share of b. No density
//! of the mix is ever needed: a path draws its material at every vertex, and is then a path over that material. The
//! parts may be mixes themselves, but never, by any way, of themselves.

use super::{Factor, Material, MaterialError, Surface};
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

/// The part that `u` in [0, 1) falls on, and where in it, again in [0, 1).
pub(super) fn choose(mix: &Mix, weight: f32, u: f32) -> (MaterialId, f32) {
    let (part, u) = if u < weight { (mix.b, u / weight) } else { (mix.a, (u - weight) / (1.0 - weight)) };
    (part, u.clamp(0.0, 1.0_f32.next_down()))
}

/// Checks that the parts of material `index` are there, and that it is no part of itself.
pub(super) fn check(materials: &[Material], index: usize, mix: &Mix) -> Result<(), MaterialError> {
    for part in [mix.a, mix.b] {
        let unknown = MaterialError::UnknownMaterial { material: index, part: part.0, materials: materials.len() };
        let found = materials.get(part.0 as usize).ok_or(unknown)?;
        let refused = |what| Err(MaterialError::Part { material: index, part: part.0, what });
        if found.emission.is_some() {
            return refused("an emission");
        }
        if found.opacity.is_some() {
            return refused("an opacity");
        }
    }
    // Marks of what was visited bound the work where parts are shared.
    let mut visited = vec![false; materials.len()];
    let mut open = vec![mix.a, mix.b];
    while let Some(part) = open.pop() {
        if part.0 as usize == index {
            return Err(MaterialError::Circle { material: index });
        }
        let new = visited.get_mut(part.0 as usize).is_some_and(|seen| !core::mem::replace(seen, true));
        if let (true, Some(Surface::Mix(inner))) = (new, materials.get(part.0 as usize).map(|m| &m.surface)) {
            open.extend([inner.a, inner.b]);
        }
    }
    Ok(())
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

    #[test]
    fn circles_are_found_and_shared_parts_are_none() {
        let of = |mixes: &[Option<Mix>]| -> Vec<Material> {
            mixes.iter().map(|m| Material::new(m.map_or(Surface::Absorber, Surface::Mix))).collect()
        };
        let shared = of(&[None, None, Some(mix(0, 1)), Some(mix(2, 2)), Some(mix(2, 3))]);
        let check_all = |materials: &[Material]| {
            materials.iter().enumerate().try_for_each(|(i, m)| match &m.surface {
                Surface::Mix(mix) => check(materials, i, mix),
                _ => Ok(()),
            })
        };
        assert_eq!(check_all(&shared), Ok(()));
        let circle = of(&[None, Some(mix(0, 2)), Some(mix(3, 0)), Some(mix(0, 1))]);
        assert_eq!(check_all(&circle), Err(MaterialError::Circle { material: 1 }));
        assert_eq!(check_all(&of(&[Some(mix(0, 0))])), Err(MaterialError::Circle { material: 0 }));
        let unknown = MaterialError::UnknownMaterial { material: 1, part: 7, materials: 2 };
        assert_eq!(check_all(&of(&[None, Some(mix(0, 7))])), Err(unknown));
    }
}
