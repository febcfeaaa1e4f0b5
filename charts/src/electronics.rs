//! Photon transfer, and the dark current by long exposures.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::Comparison;
use crate::page::Section;
use crate::program::{text, words};

const WAVELENGTH_NM: u32 = 550;
/// Without the pixels at the border, which have fewer neighbours to exchange light with: a pattern of rows and columns that is no PRNU.
const INNER: &str = "--region 2,2,316,236";
pub(crate) const DARK_CURRENT: &str = "dark_current_mean_e_per_s";

pub(crate) fn sections(bench: &Bench<'_>) -> Result<Vec<Section>, String> {
    Ok(vec![transfer(bench)?, dark_current(bench)?])
}

fn transfer(bench: &Bench<'_>) -> Result<Section, String> {
    let longest = bench.camera.transfer_exposure_s;
    let found =
        series(bench, "levels", &format!("--photon-transfer 15 --stack 100 --set sensor.exposure_s={longest}"))?;
    // What exposures of milliseconds hold of the dark current is less than they tell.
    let wanted = |key: &str| key != DARK_CURRENT;
    Ok(Section {
        title: "Photon transfer, fifteen exposures",
        body: found.quantities(wanted),
        reached: found.reached(bounds::ELECTRONICS, wanted),
    })
}

fn dark_current(bench: &Bench<'_>) -> Result<Section, String> {
    let longest = bench.camera.dark_exposure_s;
    let limits =
        if bench.camera.name == "web" { "--set sensor.auto_exposure.exposure_limits_s=[50e-6,50]" } else { "" };
    let told = format!(
        "--photon-transfer 10 --stack 3 --set sensor.exposure_s={longest} --set sensor.frame_period_s=50 {limits}"
    );
    let found = series(bench, "dark", &told)?;
    let wanted = |key: &str| key == DARK_CURRENT;
    Ok(Section {
        title: "Dark current, exposures of seconds",
        body: found.quantities(wanted),
        reached: found.reached(bounds::ELECTRONICS, wanted),
    })
}

/// A series of EMVA 1288, measured and compared.
fn series(bench: &Bench<'_>, name: &str, told: &str) -> Result<Comparison, String> {
    let to = bench.folder.join(name);
    let light = format!("--wavelength-nm {WAVELENGTH_NM}");
    let flat = ["flat".to_owned(), text(&bench.file("middle")), "-o".to_owned(), text(&to)];
    bench.program.run(&[flat.to_vec(), words(&light), words(told)].concat())?;
    let report = bench.folder.join(format!("{name}.json"));
    let descriptor = text(&to.join("middle/emva1288.txt"));
    // The list of levels comes without a side-car for its frames: their filters are told.
    let colours = bench.camera.filters.map_or_else(Vec::new, |tile| words(&format!("--cfa {tile} --channel G")));
    bench.program.measured(&report, &[vec!["ptc".to_owned(), descriptor], colours, words(INNER)].concat())?;
    Ok(Comparison(bench.program.compared(&report, &bench.file("middle"), &words(&light))?))
}
