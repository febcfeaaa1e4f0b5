"""A scene of the comparison in Cycles (bpy): the same arguments and answers as ../mitsuba/render.py.

Blender synchronises the scene at every rendering. That and whatever else does not grow with the samples is measured by
renderings of one sample and taken off.
"""

import json
import math
import os
import resource
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import spectra  # noqa: E402
from scenes import rotation  # noqa: E402

import bpy  # noqa: E402
import _cycles  # noqa: E402 (bpy brings it along)
from mathutils import Matrix, Vector  # noqa: E402

# Cycles' radiance of 1 stands for this luminance, cd/m2.
UNIT = 1000.0
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def light_rgb(points):
    points = np.array(points)
    return spectra.rgb_of_light(spectra.on_grid(points)) / UNIT


def reflectance_rgb(m, light):
    if "rgb" in m:
        return m["rgb"]
    return spectra.rgb_of_reflectance(spectra.on_grid(np.array(m["spectrum"]), "hold"), light)


def node(tree, kind, **inputs):
    made = tree.nodes.new(kind)
    for name, value in inputs.items():
        made.inputs[name.replace("_", " ")].default_value = value
    return made


def surface(tree, m, light):
    """The node that scatters."""
    if m["kind"] == "emitter":
        return None
    if m["kind"] == "conductor":
        # Physical conductor of aluminium at red, green and blue (crates/spectra/data/nk_al.csv at 630, 532, 465 nm).
        made = node(tree, "ShaderNodeBsdfMetallic", Roughness=math.sqrt(m["alpha"]))
        made.fresnel_type, made.distribution = "PHYSICAL_CONDUCTOR", "GGX"
        made.inputs["IOR"].default_value = (1.43, 0.94, 0.69)
        made.inputs["Extinction"].default_value = (7.52, 6.42, 5.64)
        return made
    if m["kind"] == "coated":
        made = node(tree, "ShaderNodeBsdfPrincipled", Roughness=math.sqrt(m["alpha"]), IOR=m["index"])
        made.distribution = "GGX"
        colour = made.inputs["Base Color"]
    else:
        made = node(tree, "ShaderNodeBsdfDiffuse")
        colour = made.inputs["Color"]
    if "texture" in m:
        picture = tree.nodes.new("ShaderNodeTexImage")
        picture.image = bpy.data.images.load(m["texture"], check_existing=True)
        tree.links.new(picture.outputs["Color"], colour)
    else:
        colour.default_value = (*reflectance_rgb(m, light), 1.0)
    return made


def glow(tree, m):
    """Emission of the front."""
    rgb = light_rgb(m["emission"])
    made = node(tree, "ShaderNodeEmission", Color=(*(rgb / rgb.max()), 1.0))
    front = tree.nodes.new("ShaderNodeMath")
    front.operation = "MULTIPLY_ADD"
    tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], front.inputs[0])
    front.inputs[1].default_value, front.inputs[2].default_value = -rgb.max(), rgb.max()
    tree.links.new(front.outputs[0], made.inputs["Strength"])
    return made


def material(m, light):
    made = bpy.data.materials.new(m["name"])
    made.use_nodes = True
    tree = made.node_tree
    tree.nodes.clear()
    out, shader = tree.nodes.new("ShaderNodeOutputMaterial"), surface(tree, m, light)
    if "emission" in m:
        made.cycles.emission_sampling = "FRONT"
        emitted, scattered = glow(tree, m), shader
        shader = emitted
        if scattered is not None:
            shader = tree.nodes.new("ShaderNodeAddShader")
            tree.links.new(emitted.outputs[0], shader.inputs[0])
            tree.links.new(scattered.outputs[0], shader.inputs[1])
    tree.links.new(shader.outputs[0], out.inputs["Surface"])
    return made


def mesh(arrays, materials):
    made = bpy.data.meshes.new("all")
    corners, triangles = arrays["corners"], arrays["triangles"]
    made.vertices.add(len(corners))
    made.vertices.foreach_set("co", corners.astype(np.float32).ravel())
    made.loops.add(triangles.size)
    made.loops.foreach_set("vertex_index", triangles.ravel())
    made.polygons.add(len(triangles))
    made.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    made.polygons.foreach_set("material_index", arrays["materials"])
    made.uv_layers.new().data.foreach_set("uv", arrays["uvs"][triangles.ravel()].astype(np.float32).ravel())
    for m in materials:
        made.materials.append(m)
    made.update(calc_edges=True)
    made.normals_split_custom_set_from_vertices(arrays["normals"].astype(np.float32))
    bpy.context.collection.objects.link(bpy.data.objects.new("all", made))


def camera(c):
    made = bpy.data.cameras.new("eye")
    made.sensor_fit, made.lens = "HORIZONTAL", c["focal_length_mm"]
    made.sensor_width = c["width_px"] * c["pixel_pitch_um"] * 1e-3
    made.clip_start, made.clip_end = 1e-3, 1e5
    turn = rotation(*c["rotation_deg"])
    axes = np.stack([-turn[:, 1], turn[:, 2], -turn[:, 0]], axis=1)
    eye = bpy.data.objects.new("eye", made)
    eye.matrix_world = Matrix.LocRotScale(Vector(c["position_m"]), Matrix(axes.tolist()), None)
    bpy.context.collection.objects.link(eye)
    bpy.context.scene.camera = eye


def sun(light):
    made = bpy.data.lights.new("sun", "SUN")
    rgb = light_rgb(light["irradiance"])
    made.color, made.energy, made.angle = rgb / rgb.max(), rgb.max(), math.radians(light["diameter_deg"])
    # One side's irradiance of a lamp of energy E is E.
    elevation, azimuth = math.radians(light["elevation_deg"]), math.radians(light["azimuth_deg"])
    towards = Vector((math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth),
                      math.sin(elevation)))
    lamp = bpy.data.objects.new("sun", made)
    lamp.rotation_mode, lamp.rotation_quaternion = "QUATERNION", towards.to_track_quat("Z", "Y")
    bpy.context.collection.objects.link(lamp)


def world(folder, scene):
    made = bpy.data.worlds.new("world")
    bpy.context.scene.world = made
    made.use_nodes = True
    tree = made.node_tree
    background = tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    if "sky" in scene:
        picture = tree.nodes.new("ShaderNodeTexEnvironment")
        picture.image = bpy.data.images.load(str(folder / scene["sky"]))
        tree.links.new(picture.outputs["Color"], background.inputs["Color"])
        background.inputs["Strength"].default_value = 1.0 / UNIT


def settings(scene, threads):
    s = bpy.context.scene
    s.render.engine = "CYCLES"
    s.render.resolution_x, s.render.resolution_y = scene["camera"]["width_px"], scene["camera"]["height_px"]
    s.render.resolution_percentage = 100
    s.render.threads_mode, s.render.threads = "FIXED", threads
    s.render.use_persistent_data = True
    s.render.image_settings.file_format, s.render.image_settings.color_depth = "OPEN_EXR", "32"
    c = s.cycles
    c.device, c.use_adaptive_sampling, c.use_denoising = "CPU", False, False
    c.pixel_filter_type = "BOX"
    c.sample_clamp_direct = c.sample_clamp_indirect = c.blur_glossy = 0.0
    # Blender counts bounces after the first surface. Roulette as early as in the others.
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = scene["bounces"] - 1
    c.min_light_bounces = 3
    c.use_auto_tile = False


def load(folder, threads):
    scene = json.loads((folder / "scene.json").read_text())
    bpy.ops.wm.read_factory_settings(use_empty=True)
    lights = [m["emission"] for m in scene["materials"] if "emission" in m]
    light = spectra.on_grid(np.array(lights[0])) if lights else None
    mesh(np.load(folder / "mesh.npz"), [material(m, light) for m in scene["materials"]])
    camera(scene["camera"])
    if "sun" in scene:
        sun(scene["sun"])
    world(folder, scene)
    settings(scene, threads)


def seconds():
    use = resource.getrusage(resource.RUSAGE_SELF)
    return use.ru_utime + use.ru_stime


def rendered(spp, seed, path):
    """Processor seconds."""
    s = bpy.context.scene
    s.cycles.samples, s.cycles.seed, s.render.filepath = spp, seed, str(path)
    before = seconds()
    bpy.ops.render.render(write_still=True)
    return seconds() - before


def luminance(path):
    image = bpy.data.images.load(str(path), check_existing=False)
    width, height = image.size
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return UNIT * (pixels.reshape(height, width, 4)[::-1, :, :3] @ LUMINANCE)


def main(folder, out, spp, threads, *seeds):
    # Blender talks on the standard output; the answers go where it was.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    print("#", *_cycles.system_info().split(), file=answers, flush=True)
    load(Path(folder), int(threads))
    spp = int(spp)
    with tempfile.TemporaryDirectory() as temporary:
        path = Path(temporary) / "picture.exr"
        rendered(1, 0, path)
        start = min(rendered(1, 0, path) for _ in range(2))
        for seed in seeds:
            taken = (rendered(spp, int(seed), path) - start) * spp / max(spp - 1, 1)
            np.save(out.replace("%", seed), luminance(path).astype(np.float32))
            print(seed, taken, file=answers, flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
