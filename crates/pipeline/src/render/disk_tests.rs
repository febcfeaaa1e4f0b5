//! Films with bands in scratch files, compared with films in memory.

use super::film::Film;
use super::light::{RaySource, RenderError, RenderJob};
use super::observer::NullObserver;
use super::test_job::{sampling, still_job};
use crate::plan::{NumberedPass, Pass, Passes};
use crate::sizes::film::FilmLayout;
use crate::sizes::tile::Shard;
use etendue_core::random::Draw;
use etendue_core::storage::{Scratch, ScratchStore};
use etendue_core::{Bands, FieldRay, PupilRay, RadianceField, Spectral, Wavelengths};
use glam::{DVec2, DVec3};
use std::sync::{Arc, Mutex};

const SIZE: [u32; 2] = [37, 23];

/// Storage in memory, for tests; `Full` has no capacity.
#[derive(Debug)]
enum TestStore {
    Memory,
    Full,
}

#[derive(Debug)]
struct MemoryScratch(Mutex<Vec<u8>>);

impl ScratchStore for TestStore {
    fn room(&self, bytes: u64) -> Result<Arc<dyn Scratch>, String> {
        match self {
            Self::Memory => Ok(Arc::new(MemoryScratch(Mutex::new(vec![0; bytes as usize])))),
            Self::Full => Ok(Arc::new(FullScratch)),
        }
    }
}

impl Scratch for MemoryScratch {
    fn write(&self, offset: u64, bytes: &[u8]) -> Result<(), String> {
        self.0.lock().expect("whole")[offset as usize..][..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    fn read(&self, offset: u64, bytes: &mut [u8]) -> Result<(), String> {
        bytes.copy_from_slice(&self.0.lock().expect("whole")[offset as usize..][..bytes.len()]);
        Ok(())
    }
}

#[derive(Debug)]
struct FullScratch;

impl Scratch for FullScratch {
    fn write(&self, _: u64, _: &[u8]) -> Result<(), String> {
        Err("no room".to_owned())
    }

    fn read(&self, _: u64, _: &mut [u8]) -> Result<(), String> {
        Err("nothing".to_owned())
    }
}

struct ForwardRays;

impl RaySource for ForwardRays {
    fn ray(&self, raster_px: DVec2, _: DVec2, _: f64) -> Option<PupilRay> {
        let ray = PupilRay { origin_m: DVec3::ZERO, direction: DVec3::Z, weight_sr: 0.25 };
        (raster_px.x > 2.0).then_some(ray)
    }
}

/// Light that varies from sample to sample.
struct NoisyField;

impl RadianceField<4> for NoisyField {
    fn radiance(&self, field_ray: &FieldRay, _: &Wavelengths<4>) -> Spectral<4> {
        Spectral::splat(field_ray.stream.one(Draw::Pupil, 0))
    }
}

fn gather_film(
    store: Option<TestStore>,
    (pass, replicates): (NumberedPass, u32),
    shard: Shard,
    before: Option<&Film>,
) -> Result<Film, RenderError> {
    let layout =
        FilmLayout { bands: Bands::covering(400.0, 700.0, 50.0), accumulates_electrons: false, watched: false };
    let store: Option<Arc<dyn ScratchStore>> = store.map(|store| -> Arc<dyn ScratchStore> { Arc::new(store) });
    let job = still_job(&ForwardRays, SIZE, layout, sampling(pass, replicates));
    RenderJob { shard, scratch: store.as_ref(), ..job }.gather::<4>(&NoisyField, before, &NullObserver)
}

/// Bits of all bands, with rows requested in strips that match no tile.
fn bits(film: &Film) -> Vec<u32> {
    let (bands, readers) = film.bands().expect("bands");
    let [width, height] = SIZE.map(|side| side as usize);
    let mut all = Vec::new();
    for reader in readers {
        for band in 0..bands.count() {
            for first in (0..height).step_by(5) {
                let rows = first..(first + 5).min(height);
                let mut samples = vec![0.0_f32; width * rows.len()];
                reader.read(band, rows, &mut samples).expect("read");
                all.extend(samples.into_iter().map(f32::to_bits));
            }
        }
    }
    all
}

#[test]
fn a_film_on_the_disk_has_the_bits_of_one_in_memory() {
    let third = Shard::new(1, 3).expect("a shard");
    for (replicates, shard) in [(4, Shard::WHOLE), (1, Shard::WHOLE), (1, third), (2, third)] {
        let passes = Passes::new(vec![Pass::all_pixels(8), Pass { samples: 4, part: 64 }, Pass::all_pixels(4)]);
        let (mut on_disk, mut in_memory) = (None, None);
        for number in 0..3 {
            let pass = (passes.at(number), replicates);
            on_disk = Some(gather_film(None, pass, shard, on_disk.as_ref()).expect("in memory"));
            in_memory = Some(gather_film(Some(TestStore::Memory), pass, shard, in_memory.as_ref()).expect("room"));
            let [on_disk, in_memory] = [&on_disk, &in_memory].map(|film| film.as_ref().expect("just gathered"));
            assert!(on_disk.disk().is_none() && in_memory.cube().is_none());
            assert_eq!(bits(in_memory), bits(on_disk), "{replicates} replicates, pass {number}");
            assert_eq!((&in_memory.weight, &in_memory.samples), (&on_disk.weight, &on_disk.samples));
        }
    }
}

#[test]
fn a_pass_leaves_the_film_before_as_it_is_and_joins_one_in_memory() {
    let passes = Passes::new(vec![Pass::all_pixels(8), Pass::all_pixels(8)]);
    let [first, second] = [0, 1].map(|number| (passes.at(number), 2));
    let of_first = |room| gather_film(room, first, Shard::WHOLE, None).expect("room");
    let (on_disk, in_memory) = (of_first(None), of_first(Some(TestStore::Memory)));
    let merged_film = |room, before| bits(&gather_film(room, second, Shard::WHOLE, Some(before)).expect("room"));
    let both = merged_film(None, &on_disk);
    assert_eq!(merged_film(Some(TestStore::Memory), &in_memory), both);
    assert_eq!(merged_film(Some(TestStore::Memory), &on_disk), both, "of a film that was read into memory");
    assert_eq!(bits(&in_memory), bits(&on_disk), "the film before");
}

#[test]
fn a_disk_that_is_full_ends_the_rendering() {
    let failed =
        gather_film(Some(TestStore::Full), (NumberedPass::only(4), 1), Shard::WHOLE, None).expect_err("no room");
    assert_eq!(failed, RenderError::Scratch("no room".to_owned()));
}
