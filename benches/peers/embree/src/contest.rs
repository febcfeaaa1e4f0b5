//! Rays a second, theirs and ours in turns.

use crate::embree::{DEFAULT, Embree, HIGH, Mode, ROBUST, ROBUST_HIGH, Scene};
use crate::flush;
use etendue_bench_rays::clock::timed;
use etendue_bench_rays::questions::RayQueries;
use etendue_bench_rays::runs::Runs;
use etendue_bench_rays::table::Table;
use etendue_core::TimeInterval;
use etendue_tracer::accel::{Simd, World};
use etendue_tracer::geometry::Mesh;
use etendue_tracer::render_space::RenderSpace;
use glam::DVec3;
use std::hint::black_box;

/// Turns of everybody.
const TURNS: usize = 9;
/// Embree's modes, the default first.
const MODES: [(&str, Mode); 4] =
    [("Embree", DEFAULT), ("robust", ROBUST), ("high quality", HIGH), ("robust, high quality", ROBUST_HIGH)];
/// Distances that differ by less than this, relatively, agree.
const AGREES: f32 = 1e-4;

/// A mesh with rays to ask.
pub struct Contest {
    /// Its name.
    pub name: &'static str,
    /// A world of the mesh alone, in the render frame.
    pub world: World,
    /// What is asked.
    pub questions: Vec<RayQueries>,
}

/// Rates of one kind of ray.
struct Rates {
    ours: Runs,
    scalar: Runs,
    theirs: Vec<Runs>,
}

/// Whether some kind of ray counts for the mean: shadow rays to the sky are shown only.
fn counts(queries: &RayQueries) -> bool {
    queries.name != "shadow, sky"
}

impl Contest {
    fn mesh(&self) -> &Mesh {
        &self.world.meshes()[0]
    }
}

/// The rates, and the geometric means of the ratios.
pub fn rates(embree: &Embree, contests: &[Contest]) -> Table {
    let head =
        ["ray", "thousands", "ours", "Embree", "ratio", "robust", "ratio", "high quality", "robust, high quality"];
    let note = "Millions a second of one thread, ray by ray; medians of nine turns. Ratio: ours over Embree's \
        in the column before, default quality, the median of the turns' ratios. The columns after are Embree's other modes.";
    let mut table = Table::new("Rays beside Embree", note, &[&head[..], &["ours, scalar", "spread"]].concat());
    let mut logs = [0.0; 2];
    let mut count = 0;
    for contest in contests {
        for (queries, rates) in contest.questions.iter().zip(contest_rates(embree, contest)) {
            table.row(row(contest.name, queries, &rates));
            if counts(queries) {
                logs[0] += rates.ratio(0).ln();
                logs[1] += rates.ratio(1).ln();
                count += 1;
            }
        }
    }
    let mean = |log: f64| format!("**{:.3}**", (log / f64::from(count)).exp());
    let mut last = vec![format!("**geometric mean** of the ratios of {count} sets, without the sky")];
    last.extend(["", "", "", &mean(logs[0]), "", &mean(logs[1]), "", "", "", ""].map(str::to_owned));
    table.row(last);
    table
}

impl Rates {
    /// Ours over theirs in a mode.
    fn ratio(&self, mode: usize) -> f64 {
        self.ours.over(&self.theirs[mode]).median()
    }
}

fn contest_rates(embree: &Embree, contest: &Contest) -> Vec<Rates> {
    let ours = contest.world.render_space(DVec3::ZERO);
    let scalar = contest.world.render_space_with(DVec3::ZERO, TimeInterval::default(), Simd::Scalar);
    let theirs: Vec<Scene<'_>> = MODES.iter().map(|(_, mode)| embree.scene(contest.mesh(), *mode)).collect();
    let new = |_: &RayQueries| Rates {
        ours: Runs::default(),
        scalar: Runs::default(),
        theirs: vec![Runs::default(); theirs.len()],
    };
    let mut rates: Vec<Rates> = contest.questions.iter().map(new).collect();
    for turn in 0..TURNS {
        for (queries, rates) in contest.questions.iter().zip(&mut rates) {
            rates.ours.add(our_rate(queries, &ours));
            theirs.iter().zip(&mut rates.theirs).for_each(|(scene, runs)| runs.add(their_rate(queries, scene)));
            if turn % 4 == 0 {
                rates.scalar.add(our_rate(queries, &scalar));
            }
        }
    }
    rates
}

fn our_rate(queries: &RayQueries, view: &RenderSpace<'_>) -> f64 {
    let (_, seconds) = timed(|| black_box(queries.count_hits(view)));
    queries.rays.len() as f64 / seconds / 1e6
}

fn their_rate(queries: &RayQueries, scene: &Scene<'_>) -> f64 {
    let (_, seconds) = flush::to_zero(|| timed(|| black_box(count_hits(queries, scene))));
    queries.rays.len() as f64 / seconds / 1e6
}

/// Asks Embree all of them; the number of rays that met something.
fn count_hits(queries: &RayQueries, scene: &Scene<'_>) -> usize {
    match queries.any_hit {
        true => queries.rays.iter().filter(|ray| scene.occluded(ray)).count(),
        false => queries.rays.iter().filter(|ray| scene.closest(ray).is_some()).count(),
    }
}

fn row(name: &str, queries: &RayQueries, rates: &Rates) -> Vec<String> {
    let mut cells = vec![format!("{name}: {}", queries.name), format!("{:.0}", queries.rays.len() as f64 / 1e3)];
    let rate = |runs: &Runs| format!("{:.2}", runs.median());
    cells.push(rate(&rates.ours));
    (0..2).for_each(|mode| cells.extend([rate(&rates.theirs[mode]), format!("{:.3}", rates.ratio(mode))]));
    cells.extend(rates.theirs[2..].iter().map(rate));
    cells.extend([rate(&rates.scalar), rates.ours.spread_text()]);
    cells
}

/// How far both agree on what is met.
pub fn agreement(embree: &Embree, contests: &[Contest]) -> Table {
    let note = "Shares of rays on which the two answer differently: whether something is met, by which triangle \
        (neighbours share edges, where either is right), at which distance (by more than 1e-4 of it).";
    let head = ["ray", "mode", "met or not", "triangle", "distance"];
    let mut table = Table::new("Agreement", note, &head);
    for contest in contests {
        let ours = contest.world.render_space(DVec3::ZERO);
        for (mode, scene) in MODES.map(|(name, mode)| (name, embree.scene(contest.mesh(), mode))).iter().take(2) {
            for queries in &contest.questions {
                table.row(disagreement(contest.name, mode, queries, &ours, scene));
            }
        }
    }
    table
}

fn disagreement(
    name: &str,
    mode: &str,
    queries: &RayQueries,
    ours: &RenderSpace<'_>,
    theirs: &Scene<'_>,
) -> Vec<String> {
    let (mut hits, mut triangle, mut distance) = (0, 0, 0);
    for ray in &queries.rays {
        if queries.any_hit {
            hits += usize::from(ours.occluded(ray) != theirs.occluded(ray));
            continue;
        }
        match (ours.closest(ray), theirs.closest(ray)) {
            (Some(a), Some(b)) => {
                triangle += usize::from(a.primitive != b.primitive);
                distance += usize::from((a.t - b.t).abs() > AGREES * a.t);
            }
            (None, None) => {}
            _ => hits += 1,
        }
    }
    let fraction = |count: usize| format!("{:.1e}", count as f64 / queries.rays.len() as f64);
    let closest = |count| if queries.any_hit { String::new() } else { fraction(count) };
    vec![format!("{name}: {}", queries.name), mode.to_owned(), fraction(hits), closest(triangle), closest(distance)]
}
