"""A hundred scenes in which every manoeuvre ends in a crash, and how harmful each crash is.

>>> from crashrank import benchmark
>>> rows = benchmark.score(lambda scene: "brake hard in lane")
>>> sum(row.regret_persons for row in rows) / len(rows) > 0
True
"""

from __future__ import annotations

from ._data import Benchmark, StoredAnswer, load
from ._score import Row, score, stored_rows, summary

__all__ = ["Benchmark", "Row", "StoredAnswer", "load", "score", "stored_rows", "summary"]


def __dir__() -> list[str]:
    """List the public names alone."""
    return sorted(__all__)
