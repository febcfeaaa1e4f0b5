//! Faults of a job name the file, the line and the key that hold them.

use etendue::{Error, Job};

#[test]
fn a_missing_file_is_a_fault_of_the_key_that_names_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = folder.path().join("job.toml");
    let text = "format = 1\n[[scene.meshes]]\nname = \"m\"\nfile = \"lost.obj\"\nup_axis = \"z\"\n[[scene.objects]]\nname = \"o\"\nmesh = \"m\"\n\
        [[cameras]]\nname = \"c\"\nposition_m = [0, 0, 1]\nlook_at_m = [0, 0, 0]\nup = [0, 1, 0]\n[cameras.lens]\ntype = \"pinhole\"\n\
        focal_length_mm = 4\nf_number = 8\n[cameras.sensor]\nwidth_px = 8\nheight_px = 8\npixel_pitch_um = 4\n";
    std::fs::write(&job, text).expect("written");
    let told = Job::open(&job).map(|_| ());
    let Err(Error::Input(faults)) = told else { panic!("{told:?}") };
    let Some(fault) = faults.iter().find(|fault| fault.message.contains("lost.obj")) else { panic!("{faults:?}") };
    assert_eq!((fault.file.as_ref(), fault.line, fault.column), (Some(&job), Some(4), Some(8)), "{fault:?}");
    assert_eq!(fault.key.as_deref(), Some("scene.meshes.m.file"));
}
