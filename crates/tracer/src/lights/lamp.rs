//! Lamps: intensity by direction; lamps that are points fall off as 1/d² with distance.
//!
//! A surface that faces a lamp of intensity I(λ) · value(direction) from the distance d has the spectral irradiance E(λ) = I(λ) · value / d² / (1 + a
//! d). The last factor is the attenuation coefficient a (1/m) of the legacy mode, 0 by default; it does not represent clear air.
//!
//! A lamp's frame is x forward, y left, z up; its axes give these directions in the world. A lamp without an opening has no size: shadows are sharp,
//! and its light is too strong at distances at which a real lamp is no point. One with an opening emits from a surface of the world (`opening/`). A
//! moving lamp is evaluated at the receiver's time (`carried`). Its strength may change over time. Left out: polarisation.

use std::sync::Arc;

use etendue_core::{Motion, Spectral, TimeInterval, Waveform, WavelengthRange, maths};
use etendue_spectra::Spectrum;
use glam::{DAffine3, DMat3, DVec3, Mat3, Vec3};

use super::{
    LightSample, LightSampleContext, MAX_LIGHT_VALUE, light_sample::LampIrradiance, opening::Opening, profile::Profile,
    tree::LightBounds,
};
use crate::materials::{EmissionQuery, selection_level};

/// Error of a lamp.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LampError {
    /// The position is not finite.
    #[error("the position of a light must be three finite numbers")]
    Position,
    /// The axes are no rotation.
    #[error("the axes of a light must be three orthogonal unit vectors, right-handed (x forward, y left, z up)")]
    Axes,
    /// The intensity is negative or not finite.
    #[error("the intensity of a light must be 0 to 1e30 at every wavelength")]
    Intensity,
    /// The attenuation coefficient is negative or not finite.
    #[error("the attenuation is {per_m} 1/m; it must be finite and 0 or more")]
    Attenuation {
        /// Value given, 1/m.
        per_m: f64,
    },
    /// Attenuation of a lamp with an opening.
    #[error(
        "a light with an opening has an attenuation ({per_m} 1/m), but its radiance is the same at every distance; remove one of \
         the two"
    )]
    AttenuatedOpening {
        /// Value given, 1/m.
        per_m: f64,
    },
    /// The opening is too bright.
    #[error(
        "the opening has a radiance of {radiance:e} W·m⁻²·sr⁻¹·nm⁻¹, more than the maximum of 1e30; lower the intensity"
    )]
    OpeningRadiance {
        /// Maximum radiance, W·m⁻²·sr⁻¹·nm⁻¹.
        radiance: f32,
    },
}

/// A lamp. Lamps of the same kind share intensity and profile.
#[derive(Clone, Debug, PartialEq)]
pub struct Lamp {
    to_world: Motion,
    intensity: Arc<Spectrum>,
    profile: Arc<Profile>,
    attenuation_per_m: f64,
    modulation: Option<Arc<Waveform>>,
    /// Its opening, and the instance of the world that is its surface.
    opening: Option<(Opening, u32)>,
}

impl Lamp {
    /// A lamp at `position_m` of the world. The columns of `axes` are its x (forward), y (left) and z (up) in the world; `intensity`
    /// (W·sr⁻¹·nm⁻¹) is the intensity where the profile is 1.
    ///
    /// # Errors
    /// If a number is not finite, the axes are no rotation, or the intensity is negative.
    pub fn new(
        position_m: DVec3,
        axes: DMat3,
        intensity: impl Into<Arc<Spectrum>>,
        profile: impl Into<Arc<Profile>>,
    ) -> Result<Self, LampError> {
        Self::moving(Motion::constant(DAffine3::from_mat3_translation(axes, position_m)), intensity, profile)
    }

    /// A lamp that moves by `to_world`, a transform from its frame to the world without scaling.
    ///
    /// # Errors
    /// As [`Lamp::new`].
    pub fn moving(
        to_world: Motion,
        intensity: impl Into<Arc<Spectrum>>,
        profile: impl Into<Arc<Profile>>,
    ) -> Result<Self, LampError> {
        let (intensity, profile) = (intensity.into(), profile.into());
        if !to_world.at(0.0).translation.is_finite() {
            return Err(LampError::Position);
        }
        if !to_world.is_rigid() {
            return Err(LampError::Axes);
        }
        if !(intensity.min_value() >= 0.0 && intensity.max_value() <= MAX_LIGHT_VALUE) {
            return Err(LampError::Intensity);
        }
        Ok(Self { to_world, intensity, profile, attenuation_per_m: 0.0, modulation: None, opening: None })
    }

    /// Sets an attenuation coefficient, 1/m.
    ///
    /// # Errors
    /// If it is negative or not finite, or the lamp has an opening.
    pub fn attenuated(self, attenuation_per_m: f64) -> Result<Self, LampError> {
        if self.opening.is_some() && attenuation_per_m > 0.0 {
            return Err(LampError::AttenuatedOpening { per_m: attenuation_per_m });
        }
        let legal = attenuation_per_m >= 0.0 && attenuation_per_m.is_finite();
        if legal {
            Ok(Self { attenuation_per_m, ..self })
        } else {
            Err(LampError::Attenuation { per_m: attenuation_per_m })
        }
    }

    /// Sets a strength that changes over time: a factor on the intensity.
    ///
    /// # Errors
    /// If the lamp would be brighter than can be traced, or already has an opening.
    pub fn modulated(self, modulation: impl Into<Arc<Waveform>>) -> Result<Self, LampError> {
        let modulation = modulation.into();
        let brightest = f64::from(self.intensity.max_value()) * modulation.max_level();
        if brightest > f64::from(MAX_LIGHT_VALUE) || self.opening.is_some() {
            return Err(LampError::Intensity);
        }
        Ok(Self { modulation: Some(modulation), ..self })
    }

    /// Adds an opening whose surface is an instance of the world: that of [`Opening::mesh`] or of a sphere of radius 1, placed by
    /// [`Lamp::opening_to_world`].
    ///
    /// # Errors
    /// If the lamp is attenuated, or the opening would be brighter than can be traced.
    pub fn opened(self, opening: Opening, instance: u32) -> Result<Self, LampError> {
        if self.attenuation_per_m > 0.0 {
            return Err(LampError::AttenuatedOpening { per_m: self.attenuation_per_m });
        }
        let level = self.modulation.as_ref().map_or(1.0, |modulation| modulation.max_level() as f32);
        let radiance =
            self.intensity.max_value() * level * self.profile.peak() as f32 / opening.min_projected_area_m2();
        if radiance <= MAX_LIGHT_VALUE {
            Ok(Self { opening: Some((opening, instance)), ..self })
        } else {
            Err(LampError::OpeningRadiance { radiance })
        }
    }

    /// Transform from the frame of an opening's mesh or sphere to the world.
    #[must_use]
    pub fn opening_to_world(&self, opening: &Opening) -> Motion {
        self.to_world.after(&opening.to_lamp())
    }

    /// Its opening, and the instance of the world that is its surface.
    #[must_use]
    pub fn opening(&self) -> Option<(Opening, u32)> {
        self.opening
    }

    /// Transform from its frame (x forward, y left, z up) to the world.
    #[must_use]
    pub fn to_world(&self) -> &Motion {
        &self.to_world
    }

    /// Distribution of its intensity over directions.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Change of its strength over time; `None` if it is constant.
    #[must_use]
    pub fn modulation(&self) -> Option<&Waveform> {
        self.modulation.as_deref()
    }

    /// Spectral intensity where the profile is 1, W·sr⁻¹·nm⁻¹, at the level 1.
    #[must_use]
    pub fn intensity(&self) -> &Spectrum {
        &self.intensity
    }
}

/// A lamp in the render frame.
#[derive(Clone, Debug)]
pub(super) struct LampLight {
    position: Vec3,
    /// Rotation from the render frame to the lamp's.
    to_lamp: Mat3,
    /// Mean intensity over the wavelengths of the camera where the profile is 1, W·sr⁻¹·nm⁻¹, with the lamp's strength over the view's
    /// interval, for light selection.
    mean_intensity: f32,
    attenuation: f32,
    intensity: Arc<Spectrum>,
    profile: Arc<Profile>,
    modulation: Option<Arc<Waveform>>,
}

impl LampLight {
    /// The lamp placed by `to_render`, from its frame to the render frame, in a view of an `interval`.
    pub(super) fn new(lamp: Lamp, to_render: &DAffine3, interval: TimeInterval, range: WavelengthRange) -> Self {
        let counts = lamp.modulation().map_or(1.0, |modulation| selection_level(modulation, interval));
        Self {
            position: to_render.translation.as_vec3(),
            to_lamp: to_render.matrix3.transpose().as_mat3(),
            mean_intensity: (lamp.intensity.band_mean(range.low_nm, range.high_nm) * counts) as f32,
            attenuation: lamp.attenuation_per_m as f32,
            intensity: lamp.intensity,
            profile: lamp.profile,
            modulation: lamp.modulation,
        }
    }

    /// Position in the render frame, m.
    pub(super) fn position(&self) -> Vec3 {
        self.position
    }

    /// Mean intensity over the wavelengths of the camera in its brightest direction, W·sr⁻¹·nm⁻¹.
    pub(super) fn max_intensity(&self) -> f32 {
        self.mean_intensity * self.profile.peak() as f32
    }

    /// Bounds for light selection.
    pub(super) fn bounds(&self) -> LightBounds {
        let spread = self.profile.spread();
        let core_sr = core::f64::consts::TAU * (1.0 - maths::f64::cos(f64::from(spread.core_rad)));
        LightBounds {
            low: self.position,
            high: self.position,
            radius: 0.0,
            intensity: f64::from(self.mean_intensity) * spread.flux_sr / core_sr.max(f64::MIN_POSITIVE),
            axis: (self.to_lamp.transpose() * spread.axis).normalize(),
            theta_o: spread.core_rad,
            theta_e: (spread.reach_rad - spread.core_rad).max(0.0),
            is_lamp: true,
        }
    }

    /// Mean irradiance at a receiver.
    pub(super) fn irradiance(&self, receiver: &LightSampleContext) -> LampIrradiance {
        let Some((direction, factor)) = self.reach(receiver.position) else { return LampIrradiance::default() };
        let cos = if receiver.normal == Vec3::ZERO { 1.0 } else { receiver.normal.dot(direction).max(0.0) };
        let raised = if cos > 0.0 { cos + receiver.glossy(direction, 0.0) } else { 0.0 };
        let faced = self.mean_intensity * factor;
        LampIrradiance { diffuse: faced * cos, with_gloss: faced * raised }
    }

    /// Mean irradiance of a lamp whose light starts within `extent_m` of its position.
    pub(super) fn irradiance_of_extent(&self, receiver: &LightSampleContext, extent_m: f32) -> LampIrradiance {
        let to_lamp = self.position - receiver.position;
        let distance = to_lamp.length();
        let Some(direction) = (distance > 0.0).then(|| to_lamp / distance) else {
            return LampIrradiance::default();
        };
        let sin = (extent_m / distance).min(1.0);
        let cos =
            if receiver.normal == Vec3::ZERO { 1.0 } else { (receiver.normal.dot(direction) + sin).clamp(0.0, 1.0) };
        let raised = if cos > 0.0 { cos + receiver.glossy(direction, sin) } else { 0.0 };
        let near = distance.max(0.5 * extent_m);
        let faced = self.mean_intensity * self.profile.value(self.to_lamp(-direction)) / (near * near);
        LampIrradiance { diffuse: faced * cos, with_gloss: faced * raised }
    }

    /// Transforms a direction of the render frame to the lamp's.
    pub(super) fn to_lamp(&self, direction: Vec3) -> Vec3 {
        self.to_lamp * direction
    }

    /// Spectral intensity along the unit `direction` of the lamp's frame, W·sr⁻¹·nm⁻¹.
    pub(super) fn intensity_along<const N: usize>(&self, direction: Vec3, query: EmissionQuery<'_, N>) -> Spectral<N> {
        self.intensity(query) * self.profile.value(direction)
    }

    /// Spectral intensity where the profile is 1, W·sr⁻¹·nm⁻¹, averaged over a time.
    fn intensity<const N: usize>(&self, query: EmissionQuery<'_, N>) -> Spectral<N> {
        let intensity = self.intensity.sample(query.wavelengths);
        match &self.modulation {
            None => intensity,
            Some(modulation) => intensity * (modulation.mean(*query.interval) as f32),
        }
    }

    /// Direction to the lamp, and the irradiance of a surface that faces it per unit of intensity; `None` if there is none.
    fn reach(&self, from: Vec3) -> Option<(Vec3, f32)> {
        let to_lamp = self.position - from;
        let distance = to_lamp.length();
        let direction = to_lamp / distance;
        let value = self.profile.value(self.to_lamp * -direction);
        let factor = value / (distance * distance) / (1.0 + self.attenuation * distance);
        (factor > 0.0 && factor.is_finite()).then_some((direction, factor))
    }

    pub(super) fn sample<const N: usize>(&self, from: Vec3, query: EmissionQuery<'_, N>) -> Option<LightSample<N>> {
        let (direction, factor) = self.reach(from)?;
        let radiance = self.intensity(query) * factor;
        let target = Some(self.position);
        Some(LightSample { direction, target, radiance, pdf: 1.0, delta: true, is_environment: false })
    }
}
