"""A job on many machines: frames x cameras x shards on Ray, joined to the bytes of one machine.

>>> import etendue.cluster
>>> etendue.cluster.render("scenes/street/street.toml", "out/street", shards=8)

or ``python -m etendue.cluster scenes/street/street.toml -o out/street --shards 8``. Needs Ray: ``pip install "./crates/python[cluster]"``.
"""

from .driver import render

__all__ = ["render"]
