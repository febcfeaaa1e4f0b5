"""Scenes of scenes/import by usd-core: figures/usd_scenes.json, and kinds.usdc and kinds.usdz beside kinds.usda.

Python 3.11, usd-core 26.11 (requirements.txt). Run at the root of the repository:
    python tests/oracles/usd_scenes.py
Lengths are metres, axes the stage's own (y upwards). Of every shape that is drawn: the places of its points in the world,
its area, the sum of the areas of its faces along their normals, its texture coordinates with the places at which they lie,
and the material that it is bound to. Of cameras: place, direction, and field by Gf.Camera. Of lights: what UsdLux says of
their luminance, with the defaults of its schema. Of materials: inputs of their surfaces, through node graphs.
"""

import json
import math
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom, UsdLux, UsdShade, UsdUtils

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "scenes/import"
BT709 = (0.2126, 0.7152, 0.0722)
DIGITS = 7


def rounded(values):
    return np.round(np.asarray(values, dtype=float), DIGITS).tolist()


def luminance(rgb):
    return float(sum(v * w for v, w in zip(rgb, BT709)))


def faces(mesh):
    """Corners of faces: numbers of points, and of themselves."""
    counts, indices = mesh.GetFaceVertexCountsAttr().Get(TIME), mesh.GetFaceVertexIndicesAttr().Get(TIME)
    at = 0
    for face, count in enumerate(counts):
        yield face, [(indices[at + i], at + i) for i in range(count)]
        at += count


def newell(corners):
    """The area of a polygon along its normal."""
    fan = range(1, len(corners) - 1)
    return sum((np.cross(corners[i] - corners[0], corners[i + 1] - corners[0]) for i in fan), np.zeros(3)) / 2


def mesh_figures(prim, to_world, metres):
    mesh = UsdGeom.Mesh(prim)
    points = [np.array(to_world.Transform(Gf.Vec3d(p))) * metres for p in mesh.GetPointsAttr().Get(TIME)]
    own = [np.array(p, dtype=float) for p in mesh.GetPointsAttr().Get(TIME)]
    left = mesh.GetOrientationAttr().Get() == "leftHanded"
    normals = to_world.GetInverse().GetTranspose()
    area, along = 0.0, np.zeros(3)
    for _, corners in faces(mesh):
        world = newell([points[p] for p, _ in corners])
        local = newell([own[p] for p, _ in corners]) * (-1 if left else 1)
        facing = np.array(normals.TransformDir(Gf.Vec3d(*local)))
        area += np.linalg.norm(world)
        along += world if world @ facing > 0 else -world
    used = [points[p] for _, corners in faces(mesh) for p, _ in corners]
    places = sorted(set(map(tuple, np.round(used, DIGITS).tolist())))
    made = {"points": places, "area": round(area, DIGITS), "along": rounded(along)}
    for name in ["st", "UVMap"]:
        primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar(name)
        if not primvar:
            continue
        flat = primvar.ComputeFlattened(TIME)
        element = {"vertex": 0, "varying": 0, "faceVarying": 1}[primvar.GetInterpolation()]
        pairs = set()
        for _, corners in faces(mesh):
            for corner in corners:
                place = np.round(points[corner[0]], DIGITS).tolist()
                pairs.add((*place, *map(float, flat[corner[element]])))
        made["uvs"] = rounded(sorted(pairs))
    return made


def light_figures(prim, to_world):
    """Luminance, cd/m², or illuminance, lx, and the colour by which it is."""
    get = lambda name: prim.GetAttribute(f"inputs:{name}").Get(TIME)
    color = [float(v) for v in get("color")]
    if get("enableColorTemperature"):
        body = UsdLux.BlackbodyTemperatureAsRgb(get("colorTemperature"))
        color = [a * b for a, b in zip(color, body)]
    level = get("intensity") * 2.0 ** get("exposure") * luminance(color)
    scale = [Gf.Vec3d(to_world.GetRow3(i)).GetLength() for i in range(3)]
    if prim.IsA(UsdLux.DistantLight):
        sine = math.sin(math.radians(get("angle") / 2))
        solid = math.pi * sine * sine
        return {"lux": level if get("normalize") else level * solid, "color": color}
    if get("normalize"):
        if prim.IsA(UsdLux.RectLight):
            level /= get("width") * scale[0] * get("height") * scale[1]
        else:
            level /= 4 * math.pi * (get("radius") * scale[0]) ** 2
    return {"luminance": level, "color": color}


def material_figures(material):
    shader = material.ComputeSurfaceSource()[0]
    made = {}
    for name in ["diffuseColor", "emissiveColor", "metallic", "roughness", "ior", "opacityThreshold"]:
        entry = shader.GetInput(name)
        if not entry:
            continue
        attributes = entry.GetValueProducingAttributes()
        prim = attributes[0].GetPrim() if attributes else None
        if prim and prim.IsA(UsdShade.Shader) and prim != shader.GetPrim():
            made[name] = {"file": Path(UsdShade.Shader(prim).GetInput("file").Get().path).name}
        elif attributes:
            value = attributes[0].Get()
            made[name] = rounded(value) if isinstance(value, Gf.Vec3f) else round(float(value), DIGITS)
    return made


def camera_figures(prim, metres):
    camera = UsdGeom.Camera(prim).GetCamera(TIME)
    to_world = camera.transform
    place = np.array(to_world.Transform(Gf.Vec3d(0))) * metres
    ahead, up = (to_world.TransformDir(Gf.Vec3d(*axis)).GetNormalized() for axis in [(0, 0, -1), (0, 1, 0)])
    made = {"place": rounded(place), "ahead": rounded(ahead), "up": rounded(up)}
    if camera.projection == Gf.Camera.Perspective:
        made["yfov_deg"] = camera.GetFieldOfView(Gf.Camera.FOVVertical)
        made["focal_m"] = camera.focalLength * Gf.Camera.FOCAL_LENGTH_UNIT * metres
        made["f_number"], made["focus_m"] = camera.fStop, camera.focusDistance * metres
    else:
        made["width_m"] = camera.frustum.window.GetSize()[0] * metres
    return made


def figures(file):
    global TIME
    stage = Usd.Stage.Open(str(file))
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    TIME = Usd.TimeCode(stage.GetStartTimeCode())
    cache = UsdGeom.XformCache(TIME)
    made = {"metres_per_unit": metres, "up": str(UsdGeom.GetStageUpAxis(stage)), "instances": []}
    made |= {key: {} for key in ["meshes", "lights", "cameras", "materials", "bound"]}
    instancers = []
    for prim in iter(Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies())):
        if any(str(prim.GetPath()).startswith(path) for path in instancers):
            continue
        to_world = cache.GetLocalToWorldTransform(prim)
        image = UsdGeom.Imageable(prim)
        is_seen = bool(image) and image.ComputeVisibility(TIME) != "invisible"
        drawn = is_seen and image.ComputePurpose() in ("default", "render")
        bound = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
        if prim.IsA(UsdGeom.PointInstancer):
            instancers.append(str(prim.GetPath()) + "/")
            instancer = UsdGeom.PointInstancer(prim)
            places = instancer.ComputeInstanceTransformsAtTime(TIME, TIME)
            own = [m * to_world for m in places]
            made["instances"] = [rounded(np.array(m.Transform(Gf.Vec3d(0))) * metres) for m in own]
        elif prim.IsA(UsdGeom.Mesh) and drawn:
            made["meshes"][prim.GetName()] = mesh_figures(prim, to_world, metres)
            if bound:
                made["bound"][prim.GetName()] = bound.GetPrim().GetName()
        elif prim.IsA(UsdGeom.Camera):
            made["cameras"][prim.GetName()] = camera_figures(prim, metres)
        elif prim.HasAPI(UsdLux.LightAPI):
            made["lights"][prim.GetName()] = light_figures(prim, to_world)
        elif prim.IsA(UsdShade.Material):
            made["materials"][prim.GetName()] = material_figures(UsdShade.Material(prim))
    return made


def main():
    source = FOLDER / "kinds.usda"
    # The same as a crate, and as a package with all that it names.
    Sdf.Layer.FindOrOpen(str(source)).Export(str(FOLDER / "kinds.usdc"))
    UsdUtils.CreateNewUsdzPackage(str(source), str(FOLDER / "kinds.usdz"))
    found = figures(source)
    for name in ["kinds.usdc", "kinds.usdz"]:
        other = figures(FOLDER / name)
        assert other == found, name
    lines = ",\n".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in found.items())
    (ROOT / "tests/oracles/figures/usd_scenes.json").write_text("{\n" + lines + "\n}\n")


if __name__ == "__main__":
    main()
