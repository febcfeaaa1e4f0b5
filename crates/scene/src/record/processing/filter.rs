//! `[[isp.image_filters]]`: the filters of Gruyer, Grapinet, De Souza (2012), "the paper".

use super::tone::{ToneCurve, tone_curve};
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::{Place, Placed};
use crate::reader::{
    RuleExt as _, choice, exactly, integer, keyed, list, number, percentile, record, variants, vector, words,
};

variants! {
    /// A filter of the paper.
    pub enum GruyerFilter by "type" {
        /// Histogram gain control and blooming, on linear light.
        "glow" => Glow(Glow),
        /// Tone mapping to the sensor's range, on linear light.
        "tone_map" => ToneMap(ToneMap),
        /// Raindrops: inverted images in discs, on linear light.
        "drops" => Drops(PaintedDrops),
        /// A 4 × 4 affine matrix on colours.
        "colour" => Colour(ColourChange),
        /// Pulse noise: brighter and darker pixels.
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
        /// Luminance percentile that controls the gain; 50 is the median.
        required percentile: Placed<f64> = percentile();
        /// Luminance to which the percentile is mapped, fraction of white.
        required target: Placed<f64> = number("").above(0.0);
        /// Luminance after the gain above which the excess glows, fraction of white.
        required threshold: Placed<f64> = number("").at_least(0.0);
        /// σ of the glow.
        required radius_px: Placed<f64> = number("px").above(0.0).at_most(500.0);
        /// Fraction of the excess that is added.
        required strength: Placed<f64> = number("").at_least(0.0);
    }
}

record! {
    /// Tone mapping.
    pub struct ToneMap {
        /// Weight of the unmapped image; the paper shows 0.4 and 1.0.
        required original_factor: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Factor before the curve. Default: 1.
        optional gain: Placed<f64> = number("").above(0.0);
        /// Sensitivity curve of the sensor. Default: 1 − exp(−x).
        optional curve: ToneCurve = tone_curve();
    }
}

record! {
    /// Raindrops painted on the image: each disc shows its surroundings upside down. Drops on a windscreen are traced instead.
    pub struct PaintedDrops check(check_drops) {
        /// Number of drops.
        required count: Placed<u64> = integer(1, 100_000);
        /// Smallest radius.
        required min_radius_px: Placed<f64> = number("px").above(0.0);
        /// Largest radius; radii are uniformly distributed.
        required max_radius_px: Placed<f64> = number("px").above(0.0);
        /// Reduction of the image within a drop, above 0.
        required scale: Placed<f64> = number("").above(0.0);
        /// σ of the blur and width of the soft edge; times "scale" at most 500.
        required blur_px: Placed<f64> = number("px").above(0.0);
        /// With "fade_frames": downward flow per frame.
        optional flow_px_per_frame: Placed<f64> = number("px").above(0.0);
        /// Lifetime in frames, fading linearly. Default: permanent.
        optional fade_frames: Placed<u64> = integer(1, 1_000_000);
    }
}

fn check_drops(drops: &PaintedDrops, errors: &mut DescriptionErrors) {
    let (min, greatest) = (&drops.min_radius_px, drops.max_radius_px.value);
    if min.value > greatest {
        let problem = format!("{} px is above max_radius_px = {greatest} px", min.value);
        errors.add(ErrorCode::WrongOrder, &min.place, problem, "give a minimum of at most the maximum");
    }
    let in_image_px = drops.blur_px.value * drops.scale.value;
    if in_image_px > 500.0 {
        let problem = format!("times scale = {} it is {in_image_px} px in the image", drops.scale.value);
        errors.add(ErrorCode::OutOfRange, &drops.blur_px.place, problem, "choose both so that it is at most 500 px");
    }
    if let (Some(flow), None) = (&drops.flow_px_per_frame, &drops.fade_frames) {
        let problem =
            "\"flow_px_per_frame\" has no effect without \"fade_frames\": permanent drops would flow out of the image";
        errors.add(ErrorCode::NoEffect, &flow.place, problem, "add \"fade_frames\", or remove it");
    }
}

record! {
    /// A change of colours.
    pub struct ColourChange {
        /// Stage: encoded ("display") or linear image. Default: "display".
        optional on: Placed<Stage> = choice();
        /// Operations in order, combined into one matrix and clipped once.
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
        /// Factor on all channels.
        brightness => Brightness(Placed<f64>) = number("").at_least(0.0);
        /// Saturation: 0 grey, 1 unchanged.
        saturation => Saturation(Placed<f64>) = number("").at_least(0.0);
        /// Hue rotation about the grey axis, red towards green.
        hue_rotation_deg => HueRotation(Placed<f64>) = number("°");
        /// Conversion to this colour space, which replaces red, green and blue.
        to => To(Placed<ColourSpace>) = choice();
        /// Conversion from this colour space.
        from => From(Placed<ColourSpace>) = choice();
        /// Affine map: three rows of four numbers, the last added.
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
        /// p₁: change of brightness, DN of 8 bits.
        required amplitude_dn: Placed<f64> = number("DN").at_least(0.0).at_most(255.0);
        /// p₂: fraction of pixels that become brighter, and of those that become darker.
        required probability: Placed<f64> = number("").at_least(0.0).at_most(0.5);
    }
}

record! {
    /// Additive Gaussian noise.
    pub struct GaussianNoise {
        /// p₁: standard deviation, DN of 8 bits.
        required sigma_dn: Placed<f64> = number("DN").at_least(0.0).at_most(255.0);
    }
}

record! {
    /// Multiplicative uniform noise.
    pub struct UniformNoise {
        /// p₁: width of the factor's range about 1.
        required range: Placed<f64> = number("").at_least(0.0).at_most(2.0);
    }
}

impl GruyerFilter {
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
