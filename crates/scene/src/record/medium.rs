//! `[[media]]`: fog, haze, spray and smoke between the surfaces of a scene.

use super::curve::{Curve, curve};
use super::transform::Transform;
use crate::asset::file_list::{FileList, NamesFiles};
use crate::asset::request::{ReplacedMaterials, SpectrumValues};
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::{Place, Placed};
use crate::reader::{integer, keyed, name_of, number, path, record, text, variants, vector};
use std::path::PathBuf;

record! {
    /// A participating medium in a part of the world. Overlapping media add up. Ground truth ignores it.
    pub struct Medium check(check) {
        /// Name of the medium.
        required name: Placed<String> = text("the name of the medium");
        /// Density.
        inside extinction: Extinction;
        /// Single-scattering albedo. Default: 1, as of water droplets.
        optional albedo: Curve = curve(number("").at_least(0.0).at_most(1.0));
        /// Phase function. Default: water droplets of 12 µm.
        optional phase: Phase = record();
        /// Part of the world that it fills. Default: everywhere.
        optional shape: MediumShape = record();
        /// Placement of the shape; only of shapes with bounds.
        inside transform: Transform;
        /// Frame of the shape. Default: the world.
        optional frame: Placed<String> = name_of(NameKind::Frame);
        /// Variation of the density. Default: homogeneous.
        optional unevenness: DensityNoise = record();
    }
}

keyed! {
    /// Extinction of a medium.
    pub enum Extinction {
        /// Visibility in the medium.
        visibility => Visibility(Visibility) = record();
        /// Extinction coefficient.
        extinction_per_m => PerMetre(Curve) = curve(number("1/m").at_least(0.0).at_most(1e6));
    }
}

record! {
    /// The distance at which the contrast of a black object against the horizon falls to a threshold. The extinction coefficient is
    /// −ln(contrast)/distance (Koschmieder 1924), equal at all wavelengths.
    pub struct Visibility {
        /// Distance.
        required distance_m: Placed<f64> = number("m").above(0.0);
        /// Contrast threshold: 0.02 (Koschmieder), 0.05 (meteorological optical range, WMO).
        required contrast: Placed<f64> = number("").above(0.0).at_most(0.999);
    }
}

variants! {
    /// Phase function.
    pub enum Phase by "type" {
        /// Water droplets, by Mie's series.
        "water_droplets" => WaterDroplets(WaterDroplets),
        /// Fit of Jendersie and d'Eon (2023): quicker to prepare, backscatter four to five times too dark.
        "water_droplets_fit" => WaterDropletsFit(WaterDropletsFit),
        /// Henyey and Greenstein's function.
        "henyey_greenstein" => HenyeyGreenstein(HenyeyGreenstein),
        /// Rayleigh scattering by molecules of air.
        "rayleigh" => Rayleigh(Rayleigh),
        /// Equal in all directions.
        "isotropic" => Isotropic(Isotropic),
    }
}

record! {
    /// Droplets of log-normal sizes (a factor of 1.35 is one standard deviation).
    pub struct WaterDroplets {
        /// Median diameter by number; about 5 to 20 in fog.
        required diameter_um: Placed<f64> = number("µm").at_least(0.1).at_most(60.0);
    }
}

record! {
    /// Droplets of a mean diameter.
    pub struct WaterDropletsFit {
        /// Diameter.
        required diameter_um: Placed<f64> = number("µm").at_least(5.0).at_most(50.0);
    }
}

record! {
    /// Henyey and Greenstein's function (1941).
    pub struct HenyeyGreenstein {
        /// Mean cosine, positive forward.
        required g: Placed<f64> = number("").at_least(-0.99).at_most(0.99);
    }
}

record! {
    /// Molecules: no keys.
    pub struct Rayleigh {}
}

record! {
    /// Isotropic: no keys.
    pub struct Isotropic {}
}

variants! {
    /// A part of the world.
    pub enum MediumShape by "type" {
        /// The whole world, unlimited: no light from infinity is transmitted.
        "everywhere" => Everywhere(UnboundedRegion),
        /// Everything below a height.
        "layer" => Layer(Layer),
        /// A box about its origin.
        "box" => Box(MediumBox),
        /// A sphere about its origin.
        "sphere" => Sphere(MediumSphere),
        /// The inside of a closed mesh.
        "mesh" => Mesh(MediumMesh),
    }
}

record! {
    /// All of the world: no keys.
    pub struct UnboundedRegion {}
}

record! {
    /// Below a height.
    pub struct Layer {
        /// Height of its top above its origin.
        required top_m: Placed<f64> = number("m");
    }
}

record! {
    /// A box about its origin.
    pub struct MediumBox {
        /// Size along x, y and z.
        required size_m: Placed<[f64; 3]> = vector::<3>(number("m").above(0.0));
    }
}

record! {
    /// A sphere about its origin.
    pub struct MediumSphere {
        /// Radius.
        required radius_m: Placed<f64> = number("m").above(0.0);
    }
}

record! {
    /// The inside of a mesh without open edges, in the axes of its file: points from which a ray crosses the surface an odd number of times. Where
    /// parts overlap is outside, as a part within another is a hollow.
    pub struct MediumMesh {
        /// Wavefront OBJ file.
        required file: Placed<PathBuf> = path(&["obj"]);
        /// Metres per unit of the file. Default: 1.
        optional unit_m: Placed<f64> = number("m").above(0.0);
    }
}

record! {
    /// Gradient noise (Perlin 2002) of mean 0, in the world's frame, about the mean density.
    pub struct DensityNoise {
        /// Maximum relative deviation of the density from its mean.
        required amplitude: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Size of the largest clouds.
        required scale_m: Placed<f64> = number("m").above(0.0);
        /// Octaves, each of half the size. Default: 4.
        optional octaves: Placed<u64> = integer(1, 12);
        /// Amplitude ratio of successive octaves. Default: 0.5.
        optional gain: Placed<f64> = number("").at_least(0.0).at_most(1.0);
        /// Drift velocity of the noise. Default: 0.
        optional wind_m_s: Placed<[f64; 3]> = vector::<3>(number("m/s"));
        /// Seed of the noise. Default: 0.
        optional seed: Placed<u64> = integer(0, u64::from(u32::MAX));
    }
}

fn check(medium: &Medium, errors: &mut DescriptionErrors) {
    let placed = medium.transform.stated_at().or(medium.frame.as_ref().map(|frame| &frame.place));
    check_place(medium.shape.as_ref(), placed, errors);
    check_gain(medium.unevenness.as_ref(), errors);
}

/// Refuses a placement of a medium that is everywhere.
pub(super) fn check_place(shape: Option<&MediumShape>, placed: Option<&Place>, errors: &mut DescriptionErrors) {
    let endless = matches!(shape, None | Some(MediumShape::Everywhere(_)));
    if let (true, Some(place)) = (endless, placed) {
        errors.add(
            ErrorCode::NoEffect,
            place,
            "the medium is unbounded, so its placement has no effect",
            "give a \"shape\" with bounds, or remove the key",
        );
    }
}

/// Refuses the gain of absent octaves.
pub(super) fn check_gain(unevenness: Option<&DensityNoise>, errors: &mut DescriptionErrors) {
    let idle = unevenness
        .and_then(|u| u.gain.as_ref().filter(|_| u.octaves.as_ref().is_some_and(|octaves| octaves.value == 1)));
    if let Some(gain) = idle {
        errors.add(
            ErrorCode::NoEffect,
            &gain.place,
            "\"gain\" has no effect with one octave",
            "give more \"octaves\", or remove it",
        );
    }
}

impl NamesFiles for Medium {
    fn name_files(&self, files: &mut FileList) {
        let Self { place: _, name: _, extinction, albedo, phase: _, shape, transform: _, frame: _, unevenness: _ } =
            self;
        shape.name_files(files);
        if let Extinction::PerMetre(curve) = extinction {
            curve.name_file(SpectrumValues::Light, files);
        }
        albedo.iter().for_each(|albedo| albedo.name_file(SpectrumValues::Share, files));
    }
}

impl NamesFiles for MediumShape {
    fn name_files(&self, files: &mut FileList) {
        match self {
            Self::Everywhere(_) | Self::Layer(_) | Self::Box(_) | Self::Sphere(_) => {}
            Self::Mesh(mesh) => files.mesh(&mesh.file, ReplacedMaterials::All),
        }
    }
}
