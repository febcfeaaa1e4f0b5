"""A scene of the comparison in Mitsuba 3, variant llvm_ad_spectral.

render.py SCENE_DIR OUT.npy SPP THREADS SEED... renders once for each seed, after a rendering of another seed that
compiles the kernels; the luminance (cd/m2) of seed n goes to OUT.npy with n in place of a %. Each line of the standard
output has a seed and the processor seconds of all threads; the first, after a #, the instruction set of the kernels.
PEER_MITSUBA_TARGET=x86-64-v3 holds the kernels to AVX2 (PEER_MITSUBA_LANES, 8) on a machine that has more.
"""

import ctypes
import json
import math
import os
import re
import resource
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import spectra  # noqa: E402
from scenes import rotation  # noqa: E402

import drjit as dr  # noqa: E402
import mitsuba as mi  # noqa: E402

mi.set_variant(os.environ.get("PEER_VARIANT", "llvm_ad_spectral"))

# Mitsuba's film gives Y = sum of L ybar / 106.857; spectra times this make it cd/m2. Colours (the sky's) are relative
# to D65 of Y = 1, hence already in cd/m2.
UNIT = spectra.LUMENS_PER_WATT * 106.856895
# 1 m in 1e6: parallax of the sun over the street below 1e-4 rad.
SUN_DISTANCE_M = 1e6
SUN_CORNERS = 64


def regular(points, scale=1.0):
    """A spectrum on a uniform grid; ends are held."""
    points = np.array(points)
    nm = np.arange(360.0, 833.0, 1.0)
    values = scale * np.interp(nm, points[:, 0], points[:, 1])
    return {"type": "regular", "wavelength_min": nm[0], "wavelength_max": nm[-1],
            "values": ",".join(f"{v:.9g}" for v in values)}


def reflectance(m):
    if "texture" in m:
        return {"type": "bitmap", "filename": m["texture"]}
    if "spectrum" in m:
        return regular(m["spectrum"])
    return {"type": "rgb", "value": m["rgb"]}


def bsdf(m):
    if m["kind"] == "diffuse":
        inner = {"type": "diffuse", "reflectance": reflectance(m)}
    elif m["kind"] == "coated":
        inner = {"type": "roughplastic", "diffuse_reflectance": reflectance(m), "alpha": m["alpha"],
                 "distribution": "ggx", "int_ior": m["index"], "ext_ior": 1.0, "nonlinear": True}
    elif m["kind"] == "conductor":
        inner = {"type": "roughconductor", "material": m["metal"], "alpha": m["alpha"], "distribution": "ggx"}
    else:
        return {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
    return {"type": "twosided", "bsdf": inner}


def write_ply(path, corners, normals, uvs, triangles):
    """Binary; v runs downwards in Mitsuba's pictures."""
    rows = np.concatenate([corners, normals, uvs], axis=1).astype("<f4")
    rows[:, 7] = 1.0 - rows[:, 7]
    faces = np.empty(len(triangles), dtype=[("n", "u1"), ("i", "<i4", 3)])
    faces["n"], faces["i"] = 3, triangles
    names = "x y z nx ny nz u v".split()
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(rows)}"]
    head += [f"property float {n}" for n in names]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    path.write_bytes("\n".join(head).encode() + rows.tobytes() + faces.tobytes())


def meshes(folder, scene):
    """One mesh a material."""
    arrays, found = np.load(folder / "mesh.npz"), {}
    for i, m in enumerate(scene["materials"]):
        chosen = arrays["triangles"][arrays["materials"] == i]
        if not len(chosen):
            continue
        used, index = np.unique(chosen, return_inverse=True)
        path = folder / f"{m['name']}.ply"
        write_ply(path, *(arrays[k][used] for k in ("corners", "normals", "uvs")), index.reshape(-1, 3))
        found[m["name"]] = {"type": "ply", "filename": str(path), "bsdf": bsdf(m)}
        if "emission" in m:
            found[m["name"]]["emitter"] = {"type": "area", "radiance": regular(m["emission"], UNIT)}
    return found


def sun(folder, light):
    """The sun's disc as a far polygon of the same solid angle."""
    elevation, azimuth = math.radians(light["elevation_deg"]), math.radians(light["azimuth_deg"])
    towards = np.array([math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth),
                        math.sin(elevation)])
    across = np.cross(towards, [0.0, 0.0, 1.0])
    across /= np.linalg.norm(across)
    down = np.cross(towards, across)
    area = math.pi * math.tan(math.radians(light["diameter_deg"] / 2)) ** 2
    radius = math.sqrt(area / (0.5 * SUN_CORNERS * math.sin(2 * math.pi / SUN_CORNERS)))
    turn = 2 * math.pi * np.arange(SUN_CORNERS)[:, None] / SUN_CORNERS
    rim = SUN_DISTANCE_M * (towards + radius * (np.cos(turn) * across + np.sin(turn) * down))
    corners = np.concatenate([[SUN_DISTANCE_M * towards], rim])
    fan = np.array([[0, 1 + i, 1 + (i + 1) % SUN_CORNERS] for i in range(SUN_CORNERS)])
    facing = np.dot(np.cross(corners[fan[0, 1]] - corners[0], corners[fan[0, 2]] - corners[0]), towards) < 0
    fan = fan if facing else fan[:, ::-1]
    path = folder / "sun.ply"
    write_ply(path, corners, np.broadcast_to(-towards, corners.shape), np.zeros((len(corners), 2)), fan)
    scale = UNIT / (math.pi * math.sin(math.radians(light["diameter_deg"] / 2)) ** 2)
    return {"type": "ply", "filename": str(path), "bsdf": bsdf({"kind": "emitter"}),
            "emitter": {"type": "area", "radiance": regular(light["irradiance"], scale)}}


def sensor(c):
    turn, at = rotation(*c["rotation_deg"]), np.array(c["position_m"], float)
    width_mm = c["width_px"] * c["pixel_pitch_um"] * 1e-3
    return {
        "type": "perspective",
        "fov": math.degrees(2 * math.atan(width_mm / 2 / c["focal_length_mm"])), "fov_axis": "x",
        "near_clip": 1e-3, "far_clip": 1e7,
        "to_world": mi.ScalarTransform4f().look_at(list(at), list(at + turn[:, 0]), list(turn[:, 2])),
        "film": {"type": "hdrfilm", "width": c["width_px"], "height": c["height_px"], "pixel_format": "xyz",
                 "component_format": "float32", "rfilter": {"type": "box"}},
        "sampler": {"type": os.environ.get("PEER_SAMPLER", "independent")},
    }


def load(folder):
    scene = json.loads((folder / "scene.json").read_text())
    # A path of n scattering events has depth n + 1; roulette begins after the fourth as in Etendue.
    described = {"type": "scene", "sensor": sensor(scene["camera"]),
                 "integrator": {"type": "path", "max_depth": scene["bounces"] + 1, "rr_depth": 4}}
    described |= meshes(folder, scene)
    if "sun" in scene:
        described["the-sun"] = sun(folder, scene["sun"])
    if "sky" in scene:
        # Its picture's centre looks along the local +z with y up.
        turn = mi.ScalarTransform4f([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
        described["the-sky"] = {"type": "envmap", "filename": str(folder / scene["sky"]), "to_world": turn}
    return mi.load_dict(described)


def seconds():
    use = resource.getrusage(resource.RUSAGE_SELF)
    return use.ru_utime + use.ru_stime


# Samples of one kernel launch: memory is limited, one launch of 512 x 384 x 64 samples is 12.6 million lanes.
LAUNCH_SPP = 64


def render(scene, spp, seed):
    """Luminance, in launches that fit into memory."""
    parts = []
    for i in range(math.ceil(spp / LAUNCH_SPP)):
        image = mi.render(scene, spp=min(spp, LAUNCH_SPP), seed=1000 * seed + i)
        dr.eval(image)
        parts.append(np.array(image, dtype=np.float64)[..., 1])
    return np.mean(parts, axis=0)


def hold(target, lanes):
    """Kernels for a processor that is not this one. DrJit has it in its library, not in Python; Embree, which traces the rays, goes on choosing for itself."""
    library = next(Path(dr.__file__).parent.glob("libdrjit-core.*"))
    set_target = ctypes.CDLL(str(library))["_Z19jit_llvm_set_targetPKcS0_j"]
    set_target.argtypes, set_target.restype = [ctypes.c_char_p, ctypes.c_char_p, ctypes.c_uint32], None
    set_target(target.encode(), None, lanes)


def instructions():
    """The lanes and the target of a kernel that LLVM was given."""
    with dr.scoped_set_flag(dr.JitFlag.KernelHistory, True):
        dr.eval(dr.llvm.Float([1.0, 2.0]) + 1.0)
        code = dr.kernel_history()[0]["ir"].getvalue()
    lanes, target = re.search(r"<(\d+) x float>", code)[1], re.search(r'"target-cpu"="([^"]*)"', code)[1]
    wide = next((name for name in ("avx512f", "avx2", "neon") if f"+{name}" in code), "what that has")
    return f"LLVM {'.'.join(map(str, dr.detail.llvm_version()))} for {target}, {wide}, {lanes} lanes"


def main(folder, out, spp, threads, *seeds):
    dr.set_thread_count(int(threads))
    if target := os.environ.get("PEER_MITSUBA_TARGET"):
        hold(target, int(os.environ.get("PEER_MITSUBA_LANES", "8")))
    print("#", instructions(), flush=True)
    scene = load(Path(folder))
    render(scene, min(int(spp), LAUNCH_SPP), 999)
    for seed in seeds:
        before = seconds()
        luminance = render(scene, int(spp), int(seed))
        print(seed, seconds() - before, flush=True)
        np.save(out.replace("%", seed), luminance.astype(np.float32))


if __name__ == "__main__":
    main(*sys.argv[1:])
