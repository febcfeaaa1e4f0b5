//! Luminous openings of lamps: from records to the tracer's, and their placement in the world.

use super::context::{Context, ErrorCode};
use super::material::MaterialTableBuilder;
use crate::plan::Identity;
use etendue_scene::Place;
use etendue_scene::asset::{OpeningShape, PhotometryAsset, PhotometryAxes};
use etendue_scene::record::light::LampOpening;
use etendue_scene::record::light::placement::MainAxis;
use etendue_tracer::accel::WorldBuilder;
use etendue_tracer::geometry::{Instance, Shape};
use etendue_tracer::lights::{Lamp, Opening, OpeningBody, Profile};
use glam::DMat3;

/// Opening of a lamp that emits along its `main` axis according to `profile`; `None` if it is invalid.
pub(super) fn opening(
    record: &LampOpening,
    main: MainAxis,
    file: Option<&PhotometryAsset>,
    profile: &Profile,
    context: &mut Context<'_>,
) -> Option<Opening> {
    let (body, extents_m) = match (record, file) {
        (LampOpening::File(record), Some(asset)) => from_photometry(asset, &record.place, context)?,
        // Refused when the record was read.
        (LampOpening::File(_), None) => return None,
        (LampOpening::Sphere(sphere), _) => (OpeningBody::Ellipsoid, [2.0 * sphere.radius_m.value; 3]),
        (LampOpening::Tube(tube), _) => {
            let across = 2.0 * tube.radius_m.value;
            (OpeningBody::Cylinder(1), [across, tube.length_m.value, across])
        }
        (LampOpening::Disc(disc), _) => {
            let across = 2.0 * disc.radius_m.value;
            match main {
                MainAxis::Forward => (OpeningBody::Cylinder(0), [0.0, across, across]),
                MainAxis::Downward => (OpeningBody::Cylinder(2), [across, across, 0.0]),
            }
        }
        (LampOpening::Rectangle(rectangle), _) => {
            let (width, height) = (rectangle.width_m.value, rectangle.height_m.value);
            match main {
                MainAxis::Forward => (OpeningBody::Box, [0.0, width, height]),
                MainAxis::Downward => (OpeningBody::Box, [height, width, 0.0]),
            }
        }
    };
    let opening = context.accept(record.place(), Opening::new(body, extents_m))?;
    context.accept(record.place(), opening.check(profile))?;
    Some(opening)
}

/// Opening stated by a photometric file. Length, width and height are along the photometric horizontal, across it and along the photometric zero (LM-63-2002,
/// section 3): x, y and z of types A and C, z, y and x of type B.
fn from_photometry(
    asset: &PhotometryAsset,
    place: &Place,
    context: &mut Context<'_>,
) -> Option<(OpeningBody, [f64; 3])> {
    let opening_record = &asset.opening;
    let (length, height) = match asset.axes {
        PhotometryAxes::A | PhotometryAxes::C => (0, 2),
        PhotometryAxes::B => (2, 0),
    };
    let body = match opening_record.shape {
        OpeningShape::Point => {
            context.error(
                ErrorCode::UnsuitableFile,
                place,
                "the photometric file states no luminous opening: its length, width and height are 0, a point",
                "give another shape, or remove \"opening\"",
            );
            return None;
        }
        OpeningShape::Rectangular => OpeningBody::Box,
        OpeningShape::Round => OpeningBody::Cylinder(height),
        OpeningShape::Lying => OpeningBody::Cylinder(length),
        OpeningShape::LyingAcross => OpeningBody::Cylinder(1),
        OpeningShape::Ball => OpeningBody::Ellipsoid,
    };
    let mut extents_m = [0.0; 3];
    (extents_m[length], extents_m[1], extents_m[height]) =
        (opening_record.length_m, opening_record.width_m, opening_record.height_m);
    Some((body, extents_m))
}

/// Places the openings in the world, each with its own identity, and returns their lamps.
pub(super) fn place_openings(
    lamps_with_opening: Vec<LampWithOpening>,
    builder: &mut WorldBuilder,
    identities: &mut Vec<Identity>,
    material_table: &mut MaterialTableBuilder,
    context: &mut Context<'_>,
) -> Vec<Lamp> {
    let mut lamps = Vec::new();
    for LampWithOpening { lamps: copies, opening, place } in lamps_with_opening {
        let shape = match opening.mesh() {
            Some(mesh) => Shape::Mesh(builder.add_mesh(mesh)),
            None => Shape::Sphere { radius_m: 1.0 },
        };
        let material = material_table.lamp_opening(&place);
        for (name, lamp) in copies {
            identities.push(Identity { name, class: None, axes: DMat3::IDENTITY });
            let instance = builder.add_instance(Instance {
                shape,
                to_world: lamp.opening_to_world(&opening),
                materials: vec![material],
                instance_id: identities.len() as u32,
                semantic_id: 0,
            });
            lamps.extend(context.accept(&place, lamp.opened(opening, instance)));
        }
    }
    lamps
}

/// A lamp with an opening, with all its instances.
pub(super) struct LampWithOpening {
    /// By the names of its instances.
    pub(super) lamps: Vec<(String, Lamp)>,
    pub(super) opening: Opening,
    pub(super) place: Place,
}
