//! `[front]`: elements before the lens.

use super::context::{Context, ErrorCode};
use super::lens::coating;
use super::material::{complex_index, reflectance_spectrum};
use super::picture::grey;
use super::spectrum::from_file;
use etendue_core::ExactTime;
use etendue_optics::front::{
    Course, Curve, Dirt, DirtParameters, DropsParameters, Front, FrontError, Layer, Mask, MeshMirror, Mirror,
    MirrorParameters, MirrorShape, Optic, Placement, Quadric, QuadricKind, Reflectance, Sliding, Tint, Windscreen,
    WindscreenParameters, Wiper,
};
use etendue_optics::prescription::coating::Coating;
use etendue_optics::{Lens, PRINCIPAL_NM};
use etendue_projection::Raster;
use etendue_scene::Placed;
use etendue_scene::record::front::drops::DropCount;
use etendue_scene::record::front::mirror::{Edges, Finish, MirrorShape as Shape};
use etendue_scene::record::{Colour, Curve as CurveRecord, front as record};
use etendue_spectra::{Extrapolation, dielectric};
use glam::{DVec2, DVec3};

/// Front of a camera, checked against the camera's field; `None` with the errors recorded.
pub(super) fn front(
    record: &record::ExternalOptics,
    lens: &Lens,
    raster: &Raster,
    context: &mut Context<'_>,
) -> Option<Front> {
    let dirt = match &record.dirt {
        Some(record) => Some(self::dirt(record, context)?),
        None => None,
    };
    let (optic, place) = match (&record.windscreen, &record.mirror) {
        (Some(glass), _) => (Some(Optic::Windscreen(Box::new(windscreen(glass, context)?))), &glass.place),
        (None, Some(mirror)) => (Some(Optic::Mirror(Box::new(self::mirror(mirror, context)?))), &mirror.place),
        (None, None) => (None, &record.place),
    };
    let front = Front::new(dirt, optic)?;
    let checked = front.check(lens, raster);
    let drops = record.windscreen.as_ref().and_then(|glass| glass.drops.as_ref());
    let place = match (&checked, drops) {
        (Err(FrontError::DropsNotSeen), Some(drops)) => &drops.place,
        _ => place,
    };
    context.accept(place, checked)?;
    Some(front)
}

fn dirt(r: &record::dirt::Dirt, context: &mut Context<'_>) -> Option<Dirt> {
    let (width, texels) = grey(&r.mask, context)?;
    let mask = context.accept(&r.mask.place, Mask::new(width, texels.len() / width.max(1), texels))?;
    let [x, y] = r.offset_mm.as_ref().map_or([0.0; 2], |o| o.value);
    let tilt = r.tilt_deg.as_ref().map_or(0.0, |t| t.value);
    let placement = Placement::with_rotation_deg(DVec3::new(x, y, r.distance_mm.value), [tilt, 0.0, 0.0]);
    let size_mm = DVec2::from_array(r.size_mm.value);
    context.accept(&r.place, Dirt::new(DirtParameters { placement, size_mm, mask }))
}

fn mirror(r: &record::mirror::Mirror, context: &mut Context<'_>) -> Option<Mirror> {
    let reflectance = reflectance(&r.finish, context);
    let (shape, usual_mm) = shape(&r.shape, context)?;
    // A mirror in a loaded description has a distance, or is a hyperboloid.
    let distance_mm = r.distance_mm.as_ref().map(|d| d.value).or(usual_mm)?;
    let [x, y] = r.offset_mm.as_ref().map_or([0.0; 2], |o| o.value);
    let degrees = r.rotation_deg.as_ref().map_or([0.0; 3], |d| d.value);
    let placement = Placement::with_rotation_deg(DVec3::new(x, y, distance_mm), degrees);
    context.accept(&r.place, Mirror::new(MirrorParameters { shape, placement, reflectance: reflectance? }))
}

/// Surface, and the position of its vertex unless stated.
fn shape(r: &Shape, context: &mut Context<'_>) -> Option<(MirrorShape, Option<f64>)> {
    let (place, profile) = match r {
        Shape::Sphere(s) => (&s.place, conic(s.radius_mm.value, 0.0, &s.edges)),
        Shape::Paraboloid(s) => (&s.place, conic(s.radius_mm.value, -1.0, &s.edges)),
        Shape::Hyperboloid(h) => (&h.place, conic(h.radius_mm.value, h.conic.value, &h.edges)),
        Shape::Cone(c) => (&c.place, quadric(QuadricKind::Cone { half_angle_deg: c.half_angle_deg.value }, &c.edges)),
        Shape::Mesh(mesh) => return Some((MirrorShape::Mesh(Box::new(self::mesh(mesh, context)?)), None)),
    };
    let quadric = context.accept(place, profile)?;
    Some((MirrorShape::Quadric(quadric), quadric.outer_focus_mm()))
}

fn mesh(r: &record::mirror::MeshFile, context: &mut Context<'_>) -> Option<MeshMirror> {
    let Some(asset) = context.assets.meshes.get(&r.file.value) else {
        context.error(ErrorCode::UnreadableFile, &r.file.place, "the mesh was not loaded", "give a readable file");
        return None;
    };
    let scale = r.scale_mm.as_ref().map_or(1.0, |s| s.value);
    let vector = |v: &[f32; 3]| DVec3::from_array(v.map(f64::from));
    let origin = DVec3::from_array(asset.origin);
    let positions = asset.positions.iter().map(|p| (vector(p) + origin) * scale).collect();
    let normals = asset.normals.iter().map(vector).collect();
    context.accept(&r.file.place, MeshMirror::new(positions, normals, asset.triangles.clone()))
}

fn conic(radius_mm: f64, conic: f64, edges: &Edges) -> Result<Quadric, FrontError> {
    quadric(QuadricKind::Conic { radius_mm, conic }, edges)
}

fn quadric(kind: QuadricKind, edges: &Edges) -> Result<Quadric, FrontError> {
    Quadric::new(kind, edges.rim_radius_mm.value, edges.hole_radius_mm.as_ref().map_or(0.0, |h| h.value))
}

fn reflectance(finish: &Finish, context: &mut Context<'_>) -> Option<Reflectance> {
    match (finish, finish.metal()) {
        (Finish::Share(colour), _) => curve(colour, context).map(Reflectance::Fraction),
        (_, metal) => complex_index(&metal?, context).map(|index| Reflectance::Metal(Box::new(index))),
    }
}

/// Laminated glass of cars: 2.1 mm of float glass on each side of an interlayer of 0.76 mm. Indices at 588 nm: soda-lime glass 1.52 (M. Rubin, "Optical
/// properties of soda lime silica glasses", Solar Energy Materials 12, 1985), polyvinyl butyral 1.48 (manufacturers' data sheets by ASTM D542).
const LAMINATE: [(f64, f64); 3] = [(2.1, 1.52), (0.76, 1.48), (2.1, 1.52)];

fn windscreen(r: &record::windscreen::Windscreen, context: &mut Context<'_>) -> Option<Windscreen> {
    let number = |value: &Option<Placed<f64>>, default: f64| value.as_ref().map_or(default, |n| n.value);
    let degrees = [number(&r.tilt_deg, 0.0), number(&r.yaw_deg, 0.0), 0.0];
    let doubles = r.double_image.as_ref().is_none_or(|d| d.value);
    let parameters = WindscreenParameters {
        placement: Placement::with_rotation_deg(DVec3::new(0.0, 0.0, r.distance_mm.value), degrees),
        radius_across_mm: number(&r.radius_across_mm, f64::INFINITY),
        radius_upright_mm: number(&r.radius_upright_mm, f64::INFINITY),
        layers: layers(r.layers.as_deref(), context)?,
        wedge_rad: 1e-3 * number(&r.wedge_mrad, 0.0),
        tint: tint(r, context)?,
        coating: r.coating.as_ref().map_or(Coating::Uncoated, coating),
        double_image_fraction: if doubles {
            r.double_image_sample_fraction.as_ref().map(|s| s.value)
        } else {
            Some(0.0)
        },
    };
    let glass = context.accept(&r.place, Windscreen::new(parameters))?;
    match &r.drops {
        Some(record) => {
            let drops = drops(record, context);
            context.accept(&record.place, glass.with_drops(drops))
        }
        None => Some(glass),
    }
}

fn layers(records: Option<&[record::windscreen::Layer]>, context: &mut Context<'_>) -> Option<Vec<Layer>> {
    let Some(records) = records else {
        let layer = |(thickness_mm, index)| Layer { thickness_mm, index: Curve::Constant(index) };
        return Some(LAMINATE.map(layer).to_vec());
    };
    let index = |record: &CurveRecord, context: &mut Context<'_>| match record {
        CurveRecord::Constant(index) => Some(Curve::Constant(index.value)),
        CurveRecord::File(file) => from_file(file, Extrapolation::Hold, context).map(|s| Curve::Table(Box::new(s))),
    };
    let layer = |r: &record::windscreen::Layer| {
        Some(Layer { thickness_mm: r.thickness_mm.value, index: index(&r.index, context)? })
    };
    records.iter().map(layer).collect()
}

/// `None` with an error recorded, `Some(None)` for clear glass.
fn tint(r: &record::windscreen::Windscreen, context: &mut Context<'_>) -> Option<Option<Tint>> {
    let Some(colour) = &r.internal_transmittance else { return Some(None) };
    let thickness_mm = r.reference_thickness_mm.as_ref().map(|t| t.value);
    Some(Some(Tint { transmittance: curve(colour, context)?, thickness_mm }))
}

/// For drops that condense and coalesce: see the record.
const SIZE_EXPONENT: f64 = 8.0 / 3.0;
const CONTACT_ANGLE_DEG: f64 = 60.0;

fn drops(r: &record::drops::Drops, context: &mut Context<'_>) -> DropsParameters {
    let contact_angle_deg = r.contact_angle_deg.as_ref().map_or(CONTACT_ANGLE_DEG, |a| a.value);
    DropsParameters {
        offset_mm: r.offset_mm.as_ref().map_or(DVec2::ZERO, |o| DVec2::from_array(o.value)),
        size_mm: DVec2::from_array(r.size_mm.value),
        count: count(r),
        radius_mm: [r.min_radius_mm.value, r.max_radius_mm.value],
        size_exponent: r.size_exponent.as_ref().map_or(SIZE_EXPONENT, |e| e.value),
        contact_angle_rad: contact_angle_deg.to_radians(),
        index: water(r.dispersion.as_ref().is_none_or(|d| d.value)),
        seed: r.seed.as_ref().map_or(0, |s| s.value),
        course: r.changes().then(|| course(r, context)),
    }
}

fn course(r: &record::drops::Drops, context: &mut Context<'_>) -> Course {
    let zero_s = context.epoch.to(ExactTime::default());
    let start_s = r.start_s.as_ref().map_or(zero_s, |start| context.since_epoch_s(start));
    let sliding = |s: &record::drops::Sliding| Sliding {
        speed_mm_s: s.speed_mm_s.value,
        still_radius_mm: s.still_radius_mm.value,
    };
    let wiper = |w: &record::drops::Wiper| Wiper {
        pivot_mm: DVec2::from_array(w.pivot_mm.value),
        blade_mm: w.blade_mm.value,
        angles_rad: w.angles_deg.value.map(f64::to_radians),
        sweep_s: w.sweep_s.value,
        period_s: w.period_s.value,
        start_s: w.start_s.as_ref().map_or(start_s, |start| context.since_epoch_s(start)),
    };
    Course {
        start_s,
        sliding: r.sliding.as_ref().map(sliding),
        drying_s: r.drying_s.as_ref().map(|s| s.value),
        arrivals_hz: r.arrivals_per_s.as_ref().map_or(0.0, |s| s.value),
        wiper: r.wiper.as_ref().map(wiper),
    }
}

/// Number of fallen drops: the record has checked the range 1 to 1 000 000.
fn count(r: &record::drops::Drops) -> u32 {
    match &r.amount {
        DropCount::Count(count) => count.value as u32,
        DropCount::Density(density) => {
            let [width, height] = r.size_mm.value;
            ((density.value * width * height * 1e-4).round() as u32).max(1)
        }
    }
}

fn water(disperses: bool) -> Curve {
    let index = &dielectric::by_name("water").expect("water is among the dielectrics").n;
    match disperses {
        true => Curve::Table(Box::new(index.clone())),
        false => Curve::Constant(f64::from(index.at(PRINCIPAL_NM as f32))),
    }
}

/// A transmittance over wavelength.
fn curve(colour: &Colour, context: &mut Context<'_>) -> Option<Curve> {
    match colour {
        Colour::Grey(reflectance) => Some(Curve::Constant(reflectance.value)),
        _ => reflectance_spectrum(colour, context).map(|spectrum| Curve::Table(Box::new(spectrum))),
    }
}
