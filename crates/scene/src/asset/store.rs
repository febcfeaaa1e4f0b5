//! The assets of a description, by path.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::mtl::SlotMaterial;
use super::{
    AssetKind, AssetRequest, CalibrationAsset, CalibrationChoice, ComplexIndexAsset, GlassCatalogueAsset, ImageAsset,
    LargeImage, LensQuantity, LensTableAsset, MeshAsset, MeshFrameAsset, NumbersAsset, PhotometryAsset,
    PointSpreadAsset, PrescriptionAsset, RayTransferAsset, ReplacedMaterials, RetroTableAsset, SpectrumAsset,
    TexelStore, TrajectoryAsset,
};
use crate::numbered_files::is_numbered;
use crate::place::Place;

/// Everything that was read for a description.
///
/// Filled by reading [`Assets::missing`] until nothing is missing: meshes can name images of their own.
#[derive(Clone, Debug, Default)]
pub struct Assets {
    /// Meshes by path.
    pub meshes: BTreeMap<PathBuf, MeshAsset>,
    /// Files of meshes with moving vertices, by path.
    pub mesh_frames: BTreeMap<PathBuf, MeshFrameAsset>,
    /// Images by path.
    pub images: BTreeMap<PathBuf, ImageAsset>,
    /// Images of textures that are too large for memory, by path.
    pub large_images: BTreeMap<PathBuf, LargeImage>,
    /// Storage of the texels of large images; `None` if there are none.
    pub texel_store: Option<TexelStore>,
    /// Spectra by path.
    pub spectra: BTreeMap<PathBuf, SpectrumAsset>,
    /// Measured lamps by path.
    pub photometry: BTreeMap<PathBuf, PhotometryAsset>,
    /// Refractive indices by path.
    pub indices: BTreeMap<PathBuf, ComplexIndexAsset>,
    /// Coefficients of retro-reflection by path.
    pub retro_tables: BTreeMap<PathBuf, RetroTableAsset>,
    /// Tables of numbers by path.
    pub numbers: BTreeMap<PathBuf, NumbersAsset>,
    /// Lenses by path and the glass catalogues that are searched first.
    pub prescriptions: BTreeMap<(PathBuf, Vec<PathBuf>), PrescriptionAsset>,
    /// Glass catalogues by path.
    pub glass_catalogues: BTreeMap<PathBuf, GlassCatalogueAsset>,
    /// Lenses given by their ray-transfer functions, by path.
    pub ray_transfers: BTreeMap<PathBuf, RayTransferAsset>,
    /// Trajectories by path.
    pub trajectories: BTreeMap<PathBuf, TrajectoryAsset>,
    /// Tables over the field by path and quantity.
    pub lens_tables: BTreeMap<(PathBuf, LensQuantity), LensTableAsset>,
    /// Point-spread functions of field points by path.
    pub point_spreads: BTreeMap<PathBuf, PointSpreadAsset>,
    /// Calibrated cameras by path and camera of the file.
    pub calibrations: BTreeMap<(PathBuf, CalibrationChoice), CalibrationAsset>,
}

impl Assets {
    /// Returns the files of `named`, and of meshes that were read, that are missing.
    #[must_use]
    pub fn missing(&self, named: &[AssetRequest]) -> Vec<AssetRequest> {
        let mut missing = named.to_vec();
        missing.extend(self.meshes.iter().flat_map(|(path, mesh)| textures_of(path, mesh, named)));
        missing.retain(|request| !self.has(&request.kind, &request.path));
        missing.sort_by(|a, b| a.path.cmp(&b.path));
        missing.dedup_by(|a, b| a.kind == b.kind && a.path == b.path);
        missing
    }

    /// Hashes of the content of a file (of numbered files: of each), and of the images that a mesh names, concatenated: equal where the contents are
    /// equal, at any path. Empty for a file that was not read, such as an unused mesh.
    #[must_use]
    pub fn hashes(&self, path: &Path) -> Vec<u8> {
        let Self {
            meshes,
            mesh_frames,
            images,
            large_images,
            texel_store: _,
            spectra,
            photometry,
            indices,
            retro_tables,
            numbers,
            prescriptions,
            glass_catalogues,
            ray_transfers,
            trajectories,
            lens_tables,
            point_spreads,
            calibrations,
        } = self;
        let is_match = |file: &Path| file == path || is_numbered(path, file);
        let meshes: Vec<&MeshAsset> = meshes.iter().filter(|(file, _)| is_match(file)).map(|(_, mesh)| mesh).collect();
        let image_files = meshes.iter().flat_map(|mesh| mesh.slot_materials.iter().flat_map(files));
        let image = |path: &Path| {
            images.get(path).map(|asset| asset.hash).or_else(|| large_images.get(path).map(|asset| asset.hash))
        };
        let mut hashes: Vec<[u8; 32]> = meshes.iter().map(|asset| asset.hash).collect();
        hashes.extend(mesh_frames.iter().filter(|(file, _)| is_match(file)).map(|(_, asset)| asset.hash));
        hashes.extend(image_files.chain([path]).filter_map(image));
        let layers = images.iter().filter(|(key, _)| is_layer_of(key, path));
        hashes.extend(layers.map(|(_, asset)| asset.hash));
        hashes.extend(spectra.get(path).map(|asset| asset.hash));
        hashes.extend(photometry.get(path).map(|asset| asset.hash));
        hashes.extend(indices.get(path).map(|asset| asset.hash));
        hashes.extend(retro_tables.get(path).map(|asset| asset.hash));
        hashes.extend(numbers.get(path).map(|asset| asset.hash));
        hashes.extend(prescriptions.iter().filter(|((file, _), _)| file == path).map(|(_, asset)| asset.hash));
        hashes.extend(glass_catalogues.get(path).map(|asset| asset.hash));
        hashes.extend(ray_transfers.get(path).map(|asset| asset.hash));
        hashes.extend(trajectories.get(path).map(|asset| asset.hash));
        hashes.extend(lens_tables.iter().filter(|((file, _), _)| file == path).map(|(_, asset)| asset.hash));
        hashes.extend(point_spreads.get(path).map(|asset| asset.hash));
        hashes.extend(calibrations.iter().filter(|((file, _), _)| file == path).map(|(_, asset)| asset.hash));
        hashes.concat()
    }

    fn has(&self, kind: &AssetKind, path: &Path) -> bool {
        match kind {
            AssetKind::Mesh => self.meshes.contains_key(path),
            AssetKind::MeshFrame => self.mesh_frames.contains_key(path),
            AssetKind::Image => self.images.contains_key(path),
            AssetKind::ImageLayer(layer) => self.images.contains_key(&layer_key(path, layer)),
            AssetKind::Texture => self.images.contains_key(path) || self.large_images.contains_key(path),
            AssetKind::Spectrum(_) => self.spectra.contains_key(path),
            AssetKind::Photometry => self.photometry.contains_key(path),
            AssetKind::ComplexIndex => self.indices.contains_key(path),
            AssetKind::RetroTable => self.retro_tables.contains_key(path),
            AssetKind::Numbers => self.numbers.contains_key(path),
            AssetKind::Prescription(glasses) => self.prescriptions.contains_key(&(path.to_owned(), glasses.clone())),
            AssetKind::GlassCatalogue => self.glass_catalogues.contains_key(path),
            AssetKind::RayTransfer => self.ray_transfers.contains_key(path),
            AssetKind::Trajectory => self.trajectories.contains_key(path),
            AssetKind::LensTable(quantity) => self.lens_tables.contains_key(&(path.to_owned(), *quantity)),
            AssetKind::PointSpread => self.point_spreads.contains_key(path),
            AssetKind::Calibration(choice) => self.calibrations.contains_key(&(path.to_owned(), choice.clone())),
        }
    }
}

/// Key of a layer of an image file in [`Assets::images`].
#[must_use]
pub fn layer_key(file: &Path, layer: &str) -> PathBuf {
    let mut key = file.as_os_str().to_owned();
    key.push(format!("{LAYER_MARK}{layer}"));
    key.into()
}

/// Text between the file and the layer in a key.
const LAYER_MARK: &str = "#layer ";

/// True if `key` is that of a layer of the file.
fn is_layer_of(key: &Path, file: &Path) -> bool {
    let (key, file) = (key.as_os_str().as_encoded_bytes(), file.as_os_str().as_encoded_bytes());
    key.strip_prefix(file).is_some_and(|rest| rest.starts_with(LAYER_MARK.as_bytes()))
}

/// Images of the visible materials of a mesh's file.
fn textures_of<'a>(
    file: &'a Path,
    mesh: &'a MeshAsset,
    named: &'a [AssetRequest],
) -> impl Iterator<Item = AssetRequest> + 'a {
    let requests = move || named.iter().filter(move |request| request.kind == AssetKind::Mesh && request.path == file);
    let is_requested = move |slot: &&SlotMaterial| requests().any(|request| !request.covered.has(&slot.name));
    let visible_slots =
        mesh.slot_materials.iter().zip(mesh.shown_slots()).filter_map(|(slot, is_visible)| is_visible.then_some(slot));
    visible_slots.filter(is_requested).flat_map(files).map(move |path| {
        let (path, place) = (path.to_owned(), Place::file_head(file));
        AssetRequest { path, kind: AssetKind::Texture, place, covered: ReplacedMaterials::All }
    })
}

/// Image files of a material of a mesh's file.
fn files(slot: &SlotMaterial) -> impl Iterator<Item = &Path> {
    slot.surface.iter().flat_map(|surface| surface.files()).map(PathBuf::as_path)
}

#[cfg(test)]
mod tests {
    use super::super::photometry::{Opening, OpeningShape, PhotometryAxes, Tilt};
    use super::super::{
        CalibrationFormat, FieldPoint, ImagePixels, LensNumbers, SlotReflectance, SlotSurface, SpectrumValues,
    };
    use super::*;
    use etendue_projection::model::Perspective;
    use etendue_projection::{Calibration, CameraMatrix, Model};
    use etendue_spectra::glass::agf::AgfCatalogue;

    /// Assets with the file "file" of such a hash.
    fn test_assets(kind: &AssetKind, hash: [u8; 32]) -> Assets {
        let (file, mut assets) = (PathBuf::from("file"), Assets::default());
        match kind {
            AssetKind::Mesh => drop(assets.meshes.insert(file, MeshAsset { hash, ..Default::default() })),
            AssetKind::MeshFrame => {
                drop(assets.mesh_frames.insert(file, MeshFrameAsset { hash, ..Default::default() }));
            }
            AssetKind::Image | AssetKind::Texture => drop(assets.images.insert(file, image(hash))),
            AssetKind::ImageLayer(layer) => drop(assets.images.insert(layer_key(&file, layer), image(hash))),
            AssetKind::Spectrum(_) => drop(assets.spectra.insert(file, SpectrumAsset { hash, ..Default::default() })),
            AssetKind::Photometry => drop(assets.photometry.insert(file, lamp(hash))),
            AssetKind::ComplexIndex => {
                drop(assets.indices.insert(file, ComplexIndexAsset { hash, ..Default::default() }));
            }
            AssetKind::RetroTable => {
                drop(assets.retro_tables.insert(file, RetroTableAsset { hash, ..Default::default() }));
            }
            AssetKind::Numbers => drop(assets.numbers.insert(file, NumbersAsset { hash, ..Default::default() })),
            AssetKind::Prescription(glasses) => {
                drop(assets.prescriptions.insert((file, glasses.clone()), lens(hash)));
            }
            AssetKind::GlassCatalogue => {
                let asset = GlassCatalogueAsset { file: file.clone(), catalogue: AgfCatalogue::default(), hash };
                drop(assets.glass_catalogues.insert(file, asset));
            }
            AssetKind::RayTransfer => {
                drop(assets.ray_transfers.insert(file, RayTransferAsset { hash, ..Default::default() }));
            }
            AssetKind::Trajectory => {
                drop(assets.trajectories.insert(file, TrajectoryAsset { hash, ..Default::default() }));
            }
            AssetKind::LensTable(quantity) => drop(assets.lens_tables.insert((file, *quantity), table(hash))),
            AssetKind::PointSpread => drop(assets.point_spreads.insert(file, point_spread(hash))),
            AssetKind::Calibration(choice) => {
                drop(assets.calibrations.insert((file, choice.clone()), camera(hash)));
            }
        }
        assets
    }

    fn image(hash: [u8; 32]) -> ImageAsset {
        ImageAsset { width: 1, height: 1, pixels: ImagePixels::Gray8(vec![0]), to_rec_709: None, hash }
    }

    fn lamp(hash: [u8; 32]) -> PhotometryAsset {
        PhotometryAsset {
            format: String::new(),
            axes: PhotometryAxes::C,
            vertical_deg: Vec::new(),
            horizontal_deg: Vec::new(),
            candela: Vec::new(),
            rated_lumens: None,
            output_ratio: None,
            lamps: 1,
            factor: 1.0,
            watts: 0.0,
            opening: Opening { shape: OpeningShape::Point, length_m: 0.0, width_m: 0.0, height_m: 0.0 },
            tilt: Tilt::None,
            texts: Vec::new(),
            report: Vec::new(),
            hash,
        }
    }

    fn lens(hash: [u8; 32]) -> PrescriptionAsset {
        PrescriptionAsset {
            title: String::new(),
            surfaces: Vec::new(),
            object_distance_mm: f64::INFINITY,
            back_focus_mm: 0.0,
            defocus_mm: 0.0,
            opening: None,
            opening_line: 0,
            fields: None,
            vignetting: [Vec::new(), Vec::new()],
            wavelengths_nm: Vec::new(),
            primary_nm: None,
            notes: Vec::new(),
            hash,
        }
    }

    fn point_spread(hash: [u8; 32]) -> PointSpreadAsset {
        PointSpreadAsset {
            field: FieldPoint::Degrees([0.0; 2]),
            place_mm: None,
            wavelengths_nm: [550.0; 2],
            spacing_um: 1.0,
            width: 1,
            light: vec![1.0],
            point: [0; 2],
            notes: Vec::new(),
            hash,
        }
    }

    fn table(hash: [u8; 32]) -> LensTableAsset {
        LensTableAsset { numbers: LensNumbers::Modulation, points: Vec::new(), notes: Vec::new(), hash }
    }

    fn camera(hash: [u8; 32]) -> CalibrationAsset {
        let matrix = CameraMatrix { fx: 1.0, fy: 1.0, skew: 0.0, cx: 0.5, cy: 0.5 };
        let model = Model::Perspective(Perspective::from_opencv(&[]).expect("no distortion"));
        let calibration = Calibration::new(model, matrix, [1, 1]).expect("legal");
        CalibrationAsset { calibration, states_size: true, report: Vec::new(), hash }
    }

    #[test]
    fn a_file_of_any_kind_has_the_hash_of_its_contents() {
        let choice = CalibrationChoice { format: CalibrationFormat::OpenCv, camera: None };
        let kinds = [
            AssetKind::Mesh,
            AssetKind::MeshFrame,
            AssetKind::Image,
            AssetKind::ImageLayer("a".to_owned()),
            AssetKind::Texture,
            AssetKind::Spectrum(SpectrumValues::Share),
            AssetKind::Photometry,
            AssetKind::ComplexIndex,
            AssetKind::RetroTable,
            AssetKind::Numbers,
            AssetKind::Prescription(Vec::new()),
            AssetKind::GlassCatalogue,
            AssetKind::RayTransfer,
            AssetKind::Trajectory,
            AssetKind::LensTable(LensQuantity::RelativeIllumination),
            AssetKind::PointSpread,
            AssetKind::Calibration(choice),
        ];
        for kind in kinds {
            for hash in [[1; 32], [2; 32]] {
                let assets = test_assets(&kind, hash);
                assert!(assets.has(&kind, Path::new("file")), "{kind:?}");
                assert_eq!(assets.hashes(Path::new("file")), hash, "{kind:?}");
            }
        }
    }

    #[test]
    fn numbered_files_have_the_hashes_of_each() {
        let frame = |number: u8| MeshFrameAsset { hash: [number; 32], ..Default::default() };
        let files = [("walk_0.obj", 1), ("walk_1.obj", 2), ("run_0.obj", 3)];
        let mesh_frames = files.map(|(file, number)| (PathBuf::from(file), frame(number))).into();
        let assets = Assets { mesh_frames, ..Assets::default() };
        assert_eq!(assets.hashes(Path::new("walk_%d.obj")), [[1; 32], [2; 32]].concat());
    }

    #[test]
    fn a_picture_that_a_mesh_names_belongs_to_the_mesh() {
        let surface = Some(SlotSurface::Diffuse { reflectance: SlotReflectance::Image("wood.png".into()) });
        let slot_materials = vec![SlotMaterial { name: "wood".to_owned(), surface }];
        let mesh = MeshAsset { slot_materials, hash: [1; 32], ..Default::default() };
        for image_hash in [[2; 32], [3; 32]] {
            let meshes = [("chair.obj".into(), mesh.clone())].into();
            let images = [("wood.png".into(), image(image_hash))].into();
            let assets = Assets { meshes, images, ..Default::default() };
            assert_eq!(assets.hashes(Path::new("chair.obj")), [[1; 32], image_hash].concat());
        }
    }
}
