//! Scattering of a surface: from the record's type to the tracer's model.

use super::super::spectrum::curve;
use super::compiler::MaterialCompiler;
use super::metal::{self, complex_index};
use super::reflectance::reflectance_spectrum;
use etendue_core::wavelength::{MAX_NM, MIN_NM};
use etendue_scene::Placed;
use etendue_scene::record::material::{
    self as record, Absorption, Interface, LobeDirection, LobeKind, LobeStrength, Surface as Record,
};
use etendue_spectra::{Extrapolation, Spectrum};
use etendue_tracer::materials::{
    BlinnPhong, CarPaint, CarPaintParts, Cloth, CoatedDiffuse, Conductor, Dielectric, Distribution, GroundRelief,
    Lafortune, Leaf, Lobe, Mix, Puddles, Reflectance, Surface, ThinSheet, WATER, absorption_of, flake_reflectance,
};

/// Default refractive index of a coat or a pane.
const DEFAULT_INDEX: f64 = 1.5;
/// Defaults: unevenness of flakes, roughness of a coat, amount and width of the sheen of cloth.
const FLAKE_ALPHA: f64 = 0.25;
const COAT_ALPHA: f64 = 0.01;
const SHEEN: f64 = 0.1;
const SHEEN_ALPHA: f64 = 0.5;
/// Defaults: roughness of a water film on asphalt, and the height of its grains.
const FILM_ALPHA: f64 = 0.06;
const GRAIN_MM: f64 = 2.0;
const MM_PER_M: f64 = 1000.0;

impl MaterialCompiler<'_, '_> {
    pub(super) fn surface(&mut self, record: &Record) -> Option<Surface> {
        match record {
            Record::Diffuse(r) => self.reflectance(&r.reflectance).map(Surface::from),
            Record::Conductor(r) => self.conductor(r),
            Record::CoatedDiffuse(r) => self.coated(r),
            Record::WetGround(r) => self.wet_ground(r),
            Record::CookTorrance(r) => self.cook_torrance(r),
            Record::CarPaint(r) => self.car_paint(r),
            Record::Cloth(r) => self.cloth(r),
            Record::Sheeting(r) => self.sheeting(r),
            Record::RoadMarking(r) => self.road_marking(r),
            Record::Lafortune(r) => self.lafortune(r),
            Record::BlinnPhong(r) => self.blinn_phong(r),
            Record::Dielectric(r) => self.dielectric(r),
            Record::ThinSheet(r) => self.thin_sheet(r),
            Record::Leaf(r) => self.leaf(r),
            Record::Mix(r) => self.mix(r),
            Record::Emitter(_) => Some(Surface::Absorber),
        }
    }

    fn conductor(&mut self, r: &record::Conductor) -> Option<Surface> {
        let index = complex_index(&r.metal, self.context)?;
        let alpha = self.factor(&r.alpha)?;
        let conductor = self.context.accept(&r.place, Conductor::new(index, alpha))?;
        Some(with_facets(conductor, r.distribution.as_ref(), r.multiple_scattering.as_ref()))
    }

    fn cook_torrance(&mut self, r: &record::CookTorrance) -> Option<Surface> {
        let alpha = self.factor(&r.alpha)?;
        let conductor = match &r.interface {
            Interface::Named(name) => Conductor::new(metal::named(name, self.context)?, alpha),
            Interface::File(file) => Conductor::new(metal::from_table(file, self.context)?, alpha),
            Interface::Index(index) => Conductor::dielectric(curve(index, Extrapolation::Hold, self.context)?, alpha),
        };
        let conductor = self.context.accept(&r.place, conductor)?;
        Some(with_facets(conductor, r.distribution.as_ref(), r.multiple_scattering.as_ref()))
    }

    fn coated(&mut self, r: &record::CoatedDiffuse) -> Option<Surface> {
        let base = self.reflectance(&r.reflectance)?;
        let alpha = self.factor(&r.alpha)?;
        let index = number(r.index.as_ref(), DEFAULT_INDEX);
        self.context.accept(&r.place, CoatedDiffuse::new(base, index, alpha)).map(Surface::from)
    }

    fn wet_ground(&mut self, r: &record::WetGround) -> Option<Surface> {
        let base = self.reflectance(&r.reflectance)?;
        let film_alpha = number(r.film_alpha.as_ref(), FILM_ALPHA);
        let Some(puddles) = &r.puddles else {
            return self.context.accept(&r.place, CoatedDiffuse::new(base, WATER, film_alpha)).map(Surface::from);
        };
        let height = self.factor(&record::Factor::Texture(puddles.height.clone()))?;
        let relief = GroundRelief {
            relief_mm: puddles.relief_mm.value,
            level_mm: puddles.level_mm.value,
            grain_mm: number(puddles.grain_mm.as_ref(), GRAIN_MM),
        };
        let rain_mm_h = number(puddles.rain_mm_h.as_ref(), 0.0);
        let puddles = self.context.accept(&puddles.place, Puddles::new(height, relief, film_alpha, rain_mm_h))?;
        Some(Surface::from(CoatedDiffuse::under_water(base, puddles)))
    }

    fn car_paint(&mut self, r: &record::CarPaint) -> Option<Surface> {
        let pigment = self.reflectance(&r.reflectance)?;
        let coat_index = number(r.index.as_ref(), DEFAULT_INDEX);
        let bare = flake_reflectance(&complex_index(&r.metal, self.context)?, coat_index);
        let flakes = match &r.flake_tint {
            Some(tint) => bare.product(&reflectance_spectrum(tint, self.context)?),
            None => bare,
        };
        let parts = CarPaintParts {
            pigment,
            flakes,
            coverage: r.flake_coverage.value,
            flake_alpha: number(r.flake_alpha.as_ref(), FLAKE_ALPHA),
            coat_index,
            coat_alpha: number(r.alpha.as_ref(), COAT_ALPHA),
        };
        self.context.accept(&r.place, CarPaint::new(parts)).map(Surface::from)
    }

    fn cloth(&mut self, r: &record::Cloth) -> Option<Surface> {
        let base = self.reflectance(&r.reflectance)?;
        let sheen = match &r.sheen {
            Some(sheen) => reflectance_spectrum(sheen, self.context)?,
            None => Spectrum::constant(SHEEN),
        };
        let cloth = Cloth::new(base, sheen, number(r.alpha.as_ref(), SHEEN_ALPHA));
        self.context.accept(&r.place, cloth).map(Surface::from)
    }

    fn lafortune(&mut self, r: &record::Lafortune) -> Option<Surface> {
        let base = self.reflectance(&r.reflectance)?;
        let lobes: Option<Vec<Lobe>> = r.lobes.iter().map(|lobe| self.lobe(lobe)).collect();
        self.context.accept(&r.place, Lafortune::new(base, lobes?)).map(Surface::from)
    }

    fn lobe(&mut self, r: &record::Lobe) -> Option<Lobe> {
        let [tangential, normal] = match &r.direction {
            LobeDirection::Factors(factors) => factors.value,
            LobeDirection::Kind(kind) => match kind.value {
                LobeKind::Mirror => [-1.0, 1.0],
                LobeKind::Retro => [1.0, 1.0],
            },
        };
        let exponent = r.exponent.value;
        match &r.strength {
            LobeStrength::Albedo(colour) => {
                Some(Lobe::from_albedo(tangential, normal, exponent, &reflectance_spectrum(colour, self.context)?))
            }
            LobeStrength::Weight(per_sr) => {
                let weight = curve(per_sr, Extrapolation::Hold, self.context)?;
                Some(Lobe { tangential, normal, exponent, weight })
            }
        }
    }

    fn blinn_phong(&mut self, r: &record::BlinnPhong) -> Option<Surface> {
        let base = self.reflectance(&r.reflectance)?;
        let specular = reflectance_spectrum(&r.specular, self.context)?;
        self.context.accept(&r.place, BlinnPhong::new(base, specular, r.exponent.value)).map(Surface::from)
    }

    fn dielectric(&mut self, r: &record::Dielectric) -> Option<Surface> {
        let alpha = match &r.alpha {
            Some(alpha) => self.factor(alpha)?,
            None => 0.0.into(),
        };
        let absorption = match &r.absorption {
            None => None,
            Some(Absorption::Coefficient(per_m)) => Some(curve(per_m, Extrapolation::Hold, self.context)?),
            Some(Absorption::Transmittance(colour)) => {
                let transmittance = reflectance_spectrum(colour, self.context)?;
                let thickness_m = number(r.thickness_mm.as_ref(), 0.0) / MM_PER_M;
                Some(self.context.accept(colour.place(), absorption_of(&transmittance, thickness_m))?)
            }
        };
        let dielectric = Dielectric::new(r.index.value, alpha, absorption);
        self.context.accept(&r.place, dielectric).map(Surface::from)
    }

    fn thin_sheet(&mut self, r: &record::ThinSheet) -> Option<Surface> {
        let transmittance = match &r.absorption {
            None => Spectrum::constant(1.0),
            Some(Absorption::Transmittance(colour)) => reflectance_spectrum(colour, self.context)?,
            Some(Absorption::Coefficient(per_m)) => {
                let coefficient = curve(per_m, Extrapolation::Hold, self.context)?;
                beer_lambert(&coefficient, number(r.thickness_mm.as_ref(), 0.0) / MM_PER_M)
            }
        };
        let sheet = ThinSheet::new(number(r.index.as_ref(), DEFAULT_INDEX), Reflectance::Spectrum(transmittance));
        self.context.accept(&r.place, sheet).map(Surface::from)
    }

    fn leaf(&mut self, r: &record::Leaf) -> Option<Surface> {
        let (reflectance, transmittance) = (self.reflectance(&r.reflectance), self.reflectance(&r.transmittance));
        Some(Leaf { reflectance: reflectance?, transmittance: transmittance? }.into())
    }

    fn mix(&mut self, r: &record::Mix) -> Option<Surface> {
        let weight = self.factor(&r.weight)?;
        Some(Surface::Mix(Mix { a: self.id_of(&r.a.value)?, b: self.id_of(&r.b.value)?, weight }))
    }
}

fn with_facets(
    conductor: Conductor,
    distribution: Option<&Placed<record::Distribution>>,
    multiple_scattering: Option<&Placed<bool>>,
) -> Surface {
    let conductor = conductor.with_distribution(match distribution.map(|d| d.value) {
        Some(record::Distribution::Beckmann) => Distribution::Beckmann,
        Some(record::Distribution::Ggx) | None => Distribution::Ggx,
    });
    let more = multiple_scattering.is_some_and(|m| m.value);
    if more { conductor.with_interreflection().into() } else { conductor.into() }
}

fn number(value: Option<&Placed<f64>>, default: f64) -> f64 {
    value.map_or(default, |v| v.value)
}

/// exp(−a d): internal transmittance of a thickness `m` of a substance, without reflections.
fn beer_lambert(coefficient_per_m: &Spectrum, m: f64) -> Spectrum {
    let at = |nm: f64| etendue_core::maths::f64::exp(-f64::from(coefficient_per_m.at(nm as f32)) * m);
    Spectrum::from_fn(|nm| at(nm.clamp(MIN_NM, MAX_NM)))
}
