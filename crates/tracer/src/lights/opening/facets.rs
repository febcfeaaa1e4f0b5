//! The facets of an opening as seen by a receiver: parallelograms, and polygons that approximate discs.
//!
//! One facet is sampled in proportion to its approximate solid angle, A h / (d² + A/4)^{3/2} with the height h of the receiver above its plane and
//! the distance d from its middle. Of a body only the facets that face the receiver are sampled; no other part of a convex body hides them. A
//! parallelogram is sampled by solid angle from near by and by area from afar (`lights/triangle.rs`), a polygon by area.

use etendue_core::warp::uniform_triangle;
use glam::{DAffine3, Vec2, Vec3};

use super::body::{Opening, OpeningBody};
use super::mesh::{self, SIDES, corner};
use crate::lights::{LightHit, ROUNDING, SurfaceSample, solid_angle_pdf};
use crate::{MaterialId, geometry::Mesh, lights::triangle::TriangleLight};

/// Maximum number of facets: those of a tube with its two ends.
const MAX_FACETS: usize = SIDES as usize + 2;

/// The facets of an opening in the render frame.
#[derive(Clone, Debug)]
pub(in crate::lights) struct OpeningFacets {
    facets: Vec<OpeningFacet>,
    /// Number of parallelograms; they come first.
    parallelograms: usize,
    /// True if they emit from both sides.
    both: bool,
}

#[derive(Clone, Debug)]
struct OpeningFacet {
    middle: Vec3,
    /// Outward.
    normal: Vec3,
    area_m2: f32,
    form: FacetForm,
}

#[derive(Clone, Debug)]
enum FacetForm {
    Parallelogram(TriangleLight),
    Polygon(Polygon),
}

/// An affine image of a regular polygon.
#[derive(Clone, Debug)]
struct Polygon {
    /// Images of the unit vectors, from the middle.
    axes: [Vec3; 2],
    /// Distance of the corners from the middle before the map.
    reach: f32,
    error_m: f32,
}

/// A sampled point, and how far the accelerator may see it elsewhere: off its plane, and before it along the ray.
pub(in crate::lights) struct FacetSample {
    pub(in crate::lights) surface: SurfaceSample,
    pub(in crate::lights) error_m: f32,
    pub(in crate::lights) early_m: f32,
}

/// The weight of each facet for a receiver.
struct FacetWeights {
    of: [f32; MAX_FACETS],
    total: f32,
}

impl OpeningFacets {
    /// The facets of an opening's mesh; `None` if rounding leaves one no area.
    pub(in crate::lights) fn new(
        opening: &Opening,
        mesh: &Mesh,
        to_render: &DAffine3,
        material: MaterialId,
    ) -> Option<Self> {
        let parallelograms = opening.parallelograms();
        let of_two = |k: usize| {
            let light = TriangleLight::from_parallelogram(mesh, [2 * k, 2 * k + 1], to_render, material)?;
            Some(OpeningFacet {
                middle: light.middle(),
                normal: light.normal(),
                area_m2: light.area_m2() as f32,
                form: FacetForm::Parallelogram(light),
            })
        };
        let mut facets = (0..parallelograms).map(of_two).collect::<Option<Vec<_>>>()?;
        if let OpeningBody::Cylinder(along) = opening.body {
            let ends: &[f64] = if opening.half_m[along] == 0.0 { &[1.0] } else { &[-1.0, 1.0] };
            facets.extend(ends.iter().map(|end| polygon(opening, along, *end, to_render)));
        }
        Some(Self { facets, parallelograms, both: opening.flat_axis().is_some() })
    }

    /// Number of triangles of the mesh of these facets.
    pub(in crate::lights) fn triangles(&self) -> usize {
        2 * self.parallelograms + SIDES as usize * (self.facets.len() - self.parallelograms)
    }

    fn weights(&self, from: Vec3) -> FacetWeights {
        let mut weights = FacetWeights { of: [0.0; MAX_FACETS], total: 0.0 };
        for (weight, facet) in weights.of.iter_mut().zip(&self.facets) {
            let offset = from - facet.middle;
            let height = facet.normal.dot(offset);
            let height = if self.both { height.abs() } else { height.max(0.0) };
            let wide2 = offset.length_squared() + 0.25 * facet.area_m2;
            *weight = facet.area_m2 * height / (wide2 * wide2.sqrt());
            weights.total += *weight;
        }
        weights
    }

    /// Samples a point for a receiver; `None` if no facet faces it.
    pub(in crate::lights) fn sample(&self, from: Vec3, u: Vec2) -> Option<FacetSample> {
        let weights = self.weights(from);
        let (chosen, within) = weights.select(u.x)?;
        let facet = &self.facets[chosen];
        let mut facet_sample = facet.sample(from, Vec2::new(within, u.y))?;
        facet_sample.surface.pdf *= weights.probability(chosen);
        (facet_sample.surface.pdf > 0.0).then_some(facet_sample)
    }

    /// Density with which [`OpeningFacets::sample`] returns the direction to a point that was hit, 1/sr.
    pub(in crate::lights) fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        let weights = self.weights(hit.receiver.position);
        let facet = self.facet_of(hit.point.primitive as usize);
        let probability = weights.probability(facet);
        if probability > 0.0 { probability * self.facets[facet].pdf(hit) } else { 0.0 }
    }

    /// The facet that a triangle of the mesh belongs to.
    fn facet_of(&self, primitive: usize) -> usize {
        match primitive.checked_sub(2 * self.parallelograms) {
            None => primitive / 2,
            Some(beyond) => self.parallelograms + beyond / SIDES as usize,
        }
    }
}

impl FacetWeights {
    fn probability(&self, facet: usize) -> f32 {
        if self.total > 0.0 { self.of[facet] / self.total } else { 0.0 }
    }

    /// The facet selected by `u` in [0, 1), and the place of `u` within it.
    fn select(&self, u: f32) -> Option<(usize, f32)> {
        let mut rest = u * self.total;
        let mut chosen = None;
        for (facet, weight) in self.of.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            chosen = Some((facet, (rest / weight).min(ONE_BELOW)));
            if rest < *weight {
                break;
            }
            rest -= weight;
        }
        chosen
    }
}

/// The largest `f32` below one.
const ONE_BELOW: f32 = 1.0 - 0.5 * f32::EPSILON;

impl OpeningFacet {
    fn sample(&self, from: Vec3, u: Vec2) -> Option<FacetSample> {
        match &self.form {
            FacetForm::Parallelogram(light) => {
                let (error_m, early_m) = light.rounding_m();
                Some(FacetSample { surface: light.sample(from, u)?, error_m, early_m })
            }
            FacetForm::Polygon(polygon) => {
                let to_light = self.middle + polygon.place(u) - from;
                let distance = to_light.length();
                let pdf = solid_angle_pdf(1.0 / self.area_m2, to_light, distance, self.normal);
                let surface =
                    SurfaceSample { to_light, distance, normal: self.normal, pdf, uv: Vec2::ZERO, uv_per_m: 0.0 };
                Some(FacetSample { surface, error_m: polygon.error_m, early_m: 0.0 })
            }
        }
    }

    fn pdf(&self, hit: &LightHit<'_>) -> f32 {
        match &self.form {
            FacetForm::Parallelogram(light) => light.pdf(hit),
            FacetForm::Polygon(_) => {
                solid_angle_pdf(1.0 / self.area_m2, hit.direction * hit.distance_m, hit.distance_m, self.normal)
            }
        }
    }
}

impl Polygon {
    /// A point, uniformly by area, from the middle.
    fn place(&self, u: Vec2) -> Vec3 {
        let scaled = u.x * SIDES as f32;
        let side = (scaled as u32).min(SIDES - 1);
        let [near, far] = [side, side + 1].map(|k| Vec2::from(corner(k, 1.0).map(|x| x as f32)) * self.reach);
        let fractions = uniform_triangle(Vec2::new((scaled - side as f32).min(ONE_BELOW), u.y));
        let place = near * fractions.x + far * fractions.y;
        self.axes[0] * place.x + self.axes[1] * place.y
    }
}

/// The end of a cylinder towards one side of its axis, or a disc.
fn polygon(opening: &Opening, along: usize, end: f64, to_render: &DAffine3) -> OpeningFacet {
    let mut middle = glam::DVec3::ZERO;
    middle[along] = end * opening.half_m[along];
    let axis = |k: usize| {
        let mut axis = glam::DVec3::ZERO;
        axis[k] = opening.half_m[k];
        to_render.transform_vector3(axis)
    };
    let axes = [axis((along + 1) % 3), axis((along + 2) % 3)];
    let across = axes[0].cross(axes[1]);
    let reach = if opening.half_m[along] == 0.0 { mesh::disc_reach() } else { mesh::tube_reach() };
    let middle = to_render.transform_point3(middle).as_vec3();
    let extent = (axes[0].length() + axes[1].length()) as f32 + middle.abs().max_element();
    OpeningFacet {
        middle,
        normal: (across.normalize() * end).as_vec3(),
        area_m2: (across.length() * mesh::polygon_area(reach)) as f32,
        form: FacetForm::Polygon(Polygon {
            axes: axes.map(|axis| axis.as_vec3()),
            reach: reach as f32,
            error_m: ROUNDING * extent,
        }),
    }
}
