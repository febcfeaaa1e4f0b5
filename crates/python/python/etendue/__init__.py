"""Étendue: spectral path tracing joined to a physically based camera.

>>> import etendue
>>> job = etendue.Job.open("scenes/street/street.toml", set={"render.spp": 16})
>>> front = job.render()["front"]
>>> front.picture.shape, front.depth.shape

Arrays have rows from the top and pixels from the left; they are read-only and share the memory of the results: ``.copy()`` gives one to change.
"""

from collections.abc import Mapping as _Mapping

from . import chart, measure
from ._errors import Error, Fault, InputError, RunError
from ._etendue import Camera, Frame, Job, Results, __version__, set_limit
from ._report import Estimate, Report
from ._xarray import to_xarray
from .verbs import *
from .verbs import __all__ as _verb_names

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
    *_verb_names,
]

for _class in (Results, Frame):
    _Mapping.register(_class)
