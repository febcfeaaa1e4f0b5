//! Writes the generated scenes into a folder: `generate-scenes scenes`.

use std::io::Write as _;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut messages = std::io::stderr();
    let [folder] = arguments.as_slice() else {
        let _ = writeln!(messages, "usage: generate-scenes FOLDER (the scenes are written into it)");
        return ExitCode::from(2);
    };
    match write_all(Path::new(folder)) {
        Ok(bytes) => {
            let [unique, placed] = etendue_scenes::street::triangle_counts();
            let _ = writeln!(messages, "{bytes} bytes; street: {unique} triangles, {placed} with every instance");
            ExitCode::SUCCESS
        }
        Err(error) => {
            let _ = writeln!(messages, "cannot write the scenes into {folder}: {error}");
            ExitCode::FAILURE
        }
    }
}

fn write_all(folder: &Path) -> std::io::Result<usize> {
    let files = etendue_scenes::files();
    for file in &files {
        let path = folder.join(&file.path);
        std::fs::create_dir_all(path.parent().unwrap_or(folder))?;
        std::fs::write(path, &file.bytes)?;
    }
    Ok(files.iter().map(|file| file.bytes.len()).sum())
}
