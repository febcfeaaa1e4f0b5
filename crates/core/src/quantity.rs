//! Types of the quantities that stages exchange.
//!
//! A [`Quantity`] is a marker: a `Plane<Irradiance>` cannot be given to an effect that works on electrons, nor a plane of mean electrons to one that works on
//! counted charge.

/// Physical quantity of an image: a type, so that planes of different quantities cannot be confused.
pub trait Quantity: Copy + core::fmt::Debug + Send + Sync + 'static {
    /// Value of one pixel.
    type Sample: Copy + Default + PartialEq + Send + Sync + core::fmt::Debug + 'static;
    /// Name of the quantity as files state it, in standard terms.
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
    /// Fraction of light transmitted by what lies between.
    Transmittance(f32) = "transmittance", "1";
    /// Fraction of a pixel, and of its exposure, covered by near drops or flakes.
    Cover(f32) = "cover", "1";
    /// The weight of a pixel's pupil: mean projected solid angle times transmittance.
    SolidAngle(f32) = "projected solid angle", "sr";
    /// Variance of a mean, in the square of that mean's unit.
    Variance(f32) = "variance of the mean", "(unit of the mean)^2";
    /// Mean electrons of a pixel: the expected number of photo-electrons of an exposure, before photon noise.
    MeanElectrons(f32) = "electrons", "e";
    /// Charge of a pixel: the collected electrons.
    Charge(f32) = "charge", "e";
    /// Voltage of a pixel after the sense node, in electrons: the charge that gives this voltage at low light.
    Voltage(f32) = "voltage", "e";
    /// Contribution of one cause to a pixel's digital number, from any stage of the chain, in electrons at the ADC input; also the flag, 0 or 1, of a breakdown
    /// into such contributions.
    SignalPart(f32) = "part of a signal", "e";
    /// Mean electrons that a pixel generates per second of light.
    ElectronRate(f32) = "electron rate", "e.s^-1";
    /// Quantity that a noise limit applies to: electrons per second of light, or irradiance over all wavelengths if there are no electrons.
    WatchedSignal(f32) = "watched signal", "e.s^-1 or W.m^-2";
    /// Digital numbers of the ADC, of up to 24 bits.
    DigitalNumber(u32) = "digital number", "DN";
    /// Display-referred image, sRGB-encoded, 0 to 1 per channel.
    Display([f32; 3]) = "display", "1";
    /// Linear, scene-referred colour in a camera's or display's primaries.
    LinearRgb([f32; 3]) = "linear rgb", "1";
    /// A length along a ray or an axis.
    Length(f32) = "length", "m";
    /// An identity; 0 is the background.
    Identity(u32) = "identity", "1";
    /// Optical flow: position, in another image, of the surface point that a pixel sees, minus its position here (x right, y down); NaN where unknown.
    OpticalFlow([f32; 2]) = "optical flow", "px";
    /// Disparity: distance by which a point lies farther left in the right image of a rectified pair than in the left one; NaN where unknown.
    Disparity(f32) = "disparity", "px";
    /// Simulated time, counted from an origin that its owner states.
    Time(f32) = "time", "s";
    /// Velocity within the image (x right, y down); NaN where there is none.
    ImageVelocity([f32; 2]) = "image velocity", "px.s^-1";
    /// A vector of three components: a normal (dimensionless), a position (m) or a velocity (m/s), as its owner states.
    Vector([f32; 3]) = "vector", "1";
}
