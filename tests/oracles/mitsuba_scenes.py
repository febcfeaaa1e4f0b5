"""Scenes of scenes/import by Mitsuba 3: figures/mitsuba_scenes.json.

Python 3.11, mitsuba 3.9.1 (requirements.txt), variant scalar_spectral (it needs no LLVM). Run at the root of the
repository:
    python tests/oracles/mitsuba_scenes.py
cornell.xml and studio.xml are written in Mitsuba's format alone; shapes.xml and smoke.xml are what shapes.pbrt and
smoke.pbrt (but its spot) say. Every figure is the mean of linear sRGB over a box of BOX by BOX pixels, row by row from the
top, with the standard error of independent pictures; a unit is a luminance of 1 of white light, which `etendue import`
takes as 1 cd/m2. Paths have no greatest length.
"""

import json
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_spectral")

ROOT = Path(__file__).resolve().parents[2]
BOX = 12
SEEDS, SPP = 16, 64


def boxes(picture):
    """Means over boxes: rows, columns, channels."""
    rows, columns, channels = picture.shape
    return picture.reshape(rows // BOX, BOX, columns // BOX, BOX, channels).mean(axis=(1, 3))


def figures(name):
    scene = mi.load_file(str(ROOT / f"scenes/import/{name}.xml"))
    pictures = [boxes(np.array(mi.render(scene, spp=SPP, seed=seed))[..., :3]) for seed in range(SEEDS)]
    flat = np.array(pictures).reshape(SEEDS, -1, 3)
    error = flat.std(axis=0, ddof=1) / np.sqrt(SEEDS)
    return {"mean": np.round(flat.mean(axis=0), 6).tolist(), "standard_error": np.round(error, 6).tolist()}


def main():
    found = {name: figures(name) for name in ["cornell", "studio", "shapes", "smoke"]}
    stored = {"box_px": BOX, "seeds": SEEDS, "scenes": found}
    text = json.dumps(stored).replace('"mean"', '\n"mean"').replace('"standard_error"', '\n"standard_error"')
    (ROOT / "tests/oracles/figures/mitsuba_scenes.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
