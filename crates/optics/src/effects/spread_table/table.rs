//! Tabulated point-spread functions by wavelength and distance from the axis.

use std::sync::Arc;

use etendue_core::{Bands, EffectStatus, WavelengthRange, maths::f64::sin_cos};
use etendue_projection::Raster;
use glam::{DMat2, DVec2};
use rayon::prelude::*;

use super::function::{FieldSpread, RadialFunction, SpreadShape, keeps_shapes, patches_needed};
use crate::effects::convolve::{self, OperationCounts, UsageCounts};
use crate::effects::core_table::{CoreBuilder, CoreTable};
use crate::effects::film_part::{SpreadWidth, mid_wavelengths};
use crate::effects::patches::{PatchLayout, Patches};
use crate::{
    effects::Canvas, effects::error::EffectsError, effects::psf::VISIBLE, effects::sample_spread::SampleSpread,
};

/// The functions of one wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct WavelengthTable {
    /// Wavelength, nm; `None` if the functions hold at all wavelengths.
    pub nm: Option<f64>,
    /// Functions from the axis outwards.
    pub fields: Vec<FieldSpread>,
}

/// Point-spread functions over the field.
#[derive(Clone, Debug, PartialEq)]
pub struct SpreadTableParameters {
    /// By increasing wavelength; a single entry, or all with a wavelength.
    pub wavelengths: Vec<WavelengthTable>,
    /// Patches across and down; `None`: as many as the functions need.
    pub patches: Option<[usize; 2]>,
}

/// The prepared functions of one wavelength.
#[derive(Clone, Debug, PartialEq)]
struct Wavelength {
    nm: Option<f64>,
    functions: Vec<RadialFunction>,
}

/// Point-spread functions over the field, from tables.
#[derive(Clone, Debug, PartialEq)]
pub struct SpreadTable {
    wavelengths: Arc<Vec<Wavelength>>,
    patches: [usize; 2],
    keeps_shapes: bool,
}

impl SpreadTable {
    /// Prepares the functions for an image.
    ///
    /// # Errors
    /// If distances or wavelengths do not increase or differ in number, or a function cannot be sampled on the pixels.
    pub fn new(parameters: SpreadTableParameters, image: &Raster) -> Result<Self, EffectsError> {
        let SpreadTableParameters { wavelengths, patches } = parameters;
        check_grid(&wavelengths)?;
        wavelengths.iter().flat_map(|w| &w.fields).try_for_each(|field| field.check(image))?;
        let wavelengths: Vec<Wavelength> = wavelengths.into_iter().map(ready_wavelength).collect();
        let mut table = Self { wavelengths: Arc::new(wavelengths), patches: [1, 1], keeps_shapes: true };
        let shape = |at_mm| table.shape(at_mm);
        let needed = || patches_needed(image, shape);
        (table.patches, table.keeps_shapes) =
            patches.map_or_else(needed, |patches| (patches, keeps_shapes(patches, image, shape)));
        Ok(table)
    }

    /// Patches across and down.
    #[must_use]
    pub fn patches(&self) -> [usize; 2] {
        self.patches
    }

    /// True if centroids and second moments are reproduced between the patches: centroids to 1/100 of the width, second moments to 1/200.
    #[must_use]
    pub fn keeps_shapes(&self) -> bool {
        self.keeps_shapes
    }

    /// Distances from the axis, mm, increasing; those of the shortest wavelength where they differ by wavelength.
    #[must_use]
    pub fn radii_mm(&self) -> Vec<f64> {
        self.wavelengths[0].functions.iter().map(|function| function.radius_mm).collect()
    }

    /// Wavelengths, nm, increasing; empty if the functions hold for all.
    #[must_use]
    pub fn wavelengths_nm(&self) -> Vec<f64> {
        self.wavelengths.iter().filter_map(|wavelength| wavelength.nm).collect()
    }

    /// True if the shape of the function depends on the wavelength.
    pub(in crate::effects) fn varies_by_wavelength(&self) -> bool {
        self.wavelengths.len() > 1
    }

    pub(in crate::effects) fn status(&self) -> EffectStatus {
        let radii = self.radii_mm();
        let number = |mm: &f64| format!("{}", (mm * 1e4).round() / 1e4);
        let numbers = match &radii[..] {
            [first, .., last] if radii.len() > 4 => format!("{} to {}", number(first), number(last)),
            list => list.iter().map(number).collect::<Vec<_>>().join(", "),
        };
        let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
        let nm = self.wavelengths_nm();
        let by = match (nm.len(), self.wavelengths.len()) {
            (0, _) => "the same at all wavelengths".to_owned(),
            (_, 1) => format!("computed for {} nm, the same at all wavelengths", nm[0]),
            (count, _) => format!("{count} wavelengths ({} to {} nm)", nm[0], nm[count - 1]),
        };
        let [x, y] = self.patches;
        let functions = counted(self.functions().count(), "function");
        let distances = counted(radii.len(), "distance");
        EffectStatus::Modelled(format!(
            "a table of {functions} at {distances} from the axis ({numbers} mm), {by}, in {x} × {y} patches"
        ))
    }

    /// Maximum relative error of the light of a point. Each pixel takes the functions of its own position, so the light of a point varies by the
    /// divergence of the centroids over the field, dc/dr + c/r; within the first distance c is held constant.
    #[must_use]
    pub fn light_error(&self) -> f64 {
        let pairs = self.wavelengths.iter().flat_map(|wavelength| wavelength.functions.windows(2));
        let divergence = |pair: &[RadialFunction]| {
            let [near, far] = pair else { return 0.0 };
            let slope = (far.centroid_mm - near.centroid_mm) / (far.radius_mm - near.radius_mm);
            // The maximum of c/r is at one of the ends.
            (slope + turned(near)).abs().max((slope + turned(far)).abs())
        };
        let held = self.wavelengths.iter().map(|wavelength| turned(&wavelength.functions[0]).abs());
        held.chain(pairs.map(divergence)).fold(0.0, f64::max)
    }

    fn functions(&self) -> impl Iterator<Item = &RadialFunction> {
        self.wavelengths.iter().flat_map(|wavelength| &wavelength.functions)
    }

    /// Columns and rows over which light is spread.
    pub(in crate::effects) fn reach_px(&self, pitch_mm: DVec2) -> [usize; 2] {
        let reach_mm = self.functions().map(|function| function.reach_mm).fold(0.0, f64::max);
        let reach = (DVec2::splat(reach_mm) / pitch_mm).ceil();
        [reach.x as usize, reach.y as usize]
    }

    /// The functions, with weights, that are mixed for a wavelength and a distance from the axis.
    fn mix(&self, nm: f64, radius_mm: f64) -> impl Iterator<Item = (&RadialFunction, f64)> {
        let of_wavelength = between(&self.wavelengths, nm, |wavelength| wavelength.nm.unwrap_or(0.0));
        let of_field = move |wavelength: &'_ Wavelength| between(&wavelength.functions, radius_mm, |f| f.radius_mm);
        let parts = of_wavelength.into_iter().filter(|(_, weight)| *weight > 0.0);
        parts.flat_map(move |(i, weight)| {
            let wavelength = &self.wavelengths[i];
            let fields = of_field(wavelength).into_iter().filter(|(_, weight)| *weight > 0.0);
            fields.map(move |(j, fraction)| (&wavelength.functions[j], weight * fraction))
        })
    }

    /// Deposits the light of a point of the sensor (mm) at a wavelength: positions and fractions.
    pub(super) fn deposit(&self, nm: f64, at_mm: DVec2, mut to: impl FnMut(DVec2, f64)) {
        let radius_mm = at_mm.length();
        let outwards = if radius_mm > 0.0 { at_mm / radius_mm } else { DVec2::X };
        for (function, weight) in self.mix(nm, radius_mm) {
            function.splats(outwards).for_each(|(offset, fraction)| to(offset, weight * fraction));
        }
    }

    /// Centroid and second moments at a position; the mean over the wavelengths.
    fn shape(&self, at_mm: DVec2) -> SpreadShape {
        let radius_mm = at_mm.length();
        let outwards = if radius_mm > 0.0 { at_mm / radius_mm } else { DVec2::X };
        let of = |nm: f64| {
            self.mix(nm, radius_mm).fold((DVec2::ZERO, DMat2::ZERO), |(centroid, moments), (function, weight)| {
                let aside = outwards * (function.centroid_mm * weight);
                (centroid + aside, moments + function.moments(outwards) * weight)
            })
        };
        let wavelengths = self.wavelengths_nm();
        let every = if wavelengths.is_empty() { vec![VISIBLE.low_nm] } else { wavelengths };
        let fraction = 1.0 / every.len() as f64;
        let (centroid, moments) = every
            .iter()
            .map(|nm| of(*nm))
            .fold((DVec2::ZERO, DMat2::ZERO), |sum, one| (sum.0 + one.0 * fraction, sum.1 + one.1 * fraction));
        SpreadShape { centroid, moments }
    }

    /// The transfer function (real and imaginary part) at a wavelength and sensor point, for a frequency in cycles/mm.
    #[must_use]
    pub fn transfer(&self, nm: f64, at_mm: DVec2, cycles_per_mm: DVec2) -> DVec2 {
        let mut sum = DVec2::ZERO;
        self.deposit(nm, at_mm, |offset, fraction| {
            let (sine, cosine) = sin_cos(core::f64::consts::TAU * cycles_per_mm.dot(offset));
            sum += fraction * DVec2::new(cosine, sine);
        });
        sum
    }

    /// The corner farthest from the axis, mm.
    fn corner_mm(canvas: &Canvas) -> DVec2 {
        let region = canvas.image_region();
        let corners = [region.x.start, region.x.end].into_iter().flat_map(|x| [(x, region.y.start), (x, region.y.end)]);
        let places = corners.map(|(x, y)| canvas.sensor_mm(DVec2::new(x as f64, y as f64)));
        places.max_by(|a, b| a.length().total_cmp(&b.length())).unwrap_or(DVec2::ZERO)
    }

    /// Width of the function where it is widest: the maximum over the axis, the tabulated distances within the image, and the corner.
    pub(in crate::effects) fn width(&self, canvas: &Canvas, nm: f64) -> SpreadWidth {
        let (corner_mm, pitch_mm) = (Self::corner_mm(canvas), canvas.pitch_mm());
        let outwards = corner_mm.try_normalize().unwrap_or(DVec2::X);
        let at = |radius_mm: f64| {
            SpreadWidth::new(self.reach_px(pitch_mm), self.varies_by_wavelength(), |to| {
                self.deposit(nm, outwards * radius_mm, |offset, fraction| to(offset / pitch_mm, fraction));
            })
        };
        let within = self.radii_mm().into_iter().filter(|radius| *radius < corner_mm.length());
        within.map(at).fold(at(corner_mm.length()), SpreadWidth::worse)
    }

    pub(super) fn places(&self, canvas: &Canvas) -> Patches {
        Patches::new(self.patches, PatchLayout::Edges, canvas)
    }

    /// The cores by which samples are displaced, for the wavelengths of a range; `None` if they hold no light.
    pub(in crate::effects) fn sample_spread(&self, canvas: &Canvas, range: WavelengthRange) -> Option<SampleSpread> {
        let places = self.places(canvas);
        let parts = if self.varies_by_wavelength() { mid_wavelengths(range).count() } else { 1 };
        let step_nm = (range.width_nm()) / parts as f64;
        let core = |patch: usize, part: usize| -> Option<CoreTable> {
            let mut builder = CoreBuilder::default();
            let nm = range.low_nm + (part as f64 + 0.5) * step_nm;
            let pitch_mm = canvas.pitch_mm();
            self.deposit(nm, canvas.sensor_mm(places.middle_px(patch)), |offset, fraction| {
                builder.deposit(offset / pitch_mm, fraction);
            });
            builder.table()
        };
        let of_patch = |patch: usize| (0..parts).map(|part| core(patch, part)).collect::<Option<Vec<_>>>();
        let tables = (0..places.count()).into_par_iter().map(of_patch).collect::<Option<Vec<_>>>()?;
        Some(SampleSpread::new(places.into_hats(), range.low_nm, step_nm, tables))
    }

    /// Operation counts for the given number of images per band; all bands count as the middle one.
    pub(in crate::effects) fn operation_counts(&self, canvas: &Canvas, bands: Bands, images: f64) -> OperationCounts {
        let (places, reach) = (self.places(canvas), self.reach_px(canvas.pitch_mm()));
        let count = bands.count() as f64;
        let uses = UsageCounts { ready: images * count, applied: images * count };
        let kernels = if self.varies_by_wavelength() { count } else { 1.0 };
        let parts =
            mid_wavelengths(WavelengthRange::new(bands.low_nm(), bands.low_nm() + bands.width_nm())).count() as f64;
        let (mixed, parts) = if self.varies_by_wavelength() { (4.0, parts) } else { (2.0, 1.0) };
        let samples = self.functions().map(RadialFunction::samples).max().unwrap_or(0) as f64;
        let kernel = OperationCounts { shared: kernels * parts * mixed * samples, ..OperationCounts::default() };
        let of = |i| kernel + convolve::operation_counts(reach, canvas.size(), &places.region(i), uses);
        (0..places.count()).map(of).sum()
    }

    /// The representative wavelengths of a band.
    pub(super) fn wavelengths_of(&self, band: WavelengthRange) -> Vec<f64> {
        if self.varies_by_wavelength() { mid_wavelengths(band).collect() } else { vec![VISIBLE.low_nm] }
    }
}

/// c/r, the effect of rotating a function about the axis; 0 on the axis.
fn turned(function: &RadialFunction) -> f64 {
    if function.radius_mm > 0.0 { function.centroid_mm / function.radius_mm } else { 0.0 }
}

fn check_grid(wavelengths: &[WavelengthTable]) -> Result<(), EffectsError> {
    let rises = |list: &[f64]| list.windows(2).all(|pair| pair[0] < pair[1]);
    let count = wavelengths.first().map_or(0, |first| first.fields.len());
    let radii = |w: &WavelengthTable| w.fields.iter().map(FieldSpread::radius_mm).collect::<Vec<_>>();
    let nm: Vec<f64> = wavelengths.iter().filter_map(|w| w.nm).collect();
    let known = wavelengths.len() == 1 || nm.len() == wavelengths.len();
    let total = count > 0 && wavelengths.iter().all(|w| w.fields.len() == count && rises(&radii(w)));
    if total && known && rises(&nm) { Ok(()) } else { Err(EffectsError::SpreadTable) }
}

fn ready_wavelength(wavelength: WavelengthTable) -> Wavelength {
    let WavelengthTable { nm, fields } = wavelength;
    let outwards = fields.last().and_then(FieldSpread::outwards).unwrap_or(DVec2::NEG_Y);
    Wavelength { nm, functions: fields.into_iter().map(|field| RadialFunction::new(field, outwards)).collect() }
}

/// The two nearest entries to a value, by index with weights: linear interpolation, clamped at the ends.
fn between<T>(rising: &[T], at: f64, value: impl Fn(&T) -> f64) -> [(usize, f64); 2] {
    match rising.partition_point(|item| value(item) <= at) {
        0 => [(0, 1.0), (0, 0.0)],
        n if n == rising.len() => [(n - 1, 1.0), (n - 1, 0.0)],
        n => {
            let [low, high] = [value(&rising[n - 1]), value(&rising[n])];
            let fraction = (at - low) / (high - low);
            [(n - 1, 1.0 - fraction), (n, fraction)]
        }
    }
}
