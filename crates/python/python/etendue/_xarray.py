"""A camera's results as an xarray Dataset."""

from __future__ import annotations

#: Dimensions and unit of each variable.
_VARIABLES = {
    "radiance": (("wavelength_nm", "y", "x"), "W m-2 sr-1 nm-1"),
    "radiance_variance": (("wavelength_nm", "y", "x"), "W2 m-4 sr-2 nm-2"),
    "irradiance": (("wavelength_nm", "y", "x"), "W m-2 nm-1"),
    "ghosts": (("wavelength_nm", "y", "x"), "W m-2 nm-1"),
    "electrons": (("y", "x"), "e"),
    "raw": (("y", "x"), "DN"),
    "picture": (("y", "x", "rgb"), "1"),
    "depth": (("y", "x"), "m"),
    "distance": (("y", "x"), "m"),
    "normals": (("y", "x", "xyz"), "1"),
    "positions": (("y", "x", "xyz"), "m"),
    "positions_low": (("y", "x", "xyz"), "m"),
    "camera_space_positions": (("y", "x", "xyz"), "m"),
    "instance_ids": (("y", "x"), "1"),
    "semantic_ids": (("y", "x"), "1"),
    "material_ids": (("y", "x"), "1"),
    "flow": (("y", "x", "xy"), "px"),
    "disparity": (("y", "x"), "px"),
    "disparity_visibility": (("y", "x"), "1"),
}


def to_xarray(camera):
    """A camera's light, first frame and ground truth as an xarray Dataset (the extra "xarray"), each variable with its unit.

    x and y are pixel centres in raster coordinates, px. Quantities that the camera does not have are omitted, as is a raw or developed image
    whose pixels differ from the ground truth's.
    """
    import numpy
    import xarray

    height, width = camera.depth.shape
    variables = {}
    for name, (dimensions, unit) in _VARIABLES.items():
        array = getattr(camera, name)
        if array is not None and dict(zip(dimensions, array.shape)).items() >= {"y": height, "x": width}.items():
            variables[name] = (dimensions, array, {"units": unit})
    coordinates = {"x": numpy.arange(width) + 0.5, "y": numpy.arange(height) + 0.5, "xyz": list("xyz"), "xy": list("xy")}
    if "picture" in variables:
        coordinates["rgb"] = list("rgb")
    if any(dimensions[0] == "wavelength_nm" for dimensions, *_ in variables.values()):
        coordinates["wavelength_nm"] = camera.wavelengths_nm
    return xarray.Dataset(variables, coordinates, {"camera": camera.name, "frame": camera.frame_numbers.start})
