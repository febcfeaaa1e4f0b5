"""What cannot be used is told with its place."""

import pickle

import numpy as np
import pytest
from conftest import JOB

import etendue


def test_faults_of_a_job_have_file_line_and_key(tmp_path):
    file = tmp_path / "job.toml"
    file.write_text("format = 1\n[scene]\nmesh = 3\n[render]\nspp = -1\n[[cameras]]\nname = 'a'\n")
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(file)
    error = raised.value
    assert isinstance(error, etendue.Error) and isinstance(error, ValueError)
    assert (error.file, error.line) == (str(file), 3) and "mesh" in str(error)
    by_line = {fault.line: fault for fault in error.faults}
    assert by_line[5].key == "render.spp" and by_line[5].column == 7 and "-1" in by_line[5].message
    assert by_line[5].code == "out-of-range" and error.code == error.faults[0].code and by_line[5].problem == "found -1"
    assert etendue.explain("out-of-range").startswith("out-of-range: ") and "out-of-range" in etendue.explain()
    again = pickle.loads(pickle.dumps(error))
    assert again.faults == error.faults and str(again) == str(error)


def test_faults_of_changes_have_their_key():
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(JOB, set={"render.spp": -1})
    assert raised.value.key == "render.spp" and raised.value.line is None and "`set` render.spp=-1" in str(raised.value)
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(JOB, set={"render.sp": 1})
    assert "spp" in str(raised.value)
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(JOB, time_s=3)
    assert raised.value.key == "time_s" and str(raised.value).startswith("`time_s` 3: ") and "--" not in str(raised.value)
    with pytest.raises(etendue.InputError) as raised:
        etendue.measure.sfr("none.png", black=0.1)
    assert raised.value.key == "black" and str(raised.value).startswith("`black`: ")


def test_missing_files_are_told_at_the_key_that_names_them(tmp_path):
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(tmp_path / "none.toml")
    assert raised.value.file == str(tmp_path / "none.toml")
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(JOB, set={"scene.meshes.tower.file": "lost.obj"})
    assert raised.value.key == "scene.meshes.tower.file" and "lost.obj" in str(raised.value)


@pytest.mark.parametrize(
    ("arguments", "error", "told"),
    [
        ({"integrator": "photon"}, ValueError, "flat, direct, path"),
        ({"quality": "best"}, ValueError, "draft, standard, reference"),
        ({"spp": "many"}, TypeError, "spp"),
        ({"set": "render.spp=1"}, TypeError, "set"),
        ({"set": {"render.spp": object()}}, TypeError, "render.spp"),
        ({"set": {3: 1}}, TypeError, "expected a str as key"),
        ({"folder": "somewhere"}, ValueError, "folder"),
        ({"light": 1}, TypeError, "light"),
    ],
)
def test_wrong_arguments_are_refused(arguments, error, told):
    with pytest.raises(error, match=told):
        etendue.Job.open(JOB, **arguments)


@pytest.mark.parametrize("frames", [range(3, 3), range(0, 4, 2), -1, "all", 1.5, slice(0, 3)])
def test_frames_are_a_number_or_a_range(job, frames):
    with pytest.raises(TypeError, match="frames"):
        job.render(frames=frames)


def test_a_description_is_a_path_or_a_dict():
    for strange in (3, None, ["job.toml"], np.zeros(3)):
        with pytest.raises(TypeError, match="description"):
            etendue.Job.open(strange)


def test_limits_are_moved_by_their_names():
    etendue.set_limit("bases", 16)
    with pytest.raises(etendue.InputError, match='did you mean "picture-mib"') as raised:
        etendue.set_limit("picture-mb", 5)
    assert raised.value.key == "limit"
    with pytest.raises(etendue.InputError, match="from 1 to 64"):
        etendue.set_limit("bases", 65)


def test_files_that_are_no_pictures_are_told(tmp_path):
    file = tmp_path / "a.exr"
    file.write_bytes(b"no EXR")
    with pytest.raises(etendue.InputError) as raised:
        etendue.compare(file, file)
    assert raised.value.file == str(file)
    with pytest.raises(etendue.InputError):
        etendue.measure.sfr(file)
