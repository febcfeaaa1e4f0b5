"""Notebooks of the documentation: stored without outputs, and run from top to bottom."""

import json
import time

import pytest
from conftest import ROOT

FILES = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))


def cells(file, kind):
    return [cell for cell in json.loads(file.read_text())["cells"] if cell["cell_type"] == kind]


def test_there_is_a_notebook_for_each_of_the_list():
    page = (ROOT / "docs/python.md").read_text()
    assert len(FILES) == 6 and all(f"(notebooks/{file.name})" in page for file in FILES)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_notebooks_are_stored_without_outputs_and_name_pages_that_exist(file):
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells(file, "code"))
    text = "".join(line for cell in cells(file, "markdown") for line in cell["source"])
    links = [part.split(")")[0] for part in text.split("](")[1:]]
    assert links and all((file.parent / link).exists() for link in links), links


@pytest.mark.notebooks
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_notebooks_run_and_draw(file):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    book = nbformat.read(file, as_version=4)
    begun = time.monotonic()
    nbclient.NotebookClient(book, timeout=120, resources={"metadata": {"path": str(file.parent)}}).execute()
    print(f"{file.stem}: {time.monotonic() - begun:.1f} s")
    outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
    assert any("image/png" in output.get("data", {}) for output in outputs)
    # Warnings and deprecations would stand in front of who learns from it.
    assert [output.text for output in outputs if output.get("name") == "stderr"] == []
