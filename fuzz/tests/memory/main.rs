//! What large files take in memory: texts of 4 MiB whose values are as short as they can be, and pictures that are compressed.

mod pictures;

use etendue_fuzz::attempt::attempt;
use etendue_fuzz::targets::target;
use std::fs;
use std::sync::Mutex;

/// Memory is counted for the whole process: one test at a time.
static ALONE: Mutex<()> = Mutex::new(());

const LENGTH: usize = 4 << 20;

/// A head, and a part that is repeated until the file is long enough, and an end.
fn dense(head: &str, part: &str, end: &str) -> Vec<u8> {
    let count = (LENGTH - head.len() - end.len()) / part.len();
    [head, &part.repeat(count), end].concat().into_bytes()
}

/// A PLY file of so many vertices, each of these bytes, and no faces.
fn ply(format: &str, number: &str, count: usize, vertex: &[u8]) -> Vec<u8> {
    let axes = ["x", "y", "z"].map(|axis| format!("property {number} {axis}\n")).concat();
    let head = format!("ply\nformat {format}\nelement vertex {count}\n{axes}end_header\n");
    [head.into_bytes(), vertex.repeat(count)].concat()
}

#[test]
fn a_reader_holds_a_stated_multiple_of_its_file() {
    let _alone = ALONE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let rising: String = (0..LENGTH / 12).map(|i| format!("{i},1,1,1\n")).collect();
    let spectrum: String = (0..LENGTH / 9).map(|i| format!("{i},1\n")).collect();
    let inputs = [
        ("obj", dense("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "f 1 2 3\n", "")),
        ("obj", dense("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0\nvn 0 0 1\n", "f 1/1/1 2/1/1 3/1/1\n", "")),
        ("obj", dense("", "v 0 0 1\n", "f 1 2 3\n")),
        ("ply", ply("ascii 1.0", "float", LENGTH / 6 - 100, b"0 0 0\n")),
        ("ply", ply("binary_little_endian 1.0", "char", LENGTH / 3 - 100, &[1, 2, 3])),
        ("mesh-frame", dense("", "v 0 0 1\n", "f 1 2 3\n")),
        ("mtl", dense("newmtl wall\n", "Kd 1 1 1\n", "")),
        ("spectrum", format!("wavelength_nm,value\n{spectrum}").into_bytes()),
        ("numbers", dense("", "1,1,1,1\n", "")),
        ("retro-table", dense("a,5,30,40\n", "1,2,3,4\n", "")),
        ("trajectory-csv", format!("time_s,x_m,y_m,z_m\n{rising}").into_bytes()),
        ("ies", dense("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2000 1000 1 2 0 0 0\n1 1 1\n", "1 ", "")),
        ("ldt", dense("", "1\r\n", "")),
        ("zmx", dense("VERS 1\nMODE SEQ\nUNIT MM\n", "SURF 1\n CURV 0\n DISZ 1\n", "")),
        ("seq", dense("RDM;LEN\nDIM M\nEPD 1\nWL 500\nSO 0 1\n", "S 1 1\n", "SI 0 0\nGO\n")),
        ("emva", dense("n 1 1 1\n", "b 1 1\ni a\ni a\n", "")),
        ("colmap", dense("", "1 PINHOLE 1 1 1 1 1 1\n", "")),
        ("ocam", dense("5 ", "1 ", "")),
        ("job", dense("format = 1\na = [", "1,", "]\n")),
        ("camera", dense("format = 1\n", "[[a]]\n", "")),
        ("scene", dense("format = 1\na = [", "{a=1},", "]\n")),
        ("opencv", dense("a: [", "1,", "1]\n")),
        ("opencv", dense("<opencv_storage><a>", "<_/>", "</a></opencv_storage>")),
        ("opencv", dense("<opencv_storage><a>", "1 ", "</a></opencv_storage>")),
        ("kalibr", dense("cam0: [", "[1],", "1]\n")),
        ("kalibr", format!("a: 0\n[{}0]", "0,".repeat((1 << 20) + 8)).into_bytes()),
        ("ray-transfer", dense("{\"a\":[", "00,", "0]}")),
        ("f-theta", dense("{\"a\":[", "{},", "1]}")),
        ("side-car", dense("{\"a\":[", "[],", "1]}")),
        ("truth", dense("{\"a\":[", "[],", "1]}")),
        ("trajectory-json", dense("[", "{\"time_s\":1},", "{}]")),
    ];
    let mut findings = Vec::new();
    let mut table_text = String::new();
    for (name, input) in inputs {
        let target = target(name).expect("a target");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let _ = (target.prepare)(folder.path());
        let file = folder.path().join(target.file);
        fs::write(&file, &input).expect("written");
        let attempt = attempt(target, &file);
        table_text += &format!(
            "{name} {:.1} {:.2} {}\n",
            attempt.peak_bytes as f64 / input.len() as f64,
            attempt.time_s,
            attempt.path()
        );
        if attempt.peak_bytes > target.max_bytes(input.len()) {
            findings.push(format!("{name}: {} bytes", attempt.peak_bytes));
        }
    }
    assert!(findings.is_empty(), "{findings:#?}\n{table_text}");
}
