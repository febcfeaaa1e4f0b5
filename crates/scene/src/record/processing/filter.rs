//! `[[isp.image_filters]]`: the filters of Gruyer, Grapinet, De Souza (2012), "the paper".

use super::tone::{ToneCurve, tone_curve};
use crate::fault::{ErrorCode, Faults};
use crate::place::{Place, Placed};
use crate::reader::{
    RuleExt as _, choice, exactly, keyed, list, number, percentile, record, variants, vector, whole, words,
};

variants! {
    /// A filter of the paper.
    pub enum PaperFilter by "type" {
        /// Gain control by the histogram, and blooming, on linear light (our interpretation of the paper).
        "glow" => Glow(Glow),
        /// Tone mapping from the scene's range to the sensor's, on linear light (our interpretation of the paper).
        "tone_map" => ToneMap(ToneMap),
        /// Raindrops: inverted images in discs, which flow and fade, on linear light (our interpretation of the paper).
        "drops" => Drops(PaperDrops),
        /// A 4 × 4 affine matrix on colours.
        "colour" => Colour(ColourChange),
        /// Pulse noise: some pixels brighter, some darker.
        "pulse_noise" => PulseNoise(PulseNoise),
        /// A normally distributed number added to each pixel's brightness.
        "gaussian_noise" => GaussianNoise(GaussianNoise),
        /// A uniformly distributed factor on each pixel's brightness.
        "uniform_noise" => UniformNoise(UniformNoise),
    }
}

record! {
    /// Gain control and blooming.
    pub struct Glow {
        /// Percentile of the image's luminance that controls the gain, above 1 and at most 100: 50 is the median.
        required percentile: Placed<f64> = percentile();
        /// Luminance to which this percentile is mapped, fraction of white, above 0.
        required target: Placed<f64> = number("").above(0.0);
        /// Luminance after the gain above which the excess glows, fraction of white, 0 or more.
        required threshold: Placed<f64> = number("").at_least(0.0);
        /// σ of the glow, px, above 0 and at most 500.
        required radius_px: Placed<f64> = number("px").above(0.0).at_most(500.0);
        /// Fraction of the excess that is added, 0 or more.
        required strength: Placed<f64> = number("").at_least(0.0);
    }
}

record! {
    /// Tone mapping.
    pub struct ToneMap {
        /// Weight of the unmapped image, 0 … 1; the paper shows 0.4 and 1.0.
        required original_factor: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Factor on the light before the curve, above 0. Default: 1.
        optional gain: Placed<f64> = number("").above(0.0);
        /// Sensitivity curve of the sensor, as a tone curve. Default: 1 − exp(−x).
        optional curve: ToneCurve = tone_curve();
    }
}

record! {
    /// Raindrops painted on the image: each disc shows its surroundings upside down. Drops on a windscreen are traced instead.
    pub struct PaperDrops check(check_drops) {
        /// Number of drops, 1 … 100 000.
        required count: Placed<u64> = whole(1, 100_000);
        /// Smallest radius, px, above 0.
        required min_radius_px: Placed<f64> = number("px").above(0.0);
        /// Largest radius, px, above 0; radii are uniformly distributed between the two.
        required max_radius_px: Placed<f64> = number("px").above(0.0);
        /// Reduction of the image within a drop, above 0.
        required scale: Placed<f64> = number("").above(0.0);
        /// σ of the blur within a drop, and width of its soft edge, px, above 0; times "scale" at most 500.
        required blur_px: Placed<f64> = number("px").above(0.0);
        /// With "fade_frames": distance that a drop flows down per frame, px, above 0. Default: no flow.
        optional flow_px_per_frame: Placed<f64> = number("px").above(0.0);
        /// Lifetime of a drop in frames; it fades linearly, and a new one appears elsewhere. Default: drops are permanent.
        optional fade_frames: Placed<u64> = whole(1, 1_000_000);
    }
}

fn check_drops(drops: &PaperDrops, faults: &mut Faults) {
    let (least, greatest) = (&drops.min_radius_px, drops.max_radius_px.value);
    if least.value > greatest {
        let problem = format!("{} px is above max_radius_px = {greatest} px", least.value);
        faults.add(ErrorCode::WrongOrder, &least.place, problem, "give a minimum of at most the maximum");
    }
    let of_picture = drops.blur_px.value * drops.scale.value;
    if of_picture > 500.0 {
        let problem = format!("times scale = {} it is {of_picture} px in the image", drops.scale.value);
        faults.add(ErrorCode::OutOfRange, &drops.blur_px.place, problem, "choose both so that it is at most 500 px");
    }
    if let (Some(flow), None) = (&drops.flow_px_per_frame, &drops.fade_frames) {
        let problem = "\"flow_px_per_frame\" has no effect without \"fade_frames\": permanent drops would flow out of the image";
        faults.add(ErrorCode::NoEffect, &flow.place, problem, "add \"fade_frames\", or remove it");
    }
}

record! {
    /// A change of colours.
    pub struct ColourChange {
        /// Stage on which the filter works: "display" (the encoded image) or "linear" (linear light). Default: "display".
        optional on: Placed<Stage> = choice();
        /// Operations in this order, combined into one matrix; clipped once at the end.
        many operations: Operation = list(record(), 1);
    }
}

words! {
    /// Stage on which a change of colours works.
    pub enum Stage {
        /// The encoded image.
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
        /// Fractions of white added to red, green and blue.
        offset => Offset(Placed<[f64; 3]>) = vector::<3>(number(""));
        /// Factor on all three, 0 or more.
        brightness => Brightness(Placed<f64>) = number("").at_least(0.0);
        /// Saturation, 0 or more: 0 is grey, 1 no change.
        saturation => Saturation(Placed<f64>) = number("").at_least(0.0);
        /// Rotation of the hue about the grey axis, degrees, red towards green.
        hue_rotation_deg => HueRotation(Placed<f64>) = number("°");
        /// Conversion to this colour space: its components replace red, green and blue.
        to => To(Placed<ColourSpace>) = choice();
        /// Conversion from this colour space.
        from => From(Placed<ColourSpace>) = choice();
        /// Any affine map: three rows of four numbers; the last of each row is added.
        matrix => Matrix(Box<Placed<[Placed<[f64; 4]>; 3]>>) = exactly(vector::<4>(number(""))).map(Box::new, |rows| Some((**rows).clone()));
    }
}

words! {
    /// A colour space. RGB spaces apply to linear light, luma spaces to the encoded image, CMY to both.
    pub enum ColourSpace {
        /// Primaries of NTSC (1953).
        "rgb_ntsc" => RgbNtsc,
        /// Primaries of PAL.
        "rgb_pal" => RgbPal,
        /// Luma and colour differences of PAL.
        "yuv" => Yuv,
        /// Luma and colour differences of NTSC.
        "yiq" => Yiq,
        /// Luma and colour differences of image files.
        "ycbcr" => YCbCr,
        /// Complements.
        "cmy" => Cmy,
    }
}

record! {
    /// Pulse noise.
    pub struct PulseNoise {
        /// p₁: change of brightness, DN of an 8-bit image, 0 … 255.
        required amplitude_dn: Placed<f64> = number("DN").at_least(0.0).at_most(255.0);
        /// p₂: fraction of the pixels that become brighter, and of those that become darker, 0 … 0.5.
        required probability: Placed<f64> = number("").at_least(0.0).at_most(0.5);
    }
}

record! {
    /// Additive Gaussian noise.
    pub struct GaussianNoise {
        /// p₁: standard deviation, DN of an 8-bit image, 0 … 255.
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
    /// Place of its table.
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

    /// Tone curve of the filter, if any.
    pub(super) fn curve(&self) -> Option<&ToneCurve> {
        match self {
            Self::ToneMap(map) => map.curve.as_ref(),
            _ => None,
        }
    }
}
