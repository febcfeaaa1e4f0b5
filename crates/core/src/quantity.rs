//! The quantities that stages hand to each other, as types.
//!
//! A [`Quantity`] is a marker: a `Plane<Irradiance>` cannot be given to an effect that works on electrons, nor a plane of mean
//! electrons to one that works on counted charge.

/// A physical quantity of an image, named so that a plane of it cannot be taken for another.
pub trait Quantity: Copy + core::fmt::Debug + Send + Sync + 'static {
    /// What one pixel holds.
    type Sample: Copy + Default + PartialEq + Send + Sync + core::fmt::Debug + 'static;
    /// The quantity's name in the words of the field, as files state it.
    const NAME: &'static str;
    /// The unit, as files state it.
    const UNIT: &'static str;
}

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident($sample:ty) = $text:literal, $unit:literal;)*) => {
        $($(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $name;

        impl Quantity for $name {
            type Sample = $sample;
            const NAME: &'static str = $text;
            const UNIT: &'static str = $unit;
        })*
    };
}

quantities! {
    /// Spectral radiance at the entrance pupil.
    Radiance(f32) = "spectral radiance", "W.m^-2.sr^-1.nm^-1";
    /// Spectral irradiance on the sensor plane.
    Irradiance(f32) = "spectral irradiance", "W.m^-2.nm^-1";
    /// The share of light that comes through what lies between.
    Transmittance(f32) = "transmittance", "1";
    /// The share of a pixel, and of its exposure, that near drops or flakes cover.
    Cover(f32) = "cover", "1";
    /// The weight of a pixel's pupil: mean projected solid angle times transmittance.
    SolidAngle(f32) = "projected solid angle", "sr";
    /// Variance of a mean, in the square of that mean's unit.
    Variance(f32) = "variance of the mean", "(unit of the mean)^2";
    /// Mean electrons of a pixel: the expected number of photo-electrons of an exposure, before any is counted.
    MeanElectrons(f32) = "electrons", "e";
    /// Charge of a pixel: the electrons that it has collected.
    Charge(f32) = "charge", "e";
    /// Voltage of a pixel after the sense node, in electrons of charge that would make it at little light.
    Voltage(f32) = "voltage", "e";
    /// What one cause adds to a pixel's value on its way to a number, at whatever stage it does, in electrons at the converter's input; also
    /// the flag, 0 or 1, of a breakdown into such parts.
    SignalPart(f32) = "part of a signal", "e";
    /// Mean electrons that a pixel makes of a second of light.
    ElectronRate(f32) = "electron rate", "e.s^-1";
    /// What a limit of noise watches: electrons of a second of light, or irradiance over all wavelengths where none are made.
    WatchedSignal(f32) = "watched signal", "e.s^-1 or W.m^-2";
    /// Digital numbers out of the converter, of up to 24 bits.
    DigitalNumber(u32) = "digital number", "DN";
    /// Display-referred picture, sRGB-encoded, 0 to 1 a channel.
    Display([f32; 3]) = "display", "1";
    /// Linear, scene-referred colour in a camera's or display's primaries.
    LinearRgb([f32; 3]) = "linear rgb", "1";
    /// A length along a ray or an axis.
    Length(f32) = "length", "m";
    /// An identity; 0 is the background.
    Identity(u32) = "identity", "1";
    /// Optical flow: where the surface point that a pixel sees is seen in another picture, minus where it is seen here (x right, y
    /// down); NaN where that is not known.
    OpticalFlow([f32; 2]) = "optical flow", "px";
    /// How far left of its place in a left picture a point is seen in the right one of a rectified pair; NaN where that is not known.
    Disparity(f32) = "disparity", "px";
    /// Simulated time, counted from where its owner states.
    Time(f32) = "time", "s";
    /// A velocity within the picture (x right, y down); NaN where there is none.
    ImageVelocity([f32; 2]) = "image velocity", "px.s^-1";
    /// A vector of three components: a normal (dimensionless), a position (m) or a velocity (m/s), as its owner states.
    Vector([f32; 3]) = "vector", "1";
}
