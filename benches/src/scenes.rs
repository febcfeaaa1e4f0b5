//! The scenes that ship with the project, as plans.

use etendue_io::{Sandbox, TextureMemory, complete_assets};
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::{Choices, Plan, compile};
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides, Problem, ReadText};
use std::path::{Path, PathBuf};

/// A scene, and how it is measured.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// Its name: that of its folder and of its job.
    pub name: &'static str,
    /// What makes its picture small: a third of the street's columns and rows, with the same field of view.
    small: &'static [&'static str],
    /// Samples a pixel of the small picture.
    pub spp: u32,
}

/// The street.
pub const STREET: Scene = Scene {
    name: "street",
    small: &["cameras.0.sensor.width_px=320", "cameras.0.sensor.height_px=200", "cameras.0.sensor.pixel_pitch_um=18"],
    spp: 16,
};

/// All scenes.
pub const ALL: [Scene; 4] = [
    STREET,
    Scene { name: "cornell", small: &[], spp: 8 },
    Scene { name: "furnace", small: &[], spp: 16 },
    Scene { name: "sphere-on-plane", small: &[], spp: 16 },
];

impl Scene {
    /// The scene of a name. Panics where there is none.
    pub fn named(name: &str) -> Self {
        *ALL.iter().find(|scene| scene.name == name).expect("a scene of the list")
    }

    /// The plan of the scene as it is.
    pub fn plan(&self) -> Plan {
        self.planned(&[], self.spp)
    }

    /// The plan of a small picture.
    pub fn small_plan(&self) -> Plan {
        self.planned(self.small, self.spp)
    }

    /// The plan of the scene's own picture, with one sample a pixel.
    pub fn thin_plan(&self) -> Plan {
        self.planned(&["render.replicates=1"], 1)
    }

    /// The plan of its job with another scene, given as text; files that it names are looked for beside the job.
    pub fn with_scene(&self, scene: &str, changes: &[&str]) -> Plan {
        const OTHER: &str = "other-scene.toml";
        let named = format!("scene={OTHER}");
        let changes: Vec<&str> = changes.iter().copied().chain([named.as_str()]).collect();
        let read = |path: &Path| if path.ends_with(OTHER) { Ok(scene.to_owned()) } else { read(path) };
        compiled(&self.job(), &read, &Overrides::new(changes))
    }

    fn planned(&self, changes: &[&str], spp: u32) -> Plan {
        let mut overrides = Overrides::new(changes);
        overrides.add_render(&format!("`spp` {spp}"), "spp", &spp.to_string());
        compiled(&self.job(), &read, &overrides)
    }

    fn job(&self) -> PathBuf {
        scenes().join(self.name).join(format!("{}.toml", self.name))
    }
}

/// The plan of a job that ships, named as `scenes/` has it, with changes. Panics where it cannot be used.
pub fn shipped(job: &str, changes: &[&str]) -> Plan {
    compiled(&scenes().join(job), &read, &Overrides::new(changes))
}

/// The text of a file of `scenes/`. Panics where it cannot be read.
pub fn text_of(file: &str) -> String {
    read(&scenes().join(file)).unwrap_or_else(|error| panic!("{error}"))
}

fn scenes() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("benches/ lies in the workspace");
    root.join("scenes")
}

/// The plan of a job file. Panics where the file or what it names cannot be used.
pub fn plan_of(job: &Path) -> Plan {
    compiled(job, &read, &Overrides::default())
}

/// The same with its textures within a memory.
pub fn plan_within(job: &Path, memory: &TextureMemory) -> Plan {
    compiled_within(job, &read, &Overrides::default(), memory)
}

/// The plan of a job given as text, which names no files. Panics where it cannot be used.
pub fn plan_of_text(job: &str) -> Plan {
    compiled(Path::new("job.toml"), &|_| Ok(job.to_owned()), &Overrides::default())
}

fn read(path: &Path) -> Result<String, Problem> {
    std::fs::read_to_string(path).map_err(|error| error.to_string().into())
}

fn compiled(job: &Path, read: &ReadText<'_>, overrides: &Overrides) -> Plan {
    compiled_within(job, read, overrides, &TextureMemory::default())
}

fn compiled_within(job: &Path, read: &ReadText<'_>, overrides: &Overrides, memory: &TextureMemory) -> Plan {
    let description = Description::load(job, read, overrides).unwrap_or_else(|errors| panic!("{errors}"));
    let assets = complete_assets(Assets::default(), &description.assets(), memory, &Sandbox::NONE)
        .unwrap_or_else(|errors| panic!("{errors:?}"));
    compile(&description, &assets, &Choices::default()).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// The first camera of a plan.
pub fn camera(plan: &Plan) -> &CameraPlan {
    plan.cameras.first().expect("every scene has a camera")
}
