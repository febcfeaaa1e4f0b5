//! A ray through the layers, against the light.

use super::super::{Fate, Line};
use super::{Way, Windscreen};
use crate::prescription::coating::{Coating, Crossing};
use glam::DVec3;

/// A ray on its way: what is left of it.
struct Passage<'a> {
    glass: &'a Windscreen,
    nm: f64,
    line: Line,
    /// The medium it runs in: 0 is air inside, 1 the first layer, the last air outside.
    medium: usize,
    share: f64,
    path_mm: f64,
}

impl Windscreen {
    /// A ray from the camera, beyond the glass.
    pub(in crate::front) fn through(&self, line: Line, nm: f64, way: Way) -> Fate {
        let placement = &self.parameters.placement;
        match through(self, placement.inward(line), nm, way) {
            Fate::On(out, share) => Fate::On(placement.outward(out), share),
            other => other,
        }
    }
}

fn through(glass: &Windscreen, line: Line, nm: f64, way: Way) -> Fate {
    let outer = glass.faces.len() - 1;
    let mut passage = Passage { glass, nm, line, medium: 0, share: 1.0, path_mm: 0.0 };
    if glass.faces[0].crossed(&line, 1.0).is_none() {
        return Fate::Past;
    }
    match passage.run(outer, way) {
        Some(()) => Fate::On(passage.line, passage.share * glass.bulk(passage.path_mm, nm)),
        None => Fate::Lost,
    }
}

impl Passage<'_> {
    fn run(&mut self, outer: usize, way: Way) -> Option<()> {
        (0..outer).try_for_each(|face| self.refract(face, 1.0))?;
        if way == Way::Doubled {
            self.reflect(outer, 1.0)?;
            (1..outer).rev().try_for_each(|face| self.refract(face, -1.0))?;
            self.reflect(0, -1.0)?;
            (1..outer).try_for_each(|face| self.refract(face, 1.0))?;
        }
        self.refract(outer, 1.0)
    }

    fn index(&self, medium: usize) -> f64 {
        match medium.checked_sub(1).and_then(|i| self.glass.parameters.layers.get(i)) {
            Some(layer) => layer.index.at(self.nm),
            None => 1.0,
        }
    }

    /// The ray at a face, and the face's outward normal.
    fn arrive(&mut self, face: usize, sense: f64) -> Option<DVec3> {
        let (point_mm, normal) = self.glass.faces[face].crossed(&self.line, sense)?;
        if self.medium > 0 {
            self.path_mm += (point_mm - self.line.point_mm).length();
        }
        self.line.point_mm = point_mm;
        Some(normal)
    }

    /// Indices and cosines of a crossing of a face; `None` for total reflection.
    fn crossing(&self, face: usize, sense: f64, normal: DVec3) -> Option<(Crossing, usize)> {
        let next = if sense > 0.0 { face + 1 } else { face };
        let n = [self.index(self.medium), self.index(next)];
        let along = self.line.direction.dot(normal).abs();
        let ratio = n[0] / n[1];
        let square = 1.0 - ratio * ratio * (1.0 - along * along);
        (square > 0.0).then(|| (Crossing { n, cosine: [along, square.sqrt()] }, next))
    }

    fn coating(&self, face: usize) -> &Coating {
        let outer = self.glass.faces.len() - 1;
        if face == 0 || face == outer { &self.glass.parameters.coating } else { &Coating::Uncoated }
    }

    fn refract(&mut self, face: usize, sense: f64) -> Option<()> {
        let normal = self.arrive(face, sense)?;
        let (crossing, next) = self.crossing(face, sense, normal)?;
        self.share *= self.coating(face).transmittance(&crossing, self.nm);
        let (ratio, [along, beyond]) = (crossing.n[0] / crossing.n[1], crossing.cosine);
        let direction = self.line.direction * ratio + normal * (sense * (beyond - ratio * along));
        self.line.direction = direction.normalize();
        self.medium = next;
        Some(())
    }

    /// Reflection at an outer face from within.
    fn reflect(&mut self, face: usize, sense: f64) -> Option<()> {
        let normal = self.arrive(face, sense)?;
        let (crossing, _) = self.crossing(face, sense, normal)?;
        self.share *= 1.0 - self.coating(face).transmittance(&crossing, self.nm);
        let direction = self.line.direction;
        self.line.direction = direction - normal * (2.0 * direction.dot(normal));
        Some(())
    }
}
