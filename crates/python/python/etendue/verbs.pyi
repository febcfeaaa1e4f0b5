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

    shards: Folders of all shards. One, or a sequence of them.
    job: Path of the job file, if the shards were rendered from another path or machine [default: as stated in the shards].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Write poses and projections of a job's cameras for ROS, Kalibr and COLMAP; nothing is rendered.

    job: The job file (TOML).
    set: Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    spp: Samples per pixel, over all replicates, of every camera [default: that of the job or of the quality].
    noise: Sample each pixel until its standard error is F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp samples.
    scale: Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and mean level, with one pixel instead of K × K; sets sensor.scale of all cameras.
    integrator: Light paths that every camera simulates, as in render.integrator [default: the job's, or path]. One of flat, direct, path.
    quality: Preset of samples and bounces, for keys that the job file leaves open. One of draft, standard, reference.
    camera: Render only this camera of the job.
    seed: Seed of all random numbers [default: the job's, or 0].
    sandboxed: Refuse every file outside the folder of the job, whichever file names it and through any link: for untrusted jobs (docs/limits.md).
    allow_outside: With --sandboxed: also allow files in this folder. One, or a sequence of them.
    texture_memory: Memory of textures. If they need more, large ones are stored as tiles on disk and read on demand. The result does not depend on it. Default: 512.
    cache: Folder of these tiles, reused by later runs [default: etendue in $XDG_CACHE_HOME, else in ~/.cache].
    film_memory: Memory of the bands of one film: means and variances, 8 bytes per pixel and band. Larger films are stored in a scratch file on disk; files, effects and electrons are then computed from it some rows or one band at a time. The result does not depend on it. Default: 2048.
    memory: Memory limit of the run, without the program itself; a run with a higher estimate is refused before its first sample. 0: no check [default: the free memory of the process, its control group and the machine].
    scratch: Folder of these scratch files, which are removed at the end of the run [default: that of --cache].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Report time and error of each rendering choice for a job, and recommend settings.

    job: The job file (TOML).
    set: Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    spp: Samples per pixel, over all replicates, of every camera [default: that of the job or of the quality].
    noise: Sample each pixel until its standard error is F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp samples.
    scale: Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and mean level, with one pixel instead of K × K; sets sensor.scale of all cameras.
    integrator: Light paths that every camera simulates, as in render.integrator [default: the job's, or path]. One of flat, direct, path.
    quality: Preset of samples and bounces, for keys that the job file leaves open. One of draft, standard, reference.
    camera: Render only this camera of the job.
    seed: Seed of all random numbers [default: the job's, or 0].
    sandboxed: Refuse every file outside the folder of the job, whichever file names it and through any link: for untrusted jobs (docs/limits.md).
    allow_outside: With --sandboxed: also allow files in this folder. One, or a sequence of them.
    texture_memory: Memory of textures. If they need more, large ones are stored as tiles on disk and read on demand. The result does not depend on it. Default: 512.
    cache: Folder of these tiles, reused by later runs [default: etendue in $XDG_CACHE_HOME, else in ~/.cache].
    film_memory: Memory of the bands of one film: means and variances, 8 bytes per pixel and band. Larger films are stored in a scratch file on disk; files, effects and electrons are then computed from it some rows or one band at a time. The result does not depend on it. Default: 2048.
    memory: Memory limit of the run, without the program itself; a run with a higher estimate is refused before its first sample. 0: no check [default: the free memory of the process, its control group and the machine].
    scratch: Folder of these scratch files, which are removed at the end of the run [default: that of --cache].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    time: Approximate duration of the study, seconds (10 or more); longer studies are more precise. Default: 120.
    threads: Worker threads [default: one per processor]. Times refer to this number.
    ablate: Instead omit the effects of the plan one by one, and report the change and the saving of each.
    vary: Instead compare the frame with this change of a key (as for --set; several keys separated by ';'), and report the change and the saving; once for each change: --vary render.wavelengths_per_path=1 --vary "a.b=1; a.c=2". One, or a sequence of them.
    mtf50: With --ablate or --vary: also capture a chart of slanted edges with the unchanged camera and with each change, and report the spatial frequencies (cycles per pixel) at half contrast.
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
    """Make a data set from a job varied sample by sample: COCO, KITTI, Cityscapes and others.

    job: The job file (TOML).
    set: Change a key of the job, its scene or a camera, e.g. --set render.spp=16 or --set cameras.front.lens.f_number=4. A dict of dotted keys to values, or texts key=value.
    spp: Samples per pixel, over all replicates, of every camera [default: that of the job or of the quality].
    noise: Sample each pixel until its standard error is F times the noise that its sensor adds (F times its mean without a sensor), at most render.max_spp samples.
    scale: Size of every image over that of its sensor, 1/K or the same as a decimal fraction: the same field of view and mean level, with one pixel instead of K × K; sets sensor.scale of all cameras.
    integrator: Light paths that every camera simulates, as in render.integrator [default: the job's, or path]. One of flat, direct, path.
    quality: Preset of samples and bounces, for keys that the job file leaves open. One of draft, standard, reference.
    camera: Render only this camera of the job.
    seed: Seed of all random numbers [default: the job's, or 0].
    sandboxed: Refuse every file outside the folder of the job, whichever file names it and through any link: for untrusted jobs (docs/limits.md).
    allow_outside: With --sandboxed: also allow files in this folder. One, or a sequence of them.
    texture_memory: Memory of textures. If they need more, large ones are stored as tiles on disk and read on demand. The result does not depend on it. Default: 512.
    cache: Folder of these tiles, reused by later runs [default: etendue in $XDG_CACHE_HOME, else in ~/.cache].
    film_memory: Memory of the bands of one film: means and variances, 8 bytes per pixel and band. Larger films are stored in a scratch file on disk; files, effects and electrons are then computed from it some rows or one band at a time. The result does not depend on it. Default: 2048.
    memory: Memory limit of the run, without the program itself; a run with a higher estimate is refused before its first sample. 0: no check [default: the free memory of the process, its control group and the machine].
    scratch: Folder of these scratch files, which are removed at the end of the run [default: that of --cache].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
    variations: The variations file (TOML): keys of the job, its scene and its cameras with the distributions of their values [default: only noise varies].
    samples: Samples to make, first to last (the last excluded); a sample does not depend on the others. Default: 0..1.
    frames: Frames of each sample, first to last (the last excluded). Default: 0..1.
    format: Formats to write, separated by commas [default: those of the variations file, or coco]. One of coco, kitti, cityscapes, yolo, bop, webdataset, nuscenes, cryptomatte, mcap, openlabel, osi. One, or a sequence of them.
    resume: Resume the data set in the folder: complete samples are kept, and more may be added.
    threads: Worker threads [default: one per processor]. The result does not depend on it.
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
    """Capture a stored radiance image (rendered with route = "pupil") with another lens and sensor.

    radiance: A spectral radiance image rendered with route = "pupil".
    camera: The camera file (TOML).
    set: Change a key of the camera file, e.g. --set sensor.exposure_s=0.002. A dict of dotted keys to values, or texts key=value.
    seed: Seed of the sensor's noise [default: that of the radiance image].
    frames: Frames to take, first to last (the last excluded); each has its own sensor noise. Default: 0..1.
    depth_of_field: Blur of objects out of focus: physical, none, or an artistic setting, e.g. fast:blur_px=8,near_m=0.5..2,far_m=10..40 [default: physical].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Add fog, rain or snow to a stored radiance image (rendered with route = "pupil"), by its distances.

    radiance: A spectral radiance image rendered with route = "pupil".
    weather: The weather file (TOML): fog, rain or snow, and the radiance of the air.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Make images from stored raws, with another processing.

    raws: Raws (PNG, TIFF, DNG), each with its side-car camera.json in the same folder. One, or a sequence of them.
    camera: The camera file (TOML) with the sensor of the raws and the processing.
    set: Change a key of the camera file, e.g. --set isp.demosaic=malvar. A dict of dotted keys to values, or texts key=value.
    levels: For raws without a side-car: black level and saturation level, DN, e.g. 64..4095.
    seed: Seed of the noise of the image filters [default: that of the side-car, or 0].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Capture uniform illumination with a camera's bare sensor, or the series of EMVA 1288 measurements; nothing is traced.

    camera: The camera file (TOML); its lens is ignored.
    wavelength_nm: Wavelength of the light, nm.
    irradiance_w_m2: Irradiance of the sensor, W/m²; 0 is dark.
    photons: Photons of that wavelength on the full area of a pixel over the exposure, instead of the irradiance; 0 is dark.
    photon_transfer: The series of EMVA 1288 instead: number of exposures up to the camera's exposure_s, at which the light just saturates, with two bright and two dark frames each; then a stack at half of saturation and one in the dark.
    stack: With --photon-transfer: frames of the stacks at half of saturation and in the dark. Default: 100.
    frames: Frames to take, first to last (the last excluded); each has its own sensor noise. Default: 0..1.
    signal_breakdown: Write the components of each pixel's digital number.
    set: Change a key of the camera file, e.g. --set sensor.exposure_s=0.002. A dict of dotted keys to values, or texts key=value.
    seed: Seed of the sensor's noise [default: 0].
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Make a camera file from an EMVA 1288 data sheet; contradictory values are refused.

    sheet: Values of the data sheet (TOML; docs/format/datasheet.md has the keys).
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Convert a scene of another program (glTF, pbrt, Mitsuba, USD) to a scene and a job of the format, with a conversion report.

    scene: The scene: glTF 2.0 (.glb, .gltf), pbrt-v4 (.pbrt), Mitsuba 3 (.xml), USD (.usd, .usda, .usdc, .usdz) where it is built in.
    define: Give a value to a parameter of a Mitsuba scene ($name) in place of its default, e.g. -D radius=0.5. One, or a sequence of them.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Print the content of a file, with units; write it as an image.

    file: A file that Étendue reads or writes: EXR, PNG, JPEG, HDR, TIFF, DNG, PFM, optical flow (.flo), OBJ, tables (CSV), lights (IES, EULUMDAT), JSON side-car.
    png: Write its content as an image here.
    layer: Layer of an EXR for the image: a channel, or the part of channel names before the last dot (depth, instance, flow.forward, N).
    boxes: Draw the boxes of a frame's objects on the image.
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
    """Make a page for a browser from a result: every layer with its values, spectra, histograms, next to another result.

    folder: A folder of results: all cameras of a run, or one.
    beside: Second result, shown side by side, by a wipe, and as the difference; of the same sizes.
    frames: Frames to show, first to last (the last excluded) [default: all].
    max_mb: Maximum size of the numbers of one layer, MB; larger layers are downsampled by a whole factor. Default: 32.
    output: Folder for the page, or the name of one file that ends in .html and contains everything [default: the folder `view` in FOLDER, where an existing page is replaced].
    overwrite: Replace existing files.
    no_open: Write the page without opening it; this is the default without a terminal.
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
    """Compare two results: errors with their uncertainty; exit status 1 if they differ.

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
    """Compute a camera's intrinsics and distortion from several images of a chart, as a camera file.

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
    f_number: F-number of the lens, for the camera file [default: 4, marked as a stand-in].
    output: Write the camera file here; needs --pixel-pitch-um.
    overwrite: Replace an existing camera file.
    plot: Draw the curves here; an existing drawing is replaced.
    html: Write results, tables, curves and notes as one page for a browser; an existing page is replaced.
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
    """Make a camera file from a laboratory folder (dark frames, flats, charts), with every uncertainty and a report as a page.

    folder: Laboratory folder: folders dark, flat, field, chart, edges and checker with images, each optional, and laboratory.toml for facts that the images do not state.
    base: Camera file to extend: supplies what is not measured.
    output: Write the camera file here, and next to it the report under the same stem: .html, .json.
    overwrite: Replace existing files.
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
    """Capture a laboratory folder with a camera file: the input of characterise.

    camera: The camera file (TOML).
    set: Change a key of the camera file, e.g. --set sensor.width_px=320. A dict of dotted keys to values, or texts key=value.
    seed: Seed of all noise. Default: 0.
    levels: Levels of uniform illumination on the bare sensor, up to slightly above saturation. Default: 15.
    stack: Frames of the stacks without light and at half of saturation. Default: 32.
    views: Views of the checkerboard. Default: 13.
    spp: Samples per pixel of the images through the lens. Default: 64.
    output: Folder for the results; created if missing.
    overwrite: Replace existing results.
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
    """Explain an error code: cause, example and remedy.

    code: The code of an error, such as unknown-key, shown in brackets before its message [default: a list of all codes].
    progress: called with what is worked on, how much is done, and of how much; what it raises cancels, as Ctrl-C does.

    Answers with a text.
    """
