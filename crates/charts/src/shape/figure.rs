//! Figures in cells: nested zones about a centre.

use super::ring::ring;
use super::sheet::{Fill, Piece};
use glam::DVec2;

/// What lies between a convex outline and the one within it (all of it for the innermost).
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// The outer outline, about the figure's centre.
    pub outline: Vec<DVec2>,
    /// One fill for all; or one for each edge of the outline: sectors.
    pub fills: Vec<Fill>,
}

/// Zones from the inside out, about a centre.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The centre, inside of all zones.
    pub centre: DVec2,
    /// From the inside out. A zone with sectors follows the centre itself or a zone with as many corners at the same
    /// angles.
    pub zones: Vec<Zone>,
}

impl Zone {
    /// A zone of one fill.
    #[must_use]
    pub fn even(outline: Vec<DVec2>, ink: usize) -> Self {
        Self { outline, fills: vec![Fill::Ink(ink)] }
    }
}

impl Figure {
    /// A figure of one zone.
    #[must_use]
    pub fn one(centre: DVec2, outline: Vec<DVec2>, ink: usize) -> Self {
        Self { centre, zones: vec![Zone::even(outline, ink)] }
    }

    /// Its pieces, and those of what is left of `cell` around it.
    #[must_use]
    pub fn pieces(&self, cell: &[DVec2], ground: Fill) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut within: Option<&[DVec2]> = None;
        for zone in &self.zones {
            self.add_zone(within, &zone.outline, &zone.fills, &mut pieces);
            within = Some(&zone.outline);
        }
        self.add_zone(within, cell, &[ground], &mut pieces);
        pieces
    }

    fn add_zone(&self, within: Option<&[DVec2]>, outline: &[DVec2], fills: &[Fill], pieces: &mut Vec<Piece>) {
        match (within, fills) {
            (None, [fill]) => pieces.push(Piece { outline: outline.to_vec(), fill: *fill }),
            (Some(within), [fill]) => {
                let triangles = ring(self.centre, within, outline).into_iter();
                pieces.extend(triangles.map(|t| Piece { outline: t.to_vec(), fill: *fill }));
            }
            (within, fills) => pieces.extend(self.sectors(within, outline, fills)),
        }
    }

    fn sectors(&self, within: Option<&[DVec2]>, outline: &[DVec2], fills: &[Fill]) -> Vec<Piece> {
        assert_eq!(fills.len(), outline.len(), "one fill an edge");
        assert!(within.is_none_or(|w| w.len() == outline.len()), "sectors between outlines of as many corners");
        let next = |i: usize| (i + 1) % outline.len();
        let corners = |i: usize| match within {
            None => vec![self.centre, outline[i], outline[next(i)]],
            Some(within) => vec![within[i], outline[i], outline[next(i)], within[next(i)]],
        };
        fills.iter().enumerate().map(|(i, fill)| Piece { outline: corners(i), fill: *fill }).collect()
    }
}
