//! Meshes.

use super::ConvertedScene;

/// A ridge of two faces, with a subdivision scheme.
fn ridge(scheme: &str) -> ConvertedScene {
    ConvertedScene::new(&format!(
        "def Mesh \"a\" {{ int[] faceVertexCounts = [4, 4] int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 5, 2]\n\
         point3f[] points = [(0,0,0), (1,0,1), (1,1,1), (0,1,0), (2,0,0), (2,1,0)]\n\
         normal3f[] normals = [(0,0,1), (0,0,1), (0,0,1), (0,0,1), (0,0,1), (0,0,1)] {scheme} }}\n"
    ))
}

fn has_normals(converted: &ConvertedScene) -> bool {
    let [(_, ply)] = &converted.files[..] else { panic!("{} files", converted.files.len()) };
    String::from_utf8_lossy(&ply[..300.min(ply.len())]).contains(" nx\n")
}

#[test]
fn only_smooth_schemes_are_smoothed() {
    let ridge_with = |scheme: &str| ridge(&format!("uniform token subdivisionScheme = \"{scheme}\""));
    assert!(has_normals(&ridge_with("none")), "its own");
    let flat = ridge_with("bilinear");
    assert!(!has_normals(&flat) && !flat.reports("smooth"), "{}", flat.report_text);
    assert!(
        flat.reports("a bilinear subdivision surface becomes its control mesh with flat faces"),
        "{}",
        flat.report_text
    );
    for smooth in [ridge(""), ridge_with("catmullClark"), ridge_with("loop")] {
        assert!(
            has_normals(&smooth) && smooth.reports("its control mesh with smooth normals"),
            "{}",
            smooth.report_text
        );
    }
}
