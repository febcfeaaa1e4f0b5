//! Rays a second in the street.

use crate::questions::{RayQueries, questions};
use crate::scenes::{STREET, camera};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::flat;
use etendue_bench_rays::runs::{COUNT, RunStatistics};
use etendue_bench_rays::table::Table;
use etendue_core::TimeInterval;
use etendue_tracer::accel::Simd;
use etendue_tracer::render_space::RenderSpace;
use glam::DVec3;

const NOTE: &str = "Millions a second. One thread, one ray after the other. Bounces leave the points that the primary rays meet in the \
    directions of a diffuse surface; shadow rays leave them towards the centre of the sun, or anywhere above the horizon.";

/// Millions of rays a second, for every kind of ray.
pub fn table() -> Table {
    let plan = STREET.plan();
    let camera = camera(&plan);
    let origin_m = camera.path.at(0.0).position_m;
    let flat = flat::world(flat::mesh(&plan.world.render_space(origin_m)));
    let views = [
        plan.world.render_space_with(origin_m, TimeInterval::default(), Simd::Auto),
        plan.world.render_space_with(origin_m, TimeInterval::default(), Simd::Scalar),
        flat.render_space_with(DVec3::ZERO, TimeInterval::default(), Simd::Auto),
        flat.render_space_with(DVec3::ZERO, TimeInterval::default(), Simd::Scalar),
    ];
    let questions = questions(&plan, camera, &views[0]);
    let head = ["ray", "thousands", "met", "AVX2", "scalar", "as one mesh, AVX2", "as one mesh, scalar", "spread"];
    let mut table = Table::new("Rays in the street", NOTE, &head);
    for (queries, rates) in questions.iter().zip(measured(&questions, &views)) {
        table.row(row(queries, queries.count_hits(&views[0]), &rates));
    }
    table
}

/// Rates of every kind of ray in every view. Views and kinds take turns, so that their ratios hold on a busy machine.
fn measured(questions: &[RayQueries], views: &[RenderSpace<'_>]) -> Vec<Vec<RunStatistics>> {
    let mut rates = vec![vec![RunStatistics::default(); views.len()]; questions.len()];
    for _ in 0..COUNT {
        for (queries, rates) in questions.iter().zip(&mut rates) {
            views.iter().zip(rates).for_each(|(view, rates)| rates.add(rate(queries, view)));
        }
    }
    rates
}

fn rate(queries: &RayQueries, view: &RenderSpace<'_>) -> f64 {
    let (_, seconds) = timed(|| std::hint::black_box(queries.count_hits(view)));
    queries.rays.len() as f64 / seconds / 1e6
}

fn row(queries: &RayQueries, hits: usize, rates: &[RunStatistics]) -> Vec<String> {
    let rays = queries.rays.len() as f64;
    let mut cells = vec![queries.name.to_owned(), format!("{:.0}", rays / 1e3)];
    cells.push(format!("{:.0} %", 100.0 * hits as f64 / rays));
    cells.extend(rates.iter().map(|r| format!("{:.2}", r.median())));
    let spread = rates.iter().map(|r| r.spread()).fold(0.0, f64::max);
    cells.push(format!("± {:.0} %", 100.0 * spread));
    cells
}
