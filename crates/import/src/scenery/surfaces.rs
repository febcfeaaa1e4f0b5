//! Surfaces and media: the default surface, emissive surfaces, metals by tables, and reflectances 0 … 1.

use std::{fmt::Write as _, rc::Rc};

use etendue_scene::record::material::{Diffuse, Factor, Material, Metal, Surface};
use etendue_scene::record::medium::{Extinction, HenyeyGreenstein, Isotropic, MediumShape, Phase};
use etendue_scene::record::{Colour, Medium, Reflectance, SurfaceEmission, Transform};
use etendue_spectra::{Spectrum, upsample};

use super::stage::{Homogeneous, SceneBuilder};

/// Value of three equal numbers.
pub(crate) fn grey(values: [f64; 3]) -> Option<f64> {
    (values[0] == values[1] && values[1] == values[2]).then_some(values[0])
}

impl SceneBuilder {
    /// Reflectance of a parameter called `name`, clamped to 0 … 1 with a note.
    pub(crate) fn limit_to_unit(&mut self, name: &str, value: f64) -> f64 {
        let legal = value.clamp(0.0, 1.0);
        if legal != value {
            self.report.note(format!("\"{name}\" is limited to 0 … 1"));
        }
        legal
    }

    /// The same for linear sRGB.
    pub(crate) fn reflectance_from_rgb(&mut self, name: &str, rgb: [f64; 3]) -> Colour {
        let legal = rgb.map(|v| self.limit_to_unit(name, v));
        grey(legal).map_or(Colour::LinearSrgb(legal.into()), |v| Colour::Grey(v.into()))
    }
}

impl SceneBuilder {
    /// Fills a part of the world with a medium; does nothing if the name is empty or not supported.
    pub(crate) fn fill(&mut self, name: &str, shape: MediumShape, transform: Transform) {
        let Some(Homogeneous { extinction, albedo, g }) = self.known.media.get(name).cloned() else {
            self.report
                .note(format!("a region of the scene has no medium: \"{name}\" is not defined or not supported"));
            return;
        };
        let phase = match g {
            0.0 => Phase::Isotropic(Isotropic::default()),
            g => Phase::HenyeyGreenstein(HenyeyGreenstein::new(g)),
        };
        let own = self.names.take(name, "medium");
        self.scene.media.push(Medium {
            albedo: Some(albedo),
            phase: Some(phase),
            shape: Some(shape),
            ..Medium::new(own.as_str(), Extinction::PerMetre(extinction), transform)
        });
    }
}

impl SceneBuilder {
    /// Material by our name; the grey one if it is empty.
    pub(crate) fn known_material(&mut self, own: &str) -> String {
        if !own.is_empty() {
            return own.to_owned();
        }
        if let Some(grey) = self.known.materials.get("") {
            return grey.to_string();
        }
        let grey: Rc<str> = self.names.take("default", "default").into();
        self.known.materials.insert(String::new(), grey.clone());
        self.scene.materials.push(Material::new(&*grey, Surface::Diffuse(Diffuse::new(plain(0.5)))));
        grey.to_string()
    }

    /// Black surface of lights without one of their own, shared by all of them.
    pub(crate) fn black(&mut self) -> Rc<str> {
        const KEY: &str = "black/";
        if let Some(black) = self.known.materials.get(KEY) {
            return black.clone();
        }
        let black: Rc<str> = self.names.take("black", "black").into();
        self.known.materials.insert(KEY.to_owned(), black.clone());
        self.scene.materials.push(Material::new(&*black, Surface::Diffuse(Diffuse::new(plain(0.0)))));
        black
    }

    /// Emissive copy of a material.
    pub(crate) fn emissive_copy(&mut self, own: &str, emission: SurfaceEmission) -> String {
        let own = self.known_material(own);
        let name = self.names.take(&format!("{own}-light"), "light");
        let base = self.scene.materials.iter().find(|m| m.name.value == own).cloned();
        let own = base.unwrap_or_else(|| Material::new(name.as_str(), Surface::Diffuse(Diffuse::new(plain(0.5)))));
        self.scene.materials.push(Material { name: name.as_str().into(), emission: Some(emission), ..own });
        name
    }

    /// Partly transparent copy of a material.
    pub(crate) fn translucent_copy(&mut self, own: &str, opacity: Factor) -> String {
        let key = match &opacity {
            Factor::Number(number) => format!("{own} {}", number.value),
            Factor::Texture(texture) => {
                let channel = texture.channel.as_ref().map(|c| c.value);
                format!("{own} {} {channel:?} {:?}", texture.texture.value, texture.scale.as_ref().map(|s| s.value))
            }
        };
        if let Some(known) = self.known.translucent_copies.get(&key) {
            return known.to_string();
        }
        let name = self.names.take(&format!("{own}-thin"), "thin");
        let base = self.scene.materials.iter().find(|m| m.name.value == own).cloned();
        let copy = base.map(|m| Material { name: name.as_str().into(), opacity: Some(opacity), ..m });
        self.scene.materials.extend(copy);
        self.known.translucent_copies.insert(key, name.as_str().into());
        name
    }

    /// Metal with the reflectance of linear sRGB at normal incidence, as in pbrt: n = 1 and the matching k.
    pub(crate) fn metal_from_rgb(&mut self, rgb: [f64; 3]) -> Metal {
        self.metal_from_spectrum(&upsample::reflectance_spectrum(rgb.map(|v| v as f32)))
    }

    /// The same for a reflectance over wavelength.
    pub(crate) fn metal_from_spectrum(&mut self, reflectance: &Spectrum) -> Metal {
        let k = |nm: f32| {
            let r = f64::from(reflectance.at(nm)).clamp(0.0, 0.9999);
            2.0 * r.sqrt() / (1.0 - r).sqrt()
        };
        self.index_file(|_| 1.0, k)
    }

    /// Metal with a complex refractive index over wavelength, in a separate file next to the scene.
    pub(crate) fn index_file(&mut self, n: impl Fn(f32) -> f64, k: impl Fn(f32) -> f64) -> Metal {
        let mut text = "wavelength_nm,n,k\n".to_owned();
        for nm in (60_u16..=166).map(|i| 5 * i) {
            let at = f32::from(nm);
            writeln!(text, "{nm},{},{}", n(at).max(1e-3), k(at).max(0.0)).expect("writing to a String succeeds");
        }
        let name = self.file_names.take("metal", "metal");
        let path = self.add_file(format!("spectra/{name}.csv"), text.into_bytes());
        Metal::File(path.as_str().into())
    }
}

/// Constant reflectance over wavelength.
pub(crate) fn plain(reflectance: f64) -> Reflectance {
    Reflectance::Plain(Colour::Grey(reflectance.into()))
}
