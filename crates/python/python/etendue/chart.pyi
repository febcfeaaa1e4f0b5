"""Test charts as scenes ready to render, with their truth: the charts of ``etendue chart``.

Written by `ETENDUE_BLESS=1` of `tests/test_stubs.py`.
"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal

__all__ = ["dots", "checkerboard", "circles", "flat_field", "backlit", "slanted_edges", "slanted_star", "siemens_star", "dead_leaves", "oecf_steps", "colorchecker", "contrast_patches", "flare", "led_flicker", "points", "depth_wedge"]

_Path = str | PathLike[str]
_Progress = Callable[[str, int, int], object]

def dots(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    dot_ratio: float | None = None,
    views: int | None = None,
    hand_held: bool = False,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Black dots over the whole field: focal length, distortion, chromatic displacement (ISO 17850, ISO 19084).

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    dot_ratio: Diameter of a dot over the distance between centres. Default: 0.5.
    views: Views of the chart: the first perpendicular to it, the others tilted by 25 degrees in all directions. Default: 1.
    hand_held: Simulate hand-held views: up to 0.5 % of the distance aside, 2 % farther away, rolled by 1.5 degrees, at random by --seed.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def checkerboard(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    views: int | None = None,
    hand_held: bool = False,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """A checkerboard, fully in view: calibration.

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    views: Views of the chart: the first perpendicular to it, the others tilted by 25 degrees in all directions. Default: 1.
    hand_held: Simulate hand-held views: up to 0.5 % of the distance aside, 2 % farther away, rolled by 1.5 degrees, at random by --seed.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def circles(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    asymmetric: bool = False,
    views: int | None = None,
    hand_held: bool = False,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Circles in a square or a staggered lattice, fully in view: calibration.

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    asymmetric: A staggered lattice: every other cell of each row holds a circle.
    views: Views of the chart: the first perpendicular to it, the others tilted by 25 degrees in all directions. Default: 1.
    hand_held: Simulate hand-held views: up to 0.5 % of the distance aside, 2 % farther away, rolled by 1.5 degrees, at random by --seed.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def flat_field(
    *,
    reflectance: float | None = None,
    exposures: int | None = None,
    spacing: Literal["log", "linear"] | None = None,
    lowest: float | None = None,
    highest: float | None = None,
    levels: Sequence[float] | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """A uniform white sheet in uniform illumination: vignetting, shading, photon transfer (ISO 17957, EMVA 1288).

    reflectance: Reflectance of the sheet. Default: 0.9.
    exposures: Number of exposures, one camera each.
    spacing: Spacing from --lowest to --highest [default: log]. One of log, linear.
    lowest: Fraction of saturation that white reaches in the shortest exposure [default: 0.003].
    highest: The same in the longest exposure [default: 1.3].
    levels: The fractions themselves, e.g. 0.01,0.1,0.5,1.2. One, or a sequence of them.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def backlit(
    *,
    exposures: int | None = None,
    spacing: Literal["log", "linear"] | None = None,
    lowest: float | None = None,
    highest: float | None = None,
    levels: Sequence[float] | None = None,
    dark: bool = False,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """A luminous panel in the dark, with a series of exposures: tone curve, photon transfer.

    exposures: Number of exposures, one camera each.
    spacing: Spacing from --lowest to --highest [default: log]. One of log, linear.
    lowest: Fraction of saturation that white reaches in the shortest exposure [default: 0.003].
    highest: The same in the longest exposure [default: 1.3].
    levels: The fractions themselves, e.g. 0.01,0.1,0.5,1.2. One, or a sequence of them.
    dark: A dark frame for each exposure.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def slanted_edges(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    angle_deg: float | None = None,
    contrast: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Squares turned by a small angle over the field: spatial frequency response by position and direction (ISO 12233).

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    angle_deg: Clockwise rotation, degrees: a square by 2 … 43 in either direction, or the first edge of a star by up to 45. Default: 5.
    contrast: Luminance of the bright side over that of the dark side. Default: 4.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def slanted_star(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    spokes: int | None = None,
    angle_deg: float | None = None,
    contrast: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Stars of slanted wedges: spatial frequency response in many directions (ISO 12233).

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    spokes: Dark wedges of a star. Default: 8.
    angle_deg: Clockwise rotation, degrees: a square by 2 … 43 in either direction, or the first edge of a star by up to 45. Default: 5.
    contrast: Luminance of the bright side over that of the dark side. Default: 4.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def siemens_star(
    *,
    cycles: int | None = None,
    binary: bool = False,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """A star of many cycles: modulation over spatial frequency (ISO 12233).

    cycles: Cycles around the centre. Default: 72.
    binary: Black and white instead of a cosine.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def dead_leaves(
    *,
    smallest_px: float | None = None,
    largest_ratio: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Overlapping discs with the statistics of natural scenes: texture loss (ISO 19567-2).

    smallest_px: Radius of the smallest leaves, px. Default: 1.
    largest_ratio: Radius of the largest leaves over the side of the chart. Default: 0.2.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def oecf_steps(
    *,
    steps: int | None = None,
    density: float | None = None,
    backlit: bool = False,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Grey steps around a ring: opto-electronic conversion function (ISO 14524).

    steps: Number of steps. Default: 12.
    density: Density of the darkest step [default: 2, with --backlit 3].
    backlit: A transparency on a light box in the dark instead of a print in uniform illumination.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def colorchecker(
    *,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """The 24 patches of the ColorChecker by their measured spectra: colour error.

    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def contrast_patches(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    decades: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Luminous grey patches over several decades: contrast detection probability.

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    decades: Decades of luminance from the brightest patch to the darkest. Default: 3.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def flare(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    trap_ratio: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """A white field with light traps: veiling glare (ISO 18844).

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    trap_ratio: Diameter of a trap's opening over the distance between traps. Default: 0.25.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def led_flicker(
    *,
    frequencies_hz: Sequence[float] | None = None,
    duty_cycles: Sequence[float] | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Pulsed lights of several frequencies and duty cycles, in the dark: LED flicker (IEEE P2020).

    frequencies_hz: Frequencies of the columns, Hz. One, or a sequence of them. Default: 90,110,200,400.
    duty_cycles: Duty cycles of the rows: fractions of the period that a pulse lasts. One, or a sequence of them. Default: 0.1,0.25,0.5.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def points(
    *,
    columns: int | None = None,
    rows: int | None = None,
    pitch_mm: float | None = None,
    diameter_px: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Small lights in the dark: point-spread function, chromatic displacement.

    columns: Columns [default: as many as fit the field].
    rows: Rows [default: as many as fit the field].
    pitch_mm: Distance between centres (of squares: their side), mm [default: as the columns allow].
    diameter_px: Diameter of a light, px at the image centre. Default: 0.5.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def depth_wedge(
    *,
    steps: int | None = None,
    far_ratio: float | None = None,
    camera: str | None = None,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    distance_m: float | None = None,
    width_mm: float | None = None,
    illuminant: str | None = None,
    luminance_cd_m2: float | None = None,
    white: float | None = None,
    seed: int | None = None,
    png: float | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """A staircase and a slanted plane with texture at known distances: depth.

    steps: Steps of the staircase. Default: 8.
    far_ratio: Distance of the farthest panel over that of the nearest. Default: 3.
    camera: The camera: a camera file (TOML), or a reference camera: web, ccd-mono, ccd-bayer, automotive, laboratory. Default: web.
    set: Change a key of the written job, its scene or its camera, e.g. --set render.spp=16 or --set cameras.camera.lens.f_number=4: the chart is made for the changed camera, and the change is written into the files. A dict of dotted keys to values, or texts key=value.
    distance_m: Distance of the sheet from the entrance pupil, m [default: the camera's focus distance, or 1].
    width_mm: Width of the sheet that the camera sees, mm; determines the distance.
    illuminant: Spectrum of the light: D65, A, E, LED-B3, …. Default: D65.
    luminance_cd_m2: Luminance of a perfect white sheet (or of the panel), cd/m² [default: as required by --white].
    white: Fraction of the sensor's saturation that a perfect white sheet (or the panel) reaches in the camera's own exposure. Default: 0.7.
    seed: Seed of all random numbers. Default: 0.
    png: Also write the print as chart.png, at this many pixels per inch.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """
