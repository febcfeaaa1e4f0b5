"""A camera's results as an xarray Dataset."""

from __future__ import annotations

#: Dimensions and unit of each variable.
_VARIABLES = {
    "radiance": (("wavelength_nm", "y", "x"), "W m-2 sr-1 nm-1"),
    "irradiance": (("wavelength_nm", "y", "x"), "W m-2 nm-1"),
    "electrons": (("y", "x"), "e"),
    "raw": (("y", "x"), "DN"),
    "picture": (("y", "x", "rgb"), "1"),
    "depth": (("y", "x"), "m"),
    "distance": (("y", "x"), "m"),
    "normals": (("y", "x", "xyz"), "1"),
    "positions": (("y", "x", "xyz"), "m"),
    "instance_ids": (("y", "x"), "1"),
    "semantic_ids": (("y", "x"), "1"),
    "material_ids": (("y", "x"), "1"),
}


def dataset(camera):
    """A camera's light, first frame and ground truth as an xarray Dataset (the extra "xarray"), each variable with its unit.

    x and y are the centres of pixels in raster coordinates, px; what the camera does not have is left out.
    """
    import numpy
    import xarray

    variables = {}
    for name, (dimensions, unit) in _VARIABLES.items():
        array = getattr(camera, name)
        if array is not None and (name != "raw" or array.shape == camera.depth.shape):
            variables[name] = (dimensions, array, {"units": unit})
    height, width = camera.depth.shape
    coordinates = {"x": numpy.arange(width) + 0.5, "y": numpy.arange(height) + 0.5, "xyz": list("xyz")}
    if "picture" in variables:
        coordinates["rgb"] = list("rgb")
    if {"radiance", "irradiance"} & set(variables):
        coordinates["wavelength_nm"] = camera.wavelengths_nm
    return xarray.Dataset(variables, coordinates, {"camera": camera.name, "frame": camera.frame_numbers.start})
