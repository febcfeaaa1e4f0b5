//! Checks of the materials of a material_table.

use super::material::{Material, Mix};
use super::parameter::{Parameter, TextureCheck};
use super::{Surface, emission::Emission, error::MaterialError};
use crate::{MAX_LIGHT_VALUE, textures::ImageTexture};

/// Checks material `index` of `materials`.
pub(super) fn material(materials: &[Material], index: usize, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let material = &materials[index];
    let check = TextureCheck { material: index, textures };
    if let Surface::Mix(mix) = &material.surface {
        parts(materials, index, mix)?;
    }
    material.surface.parameters().into_iter().try_for_each(|p| check.parameter(p))?;
    material.surface.check_energy(&check)?;
    if let (Surface::Mix(_), Some(_)) = (&material.surface, &material.normal_map) {
        return Err(MaterialError::MixNormal { material: index });
    }
    if let Some(of_surface) = &material.emission {
        emission(&check, of_surface)?;
    }
    if let Some(opacity) = material.opacity {
        check.parameter(Parameter::Factor(opacity, "an opacity"))?;
        if let (Some(_), Some(id)) = (&material.emission, opacity.texture()) {
            check.uv_texture("an opacity together with an emission", id)?;
        }
    }
    if let Some(map) = material.normal_map {
        check.uv_texture("a normal map", map.texture())?;
    }
    Ok(())
}

fn emission(check: &TextureCheck<'_>, emission: &Emission) -> Result<(), MaterialError> {
    let (mut low, mut high) = (emission.radiance.min_value(), emission.radiance.max_value());
    if let Some(id) = emission.factor {
        let range = check.uv_texture("an emission", id)?.range();
        (low, high) = (low.min(range.0), high * range.1);
    }
    let level = emission.modulation.as_ref().map_or(1.0, |modulation| modulation.max_level() as f32);
    high = high.max(high * level);
    match [low, high].into_iter().find(|v| !(0.0..=MAX_LIGHT_VALUE).contains(v)) {
        Some(value) => Err(MaterialError::Radiance { material: check.material, value }),
        None => Ok(()),
    }
}

/// Checks that the parts of material `index` exist, and that it does not contain itself.
fn parts(materials: &[Material], index: usize, mix: &Mix) -> Result<(), MaterialError> {
    for part in [mix.a, mix.b] {
        let unknown = MaterialError::UnknownMaterial { material: index, part: part.0, materials: materials.len() };
        let material = materials.get(part.0 as usize).ok_or(unknown)?;
        let refused = |what| Err(MaterialError::Part { material: index, part: part.0, what });
        if material.emission.is_some() {
            return refused("an emission");
        }
        if material.opacity.is_some() {
            return refused("an opacity");
        }
    }
    // Marks of visited materials bound the work if parts are shared.
    let mut visited = vec![false; materials.len()];
    let mut open = vec![mix.a, mix.b];
    while let Some(part) = open.pop() {
        if part.0 as usize == index {
            return Err(MaterialError::Circle { material: index });
        }
        let new = visited.get_mut(part.0 as usize).is_some_and(|is_visited| !core::mem::replace(is_visited, true));
        if let (true, Some(Surface::Mix(inner))) = (new, materials.get(part.0 as usize).map(|m| &m.surface)) {
            open.extend([inner.a, inner.b]);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MaterialId;
    use crate::materials::parameter::Factor;

    fn mix(a: u32, b: u32) -> Mix {
        Mix { a: MaterialId(a), b: MaterialId(b), weight: Factor::Number(0.25) }
    }

    #[test]
    fn circles_are_found_and_shared_parts_are_none() {
        let of = |mixes: &[Option<Mix>]| -> Vec<Material> {
            mixes.iter().map(|m| Material::new(m.map_or(Surface::Absorber, Surface::Mix))).collect()
        };
        let shared = of(&[None, None, Some(mix(0, 1)), Some(mix(2, 2)), Some(mix(2, 3))]);
        let check_all = |materials: &[Material]| {
            materials.iter().enumerate().try_for_each(|(i, m)| match &m.surface {
                Surface::Mix(mix) => parts(materials, i, mix),
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
