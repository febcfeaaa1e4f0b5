//! Assets: all files that a description names.

use std::{path::PathBuf, sync::Arc};

use etendue_scene::asset::{AssetKind, AssetRequest, Assets, CalibrationAsset, TexelStore, layer_key};

use crate::calibration::{ImportedCamera, read_calibration};
use crate::lens_table::{read_lens_table, read_point_spread};
use crate::mesh::{read_mesh_frame, read_mesh_in};
use crate::picture::{ImageHead, head, large_image, read_image, read_image_layer};
use crate::table::{read_complex_index, read_numbers, read_retro_table};
use crate::texture_memory::{TextureMemory, pyramid_bytes};
use crate::{
    Error, Sandbox,
    photometry::read_photometry_in,
    prescription::{read_glass_catalogue, read_prescription_with},
    ray_transfer::read_ray_transfer,
    spectrum::read_spectrum_of,
    tile_cache::TileCache,
    trajectory::read_trajectory,
};

/// Reads every file of `named` (as a description names them) and the files that its meshes name in turn. All images are decoded completely.
///
/// # Errors
/// All errors of all files, each with the place that names the file.
pub fn load_assets(named: &[AssetRequest]) -> Result<Assets, Vec<Error>> {
    complete_assets(
        Assets::default(),
        named,
        &TextureMemory { limit_bytes: u64::MAX, ..TextureMemory::default() },
        &Sandbox::NONE,
    )
}

/// Reads the assets that are missing from an existing set, such as that of a program. Textures that need more than `memory` are not decoded but become
/// [large](Assets::large_images). Every file must lie in `sandbox`.
///
/// # Errors
/// All errors of all files, each with the place that names the file.
pub fn complete_assets(
    mut assets: Assets,
    named: &[AssetRequest],
    memory: &TextureMemory,
    sandbox: &Sandbox,
) -> Result<Assets, Vec<Error>> {
    let mut errors = Vec::new();
    let mut tried: Vec<AssetRequest> = Vec::new();
    loop {
        let mut requests = assets.missing(named);
        requests.retain(|request| !tried.iter().any(|t| t.kind == request.kind && t.path == request.path));
        if requests.is_empty() {
            break;
        }
        // Files outside the sandbox are not opened.
        let mut inside = Vec::new();
        for request in requests {
            match sandbox.check(&request.path) {
                Ok(()) => inside.push(request),
                Err(problem) => {
                    errors.push(Error::new(&request.path, problem).named_by(&request.place));
                    tried.push(request);
                }
            }
        }
        // Large textures are known only after all textures are: meshes name more of them.
        let (textures, others): (Vec<_>, Vec<_>) = inside.into_iter().partition(|r| r.kind == AssetKind::Texture);
        let now = if others.is_empty() { textures } else { others };
        let large = load_large_images(&mut assets, &now, memory);
        for (request, large) in now.into_iter().zip(large) {
            let loaded = match large {
                Some(head) => load_large(&mut assets, &request, head),
                None => load(&mut assets, &request, sandbox),
            };
            if let Err(error) = loaded {
                errors.push(error.named_by(&request.place));
            }
            tried.push(request);
        }
    }
    if errors.is_empty() { Ok(assets) } else { Err(errors) }
}

/// Headers of the textures among `requests` that are too large for memory. If there are any, the assets receive a place for their texels.
fn load_large_images(assets: &mut Assets, requests: &[AssetRequest], memory: &TextureMemory) -> Vec<Option<ImageHead>> {
    // An image with an unreadable header is read as a small one, which gives the error.
    let is_texture = |request: &&AssetRequest| request.kind == AssetKind::Texture;
    let heads: Vec<_> =
        requests.iter().map(|request| Some(request).filter(is_texture).and_then(|r| head(&r.path))).collect();
    let bytes: Vec<u64> =
        heads.iter().map(|head| head.map_or(0, |head| pyramid_bytes(head.width, head.height, head.format))).collect();
    let large = memory.large(&bytes);
    if large.contains(&true) {
        let held: u64 = bytes.iter().zip(&large).filter(|(_, is_large)| !**is_large).map(|(bytes, _)| bytes).sum();
        let blocks = Arc::new(TileCache::new(memory.cache.as_deref(), memory.cache_use));
        assets.texel_store = Some(TexelStore { blocks, memory_bytes: memory.limit_bytes - held });
    }
    heads.into_iter().zip(large).map(|(head, is_large)| head.filter(|_| is_large)).collect()
}

fn load_large(assets: &mut Assets, request: &AssetRequest, head: ImageHead) -> Result<(), Error> {
    let image = large_image(&request.path, head)?;
    assets.large_images.insert(request.path.clone(), image);
    Ok(())
}

fn load(assets: &mut Assets, request: &AssetRequest, sandbox: &Sandbox) -> Result<(), Error> {
    let (path, key) = (&request.path, request.path.clone());
    match &request.kind {
        AssetKind::Mesh => {
            let mut mesh = read_mesh_in(path, sandbox)?;
            assets.images.extend(mesh.embedded_images.drain(..));
            assets.meshes.insert(key, mesh);
        }
        AssetKind::MeshFrame => drop(assets.mesh_frames.insert(key, read_mesh_frame(path)?)),
        AssetKind::Image | AssetKind::Texture => drop(assets.images.insert(key, read_image(path)?)),
        AssetKind::ImageLayer(layer) => {
            let image = read_image_layer(path, layer)?;
            assets.images.insert(layer_key(path, layer), image);
        }
        AssetKind::Spectrum(values) => drop(assets.spectra.insert(key, read_spectrum_of(path, *values)?)),
        AssetKind::Photometry => drop(assets.photometry.insert(key, read_photometry_in(path, sandbox)?)),
        AssetKind::ComplexIndex => drop(assets.indices.insert(key, read_complex_index(path)?)),
        AssetKind::RetroTable => drop(assets.retro_tables.insert(key, read_retro_table(path)?)),
        AssetKind::Numbers => drop(assets.numbers.insert(key, read_numbers(path)?)),
        AssetKind::Prescription(glasses) => {
            let inside = |file: &PathBuf| sandbox.check(file).map_err(|problem| Error::new(file, problem));
            glasses.iter().try_for_each(inside)?;
            let catalogues = glasses.iter().map(|file| read_glass_catalogue(file)).collect::<Result<Vec<_>, _>>()?;
            let lens = read_prescription_with(path, &catalogues)?;
            drop(assets.prescriptions.insert((key, glasses.clone()), lens));
        }
        AssetKind::GlassCatalogue => drop(assets.glass_catalogues.insert(key, read_glass_catalogue(path)?)),
        AssetKind::RayTransfer => drop(assets.ray_transfers.insert(key, read_ray_transfer(path)?)),
        AssetKind::Trajectory => drop(assets.trajectories.insert(key, read_trajectory(path)?)),
        AssetKind::LensTable(quantity) => {
            drop(assets.lens_tables.insert((key, *quantity), read_lens_table(path, *quantity)?));
        }
        AssetKind::PointSpread => drop(assets.point_spreads.insert(key, read_point_spread(path)?)),
        AssetKind::Calibration(choice) => {
            let camera = read_calibration(path, choice.format, choice.camera.as_deref())?;
            let ImportedCamera { calibration, states_size, notes: report, hash, .. } = camera;
            let asset = CalibrationAsset { calibration, states_size, report, hash };
            assets.calibrations.insert((key, choice.clone()), asset);
        }
    }
    Ok(())
}
