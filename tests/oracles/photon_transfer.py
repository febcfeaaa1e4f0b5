"""Stacks simulated by the EMVA 1288 reference program, and its figures of them, for crates/metrology: figures/emva1288/.

The camera of the package is small (48 x 40 pixels, 12 bits), has fixed patterns and dark current, and is taken at 16 exposure
times. The package uses numpy.asfarray, which numpy 2 no longer has: it is given back here. Versions: requirements.txt. Run
anywhere:
    python tests/oracles/photon_transfer.py
"""

import json
import pathlib
import shutil
from importlib.metadata import version

import numpy as np
from PIL import Image

np.asfarray = lambda values: np.asarray(values, dtype=float)

from emva1288.camera.dataset_generator import DatasetGenerator  # noqa: E402
from emva1288.process.data import Data1288  # noqa: E402
from emva1288.process.loader import LoadImageData  # noqa: E402
from emva1288.process.parser import ParseEmvaDescriptorFile  # noqa: E402
from emva1288.process.results import Results1288  # noqa: E402

WIDTH, HEIGHT = 48, 40


class Generator(DatasetGenerator):
    """Writes 16-bit pictures: Pillow no longer writes the package's 32-bit ones."""

    def save_image(self, img, name):
        Image.fromarray(img.astype(np.uint16)).save(pathlib.Path(self.outdir) / "images" / name)


FIGURES = [
    "K", "R", "QE", "sigma_y_dark", "sigma_d", "u_p_min", "u_e_min", "u_p_sat", "u_e_sat", "SNR_max", "DR", "LE_min",
    "LE_max", "u_I_mean", "u_I_var", "s_2_y", "s_2_y_dark", "DSNU1288", "DSNU1288_row", "DSNU1288_col",
    "DSNU1288_pixel", "PRNU1288", "PRNU1288_row", "PRNU1288_col", "PRNU1288_pixel",
]


def patterns(rng):
    shape = (HEIGHT, WIDTH)
    rows, columns = (HEIGHT, 1), (1, WIDTH)
    dsnu = 6 * rng.normal(size=rows) + 5 * rng.normal(size=columns) + 9 * rng.normal(size=shape)
    prnu = 1 + 0.008 * rng.normal(size=rows) + 0.006 * rng.normal(size=columns) + 0.012 * rng.normal(size=shape)
    return dsnu, prnu


def main():
    folder = pathlib.Path(__file__).parent / "figures" / "emva1288"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    dsnu, prnu = patterns(np.random.default_rng(1288))
    generator = Generator(
        steps=16, L=12, outdir=str(folder), width=WIDTH, height=HEIGHT, bit_depth=12, K=0.2, K_min=0.2, K_max=0.2,
        K_steps=1, blackoffset=40, blackoffset_min=40, blackoffset_max=40, blackoffset_steps=1, dark_current_ref=6000,
        sigma2_dark_0=100.0, dsnu=dsnu, prnu=prnu, seed=1288,
    )
    parsed = ParseEmvaDescriptorFile(generator.descriptor_path)
    loaded = LoadImageData(parsed.images)
    results = Results1288(Data1288(loaded.data).data, pixel_area=25)
    figures = {name: float(value() if callable(value := getattr(results, name)) else value) for name in FIGURES}
    text = {"program": f"emva1288 {version('emva1288')}", "figures": figures}
    (folder / "figures.json").write_text(json.dumps(text, indent=1) + "\n")
    print(json.dumps(text, indent=1))


main()
