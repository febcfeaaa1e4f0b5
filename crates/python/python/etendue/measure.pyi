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
    fields: int | None = None,
    picture_radius_mm: float | None = None,
    wavelength_nm: float | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Focal lengths, principal planes, pupils and field of view; by field: distortion, illumination, spots, field curvature, colour.

    lens: A camera file (TOML), a lens of Zemax (.zmx) or CODE V (.seq), or the name of a published lens (double-gauss, wide-angle, fisheye, telephoto).
    set: Change a key of the camera, e.g. --set lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    f_number: The f-number at infinity focus, in place of the camera's or the lens file's.
    fields: How many field heights, from the axis to the picture's edge. Default: 6.
    picture_radius_mm: For a lens without a sensor: how far the picture reaches from the axis, mm [default: the largest field that a lens file states, otherwise 21.64; or as far as there is light].
    wavelength_nm: The wavelength of the first-order figures of a prescription, nm [default: the primary wavelength of a lens file, otherwise 587.56]; fields stay at 587.56 nm.
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
    """Distortion from one picture of a plane chart, without a model: the curve over the field, line distortion, k1 and k2 (ISO 17850).

    file: A picture of a plane chart that fills the field: many dots, or a checkerboard; or a list of its points (CSV: column, row, x_px, y_px).
    target: The chart [default: whichever shows more points]. One of checkerboard, dots.
    grid: Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found].
    channel: The channel to look at: R, G, B or Y of a picture, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its pixels with its colours balanced to one grey [default: the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    region: Look for the chart in this part of the picture only: left column, top row, width and height, pixels of the picture.
    size_px: Of lists of points (CSV) in place of pictures: columns and rows of the pictures in which they were seen.
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    points: List every point of the chart in the text, too; JSON has them anyway.
    centre_px: The point to which distances are taken, raster coordinates, px [default: the picture's middle].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
    camera_out: Write what was found as keys of a camera file.
    overwrite: Replace a camera file that is already there.
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
    """Focal length and principal point, from one picture of a chart at a known distance or from several.

    files: Pictures of the chart by one camera, or lists of its points (CSV: column, row, x_px, y_px): turned by 20° to 45° about different axes, filling the field together. One, or a sequence of them.
    target: The chart [default: whichever shows more points]. One of checkerboard, dots.
    grid: Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found].
    channel: The channel to look at: R, G, B or Y of a picture, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its pixels with its colours balanced to one grey [default: the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    region: Look for the chart in this part of the picture only: left column, top row, width and height, pixels of the picture.
    size_px: Of lists of points (CSV) in place of pictures: columns and rows of the pictures in which they were seen.
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    points: List every point of the chart in the text, too; JSON has them anyway.
    pitch_mm: The distance of neighbouring points of the chart, mm [with --truth: as it says].
    model: The camera model. One of pinhole, opencv, opencv5, opencv8, radial, radial-inverse, kannala-brandt, division, field-of-view, unified, extended-unified, double-sphere, equidistant, equisolid, stereographic, orthographic. Default: opencv.
    square_pixels: Pixels are square: one focal length for columns and rows.
    principal_px: The principal point is known, raster coordinates, px.
    distance_mm: The distance from the entrance pupil to the chart's plane, mm, the same in every picture.
    distance_uncertainty_mm: Its standard uncertainty, mm; 0 where it is exact [default: of rounding to its last digit].
    pixel_pitch_um: The distance of neighbouring pixels of the sensor, µm: then focal lengths are told in mm as well.
    robust: Points far from the fit count less (Huber).
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
    camera_out: Write what was found as keys of a camera file.
    overwrite: Replace a camera file that is already there.
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

    file: A picture in colour of a plane chart that fills the field.
    target: The chart [default: whichever shows more points]. One of checkerboard, dots.
    grid: Columns and rows of its points, e.g. 11x8: inner corners of a checkerboard, dots [default: as found].
    channel: The channel to look at: R, G, B or Y of a picture, an EXR channel by its full name, a colour of a raw mosaic, or "balanced" for all its pixels with its colours balanced to one grey [default: the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    region: Look for the chart in this part of the picture only: left column, top row, width and height, pixels of the picture.
    size_px: Of lists of points (CSV) in place of pictures: columns and rows of the pictures in which they were seen.
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    points: List every point of the chart in the text, too; JSON has them anyway.
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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

    descriptor: A descriptor file of the EMVA 1288 reference program: levels of light with their pictures, two a level for the curve, more for DSNU and PRNU.
    relative_light: The descriptor's photons are relative: leave out what needs their number.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
    camera_out: Write what was found as keys of a camera file.
    overwrite: Replace a camera file that is already there.
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

    picture: A picture of one or more slanted edges.
    edge: A part of the picture that holds one edge: left column, top row, width, height; once an edge [default: all of it]. One, or a sequence of them.
    edge_degree: Degree of the curve that the edges follow: 2 or 3 where the lens bends them. Default: 1.
    reach_px: How far from the edge its profile has fine detail, pixels [default: 10].
    shading_degree: Take off shading by surfaces of this degree, one on either side of the edge: 1 or 2 where the lens's fall-off makes the sides slope. Default: 0.
    pixel_pitch_um: The pixels' pitch, µm: tells MTF50 and MTF10 in line pairs a millimetre, too.
    pixels_per_degree: From where the picture is viewed, for acutance: its pixels a degree at the eye. Default: 60.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """The tone curve from a series of exposures or from steps, with linearity and dynamic range (ISO 14524); the camera's response from a scene at exposures known relatively.

    pictures: Pictures of one even surface, one an exposure; with --steps, or the --truth of a chart of steps, one picture. One, or a sequence of them.
    exposures: Exposure of each picture in their order, any unit [default: the side-cars' exposure_s]. One, or a sequence of them.
    steps: A table of steps in the picture: x, y, width, height, luminance; one step a line, # for comments.
    response: Find the camera's response from pictures of one scene (not even) at exposures known relatively.
    refine: With --response: find the ratios of the exposures too.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """A flat field's fall-off over the radial field position.

    picture: A picture of an evenly lit surface.
    centre_px: Centre of the fall-off, raster coordinates [default: the picture's].
    rings: Rings of the profile over the radial field position. Default: 20.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    pixel_pitch_um: The pixels' pitch, µm, for --camera-out.
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
    camera_out: Write what was found as keys of a camera file.
    overwrite: Replace a camera file that is already there.
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
    """A flat field's fall-off as a map, and its colour shading (ISO 17957).

    picture: A picture of an evenly lit surface.
    centre_px: Centre of the fall-off, raster coordinates [default: the picture's].
    rings: Rings of the profile over the radial field position. Default: 20.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    blocks: Blocks of the map along each side, an odd number. Default: 11.
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """Temporal and fixed-pattern noise of an even surface (ISO 15739).

    frames: Eight or more frames of one even surface, or of a chart with --truth. One, or a sequence of them.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """Light in traps that send none (ISO 18844).

    picture: A picture of light traps in a white field.
    trap: A part of a light trap: left column, top row, width, height; once a trap. One, or a sequence of them.
    white: A part of the white field.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """Light that goes up and down: frequency, modulation over rows and frames, duty of pulses (IEEE P2020).

    frames: Frames of a sequence in their order, or one of a rolling shutter. One, or a sequence of them.
    row_time_us: Time from one row of the file to the next, µs, of a rolling shutter [default: the side-car's, or all rows are exposed together].
    frame_rate_hz: Frames a second [default: the side-car's, or not known; each frame is measured by itself].
    exposure_us: Exposure of a row, µs: tells the light's own modulation and the duty of its pulses [default: the side-car's, or not known].
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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

    picture: A picture of a ColorChecker of 24 patches, in colour.
    corners: Middles of the four corner patches, raster coordinates, in the chart's order: dark skin, bluish green, black, white. One, or a sequence of them.
    patch: Side of the squares that are read, of the distance of patches. Default: 0.5.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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

    picture: A picture of grey patches.
    darker: The darker patch of a pair: left column, top row, width, height; once a pair. One, or a sequence of them.
    brighter: The brighter patch of a pair, in the same order. One, or a sequence of them.
    contrast: The scene's Weber contrast of a pair: brighter over darker luminance, less 1; in the same order. One, or a sequence of them.
    tolerance: How much a measured contrast may differ from the scene's, share. Default: 0.5.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """An estimated depth picture against the truth: bias, error and outliers by range, edges apart.

    estimate: The estimate: one channel of depth (EXR, PFM, TIFF of floats, PNG of 16 bits …; 0, NaN and infinity are missing).
    truth: The truth: a ground-truth EXR, or one channel of depth.
    estimate_channel: The estimate's channel [default: depth.Z, or the only one].
    truth_channel: The truth's channel [default: depth.Z, or the only one].
    estimate_unit_m: Metres a number of the estimate, e.g. 0.001 for millimetres. Default: 1.
    truth_unit_m: Metres a number of the truth. Default: 1.
    ranges_m: Limits of the ranges, m, e.g. 0,10,30,100. One, or a sequence of them.
    outlier_ratio: An outlier is off by more than this share of the depth. Default: 0.05.
    outlier_least_m: … and by more than this, m. Default: 0.
    focal_base_px_m: A stereo rig's focal length in pixels times its base in metres: tells errors of disparity (D1, EPE) as well.
    align: What is done to the estimate first: networks may know depth but for a factor. One of none, median. Default: none.
    edge_ratio: A jump of the truth by more than this share of the depth is an edge. Default: 0.1.
    edge_px: Pixels this near to an edge are told apart. Default: 2.
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """The dark current's growth with temperature, by three laws.

    series: Descriptors of photon transfer at several temperatures of the sensor in °C, three or more. One, or a sequence of them.
    reference_c: The temperature that the dark current is told at, °C. Default: 25.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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

    picture: A picture of a Siemens star.
    centre_px: The star's centre, raster coordinates, within two pixels.
    cycles: Cycles of dark and bright all round.
    inner_px: The smallest circle, px [with --truth: where the star has half a cycle a pixel, or begins].
    outer_px: The largest circle, px: the response is 1 there [with --truth: a little within the star's rim].
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """Texture such as dead leaves against its reference: response, invented structure, coherence.

    picture: A picture of a texture such as dead leaves.
    reference: The texture itself at the same place, pixel by pixel: a sharp render without noise (radiance.exr of --set output.radiance=true).
    even: A picture of an even surface of the same brightness, for the noise.
    channel: The channel to measure: R, G, B or Y of a picture (an EXR channel by its full name), a colour of a raw mosaic [default: the only one, or the luminance].
    cfa: The colour filters of a raw picture without a side-car: a tile of two by two from the top left, row by row, e.g. RGGB.
    region: Measure this part only: left column, top row, width and height, pixels of the file.
    encoding: How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0 and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits].
    black: The reading of no light, as stored; 0 to 1 of a picture that is decoded from an encoding [default: the side-car's, or 0].
    full_scale: The reading of a saturated pixel, in the same unit [default: the side-car's, or the largest that the file can hold].
    truth: The truth.json of `etendue chart`, which says what is in the picture and where.
    camera: With --truth: the camera that took the picture [default: the first].
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
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
    """Two cameras' measurements side by side, or a camera file against what was measured; exit status 1 where they differ.

    a: A measurement (what --json printed), or the camera file (TOML) that was measured.
    b: The same of the other; relative errors are against this one.
    wavelength_nm: Where a camera file is compared with photon transfer: the light's wavelength, for the quantum efficiency.
    illuminant: Where a camera file is compared with the response of edges or a tone curve: the light's spectrum [default: D65].
    set: Change a key of the camera file, e.g. --set sensor.exposure_s=0.002. A dict of dotted keys to values, or texts key=value.
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """
