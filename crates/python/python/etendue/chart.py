"""Test charts as scenes ready to render, with their truth: the charts of ``etendue chart``."""

from ._verbs import functions as _functions
from ._verbs import group as _group

_made = _functions(_group("chart"), ("chart",))
globals().update(_made)
__all__ = list(_made)
