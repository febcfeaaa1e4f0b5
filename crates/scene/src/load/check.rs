//! Checks that need more than one record: names that must exist, cameras with their job.

use super::Description;
use super::names;
use crate::document::Node;
use crate::fault::Faults;
use crate::place::Placed;
use crate::record::reflectance::Reflectance;
use crate::record::render::check_merged;
use crate::record::{Body, Material, Object, Surface};
use crate::suggest::nearest;

/// Every name that is used is defined.
pub(super) fn references(description: &Description, document: &Node, faults: &mut Faults) {
    let known = Known {
        meshes: names::of(document, "meshes"),
        materials: names::of(document, "materials"),
        textures: names::of(document, "textures"),
        classes: names::of_classes(document),
    };
    description.scene.objects.iter().for_each(|o| known.check_object(o, faults));
    description.scene.materials.iter().for_each(|m| known.check_material(m, faults));
}

struct Known<'d> {
    meshes: Vec<&'d str>,
    materials: Vec<&'d str>,
    textures: Vec<&'d str>,
    classes: Vec<&'d str>,
}

impl Known<'_> {
    fn check_object(&self, object: &Object, faults: &mut Faults) {
        if let Body::Mesh(mesh) = &object.body {
            must_exist("mesh", mesh, &self.meshes, faults);
        }
        for material in object.material.iter().chain(object.materials.iter().map(|(_, m)| m)) {
            must_exist("material", material, &self.materials, faults);
        }
        if let Some(class) = &object.class {
            must_exist("class", class, &self.classes, faults);
        }
    }

    fn check_material(&self, material: &Material, faults: &mut Faults) {
        if let Some(texture) = material.emission.as_ref().and_then(|e| e.texture.as_ref()) {
            must_exist("texture", texture, &self.textures, faults);
        }
        let reflectance = match &material.surface {
            Surface::Diffuse(d) => &d.reflectance,
            Surface::Coated(c) => &c.reflectance,
            Surface::Conductor(_) | Surface::Emitter(_) => return,
        };
        if let Reflectance::Texture { name, .. } = reflectance {
            must_exist("texture", name, &self.textures, faults);
        }
    }
}

fn must_exist(what: &str, name: &Placed<String>, known: &[&str], faults: &mut Faults) {
    if known.contains(&name.as_str()) {
        return;
    }
    let remedy = match (known, nearest(name, known)) {
        ([], _) => format!("define the {what}, the scene has none"),
        (_, Some(near)) => format!("did you mean \"{near}\"? Known: {}", known.join(", ")),
        (_, None) => format!("define the {what}, or use one that is known: {}", known.join(", ")),
    };
    faults.add(&name.place, format!("there is no {what} \"{}\"", name.value), remedy);
}

/// Every camera agrees with what is asked of it.
pub(super) fn cameras(description: &Description, faults: &mut Faults) {
    for setup in &description.cameras {
        check_merged(&setup.render, faults);
    }
}
