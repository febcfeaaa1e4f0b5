"""PLY files as trimesh writes them, the same with the other byte order, and the figures that trimesh has of them: figures/ply.

Python 3.11, trimesh 5.2.0 (requirements.txt). Run at the root of the repository:
    python tests/oracles/ply.py
"""

import json
import pathlib

import numpy as np
import trimesh

FOLDER = pathlib.Path("tests/oracles/figures/ply")


def solid():
    """A closed solid that is convex nowhere in particular, with normals and colours, far from its file's origin."""
    ball = trimesh.creation.icosphere(1, 0.75)
    ball.vertices *= [1.0, 1.5, 2.0]
    ball.vertices += [300.0, -20.0, 4.0]
    ball.visual.vertex_colors = [200, 100, 50, 255]
    return ball


def big_endian(little):
    """The bytes of a binary file of vertices of floats and bytes, and of triangles, in the other order."""
    head, data = little.split(b"end_header\n", 1)
    lines = [line.split() for line in head.decode().splitlines()]
    kinds = {"float": "f4", "uchar": "u1", "int": "i4", "double": "f8"}
    count = {line[1]: int(line[2]) for line in lines if line[0] == "element"}
    vertex = [(line[2], kinds[line[1]]) for line in lines if line[0] == "property" and line[1] != "list"]
    rows = np.frombuffer(data, np.dtype([(n, "<" + k) for n, k in vertex]), count["vertex"])
    faces = np.frombuffer(data[rows.nbytes :], np.dtype([("n", "u1"), ("i", "<i4", 3)]), count["face"])
    swapped = rows.astype(np.dtype([(n, ">" + k) for n, k in vertex])).tobytes()
    swapped += faces.astype(np.dtype([("n", "u1"), ("i", ">i4", 3)])).tobytes()
    return head.replace(b"binary_little_endian", b"binary_big_endian") + b"end_header\n" + swapped


def figures(file):
    mesh = trimesh.load(file, process=False)
    return {
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.faces),
        "area": float(mesh.area),
        "volume": float(mesh.volume),
        "bounds": mesh.bounds.tolist(),
        "first normal": np.asarray(mesh.vertex_normals[0]).tolist(),
    }


FOLDER.mkdir(parents=True, exist_ok=True)
little = solid().export(file_type="ply", vertex_normal=True)
(FOLDER / "little.ply").write_bytes(little)
(FOLDER / "big.ply").write_bytes(big_endian(little))
text = solid().export(file_type="ply", encoding="ascii", vertex_normal=True)
(FOLDER / "text.ply").write_bytes(text if isinstance(text, bytes) else text.encode())
told = {name: figures(FOLDER / f"{name}.ply") for name in ["little", "big", "text"]}
(FOLDER / "figures.json").write_text(json.dumps(told, indent=1, sort_keys=True) + "\n")
