"""The verbs of the command line that are in no group, as functions; ``import etendue`` has them, too."""

from ._verbs import alone as _alone
from ._verbs import functions as _functions

_made = _functions(_alone())
globals().update(_made)
__all__ = list(_made)
