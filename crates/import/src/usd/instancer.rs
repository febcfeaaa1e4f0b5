//! Many copies of a few prototypes.

use super::access::{indices, numbers, tuples};
use super::importer::{Importer, State};
use super::transform::rotation;
use crate::syntax::usd::UsdPrim;
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashSet;

/// Instancers within one another.
const MAX_DEPTH: usize = 8;

impl<'a> Importer<'a> {
    /// Each instance goes through its scale, its orientation, its position, and the instancer's own transform.
    pub(super) fn instancer(&mut self, prim: &'a UsdPrim, state: &State<'a>) -> Result<(), String> {
        let told = |what: String| Err(format!("{}: {what}", prim.path));
        if state.depth >= MAX_DEPTH {
            return told(format!("instancers stand more than {MAX_DEPTH} deep in one another, or in a circle"));
        }
        if !state.is_drawn() {
            self.leave_undrawn(prim);
            return Ok(());
        }
        let Some(which) = indices(prim, "protoIndices") else {
            return told("a prototype below 0".to_owned());
        };
        let positions = tuples::<3>(prim, "positions");
        let scales = tuples::<3>(prim, "scales");
        let precise = tuples::<4>(prim, "orientationsf");
        let turns = if precise.is_empty() { tuples::<4>(prim, "orientations") } else { precise };
        let ids = numbers(prim, "ids");
        let inactive = prim.inactive_ids.iter().map(|id| *id as f64);
        let hidden = numbers(prim, "invisibleIds").iter().copied().chain(inactive);
        let hidden: HashSet<u64> = hidden.map(f64::to_bits).collect();
        if positions.len() < which.len() {
            return told(format!("{} positions of {} instances", positions.len(), which.len()));
        }
        let targets = prim.relation("prototypes").map_or(&[][..], |relation| &relation.targets);
        for (number, prototype) in which.iter().enumerate() {
            let id = ids.get(number).copied().unwrap_or(number as f64);
            if hidden.contains(&id.to_bits()) {
                continue;
            }
            let Some(path) = targets.get(*prototype) else {
                return told(format!("an instance of prototype {prototype}, of {}", targets.len()));
            };
            let Some(found) = self.paths.prim(path) else {
                self.scenery.report.note(format!("the prototype <{path}> is not there, or a class or an over"));
                continue;
            };
            let [w, x, y, z] = turns.get(number).copied().unwrap_or([1.0, 0.0, 0.0, 0.0]);
            let turn = DMat3::from_quat(rotation([w, x, y, z]));
            let scale = DVec3::from_array(scales.get(number).copied().unwrap_or([1.0; 3]));
            let own = DAffine3 {
                matrix3: turn * DMat3::from_diagonal(scale),
                translation: DVec3::from_array(positions[number]),
            };
            if !own.is_finite() {
                return told(format!("instance {number} stands at no finite place"));
            }
            let mut inner = state.clone();
            (inner.to_world, inner.depth) = (state.to_world * own, state.depth + 1);
            self.prim(found, &inner)?;
        }
        self.scenery.report.at(prim.path.clone());
        self.scenery.report.note("instances are copies, a mesh for each");
        self.note_unused(prim);
        Ok(())
    }
}
