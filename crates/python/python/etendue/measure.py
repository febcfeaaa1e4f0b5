"""Cameras measured from pictures, and lenses without rendering: the measurements of ``etendue measure``, each answering with a Report."""

from ._verbs import functions as _functions
from ._verbs import group as _group

_made = _functions(_group("measure"), ("measure",))
globals().update(_made)
__all__ = list(_made)
