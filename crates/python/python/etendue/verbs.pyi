"""The verbs of the command line that are in no group, as functions; ``import etendue`` has them, too.

Written by `ETENDUE_BLESS=1` of `tests/test_stubs.py`.
"""

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from . import Report

__all__ = ["merge", "rig", "tradeoff", "dataset", "expose", "weather", "develop", "flat", "datasheet", "import_", "inspect", "view", "compare", "calibrate", "characterise", "laboratory", "schema", "explain"]

_Path = str | PathLike[str]
_Progress = Callable[[str, int, int], object]

def merge(
    shards: _Path | Sequence[_Path],
    *,
    job: _Path | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Join the shards of one job to the result of an unsharded run, byte for byte.

    shards: The folders of all shards. One, or a sequence of them.
    job: Where the job file is, where the shards were rendered from another place, as on another machine [default: as they state it].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def rig(
    job: _Path,
    *,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    spp: int | None = None,
    noise: float | None = None,
    scale: str | None = None,
    integrator: Literal["flat", "direct", "path"] | None = None,
    quality: Literal["draft", "standard", "reference"] | None = None,
    camera: str | None = None,
    seed: int | None = None,
    sandboxed: bool = False,
    allow_outside: _Path | Sequence[_Path] | None = None,
    texture_memory: int | None = None,
    cache: _Path | None = None,
    film_memory: int | None = None,
    memory: int | None = None,
    scratch: _Path | None = None,
    output: _Path,
    overwrite: bool = False,
    frames: range | tuple[int, int] | None = None,
    progress: _Progress | None = None,
) -> list[Path]:
    """Write where a job's cameras stand and how they project, as ROS, Kalibr and COLMAP know them; nothing is rendered.

    job: The job file (TOML).
    set: Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    spp: Samples a pixel, over all replicates, of every camera [default: the job's, or the quality's].
    noise: As many samples as each pixel needs for a standard error of F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp.
    scale: Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and the same mean level, with one pixel in the place of K × K; it sets sensor.scale of all cameras.
    integrator: How much of the light's ways every camera follows, as render.integrator says it [default: the job's, or path]. One of flat, direct, path.
    quality: A preset of samples and bounces, for what the job file leaves open. One of draft, standard, reference.
    camera: Render only this camera of the job.
    seed: The seed of all random numbers [default: the job's, or 0].
    sandboxed: Refuse every file outside the folder of the job, whoever names it and through whatever link: for the jobs of others (docs/limits.md).
    allow_outside: With --sandboxed: files may lie in this folder, too. One, or a sequence of them.
    texture_memory: Memory of textures. Where they need more, the large ones are kept in tiles on the disk and read where they are looked up. The result does not depend on it. Default: 512.
    cache: The folder of these tiles, which another run finds again [default: etendue in $XDG_CACHE_HOME, else in ~/.cache].
    film_memory: Memory of the bands of one film: their means and variances, 8 bytes a pixel and band. Larger ones are kept in a scratch file on the disk, and files, effects and electrons are made of it some rows or one band at a time. The result does not depend on it. Default: 2048.
    memory: Memory that the run may take, beside the program; a run whose estimate is higher is refused before its first sample. 0: no check [default: what the process, its control group and the machine have free].
    scratch: The folder of these scratch files, which are gone when the run ends [default: that of --cache].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    frames: Frames whose poses are written, first to last (the last excluded). Default: 0..1.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def tradeoff(
    job: _Path,
    *,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    spp: int | None = None,
    noise: float | None = None,
    scale: str | None = None,
    integrator: Literal["flat", "direct", "path"] | None = None,
    quality: Literal["draft", "standard", "reference"] | None = None,
    camera: str | None = None,
    seed: int | None = None,
    sandboxed: bool = False,
    allow_outside: _Path | Sequence[_Path] | None = None,
    texture_memory: int | None = None,
    cache: _Path | None = None,
    film_memory: int | None = None,
    memory: int | None = None,
    scratch: _Path | None = None,
    output: _Path,
    overwrite: bool = False,
    time: float | None = None,
    threads: int | None = None,
    ablate: bool = False,
    vary: Mapping[str, Any] | str | Sequence[Mapping[str, Any] | str] | None = None,
    mtf50: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Tell what each choice of rendering costs in time and error for a job, and recommend settings.

    job: The job file (TOML).
    set: Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    spp: Samples a pixel, over all replicates, of every camera [default: the job's, or the quality's].
    noise: As many samples as each pixel needs for a standard error of F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp.
    scale: Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and the same mean level, with one pixel in the place of K × K; it sets sensor.scale of all cameras.
    integrator: How much of the light's ways every camera follows, as render.integrator says it [default: the job's, or path]. One of flat, direct, path.
    quality: A preset of samples and bounces, for what the job file leaves open. One of draft, standard, reference.
    camera: Render only this camera of the job.
    seed: The seed of all random numbers [default: the job's, or 0].
    sandboxed: Refuse every file outside the folder of the job, whoever names it and through whatever link: for the jobs of others (docs/limits.md).
    allow_outside: With --sandboxed: files may lie in this folder, too. One, or a sequence of them.
    texture_memory: Memory of textures. Where they need more, the large ones are kept in tiles on the disk and read where they are looked up. The result does not depend on it. Default: 512.
    cache: The folder of these tiles, which another run finds again [default: etendue in $XDG_CACHE_HOME, else in ~/.cache].
    film_memory: Memory of the bands of one film: their means and variances, 8 bytes a pixel and band. Larger ones are kept in a scratch file on the disk, and files, effects and electrons are made of it some rows or one band at a time. The result does not depend on it. Default: 2048.
    memory: Memory that the run may take, beside the program; a run whose estimate is higher is refused before its first sample. 0: no check [default: what the process, its control group and the machine have free].
    scratch: The folder of these scratch files, which are gone when the run ends [default: that of --cache].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    time: About how long the study may take, seconds (10 or more): the longer, the surer. Default: 120.
    threads: Worker threads [default: one a processor]. Times are those of as many.
    ablate: Leave out one effect of the plan after the other instead, and tell what that changes and saves.
    vary: Compare the frame with this change of a key instead (as of --set; several keys with ';' between them), and tell what it changes and saves; give it once for each change: --vary render.wavelengths_per_path=1 --vary "a.b=1; a.c=2". One, or a sequence of them.
    mtf50: With --ablate or --vary: photograph a chart of slanted edges with the camera as it is and with each change, too, and tell the spatial frequencies (cycles a pixel) at which its contrast is halved.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a dict.
    """

def dataset(
    job: _Path,
    *,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    spp: int | None = None,
    noise: float | None = None,
    scale: str | None = None,
    integrator: Literal["flat", "direct", "path"] | None = None,
    quality: Literal["draft", "standard", "reference"] | None = None,
    camera: str | None = None,
    seed: int | None = None,
    sandboxed: bool = False,
    allow_outside: _Path | Sequence[_Path] | None = None,
    texture_memory: int | None = None,
    cache: _Path | None = None,
    film_memory: int | None = None,
    memory: int | None = None,
    scratch: _Path | None = None,
    output: _Path,
    overwrite: bool = False,
    variations: _Path | None = None,
    samples: range | tuple[int, int] | None = None,
    frames: range | tuple[int, int] | None = None,
    format: Literal["coco", "kitti", "cityscapes", "yolo", "bop", "webdataset", "nuscenes", "cryptomatte", "mcap", "openlabel", "osi"] | Sequence[Literal["coco", "kitti", "cityscapes", "yolo", "bop", "webdataset", "nuscenes", "cryptomatte", "mcap", "openlabel", "osi"]] | None = None,
    resume: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> list[Path]:
    """Make a data set of a job that is varied sample after sample: COCO, KITTI, Cityscapes and others.

    job: The job file (TOML).
    set: Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    spp: Samples a pixel, over all replicates, of every camera [default: the job's, or the quality's].
    noise: As many samples as each pixel needs for a standard error of F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp.
    scale: Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and the same mean level, with one pixel in the place of K × K; it sets sensor.scale of all cameras.
    integrator: How much of the light's ways every camera follows, as render.integrator says it [default: the job's, or path]. One of flat, direct, path.
    quality: A preset of samples and bounces, for what the job file leaves open. One of draft, standard, reference.
    camera: Render only this camera of the job.
    seed: The seed of all random numbers [default: the job's, or 0].
    sandboxed: Refuse every file outside the folder of the job, whoever names it and through whatever link: for the jobs of others (docs/limits.md).
    allow_outside: With --sandboxed: files may lie in this folder, too. One, or a sequence of them.
    texture_memory: Memory of textures. Where they need more, the large ones are kept in tiles on the disk and read where they are looked up. The result does not depend on it. Default: 512.
    cache: The folder of these tiles, which another run finds again [default: etendue in $XDG_CACHE_HOME, else in ~/.cache].
    film_memory: Memory of the bands of one film: their means and variances, 8 bytes a pixel and band. Larger ones are kept in a scratch file on the disk, and files, effects and electrons are made of it some rows or one band at a time. The result does not depend on it. Default: 2048.
    memory: Memory that the run may take, beside the program; a run whose estimate is higher is refused before its first sample. 0: no check [default: what the process, its control group and the machine have free].
    scratch: The folder of these scratch files, which are gone when the run ends [default: that of --cache].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    variations: The variations file (TOML): keys of the job, its scene and its cameras with how their values are drawn [default: nothing varies but noise].
    samples: Samples to make, first to last (the last excluded); each is the same alone or among all. Default: 0..1.
    frames: Frames of each sample, first to last (the last excluded). Default: 0..1.
    format: Formats to write, with commas between them [default: those of the variations file, or coco]. One of coco, kitti, cityscapes, yolo, bop, webdataset, nuscenes, cryptomatte, mcap, openlabel, osi. One, or a sequence of them.
    resume: Go on with the data set that is in the folder: samples that are whole are kept, and more may be added.
    threads: Worker threads [default: one a processor]. The result does not depend on it.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def expose(
    radiance: _Path,
    *,
    camera: _Path,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    seed: int | None = None,
    frames: range | tuple[int, int] | None = None,
    depth_of_field: str | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Photograph a stored radiance image (rendered with route = "pupil") by another lens and sensor.

    radiance: A spectral radiance image rendered with route = "pupil".
    camera: The camera file (TOML) to photograph it with.
    set: Change a key of the camera file, e.g. --set sensor.exposure_s=0.002. A dict of dotted keys to values, or texts key=value.
    seed: The seed of the sensor's noise [default: that of the radiance image].
    frames: Frames to take, first to last (the last excluded); each has its own sensor noise. Default: 0..1.
    depth_of_field: How things out of focus are blurred: physical, none, or a look, e.g. fast:blur_px=8,near_m=0.5..2,far_m=10..40 [default: physical].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def weather(
    radiance: _Path,
    *,
    weather: _Path,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Lay fog, rain or snow over a stored radiance image (rendered with route = "pupil"), by its distances.

    radiance: A spectral radiance image rendered with route = "pupil".
    weather: The weather file (TOML): fog, rain or snow, and the radiance of the air.
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def develop(
    raws: _Path | Sequence[_Path],
    *,
    camera: _Path,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    levels: tuple[float, float] | None = None,
    seed: int | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Make pictures of raws that were taken before, by another processing.

    raws: Raws (PNG, TIFF, DNG), each with its side-car camera.json beside it. One, or a sequence of them.
    camera: The camera file (TOML) whose sensor took them and whose processing makes the pictures.
    set: Change a key of the camera file, e.g. --set isp.demosaic=malvar. A dict of dotted keys to values, or texts key=value.
    levels: For raws without a side-car: digital numbers of no light and of a saturated pixel, e.g. 64..4095.
    seed: The seed of the paper's noises [default: that of the side-car, or 0].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def flat(
    camera: _Path,
    *,
    wavelength_nm: float,
    irradiance_w_m2: float | None = None,
    photons: float | None = None,
    photon_transfer: int | None = None,
    stack: int | None = None,
    frames: range | tuple[int, int] | None = None,
    signal_breakdown: bool = False,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    seed: int | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Photograph even light by a camera's bare sensor, or take the series by which EMVA 1288 measures; nothing is traced.

    camera: The camera file (TOML); its lens is taken off.
    wavelength_nm: Wavelength of the light, nm.
    irradiance_w_m2: Irradiance of the sensor, W/m²; 0 is dark.
    photons: Photons of that wavelength on the whole square of a pixel over the exposure, in place of the irradiance; 0 is dark.
    photon_transfer: The series of EMVA 1288 instead: so many exposures up to the camera's exposure_s, where the light just saturates, two bright and two dark frames each; then a stack at half of saturation and one in the dark.
    stack: With --photon-transfer: frames of the stacks at half of saturation and in the dark. Default: 100.
    frames: Frames to take, first to last (the last excluded); each has its own sensor noise. Default: 0..1.
    signal_breakdown: Write what each pixel's digital number is made of.
    set: Change a key of the camera file, e.g. --set sensor.exposure_s=0.002. A dict of dotted keys to values, or texts key=value.
    seed: The seed of the sensor's noise [default: 0].
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def datasheet(
    sheet: _Path,
    *,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Make a camera file of an EMVA 1288 data sheet; figures that contradict each other are refused.

    sheet: The data sheet's figures (TOML; docs/format/datasheet.md has the keys).
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def import_(
    scene: _Path,
    *,
    define: str | Sequence[str] | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Write a scene of another program (glTF, pbrt, Mitsuba, USD) as a scene and a job of the format, and what became of what.

    scene: The scene: glTF 2.0 (.glb, .gltf), pbrt-v4 (.pbrt), Mitsuba 3 (.xml), USD (.usd, .usda, .usdc, .usdz) where it is built in.
    define: Give a value to a parameter of a Mitsuba scene ($name) in place of its default, e.g. -D radius=0.5. One, or a sequence of them.
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def inspect(
    file: _Path,
    *,
    png: _Path | None = None,
    layer: str | None = None,
    boxes: _Path | None = None,
    progress: _Progress | None = None,
) -> str:
    """Say what is in a file, with units; make a picture of it.

    file: A file that Étendue reads or writes: EXR, PNG, JPEG, HDR, TIFF, DNG, PFM, optical flow (.flo), OBJ, tables (CSV), lamps (IES, EULUMDAT), JSON side-car.
    png: Write a picture of it here.
    layer: The layer of an EXR that the picture shows: a channel, or what channels have before their last dot (depth, instance, flow.forward, N).
    boxes: Draw the boxes of a frame's objects over the picture.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a text.
    """

def view(
    folder: _Path,
    *,
    beside: _Path | None = None,
    frames: range | tuple[int, int] | None = None,
    max_mb: int | None = None,
    output: _Path | None = None,
    overwrite: bool = False,
    no_open: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Make a page of a result for a browser: every layer with its values, spectra, histograms, beside another result.

    folder: A folder of results: all cameras of a run, or one.
    beside: Another result, shown side by side, by a wipe, and as the difference; of the same sizes.
    frames: Frames to show, first to last (the last excluded) [default: all].
    max_mb: What the numbers of one layer take at most, MB; larger layers have fewer pixels on the page, by a whole factor. Default: 32.
    output: Folder for the page, or the name of one file that ends in .html and holds everything [default: the folder `view` in FOLDER, where an earlier page is replaced].
    overwrite: Replace files that are already there.
    no_open: Write the page and leave it closed; without a terminal that is so by itself.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def compare(
    a: _Path,
    b: _Path,
    *,
    significance: float | None = None,
    difference: _Path | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Compare two results: errors with their uncertainty; exit status 1 where they differ.

    a: First result, an EXR or PNG file; errors are A − B.
    b: Reference of the same size and channels, which is subtracted from A.
    significance: Family-wise probability of calling equal images different, for images that carry their variance. Default: 0.001.
    difference: If they differ, write A, B and |A − B| as images into this folder.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a dict.
    """

def calibrate(
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
    f_number: float | None = None,
    output: _Path | None = None,
    overwrite: bool = False,
    plot: _Path | None = None,
    html: _Path | None = None,
    progress: _Progress | None = None,
) -> Report:
    """Find a camera's intrinsics and distortion from several pictures of a chart, as a camera file.

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
    f_number: The lens's f-number, for the camera file [default: 4, which is marked as a stand-in].
    output: Write the camera file here; needs --pixel-pitch-um.
    overwrite: Replace a camera file that is already there.
    plot: Draw the curves here; an earlier drawing is replaced.
    html: Write figures, tables, curves and notes as one page for a browser; an earlier page is replaced.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a Report.
    """

def characterise(
    folder: _Path,
    *,
    base: _Path | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Make a camera file of a laboratory folder (dark frames, flats, charts), with every uncertainty and a report as a page.

    folder: The laboratory folder: folders dark, flat, field, chart, edges and checker with pictures in them, any of them missing, and laboratory.toml where pictures do not say enough.
    base: Lay the camera file over this one: what is not measured is its.
    output: Write the camera file here, and beside it the report under the same stem: .html, .json.
    overwrite: Replace files that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def laboratory(
    camera: _Path,
    *,
    set: Mapping[str, Any] | Sequence[str] | None = None,
    seed: int | None = None,
    levels: int | None = None,
    stack: int | None = None,
    views: int | None = None,
    spp: int | None = None,
    output: _Path,
    overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[Path]:
    """Photograph a laboratory folder by a camera file: what characterise reads.

    camera: The camera file (TOML).
    set: Change a key of the camera file, e.g. --set sensor.width_px=320. A dict of dotted keys to values, or texts key=value.
    seed: The seed of all noise. Default: 0.
    levels: Levels of even light on the bare sensor, up to a little above saturation. Default: 15.
    stack: Frames of the stacks without light and at half of saturation. Default: 32.
    views: Views of the checkerboard. Default: 13.
    spp: Samples a pixel of the pictures through the lens. Default: 64.
    output: Folder for the results; made where missing.
    overwrite: Replace results that are already there.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with the paths of what was written.
    """

def schema(
    kind: Literal["scene", "camera", "job", "datasheet", "variations", "laboratory", "weather"],
    *,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Print the JSON Schema of a file kind, for editors.

    kind: The kind of file. One of scene, camera, job, datasheet, variations, laboratory, weather.
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a dict.
    """

def explain(
    code: str | None = None,
    *,
    progress: _Progress | None = None,
) -> str:
    """Explain the code of an error: its cause, an example and what to do.

    code: The code of an error, such as unknown-key, which stands in brackets before its message [default: a list of all codes].
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a text.
    """
