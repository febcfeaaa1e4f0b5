"""A GLB file as trimesh writes it, and the figures that trimesh has of it in its places: figures/gltf.

Python 3.11, trimesh 5.2.0 (requirements.txt). Run at the root of the repository:
    python tests/oracles/gltf.py
"""

import json
import pathlib

import numpy as np
import trimesh
from PIL import Image
from trimesh import transformations as t
from trimesh.visual.material import PBRMaterial

FOLDER = pathlib.Path("tests/oracles/figures/gltf")


def textured_quad():
    """A rectangle in x and y with a picture of four by two texels over it."""
    texels = np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255], [255, 255, 255]], [[128, 128, 128]] * 4], np.uint8)
    vertices = np.array([[-1, -0.5, 0], [1, -0.5, 0], [1, 0.5, 0], [-1, 0.5, 0]], float)
    material = PBRMaterial(name="print", baseColorTexture=Image.fromarray(texels), metallicFactor=0.0, roughnessFactor=0.5)
    visual = trimesh.visual.TextureVisuals(uv=[[0, 0], [1, 0], [1, 1], [0, 1]], material=material)
    return trimesh.Trimesh(vertices, [[0, 1, 2], [0, 2, 3]], visual=visual, process=False)


def of_colour(mesh, name, **keys):
    mesh.visual = trimesh.visual.TextureVisuals(material=PBRMaterial(name=name, **keys))
    return mesh


def scene():
    scene = trimesh.Scene()
    gold = of_colour(trimesh.creation.box((1, 2, 3)), "gold", baseColorFactor=[255, 196, 86, 255], metallicFactor=1.0, roughnessFactor=0.3)
    matt = of_colour(trimesh.creation.icosphere(1, 0.75), "matt", baseColorFactor=[51, 102, 153, 255], metallicFactor=0.0, roughnessFactor=1.0)
    turned = t.concatenate_matrices(t.translation_matrix([4, 5, 6]), t.rotation_matrix(0.7, [1, 2, 3]), np.diag([1.0, 1.5, 2.0, 1.0]))
    scene.add_geometry(gold, node_name="gold", geom_name="box", transform=turned)
    scene.add_geometry(matt, node_name="ball", geom_name="ball", parent_node_name="gold", transform=t.translation_matrix([0, 3, 0]))
    scene.graph.update(frame_from="ball", frame_to="ball again", matrix=np.diag([-1.0, 1.0, 1.0, 1.0]) @ t.translation_matrix([3, 0, 0]), geometry="ball")
    scene.add_geometry(textured_quad(), node_name="print", geom_name="print", transform=t.rotation_matrix(-1.1, [0, 1, 0], [0, 0, 2]))
    return scene


def figures(file):
    """Of every piece in its place: area, volume by the winding of its faces, bounds."""
    read, pieces = trimesh.load(file), {}
    for node in read.graph.nodes_geometry:
        transform, name = read.graph[node]
        mesh = read.geometry[name].copy()
        mesh.apply_transform(transform)
        material = mesh.visual.material
        piece = pieces.setdefault(material.name, {"triangles": 0, "area": 0.0, "volume": 0.0, "bounds": []})
        piece["triangles"] += len(mesh.faces)
        piece["area"] += float(mesh.area)
        piece["volume"] += float(mesh.volume)
        piece["bounds"].append(mesh.bounds.tolist())
    for piece in pieces.values():
        bounds = np.array(piece["bounds"])
        piece["bounds"] = [bounds[:, 0].min(axis=0).tolist(), bounds[:, 1].max(axis=0).tolist()]
    return pieces


FOLDER.mkdir(parents=True, exist_ok=True)
(FOLDER / "scene.glb").write_bytes(scene().export(file_type="glb"))
(FOLDER / "scene.json").write_text(json.dumps(figures(FOLDER / "scene.glb"), indent=1, sort_keys=True) + "\n")
