"""The scenes of the comparison, written once for every renderer.

A scene is a folder: `mesh.npz` (corners with normals and texture coordinates, triangles, the material of each),
`scene.json` (materials, lights, camera) for Mitsuba and Cycles, and `job.toml`, `mesh.obj` for Etendue. All of them are
made of the scenes that ship with the project:

- `cornell`: scenes/cornell, its quads and boxes as triangles, with the measured spectra.
- `street`: scenes/street, every instance written out, cars, kerbs and one kind of house divided in four, so that there
  are more than 800 000 triangles. Only materials that all renderers have: leaves and retro-reflecting signs are matt, and
  coats have alpha of 0.1 or more, so that no renderer waits for caustics.
- `night`: the same at night, under 50 lamps.
- `wet-night`: the night after rain: the carriageway under the coat of water of scenes/street/scene-wet-night.toml, with its
  own index and alpha.
"""

import json
import sys
import tomllib
from pathlib import Path

import numpy as np

import sky
from spectra import DATA, NM, OBSERVER, ROOT, black_body, on_grid, table, with_luminance

WIDTH, HEIGHT = 512, 384
# Etendue's jobs: the side of the blocks of pixels whose paths share their tails in each, px, whether paths are guided, and their branches.
JOBS = {"job.toml": (1, False, 1), "job-guided.toml": (1, True, 1), "job-branched.toml": (1, False, 4), "job-guided-branched.toml": (1, True, 4),
        "job-reuse.toml": (8, False, 1), "job-guided-reuse.toml": (8, True, 1)}
BOUNCES = 8
# The street's textures are named from where they lie.
STREET = ROOT / "scenes/street"
DIVIDED = {"hatchback", "saloon", "van", "house-a", "kerb"}
LEAST_ALPHA = 0.1
LEAST_TRIANGLES = 800_000
# Ready materials as the program knows them, and those whose alpha stays theirs.
PRESETS = tomllib.loads((ROOT / "crates/scene/src/preset/materials.toml").read_text())
OWN_ALPHA = {"asphalt_wet"}
# What stands for ready materials that not all renderers have, and is enough like them.
READY = {
    "marking_white": {"type": "diffuse", "reflectance": [0.56, 0.56, 0.54]},
    "car_paint_silver": {"type": "coated", "reflectance": [0.42, 0.43, 0.44], "alpha": LEAST_ALPHA},
    "car_paint_metallic_blue": {"type": "coated", "reflectance": [0.02, 0.06, 0.20], "alpha": LEAST_ALPHA},
    "rubber": {"type": "diffuse", "reflectance": [0.04, 0.04, 0.04]},
    "marking_white_wet": {"type": "diffuse", "reflectance": [0.56, 0.56, 0.54]},
    "skin_light": {"type": "diffuse", "reflectance": [0.45, 0.28, 0.20]},
}
SUN = {"elevation_deg": 38.0, "azimuth_deg": 150.0, "diameter_deg": 0.5338, "illuminance_lx": 75_000.0}
SUN_K, SKY_LX, GROUND_CD_M2 = 5300.0, 15_000.0, 2900.0
LAMPS, LAMP_CD_M2, LAMP_SIZE_M = 50, 6000.0, (0.6, 0.25)
# The lane ahead in the streets' pictures, 8 to 23 m away: first and last column and row, px.
ROAD = {"columns": (228, 284), "rows": (212, 260)}


class Mesh:
    """Triangles with corners of their own, each of one material."""

    def __init__(self):
        self.parts = []

    def add(self, corners, normals, uvs, material):
        """Triangles (n, 3, 3) with normals (n, 3, 3) and texture coordinates (n, 3, 2)."""
        self.parts.append((corners, normals, uvs, np.full(len(corners), material)))

    def arrays(self):
        """Corners shared where all they have is equal."""
        corners, normals, uvs, materials = (np.concatenate(a) for a in zip(*self.parts))
        rows = np.concatenate([corners, normals, uvs], axis=2).reshape(-1, 8)
        rows = np.round(rows, 6) + 0.0
        unique, index = np.unique(rows, axis=0, return_inverse=True)
        return {"corners": unique[:, :3], "normals": unique[:, 3:6], "uvs": unique[:, 6:],
                "triangles": index.reshape(-1, 3).astype(np.int32), "materials": materials.astype(np.int32)}


def rotation(yaw, pitch, roll):
    """Of docs/scene-format.md: rolled about x, then pitched about y, then yawed about z."""
    (cy, sy), (cp, sp), (cr, sr) = ((np.cos(a), np.sin(a)) for a in np.radians([yaw, pitch, roll]))
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    return about_z @ about_y @ about_x


def placed(triangles, place):
    """Corners and normals moved as an instance says."""
    corners, normals, uvs = triangles
    scale = np.broadcast_to(np.asarray(place.get("scale", 1.0), float), 3)
    turn = rotation(*place.get("rotation_deg", [0, 0, 0]))
    normals = (normals / scale) @ turn.T
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    return (corners * scale) @ turn.T + np.asarray(place.get("position_m", [0, 0, 0]), float), normals, uvs


def flat_normals(corners):
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    return np.repeat(normal[:, None], 3, axis=1)


def quad(width, height):
    """Of docs/format/scene.md: in z = 0, front towards +z."""
    x, y = width / 2, height / 2
    points = np.array([[-x, -y, 0], [x, -y, 0], [x, y, 0], [-x, y, 0]])
    corners = points[[[0, 1, 2], [0, 2, 3]]]
    uvs = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])[[[0, 1, 2], [0, 2, 3]]]
    return corners, flat_normals(corners), uvs


def box(x, y, z):
    """Six quads outwards."""
    faces = [((0, 0, 0), (x, y, z)), ((0, 180, 0), (x, y, z)), ((0, 90, 0), (z, y, x)), ((0, -90, 0), (z, y, x)),
             ((0, 0, 90), (x, z, y)), ((0, 0, -90), (x, z, y))]
    parts = []
    for turn, (width, height, depth) in faces:
        out = rotation(*turn) @ [0, 0, depth / 2]
        parts.append(placed(quad(width, height), {"rotation_deg": turn, "position_m": out}))
    return tuple(np.concatenate(a) for a in zip(*parts))


def read_obj(path):
    """Triangles of an OBJ file of this project, flat where it has no normals, and each one's name of a material."""
    points, uvs, normals, faces, names, name = [], [[0.0, 0.0]], [[0.0, 0.0, 0.0]], [], [], ""
    for line in path.read_text().splitlines():
        kind, *words = line.split() or [""]
        if kind in ("v", "vt", "vn"):
            {"v": points, "vt": uvs, "vn": normals}[kind].append([float(w) for w in words])
        elif kind == "usemtl":
            name = words[0]
        elif kind == "f":
            corners = [[int(i or 0) for i in (w + "//").split("/")[:3]] for w in words]
            for i in range(1, len(corners) - 1):
                faces.append([corners[0], corners[i], corners[i + 1]])
                names.append(name)
    f = np.array(faces)
    corners = np.array(points)[f[..., 0] - 1]
    smooth = np.array(normals)[f[..., 2]]
    smooth = np.where(f[..., 2:] == 0, flat_normals(corners), smooth)
    return (corners, smooth, np.array(uvs)[f[..., 1]]), np.array(names)


def divided(triangles):
    """Each triangle as four."""
    def halves(a):
        ab, bc, ca = ((a[:, i] + a[:, (i + 1) % 3]) / 2 for i in range(3))
        four = [[a[:, 0], ab, ca], [ab, a[:, 1], bc], [ca, bc, a[:, 2]], [ab, bc, ca]]
        return np.concatenate([np.stack(t, axis=1) for t in four])
    corners, normals, uvs = (halves(a) for a in triangles)
    return corners, normals / np.linalg.norm(normals, axis=2, keepdims=True), uvs


def pinhole(position, yaw_pitch_roll, focal_mm, pitch_um):
    return {"position_m": list(position), "rotation_deg": list(yaw_pitch_roll), "focal_length_mm": focal_mm,
            "pixel_pitch_um": pitch_um, "width_px": WIDTH, "height_px": HEIGHT}


def spectrum(points):
    return [[float(a), float(b)] for a, b in points]


def emission(relative, luminance):
    return spectrum(zip(NM, with_luminance(relative, luminance)))


def cornell():
    """The box of scenes/cornell; the camera's picture is as wide as the opening."""
    folder = ROOT / "scenes/cornell"
    described = tomllib.loads((folder / "cornell.toml").read_text())
    materials, mesh = [], Mesh()
    for m in described["scene"]["materials"]:
        r = m["reflectance"]
        points = table(folder / r["spectrum"]) if isinstance(r, dict) else [[400.0, r], [700.0, r]]
        material = {"name": m["name"], "kind": "diffuse", "spectrum": spectrum(points)}
        if "emission" in m:
            relative = on_grid(table(folder / m["emission"]["spectrum"]))
            material["emission"] = emission(relative, m["emission"]["luminance_cd_m2"])
        materials.append(material)
    names = [m["name"] for m in materials]
    objects = []
    for i, o in enumerate(described["scene"]["objects"]):
        shape = quad(*o["shape"]["size_m"]) if o["shape"]["type"] == "quad" else box(*o["shape"]["size_m"])
        mesh.add(*placed(shape, o), names.index(o["material"]))
        objects += [i] * len(shape[0])
    camera = described["cameras"][0]
    view = pinhole(camera["position_m"], camera["rotation_deg"], camera["lens"]["focal_length_mm"], 25e3 / WIDTH)
    return {"materials": materials, "camera": view, "objects": objects}, mesh


def street_material(m, files):
    """In terms of what all renderers have."""
    preset = m.get("preset")
    m = READY.get(preset, PRESETS.get(preset, {})) | m
    alpha = m["alpha"] if preset in OWN_ALPHA else max(m.get("alpha", 0.0), LEAST_ALPHA)
    if m["type"] == "conductor":
        return {"name": m["name"], "kind": "conductor", "metal": m["metal"], "alpha": alpha}
    material = {"name": m["name"], "kind": "coated" if m["type"] == "coated" else "diffuse"}
    colour = m["print"] if m["type"] == "retro_sheeting" else m["reflectance"]
    if isinstance(colour, dict):
        material["texture"] = files[colour["texture"]]
    else:
        material["rgb"] = colour
    if m["type"] == "coated":
        material |= {"alpha": alpha, "index": m.get("index", 1.5)}
    return material


def street_mesh(described, names):
    mesh = Mesh()
    files = {m["name"]: read_obj(STREET / m["file"]) for m in described["meshes"]}
    for o in described["objects"]:
        triangles, slots = files[o["mesh"]]
        for slot in np.unique(slots):
            chosen = tuple(a[slots == slot] for a in triangles)
            chosen = divided(chosen) if o["mesh"] in DIVIDED else chosen
            material = names.index(o.get("material") or o.get("materials", {}).get(slot, slot))
            for place in o["instances"]:
                mesh.add(*placed(chosen, place), material)
    return mesh


def street(changed=()):
    """By day; materials that are changed stand in the place of those of their names."""
    described = tomllib.loads((STREET / "scene.toml").read_text())
    files = {t["name"]: str(STREET / t["file"]) for t in described["textures"]}
    changes = {m["name"]: m for m in changed}
    materials = [street_material(changes.get(m["name"], m), files) for m in described["materials"]]
    mesh = street_mesh(described, [m["name"] for m in materials])
    light = SUN | {"irradiance": emission(black_body(SUN_K), SUN["illuminance_lx"])}
    view = pinhole([0, -1.6, 1.35], [0, 0.5, 0], 4.6, 5760.0 / WIDTH)
    return {"materials": materials, "camera": view, "sun": light, "sky": "sky.hdr", "road": ROAD}, mesh


def towards_sun():
    elevation, azimuth = np.radians([SUN["elevation_deg"], SUN["azimuth_deg"]])
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])


def night(changed=()):
    """By night: lamps face down, 6 m above the kerbs, on both sides in turn."""
    scene, mesh = street(changed)
    del scene["sun"], scene["sky"]
    relative = on_grid(table(DATA / "illuminant_led_b3.csv"))
    scene["materials"].append({"name": "lamp", "kind": "emitter", "emission": emission(relative, LAMP_CD_M2)})
    for i in range(LAMPS):
        position = [-60.0 + 240.0 * (i + 0.5) / LAMPS, 4.5 if i % 2 else -4.5, 6.0]
        place = {"position_m": position, "rotation_deg": [0, 180, 0]}
        mesh.add(*placed(quad(*LAMP_SIZE_M), place), len(scene["materials"]) - 1)
    return scene, mesh


def wet_night():
    """The night after rain."""
    return night(tomllib.loads((STREET / "scene-wet-night.toml").read_text())["materials"])


def write_spectrum(folder, name, points):
    (folder / name).write_text("".join(f"{nm:.9g},{value:.9g}\n" for nm, value in points))
    return f'{{ spectrum = "{name}" }}'


def toml_material(folder, m):
    lines = ["", "[[scene.materials]]", f'name = "{m["name"]}"', f'type = "{m["kind"]}"']
    if "rgb" in m:
        lines.append(f"reflectance = {m['rgb']}")
    if "texture" in m:
        lines.append(f'reflectance = {{ texture = "{Path(m["texture"]).stem}" }}')
    if "spectrum" in m:
        lines.append(f"reflectance = {write_spectrum(folder, m['name'] + '.csv', m['spectrum'])}")
    if "metal" in m:
        lines.append(f'metal = "{m["metal"]}"')
    if "alpha" in m:
        lines.append(f"alpha = {m['alpha']}")
    if "index" in m:
        lines.append(f"index = {m['index']}")
    if "emission" in m:
        light = write_spectrum(folder, m["name"] + "-emission.csv", m["emission"])
        lines.append(f"emission = {{ radiance_w_m2_sr_nm = {light} }}")
    return lines


def toml_lights(folder, scene):
    lines = []
    if "sun" in scene:
        sun = scene["sun"]
        write_spectrum(folder, "sun.csv", sun["irradiance"])
        lines += ["", "[[scene.lights]]", 'type = "sun"', 'name = "sun"', f"elevation_deg = {sun['elevation_deg']}",
                  f"azimuth_deg = {sun['azimuth_deg']}", f"illuminance_lx = {sun['illuminance_lx']}",
                  'spectrum = "sun.csv"', f"angular_diameter_deg = {sun['diameter_deg']}"]
    if "sky" in scene:
        lines += ["", "[scene.environment]", 'type = "image"', f'file = "{scene["sky"]}"',
                  "luminance_cd_m2_per_unit = 1"]
    return lines


def job(folder, scene, reuse_px, is_guided, branches):
    """Etendue's job as text: a pinhole whose pixels respond like the eye, so that electrons stand for luminance."""
    write_spectrum(folder, "eye.csv", zip(NM, 400.0 * OBSERVER[:, 1] / NM))
    c = scene["camera"]
    lines = ["format = 1", "", "[scene]"]
    for path in sorted({m["texture"] for m in scene["materials"] if "texture" in m}):
        lines += ["", "[[scene.textures]]", f'name = "{Path(path).stem}"', f'file = "{path}"', 'encoding = "srgb"']
    for m in scene["materials"]:
        lines += toml_material(folder, m)
    lines += ["", "[[scene.meshes]]", 'name = "all"', 'file = "mesh.obj"', 'up_axis = "z"',
              "", "[[scene.objects]]", 'name = "all"', 'mesh = "all"',
              "materials = { " + ", ".join(f'{m["name"]} = "{m["name"]}"' for m in scene["materials"]) + " }"]
    lines += toml_lights(folder, scene)
    lines += ["", "[[cameras]]", 'name = "eye"', f"position_m = {c['position_m']}", f"rotation_deg = {c['rotation_deg']}",
              "", "[cameras.lens]", 'type = "pinhole"', f"focal_length_mm = {c['focal_length_mm']}", "f_number = 8",
              "", "[cameras.sensor]", f"width_px = {c['width_px']}", f"height_px = {c['height_px']}",
              f"pixel_pitch_um = {c['pixel_pitch_um']}", "exposure_s = 1.0", 'cfa = "mono"',
              'quantum_efficiency = { spectrum = "eye.csv" }', "full_well_e = 1e12", "read_noise_e = 0",
              "dark_current_e_s = 0", "gain_dn_per_e = 1", "black_level_dn = 0", "bits = 16",
              "", "[render]", "spp = 64", "replicates = 1", f"path_reuse_px = {reuse_px}", f"branches = {branches}", f"guiding = {str(is_guided).lower()}", f"max_bounces = {BOUNCES}", "wavelength_range_nm = [360, 830]",
              "", "[output]", "electrons = true", "raw = false", "ground_truth = false", ""]
    return "\n".join(lines)


def write_obj(path, arrays, names):
    """One mesh, grouped by material."""
    with open(path, "w") as out:
        for key, tag in (("corners", "v"), ("uvs", "vt"), ("normals", "vn")):
            rows = arrays[key]
            out.write("".join(tag + " " + " ".join(f"{x:.7g}" for x in row) + "\n" for row in rows))
        for i, name in enumerate(names):
            chosen = arrays["triangles"][arrays["materials"] == i] + 1
            if len(chosen):
                out.write(f"usemtl {name}\n")
                out.write("".join("f " + " ".join(f"{k}/{k}/{k}" for k in t) + "\n" for t in chosen.tolist()))


SCENES = {"cornell": cornell, "street": street, "night": night, "wet-night": wet_night}


def write(name, folder):
    folder.mkdir(parents=True, exist_ok=True)
    scene, mesh = SCENES[name]()
    arrays = mesh.arrays()
    used = np.unique(arrays["materials"])
    scene["materials"] = [scene["materials"][i] for i in used]
    arrays["materials"] = np.searchsorted(used, arrays["materials"]).astype(np.int32)
    if name != "cornell" and len(arrays["triangles"]) < LEAST_TRIANGLES:
        sys.exit(f"{name} has {len(arrays['triangles'])} triangles; divide more of its meshes (DIVIDED)")
    scene["triangles"], scene["bounces"] = len(arrays["triangles"]), BOUNCES
    np.savez(folder / "mesh.npz", **arrays)
    if "sky" in scene:
        sky.write(folder / scene["sky"], sky.pixels(towards_sun(), SKY_LX, GROUND_CD_M2))
    write_obj(folder / "mesh.obj", arrays, [m["name"] for m in scene["materials"]])
    for name_of_job, ways in JOBS.items():
        (folder / name_of_job).write_text(job(folder, scene, *ways))
    (folder / "scene.json").write_text(json.dumps(scene))
    print(f"{name}: {scene['triangles']} triangles")


if __name__ == "__main__":
    target = Path(sys.argv[1])
    for scene_name in sys.argv[2:] or SCENES:
        write(scene_name, target / scene_name)
