"""Étendue: spectral path tracing joined to a physically based camera."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeVar, final

import numpy as np
import numpy.typing as npt

from . import chart as chart
from . import measure as measure
from .verbs import *

__all__ = [
    "Camera",
    "Error",
    "Estimate",
    "Fault",
    "Frame",
    "InputError",
    "Job",
    "Report",
    "Results",
    "RunError",
    "__version__",
    "chart",
    "measure",
    "set_limit",
    "to_xarray",
]
# Written by `ETENDUE_BLESS=1` of `tests/test_stubs.py`.
__all__ += ["merge", "rig", "tradeoff", "dataset", "expose", "weather", "develop", "flat", "datasheet", "import_", "inspect", "view", "compare", "calibrate", "characterise", "laboratory", "schema", "explain"]

__version__: str

_Path = str | PathLike[str]
_Progress = Callable[[str, int, int], object]
_Floats = npt.NDArray[np.float32]
_Integers = npt.NDArray[np.uint32]
_Default = TypeVar("_Default")

@dataclass(frozen=True)
class Fault:
    """One fault of an input. Lines and columns count from 1; None: not known, or an argument's."""

    message: str
    file: str | None = None
    line: int | None = None
    column: int | None = None
    key: str | None = None
    code: str = "invalid-argument"
    problem: str = ""
    remedy: str | None = None

class Error(Exception):
    """Why a call did not succeed. Nothing that was written under a final name is half-written."""

class InputError(Error, ValueError):
    """Unusable input (exit status 2 of the program): ``faults`` has all, the others are those of the first."""

    faults: list[Fault]
    def __init__(self, faults: Iterable[tuple[Any, ...]]) -> None: ...
    @property
    def code(self) -> str: ...
    @property
    def file(self) -> str | None: ...
    @property
    def line(self) -> int | None: ...
    @property
    def column(self) -> int | None: ...
    @property
    def key(self) -> str | None: ...

class RunError(Error, RuntimeError):
    """A run that did not succeed although its input is good (exit status 1 of the program)."""

@final
class Job:
    """A job that was read, checked and compiled: nothing after it fails because of what its user wrote."""

    @staticmethod
    def open(
        description: _Path | Mapping[str, Any],
        *,
        set: Mapping[str, Any] | Sequence[str] | None = None,
        spp: int | None = None,
        noise: float | None = None,
        time_s: float | None = None,
        progressive: bool = False,
        scale: str | float | None = None,
        seed: int | None = None,
        integrator: Literal["flat", "direct", "path"] | None = None,
        quality: Literal["draft", "standard", "reference"] | None = None,
        camera: str | None = None,
        files: Mapping[str, Mapping[str, Any] | str] | None = None,
        meshes: Mapping[str, Mapping[str, npt.ArrayLike]] | None = None,
        folder: _Path | None = None,
        sandbox: Sequence[_Path] | None = None,
        texture_memory_mb: int = 512,
        cache: _Path | None = None,
        film_memory_mb: int = 2048,
        memory_mb: int | None = None,
        scratch: _Path | None = None,
    ) -> Job:
        """Opens a job.

        description: the path of a job file (TOML), or its keys as a dict.
        set: changes of keys, as ``--set``: a dict of dotted keys to values (None takes a key out), or texts ``key=value``.
        spp, noise, time_s, progressive, scale ("1/4" or 0.25), seed, integrator, quality, camera: as the options of ``etendue render``.
        files: files that the job names, made here: names to dicts or texts (TOML).
        meshes: meshes that the job names: names to dicts of ``positions`` (n, 3), ``triangles`` (m, 3), and where they are wanted ``normals`` (n, 3)
        and ``uvs`` (n, 2), in the unit and axes that the job states for the mesh.
        folder: the folder of a job that is a dict, which its paths are relative to. Default: the working folder.
        sandbox: folders beside the job's own that its files may lie in. None: they may lie anywhere.
        texture_memory_mb, cache, film_memory_mb, scratch: memory of textures and films, and where larger ones are kept. memory_mb: what the run may take, 0 for no limit; None: what is free when the job is opened. No bit depends on them.

        Raises InputError with every fault of all files.
        """

    def plan(self) -> dict[str, Any]:
        """What will be modelled, what is left out and why, and what it will cost: as ``etendue plan --json``."""

    def summary(self) -> str:
        """The same in words, as ``etendue plan``."""

    @property
    def files(self) -> list[Path]:
        """Paths of the files that were read: the job and all that it names, as they were named."""

    def film_names(self, frames: int | range | None = None) -> list[str]:
        """Names of the films of a shard, relative to its folder: one for each camera (of cameras of equal light one together); where light depends
        on time, of each of the frames and captures."""

    def file_names(self, frames: int | range | None = None) -> list[str]:
        """Names of all files of a whole run, relative to its folder."""

    def render(
        self, *, frames: int | range | None = None, threads: int | None = None, progress: _Progress | None = None
    ) -> Results:
        """Renders all cameras and keeps their light in memory.

        frames: a frame's number, or a range of consecutive ones. Default: frame 0.
        threads: worker threads. Default: one a processor. No bit depends on it.
        progress: called in this thread with what is worked on, how many tiles are done, and of how many, when one is; what it raises cancels
        the run, as Ctrl-C does.

        Warnings go to ``warnings``, notes to the logger "etendue". Other threads of Python run meanwhile.
        """

    def save(
        self,
        folder: _Path,
        *,
        frames: int | range | None = None,
        overwrite: bool = False,
        resume: bool = False,
        shard: tuple[int, int] | None = None,
        films: Sequence[str] | None = None,
        threads: int | None = None,
        progress: _Progress | None = None,
    ) -> list[Path]:
        """Renders camera after camera into a folder, holding one at a time: the files of ``etendue render``, byte for byte.

        overwrite: replaces what an earlier run left. resume: goes on where a run of the same plan was interrupted.
        shard: (i, n) renders the tiles whose number is i modulo n; ``etendue.merge`` joins the folders of all.
        films: the only films of the shard to render, of ``film_names()``; ``merge`` wants all of them in the folder. None: all.

        Answers with the paths of what was written.
        """

@final
class Results:
    """The results of all cameras of a job, a mapping from their names: light is held; frames and ground truth are made when they are asked for."""

    @property
    def cameras(self) -> list[Camera]:
        """The cameras, those of equal light one after the other; where light depends on time, once for each frame."""
    @property
    def names(self) -> list[str]:
        """Names of the cameras, each once."""
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def __contains__(self, name: object, /) -> bool: ...
    def __getitem__(self, name: str, /) -> Camera: ...
    def keys(self) -> list[str]:
        """Names of the cameras, as ``names``."""
    def values(self) -> list[Camera]:
        """The camera of each name; where light depends on time, of the first frame: ``cameras`` has all."""
    def items(self) -> list[tuple[str, Camera]]:
        """Names and cameras, as ``keys`` and ``values``."""
    def get(self, name: str, default: _Default | None = None) -> Camera | _Default | None:
        """The camera of a name, or ``default`` where there is none."""
    def camera(self, name: str, frame: int | None = None) -> Camera:
        """A camera by its name; where light depends on time, of one frame: the first unless another is named."""
    def save(self, folder: _Path, *, overwrite: bool = False) -> list[Path]:
        """Writes the files of ``etendue render``, the same bytes; answers with their paths."""

@final
class Camera:
    """The results of one camera. Arrays have rows from the top and pixels from the left; they are read-only and share the memory of what is held."""

    @property
    def name(self) -> str:
        """The camera's name in its job."""
    @property
    def frame_numbers(self) -> range:
        """Numbers of the frames that these results are of: one where light depends on time."""
    @property
    def wavelengths_nm(self) -> list[float] | None:
        """Centres of the bands of radiance and irradiance, nm. None where there is neither."""
    @property
    def radiance(self) -> _Floats | None:
        """Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹; (bands, height, width). None where the job does not ask for it."""
    @property
    def radiance_variance(self) -> _Floats | None:
        """The variance of the radiance's mean, in its unit squared; (bands, height, width)."""
    @property
    def irradiance(self) -> _Floats | None:
        """Spectral irradiance on the sensor plane, W·m⁻²·nm⁻¹; (bands, height, width). None where the job does not ask for it."""
    @property
    def ghosts(self) -> _Floats | None:
        """The part of the irradiance that is ghosts, W·m⁻²·nm⁻¹; (bands, height, width). None where the camera makes none."""
    @property
    def electrons(self) -> _Floats | None:
        """Mean electrons of each pixel, e⁻; (height, width). None where the camera has no electronics."""
    def frames(self) -> list[Frame]:
        """The photographs; none where the camera has no electronics. The sensor is run at every call, with the same bits."""
    @property
    def raw(self) -> _Integers | None:
        """Digital numbers of the first frame, DN; (height, width). None where the camera has no electronics."""
    @property
    def picture(self) -> _Floats | None:
        """The picture of the first frame, encoded, 0 to 1; (height, width, 3). None where the camera makes none."""
    @property
    def depth(self) -> _Floats:
        """Distance along the camera's axis, m; (height, width). +inf for the sky, NaN where no ray passes."""
    @property
    def distance(self) -> _Floats:
        """Distance along each pixel's ray, m; (height, width). +inf for the sky, NaN where no ray passes."""
    @property
    def normals(self) -> _Floats:
        """Unit shading normals in the world; (height, width, 3). Zero for the sky."""
    @property
    def positions(self) -> _Floats:
        """Positions in the world, m; (height, width, 3). Zero for the sky."""
    @property
    def positions_low(self) -> _Floats | None:
        """What rounding took off the positions, m; (height, width, 3). None but for cameras far from the world's origin."""
    @property
    def camera_space_positions(self) -> _Floats | None:
        """Positions in the camera's frame, m; (height, width, 3). None where the job does not ask for them."""
    @property
    def instance_ids(self) -> _Integers:
        """Ids of instances; (height, width). 0 is the background."""
    @property
    def semantic_ids(self) -> _Integers:
        """Ids of classes; (height, width). 0 is the background and what has no class."""
    @property
    def material_ids(self) -> _Integers:
        """Places in the plan's list of materials, from 1; (height, width). 0 is the background."""
    @property
    def flow(self) -> _Floats:
        """Optical flow to the next frame, px; (height, width, 2). NaN where there is no image."""
    def motion_truth(self) -> dict[str, Any]:
        """All of motion: "forward" and "backward" (None before frame 0), "motion_vector", px/s, "velocity", m/s, "time", s."""
    @property
    def disparity(self) -> _Floats | None:
        """Disparity to the camera that the job's ``disparity_to`` names, px; (height, width). None where it names none."""
    @property
    def disparity_visibility(self) -> _Integers | None:
        """Whether that camera sees each point; (height, width). None where the job names none."""
    @property
    def boxes(self) -> dict[str, Any]:
        """The boxes of the objects, as ``boxes.json`` has them."""
    @property
    def rays(self) -> dict[str, npt.NDArray[Any]]:
        """Each pixel's ray in the camera's frame: "origin", m, and "direction", (height, width, 3), "ray", (height, width), and with a mirror "path", m."""

@final
class Frame:
    """A photograph of a camera, a mapping from the names of its arrays."""

    @property
    def number(self) -> int:
        """The frame's number."""
    @property
    def raw(self) -> _Integers:
        """Digital numbers, DN; (height, width)."""
    @property
    def bits(self) -> int:
        """Bits of a digital number."""
    @property
    def black_level_dn(self) -> float:
        """The digital number of no charge."""
    @property
    def white_level_dn(self) -> float:
        """The digital number of a saturated pixel."""
    @property
    def picture(self) -> _Floats | None:
        """The picture as its file encodes it, before it is rounded to bits, 0 to 1; (height, width, 3). None where the camera makes none."""
    @property
    def linear_picture(self) -> _Floats | None:
        """The same in linear sRGB, not clipped; (height, width, 3). None where the camera makes none."""
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def __contains__(self, name: object, /) -> bool: ...
    def __getitem__(self, name: str, /) -> npt.NDArray[Any]: ...
    def keys(self) -> list[str]:
        """Names of the arrays that the frame has: raw, and of a camera that makes pictures picture and linear_picture."""
    def values(self) -> list[npt.NDArray[Any]]:
        """The arrays, in the order of ``keys``."""
    def items(self) -> list[tuple[str, npt.NDArray[Any]]]:
        """Names and arrays, as ``keys`` and ``values``."""
    def get(self, name: str, default: _Default | None = None) -> npt.NDArray[Any] | _Default | None:
        """The array of a name, or ``default`` where there is none."""

class Estimate(NamedTuple):
    """A number with its standard uncertainty (None: not stated, or not finite) and unit ("" for none)."""

    value: float | None
    standard_uncertainty: float | None
    unit: str

class Report(dict[str, Any]):
    """What a measurement found: the dict that ``--json`` prints, with the numbers by their keys."""

    differs: str | None
    @property
    def figures(self) -> dict[str, Estimate]:
        """All numbers."""
    @property
    def tables(self) -> dict[str, list[dict[str, Any]]]:
        """All tables: lists of rows, each a dict of columns."""
    @property
    def notes(self) -> list[str]:
        """What a user should know of the result: sentences."""
    def estimate(self, key: str) -> Estimate:
        """A number with its uncertainty and unit."""
    def value(self, key: str) -> float | None:
        """A number without its uncertainty; None where it is unknown."""
    def table(self, key: str) -> Any:
        """A table as a pandas DataFrame (the extra "pandas")."""

def set_limit(name: str, number: int) -> None:
    """Moves a limit on what files may cost for all of the process, as ``--limit NAME=N``, which messages propose (docs/limits.md).

    name: as on the command line, such as "picture-mib".
    """

def to_xarray(camera: Camera) -> Any:
    """A camera's light, first frame and ground truth as an xarray Dataset (the extra "xarray"), each variable with its unit.

    x and y are the centres of pixels in raster coordinates, px; what the camera does not have is left out.
    """
