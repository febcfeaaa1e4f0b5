//! Errors of materials.

/// Error of a material.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A roughness is outside its range.
    #[error("roughness α is {alpha}; it must be between 0 (mirror) and 1")]
    Roughness {
        /// Value given.
        alpha: f64,
    },
    /// A length of ground under water is outside its range.
    #[error("the {what} is {value} mm; it must be finite and above 0 (a level may be 0)")]
    WaterLength {
        /// The length concerned.
        what: &'static str,
        /// Value given, mm.
        value: f64,
    },
    /// A rate of rain is outside its range.
    #[error("the rain rate is {rain_mm_h} mm/h; it must be between 0 and 150")]
    Rain {
        /// Value given, mm/h.
        rain_mm_h: f64,
    },
    /// A coat's refractive index is outside its range.
    #[error("the coat's refractive index is {n}; it must be between 1.1 and 4")]
    CoatIndex {
        /// Value given.
        n: f64,
    },
    /// A transparent substance's refractive index is outside its range.
    #[error("the refractive index is {n}; it must be between 1 and 4")]
    GlassIndex {
        /// Value given.
        n: f64,
    },
    /// An absorption coefficient is negative.
    #[error("the absorption is {value} 1/m; it must be 0 or more at every wavelength")]
    Absorption {
        /// Value found.
        value: f32,
    },
    /// An internal transmittance leaves 0–1.
    #[error("the internal transmittance is {value}; it must be between 0 and 1; scale it")]
    Transmittance {
        /// Value found.
        value: f32,
    },
    /// A thickness is not a positive length.
    #[error("the thickness of the internal transmittance is {thickness_m} m; it must be above 0")]
    Thickness {
        /// Value given, m.
        thickness_m: f64,
    },
    /// A metal's index is not a substance's.
    #[error("the complex refractive index at {nm} nm is invalid: n and k must be finite, 0 or more, and not both 0")]
    Index {
        /// Wavelength, nm.
        nm: u16,
    },
    /// An interface's real index is out of range.
    #[error("the refractive index is {n} at {nm} nm; it must be between 1 and 4 at every wavelength")]
    RealIndex {
        /// Wavelength, nm.
        nm: u16,
        /// Value given.
        n: f32,
    },
    /// The strength of a normal map is outside its range.
    #[error("the strength of the normal map is {strength}; it must be between 0 and 10")]
    NormalStrength {
        /// Value given.
        strength: f64,
    },
    /// A reflectance leaves the range 0–1.
    #[error("material {material} has a reflectance of {value}; it must be between 0 and 1; scale it")]
    Reflectance {
        /// Index of the material.
        material: usize,
        /// Value found.
        value: f32,
    },
    /// A leaf reflects and transmits more than arrives.
    #[error("material {material} has reflectance + transmittance = {value}; the sum must be at most 1; scale them")]
    LeafSum {
        /// Index of the material.
        material: usize,
        /// The maximum sum found.
        value: f32,
    },
    /// A roughness, opacity or mix weight leaves the range 0–1.
    #[error("material {material} has {quantity} of {value}; it must be between 0 and 1; scale it")]
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
    #[error("material {material} emits {value} W·m⁻²·sr⁻¹·nm⁻¹; radiance must be 0 to 1e30")]
    Radiance {
        /// Index of the material.
        material: usize,
        /// Value found.
        value: f32,
    },
    /// A material names a texture that does not exist.
    #[error(
        "material {material} refers to texture {texture}, but there are {textures} textures; add the texture first"
    )]
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
        "material {material} has {what} with triplanar mapping, but this requires texture coordinates; use UV mapping"
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
        texture: u32,
    },
    /// A mix names a material that does not exist.
    #[error("material {material} mixes material {part}, but there are {materials} materials; add the material first")]
    UnknownMaterial {
        /// Index of the mix.
        material: usize,
        /// The part that it names.
        part: u32,
        /// Number of materials.
        materials: usize,
    },
    /// A mix contains itself.
    #[error("material {material} contains itself, directly or through other mixes; remove it from its own parts")]
    Circle {
        /// Index of the mix.
        material: usize,
    },
    /// A part of a mix has a property that counts only on the mix.
    #[error("material {material} mixes material {part}, which has {what}; give that to the mix instead")]
    Part {
        /// Index of the mix.
        material: usize,
        /// Index of the part.
        part: u32,
        /// The property, with its article if it needs one.
        what: &'static str,
    },
    /// A mix has a normal map.
    #[error("material {material} is a mix with a normal map, which has no effect; give the map to the parts instead")]
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
    "at an incidence of {incidence_deg:.1}° the surface reflects {albedo:.4} of the light at {wavelength_nm} nm, more than the \
     maximum of 1; multiply its reflectances or weights by {:.4}",
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
