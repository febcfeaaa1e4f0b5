//! Time to build the accelerator.

use crate::scenes::{STREET, camera};
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::flat;
use etendue_bench_rays::runs::RunStatistics;
use etendue_bench_rays::table::Table;
use etendue_bench_rays::threads::pool;
use etendue_tracer::accel::{World, WorldBuilder};

const NOTE: &str = "The street: once as it is (the triangles of each mesh once, and a tree over the instances for each \
    camera), once with all instances written out as one mesh. One thread.";

/// Build times of the street.
pub fn table() -> Table {
    let plan = STREET.plan();
    let view = plan.world.render_space(camera(&plan).path.at(0.0).position_m);
    let flat = flat::world(flat::mesh(&view));
    let mut table =
        Table::new("Trees", NOTE, &["world", "triangles", "build, ms", "µs a triangle", "view, ms", "spread"]);
    for (name, world) in [("street", &*plan.world), ("street as one mesh", &flat)] {
        table.row(row(name, world));
    }
    table
}

fn row(name: &str, world: &World) -> Vec<String> {
    let triangles: usize = world.meshes().iter().map(|mesh| mesh.triangles().len()).sum();
    let build = RunStatistics::measure(|| build_s(world));
    let view = RunStatistics::measure(|| timed(|| std::hint::black_box(world.render_space(glam::DVec3::ZERO))).1);
    vec![
        name.to_owned(),
        triangles.to_string(),
        format!("{:.1}", build.median() * 1e3),
        format!("{:.2}", build.median() / triangles as f64 * 1e6),
        format!("{:.2}", view.median() * 1e3),
        build.spread_text(),
    ]
}

/// Processor time to build a world like `world`, s.
fn build_s(world: &World) -> f64 {
    let mut builder = WorldBuilder::new();
    for mesh in world.meshes() {
        builder.add_mesh(mesh.clone());
    }
    for instance in world.instances() {
        builder.add_instance(instance.clone());
    }
    pool(1).install(|| timed(|| std::hint::black_box(builder.build().expect("a legal world"))).1)
}
