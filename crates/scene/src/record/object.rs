//! `[[objects]]`: what stands where, of which material and class.

use etendue_core::ExactTime;

use super::motion::{Course, Rolls, check_course, check_ways, trajectory_way};
use super::shape::Shape;
use super::transform::Transform;
use crate::fault::{ErrorCode, Faults, Named};
use crate::place::Placed;
use crate::reader::{keyed, keyed_by_name, list, name_of, number, record, text, time};

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
        /// Where it stands over time; one key stands still.
        many keys: Keyframe = list(record(), 1);
        /// How it moves.
        group course: Course;
        /// The frame that it is placed in, and moves with. Default: the world.
        optional frame: Placed<String> = name_of(Named::Frame);
        /// A wheel, which turns by the way that it goes. Default: none.
        optional rolls: Rolls = record();
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
        /// Simulated time, s.
        required time_s: Placed<ExactTime> = time();
        /// Where it stands.
        inside transform: Transform;
    }
}

record! {
    /// One of the places where an object stands.
    pub struct Instance {
        /// Its name. Default: the object's name and its number.
        optional name: Placed<String> = text("the name of the instance");
        /// The frame that it is placed in, and moves with. Default: the object's.
        optional frame: Placed<String> = name_of(Named::Frame);
        /// By how much the "modulation" of all its light is later here, s, besides its own delay. Default: 0.
        optional modulation_delay_s: Placed<f64> = number("s");
        /// Where it stands.
        inside transform: Transform;
    }
}

fn check(object: &Object, faults: &mut Faults) {
    check_course(object.course.as_ref(), object.keys.iter().map(|key| &key.time_s), faults);
    check_rolls(object, faults);
    check_placement(object, faults);
    check_materials(object, faults);
}

/// A wheel turns within its scale, which therefore stays one.
fn check_rolls(object: &Object, faults: &mut Faults) {
    let scales = object.keys.iter().filter_map(|key| key.transform.scale.as_ref());
    for scale in scales.filter(|_| object.rolls.is_some()) {
        faults.add(
            ErrorCode::NotModelled,
            &scale.place,
            "\"scale\" in the keys of a wheel (\"rolls\")",
            "give the keys to a frame, and the scale to the object in it",
        );
    }
}

/// An object says once where it stands.
fn check_placement(object: &Object, faults: &mut Faults) {
    let own =
        object.transform.is_given().then(|| ("\"position_m\", \"rotation_deg\", \"scale\"", object.place.clone()));
    let keys = object.keys.first().map(|k| ("\"keys\"", k.place.clone()));
    let instances = object.instances.first().map(|i| ("\"instances\"", i.place.clone()));
    check_ways([own, keys, trajectory_way(object.course.as_ref()), instances], "the object", faults);
}

fn check_materials(object: &Object, faults: &mut Faults) {
    let slots = object.materials.first();
    match (&object.body, &object.material, slots) {
        (_, Some(_), Some((slot, _))) => {
            faults.add(
                ErrorCode::Contradiction,
                &slot.place,
                "\"materials\" contradicts \"material\"",
                "keep one of the two",
            );
        }
        (Body::Shape(_), _, Some((slot, _))) => {
            faults.add(
                ErrorCode::NoEffect,
                &slot.place,
                "a shape has no materials by name",
                "give \"material\" in place of \"materials\"",
            );
        }
        (Body::Shape(_), None, None) => {
            faults.add(
                ErrorCode::MissingKey,
                &object.place,
                "a shape without a material",
                "add \"material\": the name of a material",
            );
        }
        _ => {}
    }
}
