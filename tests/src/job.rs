//! A job as text, with the contents of the files that it names.

use crate::Shot;
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::asset::{
    Assets, ImageAsset, ImagePixels, MeshAsset, MeshFrameAsset, MeshFramePart, PhotometryAsset, PrescriptionAsset,
    RetroTableAsset, SlotMaterial, SpectrumAsset,
};
use etendue_scene::{Description, Overrides};
use std::path::Path;

/// A job as text, with the contents of the files that it names.
#[derive(Clone, Debug)]
pub struct Job {
    text: String,
    assets: Assets,
    seed: u64,
}

impl Job {
    /// A job of this text, without its head (`format = 1`).
    #[must_use]
    pub fn new(text: impl AsRef<str>) -> Self {
        Self { text: format!("format = 1\n{}", text.as_ref()), assets: Assets::default(), seed: 1 }
    }

    /// With other words in place of some of the text.
    ///
    /// # Panics
    /// Where the text does not hold them.
    #[must_use]
    pub fn replaced(mut self, words: &str, by: &str) -> Self {
        assert!(self.text.contains(words), "the job does not say {words}");
        self.text = self.text.replace(words, by);
        self
    }

    /// With a spectrum file of these points.
    #[must_use]
    pub fn with_spectrum(mut self, path: &str, points: &[(f64, f64)]) -> Self {
        let asset = SpectrumAsset { points: points.to_vec(), hash: [0; 32] };
        self.assets.spectra.insert(path.into(), asset);
        self
    }

    /// With a picture file of linear numbers, first row on top.
    #[must_use]
    pub fn with_image(mut self, path: &str, width: u32, height: u32, rgb: Vec<[f32; 3]>) -> Self {
        let asset = ImageAsset { width, height, pixels: ImagePixels::Rgb32F(rgb), to_rec_709: None, hash: [0; 32] };
        self.assets.images.insert(path.into(), asset);
        self
    }

    /// With a mesh file.
    #[must_use]
    pub fn with_mesh(mut self, path: &str, mesh: MeshAsset) -> Self {
        self.assets.meshes.insert(path.into(), mesh);
        self
    }

    /// With a mesh file of these vertices and triangles, without normals, of one material without a name; it may be one of the
    /// numbered files of a mesh whose vertices move.
    #[must_use]
    pub fn with_triangles(mut self, path: &str, positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Self {
        let slot = SlotMaterial { name: String::new(), surface: None };
        let mesh = MeshAsset {
            positions: positions.iter().map(|p| p.map(|x| x as f32)).collect(),
            triangles: triangles.to_vec(),
            slots: vec![0; triangles.len()],
            slot_materials: vec![slot],
            ..MeshAsset::default()
        };
        let part = MeshFramePart {
            arities: vec![3; triangles.len()],
            vertices: triangles.as_flattened().to_vec(),
            positions: positions.to_vec(),
            ..MeshFramePart::default()
        };
        let corners = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let frame = MeshFrameAsset { parts: vec![part], vertices: positions.len(), triangles: corners, hash: [0; 32] };
        self.assets.mesh_frames.insert(path.into(), frame);
        self.with_mesh(path, mesh)
    }

    /// With a lens file.
    #[must_use]
    pub fn with_lens_file(mut self, path: &str, lens: PrescriptionAsset) -> Self {
        self.assets.prescriptions.insert((path.into(), Vec::new()), lens);
        self
    }

    /// With a lamp file.
    #[must_use]
    pub fn with_lamp(mut self, path: &str, lamp: PhotometryAsset) -> Self {
        self.assets.photometry.insert(path.into(), lamp);
        self
    }

    /// With a table of coefficients of retro-reflection.
    #[must_use]
    pub fn with_retro_table(mut self, path: &str, table: RetroTableAsset) -> Self {
        self.assets.retro_tables.insert(path.into(), table);
        self
    }

    /// With `new` in place of `old` in the text.
    ///
    /// # Panics
    /// Where `old` does not stand there.
    #[must_use]
    pub fn replacing(mut self, old: &str, new: &str) -> Self {
        assert!(self.text.contains(old), "there is no {old:?} in\n{}", self.text);
        self.text = self.text.replace(old, new);
        self
    }

    /// With another seed than 1.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// The plan.
    ///
    /// # Panics
    /// Where the text is not a good job, with all faults.
    #[must_use]
    pub fn plan(&self) -> Plan {
        self.compiled().unwrap_or_else(|errors| panic!("{errors}\n{}", self.text))
    }

    /// The plan, or all faults, one a line.
    ///
    /// # Errors
    /// Where the text is not a good job.
    pub fn compiled(&self) -> Result<Plan, String> {
        let read = |_: &Path| Ok(self.text.clone());
        let mut overrides = Overrides::default();
        overrides.add_render(&format!("--seed {}", self.seed), "seed", &self.seed.to_string());
        let description = Description::load(Path::new("job.toml"), &read, &overrides).map_err(|f| f.to_string())?;
        compile(&description, &self.assets, &Choices::default())
            .map_err(|errors| errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    }

    /// The light of the first camera.
    ///
    /// # Panics
    /// As [`Job::plan`].
    #[must_use]
    pub fn shot(&self) -> Shot {
        Shot::render(self.plan())
    }

    /// The light of every camera.
    ///
    /// # Panics
    /// As [`Job::plan`].
    #[must_use]
    pub fn shots(&self) -> Vec<Shot> {
        let plan = self.plan();
        (0..plan.cameras.len()).map(|i| Shot::render_camera(plan.clone(), i)).collect()
    }
}
