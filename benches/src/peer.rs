//! One rendering for the comparison with other renderers (`benches/peers`): a job's light, the processor time that it
//! took, and the electrons of every pixel.
//!
//! `etendue-benches --peer JOB.toml OUT.f32 SPP THREADS SEED…` renders the first camera once for each seed, after a
//! small rendering that warms caches; the electrons of seed n go to `OUT.f32` with `n` in place of a `%`, row by row as
//! little-endian f32. Each line of the standard output has a seed and the seconds of all threads, user and system
//! together; the first, after a `#`, the instruction set of the accelerator. Reading files and compiling the scene, its tree of boxes included, are not in them; placing the world
//! about the camera and collecting the lights are.

use crate::scenes::{camera, plan_of};
use etendue_bench_rays::clock::cpu_s;
use etendue_bench_rays::machine;
use etendue_bench_rays::threads::pool;
use etendue_pipeline::film::Film;
use etendue_pipeline::render::{LightRequest, light};
use etendue_pipeline::{NullObserver, Plan};
use rayon::ThreadPool;
use std::path::Path;

/// The argument that asks for such a rendering.
pub const FLAG: &str = "--peer";

const USAGE: &str = "expected JOB.toml OUT.f32 SPP THREADS SEED…, numbers of 0 or more";

/// What is asked for.
struct PeerRequest<'a> {
    plan: Plan,
    pool: ThreadPool,
    out: &'a str,
}

/// Renders what the arguments after the flag say; each answer is a line to print.
///
/// # Errors
/// A sentence where the arguments are no such order, the job folds no electrons or a file cannot be written.
pub fn rendered(arguments: &[String]) -> Result<Vec<String>, String> {
    let [job, out, spp, threads, seeds @ ..] = arguments else { return Err(USAGE.to_owned()) };
    let mut order = PeerRequest { plan: plan_of(Path::new(job)), pool: pool(number(threads)?), out };
    order.render(1, 0);
    let spp = number(spp)?;
    let kernels = std::iter::once(Ok(format!("# {}", machine::our_set())));
    kernels.chain(seeds.iter().map(|seed| order.line(spp, number(seed)?))).collect()
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| USAGE.to_owned())
}

impl PeerRequest<'_> {
    fn line(&mut self, spp: u32, seed: u64) -> Result<String, String> {
        let (film, seconds) = self.render(spp, seed);
        let sensor = camera(&self.plan).body.sensor.as_ref();
        let exposed = film.electron_rate.zip(sensor).map(|(r, s)| r.electrons(s.parameters().exposure.exposure_s));
        let electrons = exposed.ok_or("the job folds no electrons; give its camera a sensor")?;
        let bytes: Vec<u8> = electrons.mean.samples().iter().flat_map(|value| value.to_le_bytes()).collect();
        let path = self.out.replace('%', &seed.to_string());
        std::fs::write(&path, bytes).map_err(|error| format!("{path}: {error}"))?;
        Ok(format!("{seed} {seconds}"))
    }

    /// The film, and the processor time of all threads, s.
    fn render(&mut self, spp: u32, seed: u64) -> (Film, f64) {
        let settings = &mut self.plan.cameras[0].settings;
        (settings.spp, settings.seed) = (spp, seed);
        let before = self.pool.broadcast(|_| cpu_s());
        let film = self.pool.install(|| light(&self.plan, camera(&self.plan), LightRequest::default(), &NullObserver));
        let after = self.pool.broadcast(|_| cpu_s());
        let seconds = after.iter().zip(&before).map(|(after, before)| after - before).sum();
        (film.expect("nobody cancels"), seconds)
    }
}
