//! What a material_table's materials must be.

use super::mix;
use super::{Emission, EnergyGain, Factor, Leaf, Material, MaterialError, Reflectance, Surface};
use crate::lights::BRIGHTEST;
use crate::textures::{Channel, ImageTexture, TextureId};
use etendue_spectra::Spectrum;

/// Rounding in the basis spectra may take white a little over 1.
const WHITE: f32 = 1.0 + 1e-4;

/// Checks material `index` of `materials`.
pub(super) fn material(materials: &[Material], index: usize, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let material = &materials[index];
    match &material.surface {
        Surface::Absorber | Surface::Marking(_) => {}
        Surface::Diffuse(r) => reflectance(index, r, textures)?,
        Surface::Lafortune(model) => base(index, model.base(), textures, |s| model.check_energy(s))?,
        Surface::BlinnPhong(model) => base(index, model.base(), textures, |s| model.check_energy(s))?,
        Surface::CarPaint(paint) => reflectance(index, paint.pigment(), textures)?,
        Surface::Cloth(cloth) => reflectance(index, cloth.base(), textures)?,
        Surface::Sheeting(sheeting) => sheeting.print().map_or(Ok(()), |print| reflectance(index, print, textures))?,
        Surface::Conductor(conductor) => alpha(index, conductor.alpha(), textures)?,
        Surface::Coated(coated) => {
            reflectance(index, coated.base(), textures)?;
            alpha(index, coated.alpha(), textures)?;
        }
        Surface::Dielectric(dielectric) => alpha(index, dielectric.alpha(), textures)?,
        Surface::ThinSheet(sheet) => reflectance(index, sheet.transmittance(), textures)?,
        Surface::Leaf(both) => leaf(index, both, textures)?,
        Surface::Mix(parts) => {
            mix::check(materials, index, parts)?;
            factor(index, "a share", parts.weight, textures)?;
            if material.normal_map.is_some() {
                return Err(MaterialError::MixNormal { material: index });
            }
        }
    }
    if let Some(glow) = &material.emission {
        emission(index, glow, textures)?;
    }
    if let Some(opacity) = material.opacity {
        factor(index, "an opacity", opacity, textures)?;
        if let (Some(_), Some(id)) = (&material.emission, opacity.texture()) {
            laid_by_uv(index, "an opacity beside its emission", id, textures)?;
        }
    }
    if let Some(map) = material.normal_map {
        laid_by_uv(index, "a normal map", map.texture(), textures)?;
    }
    Ok(())
}

fn reflectance(material: usize, r: &Reflectance, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let (low, high) = match r {
        Reflectance::Spectrum(s) => (s.min_value(), s.max_value()),
        Reflectance::Texture(id) => find(material, *id, textures)?.range(),
    };
    match [low, high].into_iter().find(|v| !(0.0..=WHITE).contains(v)) {
        Some(value) => Err(MaterialError::Reflectance { material, value }),
        None => Ok(()),
    }
}

/// Checks the base of a model whose lobes leave less than everything for it: of a texture its brightest colour counts.
fn base(
    material: usize,
    r: &Reflectance,
    textures: &[ImageTexture],
    check_energy: impl Fn(&Spectrum) -> Result<(), EnergyGain>,
) -> Result<(), MaterialError> {
    reflectance(material, r, textures)?;
    let Reflectance::Texture(id) = r else { return Ok(()) };
    let brightest = f64::from(find(material, *id, textures)?.range().1);
    check_energy(&Spectrum::constant(brightest)).map_err(|gain| MaterialError::Gain { material, gain })
}

/// Checks that no wavelength sends on more than arrives: node by node for spectra, by its greatest value for a texture.
fn leaf(material: usize, leaf: &Leaf, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let parts = [&leaf.reflectance, &leaf.transmittance];
    parts.into_iter().try_for_each(|part| reflectance(material, part, textures))?;
    let [r, t] = parts.map(|part| match part {
        Reflectance::Spectrum(spectrum) => spectrum.clone(),
        Reflectance::Texture(id) => Spectrum::constant(f64::from(textures[id.0 as usize].range().1)),
    });
    let greatest = r.nodes().iter().zip(t.nodes()).map(|(r, t)| r + t).fold(0.0, f32::max);
    if greatest > WHITE { Err(MaterialError::LeafSum { material, value: greatest }) } else { Ok(()) }
}

fn alpha(material: usize, alpha: Factor, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    factor(material, "a roughness α", alpha, textures)
}

fn factor(material: usize, quantity: &'static str, f: Factor, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let (low, high) = match f {
        Factor::Number(value) => (value, value),
        Factor::Texture(id, channel) => {
            let texture = find(material, id, textures)?;
            if channel == Channel::Alpha && !texture.has_alpha() {
                return Err(MaterialError::NoAlpha { material, texture: id.0 });
            }
            texture.channel_range(channel)
        }
    };
    match [low, high].into_iter().find(|v| !(0.0..=1.0).contains(v)) {
        Some(value) => Err(MaterialError::Factor { material, quantity, value }),
        None => Ok(()),
    }
}

fn emission(material: usize, glow: &Emission, textures: &[ImageTexture]) -> Result<(), MaterialError> {
    let (mut low, mut high) = (glow.radiance.min_value(), glow.radiance.max_value());
    if let Some(id) = glow.factor {
        let range = laid_by_uv(material, "an emission", id, textures)?.range();
        (low, high) = (low.min(range.0), high * range.1);
    }
    match [low, high].into_iter().find(|v| !(0.0..=BRIGHTEST).contains(v)) {
        Some(value) => Err(MaterialError::Radiance { material, value }),
        None => Ok(()),
    }
}

/// The texture of what only texture coordinates can place.
fn laid_by_uv<'a>(
    material: usize,
    what: &'static str,
    id: TextureId,
    textures: &'a [ImageTexture],
) -> Result<&'a ImageTexture, MaterialError> {
    let texture = find(material, id, textures)?;
    if texture.needs_uv() { Ok(texture) } else { Err(MaterialError::Projected { material, what }) }
}

fn find(material: usize, id: TextureId, textures: &[ImageTexture]) -> Result<&ImageTexture, MaterialError> {
    let unknown = MaterialError::UnknownTexture { material, texture: id.0, textures: textures.len() };
    textures.get(id.0 as usize).ok_or(unknown)
}
