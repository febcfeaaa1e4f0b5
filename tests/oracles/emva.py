"""What the reference implementation of EMVA 1288 measures on this program's stacks: figures/emva.json.

For each camera of figures/emva: `etendue flat --photon-transfer 50` makes the standard's series (50 exposures of two bright and two dark
frames, 100 bright at half of saturation, 100 dark), and emva1288 reads its descriptor file. Stored are its results and what binds them to
the program's bits: of each stack of two the sum of all pixels and the sum of squared differences, of each stack of 100 the sum and the
sum of squares of its first and last frame. Versions: requirements.txt. Run from anywhere, the binary in ETENDUE or built anew:
    python tests/oracles/emva.py
"""

import json
import logging
import os
import pathlib
import subprocess
import tempfile
from importlib.metadata import version

import numpy as np

# The program was written for numpy 1.
np.asfarray = lambda a: np.asarray(a, dtype=float)

from emva1288.process.data import Data1288
from emva1288.process.loader import LoadImageData
from emva1288.process.parser import ParseEmvaDescriptorFile
from emva1288.process.results import Results1288
from emva1288.process.routines import load_image

HERE = pathlib.Path(__file__).parent / "figures"
ROOT = HERE.parents[2]
CAMERAS = ["web", "ccd", "automotive"]
NM, LEVELS = 525, 50
RESULTS = [
    "K", "R", "QE", "sigma_y_dark", "sigma_d", "u_p_min", "u_p_sat", "u_e_sat", "SNR_max", "DR", "u_I_mean", "index_u_ysat",
    "index_sensitivity_max", "DSNU1288", "DSNU1288_pixel", "DSNU1288_row", "DSNU1288_col", "PRNU1288", "PRNU1288_pixel", "PRNU1288_row", "PRNU1288_col",
    "s_2_y_measured", "s_2_y_measured_dark", "sigma_2_y_stack", "sigma_2_y_stack_dark",
]


def binary():
    if "ETENDUE" in os.environ:
        return os.environ["ETENDUE"]
    subprocess.run(["cargo", "build", "--release", "-p", "etendue-cli"], check=True, cwd=ROOT)
    return str(ROOT / "target" / "release" / "etendue")


def number(value):
    value = value() if callable(value) else value
    return None if value is None or np.isnan(value) else float(value)


def bound(images):
    """What the program's frames are known by again, in the order of the descriptor."""
    pairs = {}
    for exposure, by_photons in images["temporal"].items():
        for photons, names in by_photons.items():
            a, b = (load_image(name).astype(np.int64) for name in names)
            pairs[(exposure, -photons)] = [int((a + b).sum()), int(((a - b) ** 2).sum())]
    many = {}
    for exposure, by_photons in images["spatial"].items():
        for photons, names in by_photons.items():
            ends = [load_image(names[i]).astype(np.int64) for i in (0, -1)]
            many[-photons] = [[int(a.sum()), int((a * a).sum())] for a in ends]
    order = sorted(pairs)
    return {
        "levels": [{"exposure_ns": e, "photons": -p, "sum_and_squared_difference": pairs[(e, p)]} for e, p in order],
        "stacks": [{"photons": -p, "first_and_last": many[p]} for p in sorted(many)],
    }


def measured(name, program, folder):
    camera = HERE / "emva" / f"{name}.toml"
    command = [program, "flat", str(camera), "--wavelength-nm", str(NM), "--photon-transfer", str(LEVELS), "-o", folder]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    parsed = ParseEmvaDescriptorFile(f"{folder}/{name}/emva1288.txt", loglevel=logging.WARNING)
    loaded = LoadImageData(parsed.images, loglevel=logging.WARNING)
    results = Results1288(Data1288(loaded.data).data, loglevel=logging.WARNING)
    found = {key: number(getattr(results, key)) for key in RESULTS}
    return {"camera": f"emva/{name}.toml", "wavelength_nm": NM, "results": found} | bound(parsed.images)


def main():
    program = binary()
    cameras = {}
    for name in CAMERAS:
        with tempfile.TemporaryDirectory() as folder:
            cameras[name] = measured(name, program, folder)
            print(name, json.dumps(cameras[name]["results"], indent=1))
    figures = {"programs": [f"emva1288 {version('emva1288')}"], "script": "tests/oracles/emva.py", "cameras": cameras}
    (HERE / "emva.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
