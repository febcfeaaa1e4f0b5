"""The package and the program write the same bytes, and say the same."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import JOB, ROOT, contents

import etendue


def test_files_are_those_of_the_program(program, job, results, tmp_path):
    program("render", JOB, "-o", tmp_path / "program")
    expected = contents(tmp_path / "program")
    assert len(expected) > 3
    written = job.save(tmp_path / "saved", threads=1)
    assert {str(path.relative_to(tmp_path / "saved")) for path in written} == set(expected)
    assert contents(tmp_path / "saved") == expected
    results.save(tmp_path / "results")
    assert contents(tmp_path / "results") == expected


def test_changes_of_keys_are_those_of_the_program(program, tmp_path):
    changes = {"render.spp": 3, "render.seed": 7, "render.route": "pupil"}
    words = ["--set", "render.spp=3", "--set", "render.seed=7", "--set", 'render.route="pupil"']
    program("render", JOB, "-o", tmp_path / "program", *words, "--frames", "1..3")
    etendue.Job.open(JOB, set=changes).save(tmp_path / "python", frames=range(1, 3))
    assert contents(tmp_path / "python") == contents(tmp_path / "program")


def test_plans_are_those_of_the_program(program, job):
    assert job.plan() == json.loads(program("plan", JOB, "--json"))
    # The program spells arguments as its options.
    spelt = program("plan", JOB).replace("(--ablate)", "(`ablate`)").replace("(--json)", "(`json`)")
    assert job.summary() == spelt


def test_shards_are_merged_to_the_bytes_of_the_whole(job, tmp_path):
    for shard in range(3):
        job.save(tmp_path / f"shard{shard}", shard=(shard, 3))
    etendue.merge([tmp_path / f"shard{shard}" for shard in range(3)], output=tmp_path / "merged")
    job.save(tmp_path / "whole")
    assert contents(tmp_path / "merged") == contents(tmp_path / "whole")


def test_results_are_replaced_only_where_that_is_asked_for(job, results, tmp_path):
    job.save(tmp_path)
    before = contents(tmp_path)
    for save in (job.save, results.save):
        with pytest.raises(etendue.InputError):
            save(tmp_path)
        save(tmp_path, overwrite=True)
    assert contents(tmp_path) == before
    with pytest.raises(ValueError, match="exclude each other"):
        job.save(tmp_path, overwrite=True, resume=True)


def test_the_package_s_command_is_the_program(program):
    environment = {**os.environ, "COLUMNS": "100"}
    for arguments, status in ((["--version"], 0), (["plan", str(JOB)], 0), (["plan", "none.toml"], 2), (["paint"], 2)):
        done = subprocess.run(
            [sys.executable, "-m", "etendue", *arguments], cwd=ROOT, capture_output=True, text=True, env=environment
        )
        assert (done.returncode, done.stdout) == (status, program(*arguments, status=status))


def test_arrays_are_the_numbers_of_the_files(results, tmp_path):
    OpenEXR = pytest.importorskip("OpenEXR")
    Image = pytest.importorskip("PIL.Image")
    results.save(tmp_path)
    front = results.cameras[0]
    folder = tmp_path / front.name

    def channels(file):
        with OpenEXR.File(str(folder / file), separate_channels=True) as exr:
            return {name: channel.pixels.copy() for name, channel in exr.channels().items()}

    radiance = channels("radiance.exr")
    bands = sorted(name for name in radiance if name.startswith("S0."))
    assert [float(name[3:-2].replace(",", ".")) for name in bands] == pytest.approx(front.wavelengths_nm)
    assert np.array_equal(np.stack([radiance[name] for name in bands]), front.radiance)
    truth = channels("ground_truth.exr")
    for name, array in (
        ("depth.Z", front.depth),
        ("distance.Z", front.distance),
        ("N.X", front.normals[..., 0]),
        ("P.Z", front.positions[..., 2]),
        ("instance.ID", front.instance_ids),
        ("semantic.ID", front.semantic_ids),
        ("material.ID", front.material_ids),
    ):
        assert truth[name].dtype == array.dtype and np.array_equal(truth[name], array, equal_nan=array.dtype.kind == "f"), name
    assert np.array_equal(channels("electrons.exr")["electrons"], front.electrons)
    assert np.array_equal(np.asarray(Image.open(folder / "raw.0000.png")), front.raw)
    picture = np.asarray(Image.open(folder / "picture.0000.png"))
    assert picture.dtype == np.uint8 and np.abs(picture - front.picture * 255.0).max() <= 0.5 + 1e-4
