"""Ranks the crashes that a vehicle can still choose, least harmful first.

Units are SI and part of every name; frames follow ISO 8855: x forward, y left, z up. Errors are
subclasses of `Error`. Nothing prints. Every function may be called from any thread; the
interpreter's lock is released while the engine works.

>>> import crashrank
>>> ranking = crashrank.rank("data/scenarios/oncoming_truck.json")
>>> ranking.best.candidate
'coast into the barrier'
"""

from __future__ import annotations

import os as _os
from pathlib import Path as _Path

from . import _core
from ._answer import Answer, AnsweredCandidate
from ._collide import (
    collide,
    collide_all,
    collide_any,
    collide_state,
    pairs_hash,
    pose_matrix,
)
from ._errors import (
    ArgumentTypeError,
    BadInputError,
    BudgetError,
    Error,
    InternalError,
    LimitError,
    NotFoundError,
    OutOfMemoryError,
    UsageError,
)
from ._model import Model, Part, load_model
from ._parts import Actor, Body, Candidate, Ego, Pose, TimedPose
from ._ranker import Ranker
from ._ranking import BodyMotion, RankedCandidate, Ranking, rank
from ._record import Record
from ._scenario import Scenario
from .batch import rank_table

__version__: str = _core.version

# The importer of the wheel lies beside this file. In a build of the library, and where the
# environment names one, the library finds it itself.
_importer = _Path(__file__).parent / "crashrank-import"
if "CRASHRANK_IMPORTER" not in _os.environ and _importer.is_file():
    _core.set_importer(str(_importer))

__all__ = [
    "Actor",
    "Answer",
    "AnsweredCandidate",
    "ArgumentTypeError",
    "BadInputError",
    "Body",
    "BodyMotion",
    "BudgetError",
    "Candidate",
    "Ego",
    "Error",
    "InternalError",
    "LimitError",
    "Model",
    "NotFoundError",
    "OutOfMemoryError",
    "Part",
    "Pose",
    "RankedCandidate",
    "Ranker",
    "Ranking",
    "Record",
    "Scenario",
    "TimedPose",
    "UsageError",
    "__version__",
    "collide",
    "collide_all",
    "collide_any",
    "collide_state",
    "load_model",
    "pairs_hash",
    "pose_matrix",
    "rank",
    "rank_table",
]


def __dir__() -> list[str]:
    """List the public names alone."""
    return sorted(__all__)
