"""Arrays: shapes, types, and that they share the memory of the results."""

import collections.abc
import gc

import numpy as np
import pytest
from conftest import JOB

import etendue


def test_planes_have_the_shapes_and_types_that_are_told(results):
    front = results[results.names[0]]
    height, width = front.depth.shape
    bands = len(front.wavelengths_nm)
    expected = {
        "radiance": (np.float32, (bands, height, width)),
        "radiance_variance": (np.float32, (bands, height, width)),
        "electrons": (np.float32, (height, width)),
        "raw": (np.uint32, (height, width)),
        "picture": (np.float32, (height, width, 3)),
        "depth": (np.float32, (height, width)),
        "distance": (np.float32, (height, width)),
        "normals": (np.float32, (height, width, 3)),
        "positions": (np.float32, (height, width, 3)),
        "instance_ids": (np.uint32, (height, width)),
        "semantic_ids": (np.uint32, (height, width)),
        "material_ids": (np.uint32, (height, width)),
        "flow": (np.float32, (height, width, 2)),
    }
    for name, (dtype, shape) in expected.items():
        array = getattr(front, name)
        assert (array.dtype, array.shape) == (dtype, shape), name
    lengths = np.linalg.norm(front.normals[front.instance_ids > 0], axis=1)
    assert np.allclose(lengths, 1, atol=1e-6)
    assert front.electrons.min() >= 0 and front.picture.min() >= 0 and front.picture.max() <= 1
    rays = front.rays
    seen = rays["ray"] > 0
    assert np.allclose(np.linalg.norm(rays["direction"][seen], axis=-1), 1, atol=1e-6)
    assert front.disparity is None and front.disparity_visibility is None


def test_what_two_accesses_give_shares_its_memory_and_cannot_be_changed(results):
    front = results.cameras[0]
    for name in ("electrons", "radiance", "depth", "normals", "raw", "picture", "flow"):
        once, again = getattr(front, name), getattr(front, name)
        assert np.shares_memory(once, again) and not once.flags.writeable and not once.flags.owndata, name
        with pytest.raises(ValueError):
            once[...] = 0
        assert once.copy().flags.writeable


def test_arrays_outlive_the_results():
    depth = etendue.Job.open(JOB, spp=1).render().cameras[0].depth
    expected = depth.copy()
    gc.collect()
    etendue.Job.open(JOB, spp=1).render()
    assert np.array_equal(depth, expected, equal_nan=True)


def test_frames_are_taken_with_the_same_bits(results):
    front = results.cameras[0]
    (frame,) = front.frames()
    assert isinstance(frame, collections.abc.Mapping) and list(frame) == ["raw", "picture", "linear_picture"] and len(frame) == 3
    assert np.shares_memory(frame["raw"], frame.raw) and "depth" not in frame and frame.get("depth") is None
    assert frame.number == 0 and list(front.frame_numbers) == [0]
    assert np.array_equal(frame.raw, front.raw) and np.array_equal(frame.picture, front.picture)
    assert frame.raw.max() < 2**frame.bits and 0 <= frame.black_level_dn < frame.white_level_dn
    assert frame.linear_picture.shape == frame.picture.shape


def test_boxes_and_motion_are_those_of_the_ground_truth(results):
    front = results.cameras[0]
    objects = front.boxes["objects"]
    assert {box["id"] for box in objects if box["visible_pixels"]} == set(np.unique(front.instance_ids)) - {0}
    for box in objects:
        assert box["visible_pixels"] == (front.instance_ids == box["id"]).sum(), box["name"]
    motion = front.motion_truth()
    assert motion["backward"] is None and np.shares_memory(motion["forward"]["flow"], front.flow)
    assert motion["time"].shape == front.depth.shape and motion["velocity"].shape == front.normals.shape


def test_cameras_are_found_by_name(results):
    assert results.names and len(results) == len(results.names) == len({camera.name for camera in results.cameras})
    assert isinstance(results, collections.abc.Mapping) and list(results) == results.names == results.keys()
    name = results.names[0]
    assert name in results and "no such camera" not in results and 1 not in results
    assert dict(results)[name].name == name == results.get(name).name and results.get("no such camera") is None
    assert [camera.name for camera in results.values()] == results.names == [name for name, _ in results.items()]
    assert results[name] is results.camera(name, frame=0)
    with pytest.raises(KeyError, match="no camera 'rear'|no camera \"rear\""):
        results["rear"]
    with pytest.raises(KeyError, match="with frame 9"):
        results.camera(name, frame=9)
