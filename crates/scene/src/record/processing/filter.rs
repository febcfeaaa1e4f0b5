//! `[[isp.image_filters]]`: the filters of the paper.

use super::tone::{ToneCurve, tone_curve};
use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};
use crate::reader::{
    RuleExt as _, choice, exactly, keyed, list, number, percentile, record, variants, vector, whole, words,
};

variants! {
    /// A filter of the paper.
    pub enum PaperFilter by "type" {
        /// Gain control by the histogram, and blooming, on linear light (our reading).
        "glow" => Glow(Glow),
        /// From the scene's range to the sensor's, on linear light (our reading).
        "tone_map" => ToneMap(ToneMap),
        /// Drops of rain: inverted pictures in discs, which flow and fade, on linear light (our reading).
        "drops" => Drops(PaperDrops),
        /// A 4 × 4 affine matrix on colours.
        "colour" => Colour(ColourChange),
        /// Some pixels brighter, some darker.
        "pulse_noise" => PulseNoise(PulseNoise),
        /// A normal number added to each pixel's brightness.
        "gaussian_noise" => GaussianNoise(GaussianNoise),
        /// A uniform number as a factor on each pixel's brightness.
        "uniform_noise" => UniformNoise(UniformNoise),
    }
}

record! {
    /// Gain control and blooming.
    pub struct Glow {
        /// Percentile of the picture's luminances that the gain looks at, above 1 and at most 100: 50 is the median.
        required percentile: Placed<f64> = percentile();
        /// The luminance that this percentile gets, share of white, above 0.
        required target: Placed<f64> = number("").above(0.0);
        /// What exceeds this after the gain glows, share of white, 0 or more.
        required threshold: Placed<f64> = number("").at_least(0.0);
        /// σ of the glow, px, above 0 and at most 500.
        required radius_px: Placed<f64> = number("px").above(0.0).at_most(500.0);
        /// Share of the excess that is added, 0 or more.
        required strength: Placed<f64> = number("").at_least(0.0);
    }
}

record! {
    /// Tone mapping.
    pub struct ToneMap {
        /// Share of the unmapped picture, 0 … 1; the paper shows 0.4 and 1.0.
        required original_factor: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Factor on the light before the curve, above 0. Default: 1.
        optional gain: Placed<f64> = number("").above(0.0);
        /// The sensor's sensitivity curve, as a tone curve. Default: 1 − exp(−x).
        optional curve: ToneCurve = tone_curve();
    }
}

record! {
    /// Drops of rain on the picture: each disc shows what lies around it upside down. The drops of a wind-screen are traced, these are drawn.
    pub struct PaperDrops check(check_drops) {
        /// How many, 1 … 100 000.
        required count: Placed<u64> = whole(1, 100_000);
        /// Least radius, px, above 0.
        required min_radius_px: Placed<f64> = number("px").above(0.0);
        /// Greatest radius, px, above 0; radii are even between the two.
        required max_radius_px: Placed<f64> = number("px").above(0.0);
        /// How many times smaller the picture is in a drop, above 0.
        required scale: Placed<f64> = number("").above(0.0);
        /// σ of the blur in a drop, and width of its soft rim, px, above 0; times "scale" at most 500.
        required blur_px: Placed<f64> = number("px").above(0.0);
        /// With "fade_frames": how far a drop flows downwards from frame to frame, px, above 0. Default: not at all.
        optional flow_px_per_frame: Placed<f64> = number("px").above(0.0);
        /// How many frames a drop lives, fading evenly; another is born elsewhere. Default: drops stay.
        optional fade_frames: Placed<u64> = whole(1, 1_000_000);
    }
}

fn check_drops(drops: &PaperDrops, faults: &mut Faults) {
    let (least, greatest) = (&drops.min_radius_px, drops.max_radius_px.value);
    if least.value > greatest {
        let problem = format!("{} px is above max_radius_px = {greatest} px", least.value);
        faults.add(ErrorCode::WrongOrder, &least.place, problem, "make the least radius no larger than the greatest");
    }
    let of_picture = drops.blur_px.value * drops.scale.value;
    if of_picture > 500.0 {
        let problem = format!("times scale = {} it is {of_picture} px of the picture", drops.scale.value);
        faults.add(ErrorCode::OutOfRange, &drops.blur_px.place, problem, "choose both so that it is at most 500 px");
    }
    if let (Some(flow), None) = (&drops.flow_px_per_frame, &drops.fade_frames) {
        let problem = "\"flow_px_per_frame\" has no effect without \"fade_frames\": drops that live for ever would flow out of the picture";
        faults.add(ErrorCode::NoEffect, &flow.place, problem, "add \"fade_frames\", or remove it");
    }
}

record! {
    /// A change of colours.
    pub struct ColourChange {
        /// "display" (the encoded picture) or "linear" (linear light). Default: "display".
        optional on: Placed<Stage> = choice();
        /// What is done, in this order, as one matrix; clipped once at the end.
        many operations: Operation = list(record(), 1);
    }
}

words! {
    /// What a change of colours works on.
    pub enum Stage {
        /// The encoded picture.
        "display" => Display,
        /// Linear light.
        "linear" => Linear,
    }
}

keyed! {
    /// One step of a change of colours.
    pub enum Operation {
        /// Factors on red, green and blue.
        scale => Scale(Placed<[f64; 3]>) = vector::<3>(number(""));
        /// Shares of white added to red, green and blue.
        offset => Offset(Placed<[f64; 3]>) = vector::<3>(number(""));
        /// A factor on all three, 0 or more.
        brightness => Brightness(Placed<f64>) = number("").at_least(0.0);
        /// 0 is grey, 1 as it was, more is more colourful; 0 or more.
        saturation => Saturation(Placed<f64>) = number("").at_least(0.0);
        /// Turn of the hue about the greys, degrees, red towards green.
        hue_rotation_deg => HueRotation(Placed<f64>) = number("°");
        /// To this colour space: its components take the places of red, green and blue.
        to => To(Placed<ColourSpace>) = choice();
        /// From this colour space.
        from => From(Placed<ColourSpace>) = choice();
        /// Any affine map: three rows of four numbers, the last of each is added.
        matrix => Matrix(Box<Placed<[Placed<[f64; 4]>; 3]>>) = exactly(vector::<4>(number(""))).map(Box::new, |rows| Some((**rows).clone()));
    }
}

words! {
    /// A colour space. The two of primaries are for linear light, those of luma for the encoded picture, CMY for both.
    pub enum ColourSpace {
        /// Primaries of NTSC (1953).
        "rgb_ntsc" => RgbNtsc,
        /// Primaries of PAL.
        "rgb_pal" => RgbPal,
        /// Luma and two differences of PAL.
        "yuv" => Yuv,
        /// Luma and two differences of NTSC.
        "yiq" => Yiq,
        /// Luma and two differences of files.
        "ycbcr" => YCbCr,
        /// Complements.
        "cmy" => Cmy,
    }
}

record! {
    /// Pulse noise.
    pub struct PulseNoise {
        /// p₁: how much brighter or darker, DN of an 8-bit picture, 0 … 255.
        required amplitude_dn: Placed<f64> = number("DN").at_least(0.0).at_most(255.0);
        /// p₂: share of the pixels that get brighter, and of those that get darker, 0 … 0.5.
        required probability: Placed<f64> = number("").at_least(0.0).at_most(0.5);
    }
}

record! {
    /// Additive Gaussian noise.
    pub struct GaussianNoise {
        /// p₁: standard deviation, DN of an 8-bit picture, 0 … 255.
        required sigma_dn: Placed<f64> = number("DN").at_least(0.0).at_most(255.0);
    }
}

record! {
    /// Multiplicative uniform noise.
    pub struct UniformNoise {
        /// p₁: width of the factor's range about 1, 0 … 2.
        required range: Placed<f64> = number("").at_least(0.0).at_most(2.0);
    }
}

impl PaperFilter {
    /// Where its table stands.
    #[must_use]
    pub fn place(&self) -> &Place {
        match self {
            Self::Glow(r) => &r.place,
            Self::ToneMap(r) => &r.place,
            Self::Drops(r) => &r.place,
            Self::Colour(r) => &r.place,
            Self::PulseNoise(r) => &r.place,
            Self::GaussianNoise(r) => &r.place,
            Self::UniformNoise(r) => &r.place,
        }
    }

    /// The tone curve that it names.
    pub(super) fn curve(&self) -> Option<&ToneCurve> {
        match self {
            Self::ToneMap(map) => map.curve.as_ref(),
            _ => None,
        }
    }
}
