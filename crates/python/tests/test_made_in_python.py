"""Jobs as dicts, and meshes from arrays."""

import enum
import json
import types

import numpy as np
import pytest
from conftest import contents

import etendue


def sheet(side=9):
    """A sheet of 4 m × 4 m in the plane z = 0."""
    x, y = np.meshgrid(np.linspace(-2, 2, side), np.linspace(-2, 2, side))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(side * side)], axis=1)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    upper = np.stack([corner, corner + 1, corner + side + 1], axis=1)
    lower = np.stack([corner, corner + side + 1, corner + side], axis=1)
    return {"positions": positions, "triangles": np.concatenate([upper, lower])}


def described(environment={"type": "uniform", "luminance_cd_m2": 1000, "illuminant": "D65"}, **more):
    return {
        "format": 1,
        "scene": {
            "materials": [{"name": "clay", "type": "diffuse", "reflectance": 0.4}],
            "meshes": [{"name": "sheet", "file": "sheet.obj", "up_axis": "z"}],
            "objects": [{"name": "sheet", "mesh": "sheet", "material": "clay"}],
            **({"environment": environment} if environment else {}),
        },
        "cameras": [
            {
                "name": "above",
                "position_m": np.array([0.0, 0.0, 5.0]),
                "look_at_m": (0, 0, 0),
                "up": [0, 1, 0],
                "lens": {"type": "pinhole", "focal_length_mm": 4, "f_number": 8},
                "sensor": {"width_px": 16, "height_px": 12, "pixel_pitch_um": np.float64(40)},
            }
        ],
        "render": {"spp": 4},
        **more,
    }


def test_a_sheet_of_arrays_lies_where_it_was_put():
    job = etendue.Job.open(described(), meshes={"sheet.obj": sheet()})
    above = job.render()["above"]
    assert np.allclose(above.depth[5:7, 7:9], 5, atol=1e-5)
    assert np.allclose(above.normals[6, 8], [0, 0, 1], atol=1e-6)
    assert job.plan()["cameras"][0]["name"] == "above"


def test_a_dict_and_its_file_are_one_job(tmp_path):
    mesh = sheet()
    lines = [f"v {x} {y} {z}" for x, y, z in mesh["positions"].astype(np.float32)]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in mesh["triangles"]]
    (tmp_path / "sheet.obj").write_text("\n".join(lines) + "\n")
    by_file = etendue.Job.open(described(), folder=tmp_path).render()["above"]
    by_arrays = etendue.Job.open(described(), meshes={"sheet.obj": mesh}).render()["above"]
    assert np.array_equal(by_file.depth, by_arrays.depth) and np.array_equal(by_file.electrons or 0, by_arrays.electrons or 0)


def test_results_of_a_dict_are_saved(tmp_path):
    job = etendue.Job.open(described(output={"radiance": True}), meshes={"sheet.obj": sheet()})
    job.render().save(tmp_path / "a")
    job.save(tmp_path / "b")
    assert contents(tmp_path / "a") == contents(tmp_path / "b")
    assert "above/radiance.exr" in contents(tmp_path / "a")


def test_files_of_a_job_may_be_made_too():
    whole = described()
    camera = whole["cameras"][0]
    files = {"camera.toml": {"format": 1, "lens": camera.pop("lens"), "sensor": camera.pop("sensor")}}
    camera["file"] = "camera.toml"
    mesh = {"sheet.obj": sheet()}
    one = etendue.Job.open(whole, files=files, meshes=mesh).render()["above"]
    other = etendue.Job.open(described(), meshes=mesh).render()["above"]
    assert np.array_equal(one.depth, other.depth)


def test_faults_of_a_dict_have_their_key():
    wrong = described()
    wrong["cameras"][0]["lens"]["f_numbr"] = 8
    with pytest.raises(etendue.InputError) as raised:
        etendue.Job.open(wrong, meshes={"sheet.obj": sheet()})
    assert "f_number" in str(raised.value) and raised.value.key.startswith("cameras.above.lens")


@pytest.mark.parametrize(
    ("change", "error", "told"),
    [
        ({"positions": np.zeros((4, 2))}, ValueError, r"positions.*\(n, 3\)"),
        ({"positions": np.zeros(12)}, ValueError, r"positions.*\(n, 3\)"),
        ({"positions": np.zeros((4, 3), complex)}, TypeError, "positions.*numbers"),
        ({"positions": [["a", "b", "c"]]}, TypeError, "positions.*numbers"),
        ({"triangles": np.zeros((4, 3))}, TypeError, "triangles.*whole numbers"),
        ({"triangles": [[0, 1, -1]]}, ValueError, "triangles.*vertex indices from 0"),
        ({"triangles": [[0, 1, 999]]}, etendue.InputError, "vertex 999"),
        ({"triangles": np.zeros((0, 3), int)}, etendue.InputError, "no triangles"),
        ({"positions": np.full((81, 3), np.nan)}, etendue.InputError, "not finite"),
        ({"normals": np.zeros((3, 3))}, etendue.InputError, "3 normals for 81 vertices"),
        ({"colours": np.zeros((81, 3))}, ValueError, "colours"),
        ({"positions": None}, ValueError, "positions.*missing"),
    ],
)
def test_wrong_arrays_are_refused(change, error, told):
    with pytest.raises(error, match=told):
        etendue.Job.open(described(), meshes={"sheet.obj": {**sheet(), **change}})


def test_texts_numbers_and_tables_go_through_toml(program):
    odd = {"a key": 'say "yes"\\\n', "list": [1, 2.5, True, -0.0, 1e300], "none": {}}
    from etendue._etendue import to_toml

    tomllib = pytest.importorskip("tomllib")
    assert tomllib.loads(f"odd = {to_toml(odd)}")["odd"] == odd
    assert json.dumps(tomllib.loads(f"x = {to_toml(np.arange(4).reshape(2, 2))}")["x"]) == "[[0, 1], [2, 3]]"
    assert to_toml(types.MappingProxyType({"a": enum.IntEnum("Bits", {"TEN": 10}).TEN})) == '{ "a" = 10 }'
    with pytest.raises(TypeError, match="NoneType is not a value"):
        to_toml([None])
    endless = []
    endless.append(endless)
    with pytest.raises(ValueError, match="64 deep"):
        to_toml(endless)
    with pytest.raises(ValueError, match="64 bits"):
        to_toml({"seed": 2**70})


def test_mappings_that_are_no_dicts_describe_too():
    mesh = types.MappingProxyType(sheet())
    changes, meshes = types.MappingProxyType({"render.spp": 2}), types.MappingProxyType({"sheet.obj": mesh})
    job = etendue.Job.open(types.MappingProxyType(described()), meshes=meshes, set=changes)
    assert job.plan() == etendue.Job.open(described(), meshes={"sheet.obj": sheet()}, set={"render.spp": 2}).plan()
    for argument in ("files", "meshes"):
        for strange in ([1], "sheet.obj", {3: {}}):
            with pytest.raises(TypeError, match=argument):
                etendue.Job.open(described(), **{argument: strange})
