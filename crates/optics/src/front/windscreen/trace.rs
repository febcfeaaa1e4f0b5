//! A ray through the layers, against the light.

use super::super::drops::Drops;
use super::super::{Fate, Line};
use super::{Way, Windscreen};
use crate::prescription::coating::{Coating, Crossing};
use glam::DVec3;

/// A ray on its way: what is left of it.
struct Passage<'a> {
    glass: &'a Windscreen,
    /// What lies on the outer face.
    drops: Option<&'a Drops>,
    /// The drop that wets the outer face where the ray last met it.
    wet: Option<usize>,
    nm: f64,
    line: Line,
    /// The medium it runs in: 0 is air inside, 1 the first layer, the last air outside.
    medium: usize,
    share: f64,
    path_mm: f64,
}

impl Windscreen {
    /// A ray from the camera, beyond the glass as if it were dry.
    pub(in crate::front) fn through(&self, line: Line, nm: f64, way: Way) -> Fate {
        self.beyond(None, line, nm, way)
    }

    /// A ray from the camera, beyond the glass and the drops on it.
    pub(in crate::front) fn through_wet(&self, line: Line, nm: f64, way: Way) -> Fate {
        self.beyond(self.drops(), line, nm, way)
    }

    fn beyond(&self, drops: Option<&Drops>, line: Line, nm: f64, way: Way) -> Fate {
        let placement = &self.parameters.placement;
        match through(self, drops, placement.inward(line), nm, way) {
            Fate::On(out, share) => Fate::On(placement.outward(out), share),
            other => other,
        }
    }
}

fn through(glass: &Windscreen, drops: Option<&Drops>, line: Line, nm: f64, way: Way) -> Fate {
    let outer = glass.faces.len() - 1;
    let mut passage = Passage { glass, drops, wet: None, nm, line, medium: 0, share: 1.0, path_mm: 0.0 };
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
        (0..outer).try_for_each(|face| self.refract(face, 1.0).map(drop))?;
        if way == Way::Doubled {
            self.reflect(outer, 1.0)?;
            (1..outer).rev().try_for_each(|face| self.refract(face, -1.0).map(drop))?;
            self.reflect(0, -1.0)?;
            (1..outer).try_for_each(|face| self.refract(face, 1.0).map(drop))?;
        }
        let normal = self.refract(outer, 1.0)?;
        let Some(drops) = self.drops else { return Some(()) };
        let (line, share) = drops.leave(self.line, normal, self.wet, self.nm)?;
        self.line = line;
        self.share *= share;
        Some(())
    }

    fn index(&self, medium: usize) -> f64 {
        match medium.checked_sub(1).and_then(|i| self.glass.parameters.layers.get(i)) {
            Some(layer) => layer.index.at(self.nm),
            None => match self.drops.filter(|_| medium > 0 && self.wet.is_some()) {
                Some(drops) => drops.index(self.nm),
                None => 1.0,
            },
        }
    }

    /// The ray at a face, and the face's outward normal.
    fn arrive(&mut self, face: usize, sense: f64) -> Option<DVec3> {
        let (point_mm, normal) = self.glass.faces[face].crossed(&self.line, sense)?;
        if self.medium > 0 {
            self.path_mm += (point_mm - self.line.point_mm).length();
        }
        self.line.point_mm = point_mm;
        if let Some(drops) = self.drops.filter(|_| face + 1 == self.glass.faces.len()) {
            self.wet = drops.wetting(point_mm);
        }
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
        let is_dry = face == 0 || (face == outer && self.wet.is_none());
        if is_dry { &self.glass.parameters.coating } else { &Coating::Uncoated }
    }

    /// Refraction at a face, whose outward normal it returns.
    fn refract(&mut self, face: usize, sense: f64) -> Option<DVec3> {
        let normal = self.arrive(face, sense)?;
        let (crossing, next) = self.crossing(face, sense, normal)?;
        self.share *= self.coating(face).transmittance(&crossing, self.nm);
        let (ratio, [along, beyond]) = (crossing.n[0] / crossing.n[1], crossing.cosine);
        let direction = self.line.direction * ratio + normal * (sense * (beyond - ratio * along));
        self.line.direction = direction.normalize();
        self.medium = next;
        Some(normal)
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
