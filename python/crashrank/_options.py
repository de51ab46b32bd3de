"""Options that `rank` and `Ranker` share."""

from __future__ import annotations

import math
from collections.abc import Callable

from . import _core
from ._checks import as_count, as_flag, as_path, as_real, as_text
from ._errors import wrong_type

NO_LIMIT = 2**64 - 1


def as_request(
    measure: object,
    workers: object,
    risk: object,
    infeasible: object,
    order: object,
    profile: object,
    futures: object,
    motion: object = False,
    smooth: object = False,
) -> _core.RankRequest:
    """Return what is asked of every ranking: an absent measure or risk is the scenario's."""
    return _core.RankRequest(
        "" if measure is None else as_text(measure, "measure"),
        "" if risk is None else as_text(risk, "risk"),
        as_text(infeasible, "infeasible"),
        as_text(order, "order"),
        "" if profile is None else as_path(profile, "profile"),
        as_count(workers, "workers", 1, _core.max_workers),
        as_count(futures, "futures", 1, _core.max_sampled_futures),
        as_flag(motion, "motion"),
        as_flag(smooth, "smooth"),
    )


def as_budget(
    deadline_s: object, work_budget: object, first_place_only: object
) -> _core.RankBudget:
    """Return where one ranking ends early; absent limits are none."""
    return _core.RankBudget(
        math.inf if deadline_s is None else as_real(deadline_s, "deadline_s"),
        NO_LIMIT if work_budget is None else as_count(work_budget, "work_budget", 0, NO_LIMIT),
        as_flag(first_place_only, "first_place_only"),
    )


def as_progress(progress: object) -> Callable[[int, int], object] | None:
    """Return a function that is called with the numbers of candidates evaluated and of all."""
    if progress is None:
        return None
    if not callable(progress):
        raise wrong_type(
            "progress", f"is a {type(progress).__name__}, not callable", "give a function or None"
        )
    return progress
