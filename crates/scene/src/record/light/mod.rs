//! Lights: emission of surfaces, and `[[lights]]`, which are no surfaces.

pub mod emission;
pub mod lamp;
pub mod modulation;
pub mod opening;
pub mod placement;
pub mod strength;
pub mod sun;

pub(crate) use emission::illuminants;
pub use emission::{Emission, Level, LightColour};
pub use lamp::{Beam, HeadLamp, Mask, MeasuredLamp, PointLamp, SpotLamp, Traffic};
pub use modulation::Modulation;
pub use opening::LampOpening;
pub use placement::{LampAim, LampInstance, LampKey, LampPlacement};
pub use strength::{LampStrength, MeasuredStrength};
pub use sun::{Sun, SunLevel};

use crate::place::Placed;
use crate::reader::variants;

variants! {
    /// A light that is no surface.
    pub enum Light by "type" {
        /// The sun's disc, at infinity.
        "sun" => Sun(Sun),
        /// A lamp with equal intensity in all directions.
        "point" => Point(PointLamp),
        /// A lamp with a cone of light about its +x axis.
        "spot" => Spot(SpotLamp),
        /// A lamp with measured intensities (IES LM-63, EULUMDAT).
        "measured" => Measured(MeasuredLamp),
        /// Low or high beam by the test points of UN R149; +x points forward.
        "head_lamp" => HeadLamp(HeadLamp),
    }
}

impl Light {
    /// Name of the light.
    #[must_use]
    pub fn name(&self) -> &Placed<String> {
        match self {
            Self::Sun(sun) => &sun.name,
            Self::Point(lamp) => &lamp.name,
            Self::Spot(lamp) => &lamp.name,
            Self::Measured(lamp) => &lamp.name,
            Self::HeadLamp(lamp) => &lamp.name,
        }
    }

    /// Position of a lamp; `None` for a sun.
    #[must_use]
    pub fn placement(&self) -> Option<&LampPlacement> {
        match self {
            Self::Sun(_) => None,
            Self::Point(lamp) => Some(&lamp.placement),
            Self::Spot(lamp) => Some(&lamp.placement),
            Self::Measured(lamp) => Some(&lamp.placement),
            Self::HeadLamp(lamp) => Some(&lamp.placement),
        }
    }

    /// Variation of its strength over time.
    #[must_use]
    pub fn modulation(&self) -> Option<&Modulation> {
        match self {
            Self::Sun(_) => None,
            Self::Point(lamp) => lamp.modulation.as_ref(),
            Self::Spot(lamp) => lamp.modulation.as_ref(),
            Self::Measured(lamp) => lamp.modulation.as_ref(),
            Self::HeadLamp(lamp) => lamp.modulation.as_ref(),
        }
    }

    /// Colour, if the light states it.
    #[must_use]
    pub fn colour(&self) -> Option<&LightColour> {
        match self {
            Self::Sun(sun) => sun.colour.as_ref(),
            Self::Point(lamp) => Some(&lamp.colour),
            Self::Spot(lamp) => Some(&lamp.colour),
            Self::Measured(lamp) => Some(&lamp.colour),
            Self::HeadLamp(lamp) => Some(&lamp.colour),
        }
    }
}
