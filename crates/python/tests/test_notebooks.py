"""Notebooks of the documentation: stored with outputs that a new run reproduces, and numbers in the text that code or outputs contain.

`ETENDUE_BLESS=1` stores the outputs of the run.
"""

import base64
import io
import json
import os
import re
import time

import pytest
from conftest import ROOT
from PIL import Image

FILES = sorted((ROOT / "docs/notebooks").glob("*.ipynb"))
# Largest notebook with its images, bytes.
MAX_SIZE = 150_000
# Stored images: largest width, px, and number of colours.
IMAGE_WIDTH, IMAGE_COLOURS = 640, 32


def cells(file, kind):
    return [cell for cell in json.loads(file.read_text())["cells"] if cell["cell_type"] == kind]


def source(cell):
    return "".join(cell["source"])


def printed(cell):
    """Printed text of a code cell, and the number of its images."""
    outputs = cell["outputs"]
    streams = "".join("".join(output["text"]) for output in outputs if output["output_type"] == "stream")
    values = "".join("".join(output["data"].get("text/plain", "")) for output in outputs if output["output_type"] == "execute_result")
    images = sum("image/png" in output.get("data", {}) for output in outputs)
    return streams + values, images


def numbers(text):
    return {number.rstrip(".") for number in re.findall(r"(?<![\w.])\d[\d_]*(?:\.\d+)?(?!\w)", text)}


def test_there_is_a_notebook_for_each_of_the_list():
    page = (ROOT / "docs/python.md").read_text()
    assert len(FILES) == 6 and all(f"(notebooks/{file.name})" in page for file in FILES)


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_notebooks_are_stored_with_outputs_and_name_pages_that_exist(file):
    code = cells(file, "code")
    assert [cell["execution_count"] for cell in code] == list(range(1, len(code) + 1))
    assert sum(printed(cell)[1] for cell in code) > 0 and file.stat().st_size <= MAX_SIZE
    text = "".join(map(source, cells(file, "markdown")))
    links = [part.split(")")[0] for part in text.split("](")[1:]]
    assert links and all((file.parent / link).exists() for link in links), links


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_numbers_of_the_text_are_in_code_or_outputs(file):
    supported = numbers("\n".join(source(cell) + printed(cell)[0] for cell in cells(file, "code")))
    text = "\n".join(map(source, cells(file, "markdown")))
    text = re.sub(r"`[^`]*`|\$[^$]*\$|\([A-Z]\. [^)]*\)|\(Zhang \d+\)|law \(\d+\)|EMVA 1288 \(release [\d.]+|EMVA 1288|f/", " ", text)
    assert numbers(text) <= supported, numbers(text) - supported


@pytest.mark.notebooks
@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_notebooks_run_and_give_their_stored_outputs(file):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    book = nbformat.read(file, as_version=4)
    stored = [printed(cell) for cell in book.cells if cell.cell_type == "code"]
    begun = time.monotonic()
    nbclient.NotebookClient(book, timeout=120, record_timing=False, resources={"metadata": {"path": str(file.parent)}}).execute()
    print(f"{file.stem}: {time.monotonic() - begun:.1f} s")
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    # Warnings and deprecations would be the first thing a reader sees.
    assert [output.text for cell in code for output in cell.outputs if output.get("name") == "stderr"] == []
    if os.environ.get("ETENDUE_BLESS"):
        file.write_text(json.dumps(stored_form(book), indent=1, ensure_ascii=False) + "\n")
    else:
        assert [printed(cell) for cell in code] == stored


def stored_form(book):
    """The notebook as JSON, without what depends on the machine."""
    document = json.loads(json.dumps(book))
    for output in (output for cell in document["cells"] for output in cell.get("outputs", [])):
        if "image/png" in output.get("data", {}):
            output["data"]["image/png"] = small_image(output["data"]["image/png"])
    document["metadata"]["language_info"] = {"name": "python"}
    for cell in document["cells"]:
        cell["source"] = cell["source"].splitlines(keepends=True)
    return document


def small_image(encoded):
    """A PNG of fewer pixels and colours, in base 64."""
    image = Image.open(io.BytesIO(base64.b64decode(encoded))).convert("RGB")
    image.thumbnail((IMAGE_WIDTH, image.height))
    stored = io.BytesIO()
    image.quantize(IMAGE_COLOURS, dither=Image.Dither.NONE).save(stored, "png", optimize=True)
    return base64.b64encode(stored.getvalue()).decode()
