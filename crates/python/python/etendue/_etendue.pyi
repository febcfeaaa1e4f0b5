"""The module that is built in Rust. Its classes are those that the package has; the functions here are for the package's own use."""

from collections.abc import Callable, Sequence
from os import PathLike

from . import Camera as Camera
from . import Frame as Frame
from . import Job as Job
from . import Results as Results
from . import set_limit as set_limit

__all__ = ["Camera", "Frame", "Job", "Results", "__version__", "call", "catalogue", "main", "set_limit", "to_toml"]

__version__: str

def call(arguments: Sequence[str | PathLike[str]], progress: Callable[[str, int, int], object] | None = None) -> tuple[str, str | None]:
    """Runs a verb: its answer, and why the run failed where it answered first."""

def catalogue() -> str:
    """The list of verbs with their arguments, as JSON."""

def main(arguments: Sequence[str | PathLike[str]]) -> int:
    """The program: its exit status. Arguments begin with the program's name."""

def to_toml(value: object) -> str:
    """A value as TOML writes it on one line: numbers, texts, bools, paths, lists, dicts and NumPy arrays."""
