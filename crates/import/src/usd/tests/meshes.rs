//! Meshes.

use super::Made;

/// A ridge of two faces, with a subdivision scheme.
fn ridge(scheme: &str) -> Made {
    Made::of(&format!(
        "def Mesh \"a\" {{ int[] faceVertexCounts = [4, 4] int[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 5, 2]\n\
         point3f[] points = [(0,0,0), (1,0,1), (1,1,1), (0,1,0), (2,0,0), (2,1,0)]\n\
         normal3f[] normals = [(0,0,1), (0,0,1), (0,0,1), (0,0,1), (0,0,1), (0,0,1)] {scheme} }}\n"
    ))
}

fn has_normals(made: &Made) -> bool {
    let [(_, ply)] = &made.files[..] else { panic!("{} files", made.files.len()) };
    String::from_utf8_lossy(&ply[..300.min(ply.len())]).contains(" nx\n")
}

#[test]
fn only_smooth_schemes_are_smoothed() {
    let of = |scheme: &str| ridge(&format!("uniform token subdivisionScheme = \"{scheme}\""));
    assert!(has_normals(&of("none")), "its own");
    let flat = of("bilinear");
    assert!(!has_normals(&flat) && !flat.says("smooth"), "{}", flat.told);
    assert!(flat.says("a bilinear subdivision surface becomes its control mesh with flat faces"), "{}", flat.told);
    for smooth in [ridge(""), of("catmullClark"), of("loop")] {
        assert!(has_normals(&smooth) && smooth.says("its control mesh with smooth normals"), "{}", smooth.told);
    }
}
