"""The verbs as functions: what the program answers, they answer."""

import inspect
import json
import pathlib

import numpy as np
import pytest
from conftest import JOB, ROOT, contents

import etendue

WEB = ROOT / "scenes/cameras"


def test_every_verb_has_a_function_with_its_arguments_told(program):
    for name in ("expose", "develop", "flat", "merge", "compare", "weather", "calibrate", "inspect", "view", "rig", "schema", "tradeoff"):
        function = getattr(etendue, name)
        assert name in etendue.__all__ and callable(function)
        for parameter in inspect.signature(function).parameters:
            assert f"\n{parameter}: " in function.__doc__, (name, parameter)
    listed = program("measure", "--help")
    for name in etendue.measure.__all__:
        assert f"  {name.replace('_', '-')}" in listed
    assert len(etendue.measure.__all__) > 15 and len(etendue.chart.__all__) > 15


def test_comparisons_tell_differences_and_do_not_raise(job, tmp_path):
    (job.save(tmp_path / "a"), etendue.Job.open(JOB, seed=9).save(tmp_path / "b"))
    a, b = (next((tmp_path / folder).rglob("raw.0000.png")) for folder in "ab")
    assert etendue.compare(a, a)["differ"] is False
    told = etendue.compare(a, b)
    assert told["differ"] is True and told["channels"][0]["unequal"] > 0


def test_stored_light_is_exposed_and_developed_by_other_cameras(program, tmp_path):
    etendue.Job.open(JOB, set={"render.route": "pupil"}).save(tmp_path / "stored")
    radiance = next((tmp_path / "stored").rglob("radiance.exr"))
    camera = JOB.parent / "camera.toml"
    if not camera.is_file():
        camera = next(WEB.rglob("*.toml"))
    written = etendue.expose(radiance, camera=camera, frames=range(0, 2), output=tmp_path / "python", set={"sensor.exposure_s": 0.002})
    assert all(isinstance(path, pathlib.Path) and path.is_file() for path in written)
    program(
        "expose", radiance, "--camera", camera, "--frames", "0..2", "-o", tmp_path / "program", "--set", "sensor.exposure_s=0.002"
    )
    assert contents(tmp_path / "python") == contents(tmp_path / "program")
    raw = next(path for path in written if path.name.startswith("raw."))
    developed = etendue.develop(raw, camera=camera, output=tmp_path / "developed")
    assert any(path.name.startswith("picture.") for path in developed)


#: A small camera without colour.
CAMERA = """format = 1
[lens]
type = "thin"
focal_length_mm = 8
f_number = 4
focus_distance_m = 1
[sensor]
width_px = 120
height_px = 90
pixel_pitch_um = 20
cfa = "mono"
exposure_s = 0.001
quantum_efficiency = 0.5
full_well_e = 1e5
read_noise_e = 2
dark_current_e_s = 0
gain_dn_per_e = 0.1
black_level_dn = 16
bits = 14
"""


def test_a_chart_is_made_rendered_and_measured_as_the_program_measures_it(program, tmp_path):
    (tmp_path / "camera.toml").write_text(CAMERA)
    chart = tmp_path / "chart"
    written = etendue.chart.slanted_edges(camera=tmp_path / "camera.toml", output=chart, columns=1, rows=1, angle_deg=5)
    assert chart / "job.toml" in written
    written = etendue.Job.open(chart / "job.toml", spp=16).save(tmp_path / "out")
    picture = next(path for path in written if path.name.startswith("raw."))
    report = etendue.measure.sfr(picture, truth=chart / "truth.json")
    told = json.loads(program("measure", "sfr", picture, "--truth", chart / "truth.json", "--json"))
    # Notes name the parameter where the program names the option.
    notes = [note.replace("`shading_degree`", "--shading-degree") for note in report["notes"]]
    assert {**report, "notes": notes} == told and report["measurement"] == "sfr"
    for key, estimate in report.figures.items():
        assert estimate.value == told["figures"][key]["value"] == report.value(key)
    assert str(report).startswith(report["method"])
    with pytest.raises(KeyError, match="there are"):
        report.value("mtf99")


def test_flat_fields_and_lenses_answer(program, tmp_path):
    camera = sorted(WEB.rglob("*.toml"))[0]
    written = etendue.flat(camera, wavelength_nm=550, photons=500.0, frames=range(0, 2), output=tmp_path / "python")
    program("flat", camera, "--wavelength-nm", 550, "--photons", 500, "--frames", "0..2", "-o", tmp_path / "program")
    assert len(written) > 1 and contents(tmp_path / "python") == contents(tmp_path / "program")
    lens = etendue.measure.lens("double-gauss", f_number=4, fields=3)
    assert lens == json.loads(program("measure", "lens", "double-gauss", "--f-number", 4, "--fields", 3, "--json"))
    assert etendue.schema("camera") == json.loads(program("schema", "camera"))
    assert etendue.inspect(JOB.parent / "checker.png") == program("inspect", JOB.parent / "checker.png")


def test_arguments_of_verbs_are_checked(tmp_path):
    with pytest.raises(TypeError, match="edge_width"):
        etendue.measure.sfr("a.png", edge_width=3)
    with pytest.raises(TypeError, match="picture"):
        etendue.measure.sfr()
    with pytest.raises(TypeError, match="a whole number"):
        etendue.measure.sfr("a.png", edge_degree=1.5)
    with pytest.raises(TypeError, match="one value"):
        etendue.measure.sfr("a.png", reach_px=[1, 2])
    with pytest.raises(etendue.InputError, match="edge-degree"):
        etendue.measure.sfr("a.png", edge_degree=9)
    with pytest.raises(etendue.InputError, match="region|edge"):
        etendue.measure.sfr("a.png", edge=(1, 2, 3))
    with pytest.raises(TypeError, match="True or False"):
        etendue.merge([tmp_path], output=tmp_path, overwrite="yes")


def test_values_of_numpy_are_values():
    with pytest.raises(etendue.InputError, match="a.png"):
        etendue.measure.sfr("a.png", edge=np.array([[0, 0, 8, 8], [8, 8, 8, 8]]), edge_degree=np.int64(2), pixel_pitch_um=np.float32(2.5))


def test_a_result_becomes_a_page_of_the_same_bytes_and_opens_no_browser(program, tmp_path):
    camera = ROOT / "scenes/cameras/ccd-mono.toml"
    small = {"sensor.width_px": 64, "sensor.height_px": 64}
    etendue.flat(camera, wavelength_nm=550, photons=500.0, output=tmp_path / "flat", set=small)
    page = tmp_path / "python.html"
    assert etendue.view(tmp_path / "flat", output=page, max_mb=4) == [page]
    program("view", tmp_path / "flat", "-o", tmp_path / "program.html", "--max-mb", "4")
    assert page.read_bytes() == (tmp_path / "program.html").read_bytes()
    with pytest.raises(etendue.InputError, match="already exists"):
        etendue.view(tmp_path / "flat", output=page)
