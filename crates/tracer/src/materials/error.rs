//! Errors of materials.

/// Error of a material.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A roughness is outside its range.
    #[error("a roughness α of {alpha} was given, but it must lie between 0 (mirror) and 1; correct it")]
    Roughness {
        /// Value given.
        alpha: f64,
    },
    /// A length of ground under water is outside its range.
    #[error("a {what} of {value} mm was given, but it must be a finite length above 0 (a level may be 0); correct it")]
    WaterLength {
        /// The length concerned.
        what: &'static str,
        /// Value given, mm.
        value: f64,
    },
    /// A rate of rain is outside its range.
    #[error("rain of {rain_mm_h} mm/h was given, but it must lie between 0 and 150; correct it")]
    Rain {
        /// Value given, mm/h.
        rain_mm_h: f64,
    },
    /// A coat's refractive index is outside its range.
    #[error("a coat of refractive index {n} was given, but it must lie between 1.1 and 4; correct it")]
    CoatIndex {
        /// Value given.
        n: f64,
    },
    /// A transparent substance's refractive index is outside its range.
    #[error("glass of refractive index {n} was given, but it must lie between 1 and 4; correct it")]
    GlassIndex {
        /// Value given.
        n: f64,
    },
    /// An absorption coefficient is negative.
    #[error("an absorption of {value} 1/m was given, but it must be 0 or more everywhere; correct it")]
    Absorption {
        /// Value found.
        value: f32,
    },
    /// An internal transmittance leaves 0–1.
    #[error("an internal transmittance of {value} was given, but it must lie between 0 and 1; scale it")]
    Transmittance {
        /// Value found.
        value: f32,
    },
    /// A thickness is not a positive length.
    #[error("a transmittance was given for a thickness of {thickness_m} m, but that must be above 0; correct it")]
    Thickness {
        /// Value given, m.
        thickness_m: f64,
    },
    /// A metal's index is not a substance's.
    #[error("the complex index at {nm} nm is not a substance's: n and k must be 0 or more, not both 0, and finite")]
    Index {
        /// Wavelength, nm.
        nm: u16,
    },
    /// An interface's real index is out of range.
    #[error("the refractive index is {n} at {nm} nm, but it must lie between 1 and 4 at every wavelength; correct it")]
    RealIndex {
        /// Wavelength, nm.
        nm: u16,
        /// Value given.
        n: f32,
    },
    /// The strength of a normal map is outside its range.
    #[error("a normal map of strength {strength} was given, but it must lie between 0 and 10; correct it")]
    NormalStrength {
        /// Value given.
        strength: f64,
    },
    /// A reflectance leaves the range 0–1.
    #[error("material {material} has a reflectance of {value}, but it must lie between 0 and 1; scale it")]
    Reflectance {
        /// Index of the material.
        material: usize,
        /// Value found.
        value: f32,
    },
    /// A leaf reflects and transmits more than arrives.
    #[error(
        "material {material} reflects and transmits {value} of what arrives, but both must sum to at most 1; scale them"
    )]
    LeafSum {
        /// Index of the material.
        material: usize,
        /// The maximum sum found.
        value: f32,
    },
    /// A roughness, opacity or mix weight leaves the range 0–1.
    #[error("material {material} has {quantity} of {value}, but it must lie between 0 and 1; scale it")]
    Factor {
        /// Index of the material.
        material: usize,
        /// The quantity out of range, with its article.
        quantity: &'static str,
        /// Value found.
        value: f32,
    },
    /// A textured material reflects more than arrives.
    #[error("material {material} gains energy where its texture is brightest: {gain}")]
    Gain {
        /// Index of the material.
        material: usize,
        /// Its energy gain.
        gain: EnergyGain,
    },
    /// An emission is negative or not finite.
    #[error("material {material} emits {value} W.m^-2.sr^-1.nm^-1, but radiance must be 0 to 1e30")]
    Radiance {
        /// Index of the material.
        material: usize,
        /// Value found.
        value: f32,
    },
    /// A material names a texture that does not exist.
    #[error("material {material} names texture {texture}, but there are {textures}; add the texture first")]
    UnknownTexture {
        /// Index of the material.
        material: usize,
        /// The texture that it names.
        texture: u32,
        /// Number of textures.
        textures: usize,
    },
    /// A triplanar (three-sided) texture is used where texture coordinates are needed.
    #[error(
        "material {material} has {what} laid on from three sides, but that needs texture coordinates; lay it on by them"
    )]
    Projected {
        /// Index of the material.
        material: usize,
        /// The quantity with this texture, with its article.
        what: &'static str,
    },
    /// The alpha channel of an image without one is required.
    #[error("material {material} reads the alpha channel of texture {texture}, which has none; choose another channel")]
    NoAlpha {
        /// Index of the material.
        material: usize,
        /// The texture.
        texture: u32,
    },
    /// A mix names a material that does not exist.
    #[error("material {material} mixes material {part}, but there are {materials}; add the material first")]
    UnknownMaterial {
        /// Index of the mix.
        material: usize,
        /// The part that it names.
        part: u32,
        /// Number of materials.
        materials: usize,
    },
    /// A mix contains itself.
    #[error("material {material} is mixed of itself, directly or by way of other mixes; take it out of its own parts")]
    Circle {
        /// Index of the mix.
        material: usize,
    },
    /// A part of a mix has a property that counts only on the mix.
    #[error("material {material} mixes material {part}, which has {what} of its own; give that to the mix instead")]
    Part {
        /// Index of the mix.
        material: usize,
        /// Index of the part.
        part: u32,
        /// The property, with its article if it needs one.
        what: &'static str,
    },
    /// A mix has a normal map.
    #[error("material {material} is a mix with a normal map, which would bend nothing; give it to the parts instead")]
    MixNormal {
        /// Index of the mix.
        material: usize,
    },
}

impl MaterialError {
    /// Index of the material that the error is about; `None` if it was refused before it had one.
    #[must_use]
    pub fn material(&self) -> Option<usize> {
        match self {
            Self::Reflectance { material, .. }
            | Self::Gain { material, .. }
            | Self::Factor { material, .. }
            | Self::LeafSum { material, .. }
            | Self::Radiance { material, .. }
            | Self::UnknownTexture { material, .. }
            | Self::Projected { material, .. }
            | Self::NoAlpha { material, .. }
            | Self::UnknownMaterial { material, .. }
            | Self::Circle { material }
            | Self::Part { material, .. }
            | Self::MixNormal { material } => Some(*material),
            Self::RealIndex { .. }
            | Self::Roughness { .. }
            | Self::WaterLength { .. }
            | Self::Rain { .. }
            | Self::CoatIndex { .. }
            | Self::GlassIndex { .. }
            | Self::Absorption { .. }
            | Self::Transmittance { .. }
            | Self::Thickness { .. }
            | Self::Index { .. }
            | Self::NormalStrength { .. } => None,
        }
    }
}

/// A surface that would reflect more light than arrives.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "lit at {incidence_deg:.1}° from its normal, the surface would send back {albedo:.4} of the light at {wavelength_nm} \
     nm, but none sends back more than arrives (1); lower its reflectances or weights to {:.4} of what they are",
    1.0 / albedo
)]
pub struct EnergyGain {
    /// The maximum albedo found.
    pub albedo: f64,
    /// The angle of incidence at which it was found, degrees.
    pub incidence_deg: f64,
    /// The wavelength at which it was found, nm.
    pub wavelength_nm: u16,
}
