"""Small meshes as trimesh writes them and images as Pillow writes them, with these programs' own figures: figures/foreign.

Python 3.11, trimesh 5.2.0, Pillow 13.0.0 (requirements.txt). Run at the root of the repository:
    python tests/oracles/foreign_files.py
"""

import json
import pathlib

import numpy as np
import trimesh
from PIL import Image

FOLDER = pathlib.Path("tests/oracles/figures/foreign")


def meshes():
    """A box and a tetrahedron, turned, in millimetres: binary, ASCII, and binary with a header that begins as an ASCII file."""
    box = trimesh.creation.box((20.0, 30.0, 50.0))
    box.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 2, 3]))
    binary = box.export(file_type="stl")
    files = {"binary.stl": binary, "solid.stl": b"solid box".ljust(80) + binary[80:], "text.stl": box.export(file_type="stl_ascii").encode()}
    figures = {}
    for name, content in files.items():
        (FOLDER / name).write_bytes(content)
        read = trimesh.load_mesh(FOLDER / name)
        figures[name] = {"vertices": len(read.vertices), "triangles": len(read.faces), "area": float(read.area), "volume": float(read.volume), "bounds": read.bounds.tolist()}
    return figures


def images():
    """Images of 5 × 3 pixels with opacity; the figures are the pixels that Pillow reads."""
    y, x = np.mgrid[0:3, 0:5]
    rgba = np.stack([40 * x + 10, 60 * y + 20, 7 * (x + y), 255 - 30 * x], axis=-1).astype(np.uint8)
    colour = Image.fromarray(rgba[..., :3])
    forms = {
        "rgb.tga": (colour, {}),
        "rgb_rle.tga": (colour, {"compression": "tga_rle"}),
        "rgba_top.tga": (Image.fromarray(rgba), {"orientation": 1}),
        "grey.tga": (colour.convert("L"), {}),
        "palette.tga": (colour.quantize(16), {}),
        "rgb.bmp": (colour, {}),
        "palette.bmp": (colour.quantize(16), {}),
        "rgba.webp": (Image.fromarray(rgba), {"lossless": True}),
        "rgb.tif": (colour, {"compression": "tiff_lzw"}),
        "rgb.ppm": (colour, {}),
    }
    figures = {}
    for name, (image, keys) in forms.items():
        image.save(FOLDER / name, **keys)
        read = Image.open(FOLDER / name)
        mode = "RGBA" if read.mode in ("RGBA", "LA") else "RGB"
        figures[name] = {"size": read.size, "pixels": np.asarray(read.convert(mode)).reshape(-1, len(mode)).tolist()}
    return figures


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    figures = {"meshes": meshes(), "images": images()}
    (FOLDER / "figures.json").write_text(json.dumps(figures) + "\n")
