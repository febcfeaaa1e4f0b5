//! Photon transfer, and the dark current by long exposures.

use crate::bounds;
use crate::cameras::Bench;
use crate::comparison::Comparison;
use crate::page::Section;
use crate::run::{Warnings, compared, keep};
use etendue::measure::{CompareRequest, PtcRequest, Selection, ptc};
use etendue::{Error, ExistingFiles, FlatRequest, FlatSource, flat};

const WAVELENGTH_NM: f64 = 550.0;
/// Without the pixels at the border, which have fewer neighbours to exchange light with: a pattern of rows and columns that is no PRNU.
const INNER_REGION: [usize; 4] = [2, 2, 316, 236];
pub(crate) const DARK_CURRENT: &str = "dark_current_mean_e_per_s";

pub(crate) fn sections(bench: &Bench) -> Result<Vec<Section>, Error> {
    Ok(vec![transfer(bench)?, dark_current(bench)?])
}

fn transfer(bench: &Bench) -> Result<Section, Error> {
    let longest = format!("sensor.exposure_s={}", bench.camera.transfer_exposure_s);
    let comparison = series(bench, "levels", FlatSource::PhotonTransfer { levels: 15, stack: 100 }, vec![longest])?;
    // What exposures of milliseconds hold of the dark current is less than they tell.
    let includes = |key: &str| key != DARK_CURRENT;
    Ok(Section {
        title: "Photon transfer, fifteen exposures",
        body: comparison.quantities(includes),
        reached: comparison.reached(bounds::ELECTRONICS, includes),
    })
}

fn dark_current(bench: &Bench) -> Result<Section, Error> {
    let longest = format!("sensor.exposure_s={}", bench.camera.dark_exposure_s);
    let mut set = vec![longest, "sensor.frame_period_s=50".to_owned()];
    if bench.camera.name == "web" {
        set.push("sensor.auto_exposure.exposure_limits_s=[50e-6,50]".to_owned());
    }
    let comparison = series(bench, "dark", FlatSource::PhotonTransfer { levels: 10, stack: 3 }, set)?;
    let includes = |key: &str| key == DARK_CURRENT;
    Ok(Section {
        title: "Dark current, exposures of seconds",
        body: comparison.quantities(includes),
        reached: comparison.reached(bounds::ELECTRONICS, includes),
    })
}

/// A series of EMVA 1288, measured and compared.
fn series(bench: &Bench, name: &str, source: FlatSource, set: Vec<String>) -> Result<Comparison, Error> {
    let (folder, camera) = (bench.folder.join(name), bench.file("middle"));
    let request = FlatRequest { set, ..FlatRequest::new(&camera, WAVELENGTH_NM, source) };
    flat(&request, &folder, ExistingFiles::Refuse, &Warnings)?;
    // The list of levels comes without a side-car for its frames: their filters are told.
    let cfa = bench.camera.filters.map(str::to_owned);
    let channel = cfa.as_ref().map(|_| "G".to_owned());
    let selection = Selection { channel, cfa, region: Some(INNER_REGION), ..Selection::default() };
    let descriptor = folder.join("middle/emva1288.txt");
    let report = bench.folder.join(format!("{name}.json"));
    keep(&ptc(&PtcRequest { selection, ..PtcRequest::new(descriptor) }, &Warnings)?, &report)?;
    compared(&CompareRequest { wavelength_nm: Some(WAVELENGTH_NM), ..CompareRequest::new(report, camera) }, None)
}
