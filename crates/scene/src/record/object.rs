//! `[[objects]]`: shapes and meshes placed in the world, with material and class.

use etendue_core::ExactTime;

use super::motion::{MotionKeys, Wheel, check_motion, check_placements, trajectory_placement};
use super::shape::Shape;
use super::transform::Transform;
use crate::fault::{DescriptionErrors, ErrorCode, NameKind};
use crate::place::Placed;
use crate::reader::{keyed, keyed_by_name, list, name_of, number, record, text, time};

record! {
    /// A mesh or a shape in the world, with one or more instances.
    pub struct Object check(check) {
        /// Name.
        required name: Placed<String> = text("the name of the object");
        /// Mesh or shape.
        inside body: Body;
        /// Material of the whole object. Default, for a mesh: its file's.
        optional material: Placed<String> = name_of(NameKind::Material);
        /// Materials by their names in the mesh's file: `{ "car_paint" = "red" }`.
        many materials: (Placed<String>, Placed<String>) = keyed_by_name(name_of(NameKind::Material));
        /// Semantic class, a name in `[classes]`. Default: class 0.
        optional class: Placed<String> = name_of(NameKind::Class);
        /// Placement of an object with one instance.
        inside transform: Transform;
        /// Placement over time.
        many keys: Keyframe = list(record(), 1);
        /// Motion.
        group course: MotionKeys;
        /// Parent frame. Default: the world.
        optional frame: Placed<String> = name_of(NameKind::Frame);
        /// Wheel that rolls along its path.
        optional rolls: Wheel = record();
        /// Instances; each has an identity in the ground truth.
        many instances: Instance = list(record(), 1);
    }
}

keyed! {
    /// Mesh or shape of an object.
    pub enum Body {
        /// Name of a mesh.
        mesh => Mesh(Placed<String>) = name_of(NameKind::Mesh);
        /// A shape.
        shape => Shape(Shape) = record();
    }
}

record! {
    /// Placement of an object at a time.
    pub struct Keyframe {
        /// Simulated time.
        required time_s: Placed<ExactTime> = time();
        /// Placement.
        inside transform: Transform;
    }
}

record! {
    /// An instance of an object.
    pub struct Instance {
        /// Name of the instance. Default: the object's name and a number.
        optional name: Placed<String> = text("the name of the instance");
        /// Frame. Default: the object's.
        optional frame: Placed<String> = name_of(NameKind::Frame);
        /// Delay added to its emission's "modulation". Default: 0.
        optional modulation_delay_s: Placed<f64> = number("s");
        /// Placement.
        inside transform: Transform;
    }
}

fn check(object: &Object, errors: &mut DescriptionErrors) {
    check_motion(object.course.as_ref(), object.keys.iter().map(|key| &key.time_s), errors);
    check_rolls(object, errors);
    check_placement(object, errors);
    check_materials(object, errors);
}

/// Refuses a scale along the axes of a wheel, which turns within its scale.
fn check_rolls(object: &Object, errors: &mut DescriptionErrors) {
    let scales = object.keys.iter().filter_map(|key| key.transform.scale.as_ref());
    for scale in scales.filter(|_| object.rolls.is_some()) {
        errors.add(
            ErrorCode::NotModelled,
            &scale.place,
            "\"scale\" in the keys of a wheel (\"rolls\") is not modelled",
            "give the keys to a frame, and the scale to the object attached to it",
        );
    }
}

/// Checks that the placement of an object is stated once.
fn check_placement(object: &Object, errors: &mut DescriptionErrors) {
    let own =
        object.transform.is_given().then(|| ("\"position_m\", \"rotation_deg\", \"scale\"", object.place.clone()));
    let keys = object.keys.first().map(|k| ("\"keys\"", k.place.clone()));
    let instances = object.instances.first().map(|i| ("\"instances\"", i.place.clone()));
    check_placements([own, keys, trajectory_placement(object.course.as_ref()), instances], "the object", errors);
}

fn check_materials(object: &Object, errors: &mut DescriptionErrors) {
    let slots = object.materials.first();
    match (&object.body, &object.material, slots) {
        (_, Some(_), Some((slot, _))) => {
            errors.add(
                ErrorCode::Contradiction,
                &slot.place,
                "\"materials\" contradicts \"material\"",
                "keep one of the two",
            );
        }
        (Body::Shape(_), _, Some((slot, _))) => {
            errors.add(
                ErrorCode::NoEffect,
                &slot.place,
                "a shape has no materials by name",
                "give \"material\" instead of \"materials\"",
            );
        }
        (Body::Shape(_), None, None) => {
            errors.add(
                ErrorCode::MissingKey,
                &object.place,
                "the shape has no material",
                "add \"material\": the name of a material",
            );
        }
        _ => {}
    }
}
