"""What the documentation shows is Python, and the scene that it makes is rendered; extras."""

import re

import numpy as np
import pytest
from conftest import ROOT

import etendue

BLOCKS = re.findall(r"```python\n(.*?)```", (ROOT / "docs/python.md").read_text(), re.S)


def test_blocks_of_code_are_python_and_name_what_there_is():
    assert len(BLOCKS) == 3
    for block in BLOCKS:
        compile(block, "docs/python.md", "exec")
        for path in re.findall(r"\betendue((?:\.\w+)+)", block):
            found = etendue
            for name in path.split(".")[1:]:
                found = getattr(found, name)


def test_the_scene_of_the_documentation_is_rendered():
    names = {"etendue": etendue, "np": np}
    exec(BLOCKS[1], names)
    assert names["above"].depth.shape == (48, 64)


def test_attributes_in_tables_are_there(results):
    page = (ROOT / "docs/python.md").read_text()
    table = page.split("| of a camera |")[1].split("\n\n")[0]
    words = {word for row in table.splitlines()[2:] for word in re.findall(r"`(\w+)", row.split("|")[1])}
    assert len(words) > 15
    front = results.cameras[0]
    (frame,) = front.frames()
    for word in words:
        assert hasattr(front, word) or hasattr(frame, word), word


def test_a_dataset_has_units_and_coordinates(results):
    pytest.importorskip("xarray")
    front = results.cameras[0]
    found = etendue.to_xarray(front)
    assert found["radiance"].dims == ("wavelength_nm", "y", "x") and found["depth"].attrs == {"units": "m"}
    assert np.array_equal(found["radiance"].values, front.radiance) and list(found["wavelength_nm"]) == front.wavelengths_nm
    assert found["flow"].dims == ("y", "x", "xy") and found["radiance_variance"].attrs == {"units": "W2 m-4 sr-2 nm-2"}
    assert found.attrs == {"camera": front.name, "frame": 0} and float(found["x"][0]) == 0.5


def test_a_table_is_a_data_frame():
    pytest.importorskip("pandas")
    report = etendue.Report({"figures": {}, "tables": {"rows": [{"a": 1, "b": {"value": 2.0}}]}, "notes": []})
    assert list(report.table("rows").columns) == ["a", "b.value"]
