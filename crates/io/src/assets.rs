//! Everything that a description names.

use etendue_scene::asset::{AssetKind, AssetRequest, Assets, CalibrationAsset};

use crate::Error;
use crate::calibration::{ImportedCamera, read_calibration};
use crate::mesh::{read_mesh, read_mesh_frame};
use crate::photometry::read_photometry;
use crate::picture::read_picture;
use crate::prescription::read_prescription;
use crate::spectrum::read_spectrum_of;
use crate::table::{read_complex_index, read_numbers, read_retro_table};
use crate::trajectory::read_trajectory;

/// Reads every file of `named` (as a description names them), and those that its meshes name in turn.
///
/// # Errors
/// All faults of all files, each with the place that names the file.
pub fn load_assets(named: &[AssetRequest]) -> Result<Assets, Vec<Error>> {
    complete_assets(Assets::default(), named)
}

/// The same where some assets are there already, such as those a program made.
///
/// # Errors
/// All faults of all files, each with the place that names the file.
pub fn complete_assets(mut assets: Assets, named: &[AssetRequest]) -> Result<Assets, Vec<Error>> {
    let mut errors = Vec::new();
    let mut tried: Vec<AssetRequest> = Vec::new();
    loop {
        let mut requests = assets.missing(named);
        requests.retain(|request| !tried.iter().any(|t| t.kind == request.kind && t.path == request.path));
        if requests.is_empty() {
            break;
        }
        for request in requests {
            if let Err(error) = load(&mut assets, &request) {
                errors.push(error.named_at(request.place.to_string()));
            }
            tried.push(request);
        }
    }
    if errors.is_empty() { Ok(assets) } else { Err(errors) }
}

fn load(assets: &mut Assets, request: &AssetRequest) -> Result<(), Error> {
    let (path, key) = (&request.path, request.path.clone());
    match &request.kind {
        AssetKind::Mesh => drop(assets.meshes.insert(key, read_mesh(path)?)),
        AssetKind::MeshFrame => drop(assets.mesh_frames.insert(key, read_mesh_frame(path)?)),
        AssetKind::Image => drop(assets.images.insert(key, read_picture(path)?)),
        AssetKind::Spectrum(values) => drop(assets.spectra.insert(key, read_spectrum_of(path, *values)?)),
        AssetKind::Photometry => drop(assets.photometry.insert(key, read_photometry(path)?)),
        AssetKind::ComplexIndex => drop(assets.indices.insert(key, read_complex_index(path)?)),
        AssetKind::RetroTable => drop(assets.retro_tables.insert(key, read_retro_table(path)?)),
        AssetKind::Numbers => drop(assets.numbers.insert(key, read_numbers(path)?)),
        AssetKind::Prescription => drop(assets.prescriptions.insert(key, read_prescription(path)?)),
        AssetKind::Trajectory => drop(assets.trajectories.insert(key, read_trajectory(path)?)),
        AssetKind::Calibration(choice) => {
            let camera = read_calibration(path, choice.format, choice.camera.as_deref())?;
            let ImportedCamera { calibration, notes: report, hash, .. } = camera;
            assets.calibrations.insert((key, choice.clone()), CalibrationAsset { calibration, report, hash });
        }
    }
    Ok(())
}
