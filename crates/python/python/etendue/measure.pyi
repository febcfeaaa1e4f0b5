"""Cameras measured from pictures, and lenses without rendering: the measurements of ``etendue measure``, each answering with a Report.

Written by `ETENDUE_BLESS=1` of `tests/test_stubs.py`.
"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from . import Report

__all__ = ["lens", "distortion", "focal", "chromatic", "ptc", "sfr", "oecf", "vignetting", "shading", "noise", "flare", "flicker", "colour", "cdp", "depth", "dark_current", "star", "texture", "compare"]

_Path = str | PathLike[str]
_Progress = Callable[[str, int, int], object]

def lens(
    lens: str,
    *,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    f_number: float | None = None,
    glasses: _Path | Sequence[_Path] | None = None,
    fields: int | None = None,
    picture_radius_mm: float | None = None,
    wavelength_nm: float | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Focal lengths, principal planes, pupils and field of view; by field: distortion, illumination, spots, field curvature, colour.

    lens: Camera file (TOML), lens of Zemax (.zmx) or CODE V (.seq), or name of a published lens (double-gauss, wide-angle, fisheye, telephoto).
    set: Change a key of the camera, e.g. --set lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    f_number: F-number at infinity focus, in place of the camera's or the lens file's.
    glasses: Glass catalogue of Zemax (.agf), searched before those built in; may be repeated. One, or a sequence of them.
    fields: Number of field heights, from the axis to the edge of the image. Default: 6.
    picture_radius_mm: For a lens without a sensor: radius of the image from the axis, mm [default: the largest field that a lens file states, otherwise where half of the axis's light arrives; at most 21.64].
    wavelength_nm: Wavelength of the first-order figures of a prescription, nm [default: the primary wavelength of a lens file, otherwise 587.56]; fields stay at 587.56 nm.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a dict.
    """

def distortion(
    file: _Path,
    *,
    target: Literal["checkerboard", "dots"] | None = None,
    grid: str | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    encoding: str | None = None,
    region: Sequence[float] | None = None,
    size_px: str | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    points: bool = False,
    centre_px: Sequence[float] | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    camera_out: _Path | None = None,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> Report:
    """Distortion from one image of a plane chart, without a model: the curve over the field, line distortion, k1 and k2 (ISO 17850).

    file: Image of a plane chart that fills the field: many dots, or a checkerboard; or a list of its points (CSV: column, row, x_px, y_px).
    target: The chart [default: the one that shows more points]. One of checkerboard, dots.
    grid: Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found].
    channel: Channel: R, G, B or Y of an image, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its pixels with colours balanced to one grey [default: the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    region: Part of the image to search for the chart: left column, top row, width and height, pixels of the image.
    size_px: For lists of points (CSV) in place of images: columns and rows of the images in which they were seen.
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    points: List every point of the chart in the text, too; JSON always has them.
    centre_px: Centre of the radial distances, raster coordinates, px [default: the image centre].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    camera_out: Write the results as keys of a camera file.
    overwrite: Replace an existing camera file.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def focal(
    files: _Path | Sequence[_Path],
    *,
    target: Literal["checkerboard", "dots"] | None = None,
    grid: str | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    encoding: str | None = None,
    region: Sequence[float] | None = None,
    size_px: str | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    points: bool = False,
    pitch_mm: float | None = None,
    model: Literal["pinhole", "opencv", "opencv5", "opencv8", "radial", "radial-inverse", "kannala-brandt", "division", "field-of-view", "unified", "extended-unified", "double-sphere", "equidistant", "equisolid", "stereographic", "orthographic"] | None = None,
    square_pixels: bool = False,
    principal_px: Sequence[float] | None = None,
    distance_mm: str | None = None,
    distance_uncertainty_mm: float | None = None,
    pixel_pitch_um: float | None = None,
    robust: bool = False,
    plot: _Path | None = None,
    html: _Path | None = None,
    camera_out: _Path | None = None,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> Report:
    """Focal length and principal point, from one image of a chart at a known distance or from several.

    files: Images of the chart by one camera, or lists of its points (CSV: column, row, x_px, y_px): turned by 20° to 45° about different axes, filling the field together. One, or a sequence of them.
    target: The chart [default: the one that shows more points]. One of checkerboard, dots.
    grid: Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found].
    channel: Channel: R, G, B or Y of an image, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its pixels with colours balanced to one grey [default: the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    region: Part of the image to search for the chart: left column, top row, width and height, pixels of the image.
    size_px: For lists of points (CSV) in place of images: columns and rows of the images in which they were seen.
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    points: List every point of the chart in the text, too; JSON always has them.
    pitch_mm: Distance of neighbouring points of the chart, mm [with --truth: as it states].
    model: Camera model. One of pinhole, opencv, opencv5, opencv8, radial, radial-inverse, kannala-brandt, division, field-of-view, unified, extended-unified, double-sphere, equidistant, equisolid, stereographic, orthographic. Default: opencv.
    square_pixels: Assume square pixels: one focal length for columns and rows.
    principal_px: Known principal point, raster coordinates, px.
    distance_mm: Distance from the entrance pupil to the chart's plane, mm, the same in every image.
    distance_uncertainty_mm: Standard uncertainty of the distance, mm; 0 if exact [default: of rounding to its last digit].
    pixel_pitch_um: Pixel pitch of the sensor, µm: adds focal lengths in mm.
    robust: Reduce the weight of points far from the fit (Huber).
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    camera_out: Write the results as keys of a camera file.
    overwrite: Replace an existing camera file.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def chromatic(
    file: _Path,
    *,
    target: Literal["checkerboard", "dots"] | None = None,
    grid: str | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    encoding: str | None = None,
    region: Sequence[float] | None = None,
    size_px: str | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    points: bool = False,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Lateral chromatic displacement of red and blue against green (ISO 19084).

    file: Colour image of a plane chart that fills the field.
    target: The chart [default: the one that shows more points]. One of checkerboard, dots.
    grid: Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found].
    channel: Channel: R, G, B or Y of an image, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its pixels with colours balanced to one grey [default: the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    region: Part of the image to search for the chart: left column, top row, width and height, pixels of the image.
    size_px: For lists of points (CSV) in place of images: columns and rows of the images in which they were seen.
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    points: List every point of the chart in the text, too; JSON always has them.
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def ptc(
    descriptor: _Path,
    *,
    relative_light: bool = False,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    camera_out: _Path | None = None,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> Report:
    """Photon transfer after EMVA 1288: gain, quantum efficiency, dark noise, saturation, linearity, DSNU, PRNU.

    descriptor: Descriptor file of the EMVA 1288 reference program: light levels with their images, two per level for the curve, more for DSNU and PRNU.
    relative_light: The descriptor's photons are relative: leave out results that need their number.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    camera_out: Write the results as keys of a camera file.
    overwrite: Replace an existing camera file.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def sfr(
    picture: _Path,
    *,
    edge: Sequence[float] | Sequence[Sequence[float]] | None = None,
    edge_degree: int | None = None,
    reach_px: float | None = None,
    shading_degree: int | None = None,
    pixel_pitch_um: float | None = None,
    pixels_per_degree: float | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Slanted edges: the spatial frequency response with MTF50 and MTF10 (ISO 12233).

    picture: Image of one or more slanted edges.
    edge: Part of the image that contains one edge: left column, top row, width, height; once per edge [default: all of it]. One, or a sequence of them.
    edge_degree: Degree of the curve of the edges: 2 or 3 if the lens bends them. Default: 1.
    reach_px: Reach of the profile's fine detail on either side of the edge, pixels [default: 10].
    shading_degree: Degree of the surfaces that model shading, one on either side of the edge: 1 or 2 if the lens's fall-off makes the sides slope. Default: 0.
    pixel_pitch_um: Pixel pitch, µm: adds MTF50 and MTF10 in line pairs per millimetre.
    pixels_per_degree: Viewing condition for acutance: pixels per degree at the eye. Default: 60.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def oecf(
    pictures: _Path | Sequence[_Path],
    *,
    exposures: Sequence[float] | None = None,
    steps: _Path | None = None,
    response: bool = False,
    refine: bool = False,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Tone curve from a series of exposures or from steps, with linearity and dynamic range (ISO 14524); camera response from a scene at exposures with known ratios.

    pictures: Images of one uniform surface, one per exposure; with --steps, or the --truth of a chart of steps, one image. One, or a sequence of them.
    exposures: Exposure of each image in order, any unit [default: the side-cars' exposure_s]. One, or a sequence of them.
    steps: Table of steps in the image: x, y, width, height, luminance; one step per line, # for comments.
    response: Find the camera's response from images of one non-uniform scene at relatively known exposures.
    refine: With --response: find the ratios of the exposures too.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def vignetting(
    picture: _Path,
    *,
    centre_px: Sequence[float] | None = None,
    rings: int | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    pixel_pitch_um: float | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    camera_out: _Path | None = None,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> Report:
    """Fall-off of a flat field over the radial field position.

    picture: Image of a uniformly lit surface.
    centre_px: Centre of the fall-off, raster coordinates [default: the image centre].
    rings: Rings of the profile over the radial field position. Default: 20.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    pixel_pitch_um: Pixel pitch, µm, for --camera-out.
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    camera_out: Write the results as keys of a camera file.
    overwrite: Replace an existing camera file.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def shading(
    picture: _Path,
    *,
    centre_px: Sequence[float] | None = None,
    rings: int | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    blocks: int | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Fall-off of a flat field as a map, and its colour shading (ISO 17957).

    picture: Image of a uniformly lit surface.
    centre_px: Centre of the fall-off, raster coordinates [default: the image centre].
    rings: Rings of the profile over the radial field position. Default: 20.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    blocks: Blocks of the map along each side, an odd number. Default: 11.
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def noise(
    frames: _Path | Sequence[_Path],
    *,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Temporal and fixed-pattern noise of a uniform surface (ISO 15739).

    frames: Eight or more frames of one uniform surface, or of a chart with --truth. One, or a sequence of them.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def flare(
    picture: _Path,
    *,
    trap: Sequence[float] | Sequence[Sequence[float]] | None = None,
    white: Sequence[float] | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Flare: light in the image of light traps (ISO 18844).

    picture: Image of light traps in a white field.
    trap: Part of a light trap: left column, top row, width, height; once per trap. One, or a sequence of them.
    white: Part of the white field.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def flicker(
    frames: _Path | Sequence[_Path],
    *,
    row_time_us: float | None = None,
    frame_rate_hz: float | None = None,
    exposure_us: float | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Flicker of a light: frequency, modulation over rows and frames, duty cycle of pulses (IEEE P2020).

    frames: Frames of a sequence in order, or one frame of a rolling shutter. One, or a sequence of them.
    row_time_us: Time from one row of the file to the next, µs, of a rolling shutter [default: the side-car's, or all rows are exposed together].
    frame_rate_hz: Frames per second [default: the side-car's, or unknown: each frame is measured separately].
    exposure_us: Exposure of a row, µs: adds the light's own modulation and the duty cycle of its pulses [default: the side-car's, or unknown].
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def colour(
    picture: _Path,
    *,
    corners: Sequence[float] | Sequence[Sequence[float]] | None = None,
    patch: float | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Colours of a ColorChecker after a fitted matrix, CIEDE2000.

    picture: Colour image of a ColorChecker with 24 patches.
    corners: Centres of the four corner patches, raster coordinates, in the chart's order: dark skin, bluish green, black, white. One, or a sequence of them.
    patch: Side of the measured squares, as a fraction of the patch spacing. Default: 0.5.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def cdp(
    picture: _Path,
    *,
    darker: Sequence[float] | Sequence[Sequence[float]] | None = None,
    brighter: Sequence[float] | Sequence[Sequence[float]] | None = None,
    contrast: float | Sequence[float] | None = None,
    tolerance: float | None = None,
    flat: _Path | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Contrast detection probability of pairs of patches (IEEE P2020).

    picture: Image of grey patches.
    darker: Darker patch of a pair: left column, top row, width, height; once per pair. One, or a sequence of them.
    brighter: Brighter patch of a pair, in the same order. One, or a sequence of them.
    contrast: Weber contrast of a pair in the scene: brighter over darker luminance, less 1; in the same order. One, or a sequence of them.
    tolerance: Maximum relative deviation of a measured contrast from the scene's. Default: 0.5.
    flat: Image of uniform illumination by the same camera: readings are divided by it, which removes the lens's fall-off.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def depth(
    estimate: _Path,
    truth: _Path,
    *,
    estimate_channel: str | None = None,
    truth_channel: str | None = None,
    estimate_unit_m: float | None = None,
    truth_unit_m: float | None = None,
    ranges_m: Sequence[float] | None = None,
    outlier_ratio: float | None = None,
    outlier_least_m: float | None = None,
    focal_base_px_m: float | None = None,
    align: Literal["none", "median"] | None = None,
    edge_ratio: float | None = None,
    edge_px: int | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """An estimated depth image against ground truth: bias, error and outliers by range, edges separately.

    estimate: Estimate: one channel of depth (EXR, PFM, TIFF of floats, PNG of 16 bits …; 0, NaN and infinity are missing).
    truth: Ground truth: a ground-truth EXR, or one channel of depth.
    estimate_channel: Channel of the estimate [default: depth.Z, or the only one].
    truth_channel: Channel of the ground truth [default: depth.Z, or the only one].
    estimate_unit_m: Metres per unit of the estimate, e.g. 0.001 for millimetres. Default: 1.
    truth_unit_m: Metres per unit of the ground truth. Default: 1.
    ranges_m: Limits of the ranges, m, e.g. 0,10,30,100. One, or a sequence of them.
    outlier_ratio: Minimum error of an outlier as a fraction of the depth. Default: 0.05.
    outlier_least_m: … and its minimum error, m. Default: 0.
    focal_base_px_m: Focal length in pixels times baseline in metres of a stereo rig: adds disparity errors (D1, EPE).
    align: Alignment of the estimate before the comparison: networks may estimate depth up to a factor. One of none, median. Default: none.
    edge_ratio: Minimum depth jump of the ground truth at an edge, as a fraction of the depth. Default: 0.1.
    edge_px: Distance, px, within which pixels near an edge are reported separately. Default: 2.
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def dark_current(
    series: tuple[float, _Path] | Sequence[tuple[float, _Path]],
    *,
    reference_c: float | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Increase of the dark current with temperature, by three laws.

    series: Photon-transfer descriptors at several sensor temperatures in °C, three or more. One, or a sequence of them.
    reference_c: Temperature at which the dark current is reported, °C. Default: 25.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def star(
    picture: _Path,
    *,
    centre_px: Sequence[float] | None = None,
    cycles: int | None = None,
    inner_px: float | None = None,
    outer_px: float | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """A Siemens star: response over frequency (ISO 12233).

    picture: Image of a Siemens star.
    centre_px: Centre of the star, raster coordinates, within two pixels.
    cycles: Number of dark and bright cycles around the circle.
    inner_px: Radius of the smallest circle, px [with --truth: where the star has half a cycle per pixel, or begins].
    outer_px: Radius of the largest circle, px, where the response is set to 1 [with --truth: slightly inside the star's edge].
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def texture(
    picture: _Path,
    reference: _Path,
    *,
    even: _Path | None = None,
    channel: str | None = None,
    cfa: str | None = None,
    region: Sequence[float] | None = None,
    encoding: str | None = None,
    black: float | None = None,
    full_scale: float | None = None,
    truth: _Path | None = None,
    camera: str | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Texture such as dead leaves against its reference: response, artefacts, coherence.

    picture: Image of a texture such as dead leaves.
    reference: The texture itself at the same position, pixel by pixel: a sharp render without noise (radiance.exr of --set output.radiance=true).
    even: Image of a uniform surface of the same brightness, for the noise.
    channel: Channel to measure: R, G, B or Y of an image (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: Colour filters of a raw image without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Part to measure: left column, top row, width and height, pixels of the file.
    encoding: Encoding of the numbers: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: by the side-car or the PNG, else by the bits].
    black: Reading without light, as stored; 0 to 1 for an image decoded from an encoding [default: the side-car's, or 0].
    full_scale: Reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which describes the content of the image and its position.
    camera: With --truth: camera of the image [default: the first].
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def compare(
    a: _Path,
    b: _Path,
    *,
    wavelength_nm: float | None = None,
    illuminant: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Measurements of two cameras side by side, or a camera file against its measurements; exit status 1 if they differ.

    a: Measurement (output of --json), or the camera file (TOML) that was measured.
    b: The same for the other side; reference of the relative errors.
    wavelength_nm: Wavelength of the light for the quantum efficiency, when a camera file is compared with photon transfer.
    illuminant: Spectrum of the light, when a camera file is compared with the response of edges or a tone curve [default: D65].
    set: Change a key of the camera file, e.g. --set sensor.exposure_s=0.002. A dict of dotted keys to values, or texts key=value.
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """
