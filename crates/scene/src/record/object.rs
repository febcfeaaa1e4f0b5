//! `[[objects]]`: what stands where, of which material and class.

use super::shape::Shape;
use super::transform::Transform;
use crate::fault::{Faults, Named};
use crate::place::{Place, Placed};
use crate::reader::{keyed, keyed_by_name, list, name_of, number, record, text};

record! {
    /// A mesh or a shape in the world, once or many times.
    pub struct Object check(check) {
        /// Its name.
        required name: Placed<String> = text("the name of the object");
        /// What it is.
        inside body: Body;
        /// The material of all of it. A mesh may do without: then its own file says its materials.
        optional material: Placed<String> = name_of(Named::Material);
        /// Materials by the names that the mesh's file gives them: `{ "car_paint" = "red" }`. Names that are not listed
        /// keep what the mesh's file says.
        many materials: (Placed<String>, Placed<String>) = keyed_by_name(name_of(Named::Material));
        /// The semantic class, a name in `[classes]`. Default: class 0.
        optional class: Placed<String> = name_of(Named::Class);
        /// Where it stands, where it stands once.
        inside transform: Transform;
        /// Where it stands over time. One key stands still; more are refused until motion is rendered.
        many keys: Keyframe = list(record(), 1);
        /// Where it stands, where it stands many times; every instance has an identity of its own in the ground truth.
        many instances: Instance = list(record(), 1);
    }
}

keyed! {
    /// What an object is.
    pub enum Body {
        /// The name of a mesh.
        mesh => Mesh(Placed<String>) = name_of(Named::Mesh);
        /// A shape: a table with "type" and the keys of that type.
        shape => Shape(Shape) = record();
    }
}

record! {
    /// Where an object stands at a time.
    pub struct Keyframe {
        /// The time, s.
        required time_s: Placed<f64> = number("s");
        /// Where it stands.
        inside transform: Transform;
    }
}

record! {
    /// One of the places where an object stands.
    pub struct Instance {
        /// Its name. Default: the object's name and its number.
        optional name: Placed<String> = text("the name of the instance");
        /// By how much the "modulation" of all its light is later here, s, besides its own delay. Default: 0.
        optional modulation_delay_s: Placed<f64> = number("s");
        /// Where it stands.
        inside transform: Transform;
    }
}

impl Object {
    /// Where the object stands: each transform with the place that states it and its instance's name.
    pub fn placements(&self) -> impl Iterator<Item = (&Transform, Option<&Placed<String>>)> {
        let many = self.instances.iter().map(|i| (&i.transform, i.name.as_ref()));
        let key = self.keys.first().map(|k| (&k.transform, None));
        let own = (self.instances.is_empty() && self.keys.is_empty()).then_some((&self.transform, None));
        many.chain(key).chain(own)
    }
}

fn check(object: &Object, faults: &mut Faults) {
    check_motion(object, faults);
    check_placement(object, faults);
    check_materials(object, faults);
}

fn check_motion(object: &Object, faults: &mut Faults) {
    if let Some(second) = object.keys.get(1) {
        faults.add(
            &second.place,
            "a second keyframe makes the object move, and motion is not rendered yet",
            "keep one keyframe",
        );
    }
}

/// An object says once where it stands.
fn check_placement(object: &Object, faults: &mut Faults) {
    let own = object.transform.is_given().then_some(("\"position_m\", \"rotation_deg\", \"scale\"", &object.place));
    let keys = object.keys.first().map(|k| ("\"keys\"", &k.place));
    let instances = object.instances.first().map(|i| ("\"instances\"", &i.place));
    let said: Vec<(&str, &Place)> = own.into_iter().chain(keys).chain(instances).collect();
    if let [(first, _), (second, place), ..] = said.as_slice() {
        let remedy = "keep the object's own position, or \"keys\", or \"instances\"";
        faults.add(place, format!("{second} contradicts {first}: both say where the object stands"), remedy);
    }
}

fn check_materials(object: &Object, faults: &mut Faults) {
    let slots = object.materials.first();
    match (&object.body, &object.material, slots) {
        (_, Some(_), Some((slot, _))) => {
            faults.add(&slot.place, "\"materials\" contradicts \"material\"", "keep one of the two");
        }
        (Body::Shape(_), _, Some((slot, _))) => {
            faults.add(&slot.place, "a shape has no materials by name", "give \"material\" in place of \"materials\"");
        }
        (Body::Shape(_), None, None) => {
            faults.add(&object.place, "a shape without a material", "add \"material\": the name of a material");
        }
        _ => {}
    }
}
