"""The point of decision: step back from a contact, or from the closest approach, and rank."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import pairwise
from typing import Any, NoReturn

from .._checks import as_count, as_number, as_path
from .._errors import usage, wrong_type
from .._ranking import RankedCandidate, Ranking, rank
from ._curve import Choice, DecisionCurve, DecisionStep, least_distant
from ._document import Imported
from ._readers import reader_of
from ._refusals import MAX_HORIZON_S, refuse

MAX_STEPS = 10_000
# A grid's level of no acceleration or curvature, rounded.
_ZERO = 1e-9
# How well the time of the closest approach is found, s.
_APPROACH_S = 0.01
_PLACE = re.compile(r" \(a\d+ s\d+\)$")


def find_decision_point(
    source: object,
    *,
    format: str | None = None,  # noqa: A002
    ego: str | int | None = None,
    time_s: float | None = None,
    horizon_s: float = 10.0,
    before_s: float = 3.0,
    after_s: float = 2.0,
    step_s: float = 0.1,
    accelerations: int = 15,
    steerings: int = 15,
    measure: str | None = None,
    risk: str | None = None,
    deadline_s: float | None = None,
    workers: int = 1,
    base: object = None,
    progress: Callable[[int, int], object] | None = None,
) -> DecisionCurve:
    """Step back from a contact; say when it could last be avoided, or its harm be halved, and how.

    An ego that goes on without a contact has none to avoid: the steps then end where it comes
    closest to another, as distances of `crashrank.rank` say to a centimetre. They end earlier where
    the recording of the ego does.

    At each step the first of a grid of manoeuvres is found, and beside it the one that goes on: the
    ego's own recording where the file has one, else its speed and curvature held. Contacts count
    until `after_s` after the contact, whenever a manoeuvre begins. Where going on, braking straight
    ahead or steering at held speed stays free and on the road, no other manoeuvre is evaluated.

    Parameters
    ----------
    source : path, or iterable of Imported or of (time, scenario)
        A file of one of the readers, a scenario file too; or scenarios of successive moments, each
        a mapping with the keys of a scenario file whose candidates are replaced.
    format : str, optional
        Name of the reader, as of ``crashrank import``. Default: by the file's ending.
    ego : str or int, optional
        As of the reader.
    time_s : float, optional
        From when on a contact is searched for, s on the file's clock. Default: as of the reader.
    horizon_s : float, default 10
        How long a contact is searched for, s.
    before_s, after_s : float
        How far before the contact the first step may lie, and how long after it contacts count, s;
        without one before and after the closest approach.
    step_s : float
        Time between steps, s.
    accelerations, steerings : int
        Levels of the grid; odd numbers contain holding the speed and going straight.
    measure, risk, deadline_s, workers
        As of `crashrank.rank`, for each step.
    base : path, optional
        Folder that mesh paths are relative to. Default: that of the file, else the current one.
    progress : callable, optional
        Called before each step with the numbers of steps done and of all.

    Returns
    -------
    DecisionCurve

    Raises
    ------
    BadInputError
        Where the ego goes on without a contact and nothing comes within 50 m of it.
    UsageError, LimitError, NotFoundError
        As of the reader and of `crashrank.rank`.
    """
    grid = {
        "accelerations": as_count(accelerations, "accelerations", 1, 101),
        "steerings": as_count(steerings, "steerings", 1, 101),
    }
    step = _seconds(step_s, "step_s")
    before, after = _seconds(before_s, "before_s"), _seconds(after_s, "after_s")
    file = ""
    if isinstance(source, (str, bytes, os.PathLike)):
        file = as_path(source, "source")
        reader = reader_of(file, format)
        base = os.path.dirname(os.path.abspath(file)) if base is None else base

        def read(at_s: float | None, seconds: float) -> Imported:
            return reader(file, time_s=at_s, ego=ego, horizon_s=seconds)

        moments = _recorded(read, file, time_s, horizon_s, before, after, step, base)
    else:
        moments = _given(source)
    ordered = sorted(moments, key=lambda moment: moment[0])
    options = {
        "measure": measure, "risk": risk, "deadline_s": deadline_s, "workers": workers,
        "base": base,
    }  # fmt: skip
    steps: list[DecisionStep] = []
    for at_s, scenario, going_on, _ in ordered:
        if progress is not None:
            progress(len(steps), len(ordered))
        alone = _rank_alone(scenario, going_on, measure, risk, base)
        steps.append(_step(at_s, _choice(alone.best), scenario, grid, options))
    contact_s, other = _contact(steps, file)
    between = [b.time_s - a.time_s for a, b in pairwise(steps)]
    return DecisionCurve(
        file=file,
        ego=ordered[0][3],
        other=other,
        contact_time_s=contact_s,
        measure=alone.measure,
        measure_unit=alone.measure_unit,
        step_s=round(max(between, default=step), 9),
        steps=tuple(each for each in steps if contact_s is None or each.time_s < contact_s),
    )


def _contact(steps: list[DecisionStep], file: str) -> tuple[float | None, str]:
    """Return when going on leads to which contact; without one None, and the nearest actor."""
    hits = [each for each in steps if each.going_on.time_of_impact_s is not None]
    if not hits:
        nearest = least_distant(each.going_on for each in steps)
        return None, _refuse_free(file) if nearest is None else nearest.nearest or ""
    last = hits[-1].going_on
    contact_s = hits[-1].time_s + (last.time_of_impact_s or 0.0)
    if contact_s <= steps[0].time_s:
        refuse(file, "ego", f"touches {last.other} at the first moment", "choose an earlier one")
    return contact_s, last.other or ""


def first_contact(found: Imported, base: object = None) -> tuple[float, str] | None:
    """Return when the ego hits which actor if it goes on, on the file's clock; None if it does not.

    The earliest of all futures counts.
    """
    choice = going_on_choice(found.scenario, found.going_on, base=base)
    if choice.time_of_impact_s is None:
        return None
    return found.report.time_s + choice.time_of_impact_s, choice.other or ""


_Moment = tuple[float, Mapping[str, Any], Mapping[str, Any], str]


def _recorded(
    read: Callable[[float | None, float], Imported], file: str, time_s: float | None,
    horizon_s: float, before_s: float, after_s: float, step_s: float, base: object,
) -> Iterator[_Moment]:  # fmt: skip
    """Return the moments of a file: whole steps after the first, before contact or approach."""
    first = read(time_s, horizon_s)
    start_s = first.report.time_s
    contact = first_contact(first, base)
    end_s = start_s + _closest_approach(first, file, base) if contact is None else contact[0]
    last_s = min(end_s, first.last_s)
    count = math.ceil((last_s - start_s) / step_s - 1e-6)
    earliest = max(math.ceil((last_s - before_s - start_s) / step_s - 1e-6), 0)
    if count - earliest > MAX_STEPS:
        raise usage("step_s", f"makes {count - earliest} steps", f"at most {MAX_STEPS} are ranked")
    for i in range(earliest, max(count, 1)):
        at_s = round(start_s + i * step_s, 9)
        seconds = min(max(end_s - at_s + after_s, 0.1), MAX_HORIZON_S)
        found = read(at_s, seconds)
        yield at_s, found.scenario, found.going_on, found.report.ego


def _closest_approach(found: Imported, file: str, base: object) -> float:
    """Return after how many seconds going on without a contact comes closest to an actor."""

    def least(seconds: float) -> float:
        shorter = {**found.scenario, "horizon_s": seconds}
        distance = going_on_choice(shorter, found.going_on, base=base).least_distance_m
        return math.inf if distance is None else distance

    low, high = 0.0, float(found.scenario["horizon_s"])
    distance = least(high)
    if distance == math.inf:
        _refuse_free(file)
    # A longer horizon has no greater least distance; its numbers are good to a centimetre.
    while high - low > _APPROACH_S:
        middle = (low + high) / 2
        low, high = (low, middle) if least(middle) <= distance + 0.01 else (middle, high)
    return high


def _given(source: object) -> Iterator[_Moment]:
    """Return the moments of scenarios that are given."""
    if not isinstance(source, Iterable) or isinstance(source, Mapping):
        raise wrong_type(
            "source", f"is a {type(source).__name__}", "give a path, or scenarios with their times"
        )
    count = 0
    for i, each in enumerate(source):
        count += 1
        if isinstance(each, Imported):
            yield each.report.time_s, each.scenario, each.going_on, each.report.ego
        elif isinstance(each, tuple) and len(each) == 2 and isinstance(each[1], Mapping):
            yield as_number(each[0], f"source[{i}]", "seconds"), each[1], {}, "ego"
        else:
            raise wrong_type(
                f"source[{i}]", f"is a {type(each).__name__}",
                "give an Imported, or a tuple of a time and a scenario",
            )  # fmt: skip
    if not count:
        raise usage("source", "is empty", "give one scenario or more")


def going_on_choice(
    scenario: Mapping[str, Any],
    motion: Mapping[str, Any],
    measure: str | None = None,
    risk: str | None = None,
    base: object = None,
) -> Choice:
    """Return what going on leads to; ranked alone, so that no deadline leaves it open."""
    return _choice(_rank_alone(scenario, motion, measure, risk, base).best)


def _rank_alone(
    scenario: Mapping[str, Any], motion: Mapping[str, Any], measure: str | None,
    risk: str | None, base: object,
) -> Ranking:  # fmt: skip
    """Return the ranking of one candidate: a motion, or the speed held where it is empty."""
    listed = [{"name": "go on", **(motion or {"acceleration_mps2": 0.0})}]
    alone = {"listed": listed, "grid": False, "add_straight_braking": False}
    return rank({**scenario, "candidates": alone}, measure=measure, risk=risk, base=base)


def _step(
    at_s: float, going_on: Choice, scenario: Mapping[str, Any], grid: Mapping[str, int],
    options: Mapping[str, Any],
) -> DecisionStep:  # fmt: skip
    straight, held = {**grid, "steerings": 1}, {**grid, "accelerations": 1}
    braking = _first(
        scenario, {"grid": straight}, options, lambda row: row.acceleration_mps2 < -_ZERO
    )
    steering = _first(
        scenario, {"grid": held, "add_straight_braking": False}, options,
        lambda row: abs(row.curvature_per_m) > _ZERO,
    )  # fmt: skip
    ways = [way for way in (going_on, braking, steering) if way is not None]
    best = next((way for way in ways if way.avoids and not way.leaves_road), None)
    if best is None:
        first = _first(scenario, {"grid": grid}, options)
        best = min(ways if first is None else [first, *ways], key=lambda way: way.most)
    return DecisionStep(
        time_s=at_s,
        going_on=going_on,
        best=best,
        braking=braking,
        steering=steering,
        complete=all(way.score is not None for way in (best, *ways)),
    )


def _first(
    scenario: Mapping[str, Any], candidates: Mapping[str, Any], options: Mapping[str, Any],
    wanted: Callable[[RankedCandidate], bool] = bool,
) -> Choice | None:  # fmt: skip
    """Return the first of the wanted candidates, None without one."""
    # The proof of the first place leaves the order behind it open.
    for first_place_only in (True, False):
        ranking = rank(
            {**scenario, "candidates": candidates}, first_place_only=first_place_only, **options
        )
        place = next((i for i, row in enumerate(ranking) if wanted(row)), None)
        if not place:
            break
    return None if place is None else _choice(ranking[place])


def _choice(row: RankedCandidate) -> Choice:
    impacts = [
        future.time_of_impact_s for future in row.futures if future.time_of_impact_s is not None
    ]
    if row.time_of_impact_s is not None:
        impacts.append(row.time_of_impact_s)
    others = [row.other] + [future.other for future in row.futures]
    return Choice(
        # Its place in a grid of one level would not be that in the whole grid.
        candidate=_PLACE.sub("", row.candidate),
        acceleration_mps2=row.acceleration_mps2,
        curvature_per_m=row.curvature_per_m,
        score=row.score,
        score_interval=(row.score_interval[0], row.score_interval[1]),
        collision_probability=row.collision_probability,
        time_of_impact_s=min(impacts, default=None),
        other=next((other for other in others if other is not None), None),
        leaves_road=row.leaves_road is not None,
        least_distance_m=row.least_distance_m,
        nearest=row.nearest,
    )


def _seconds(value: object, name: str) -> float:
    seconds = as_number(value, name, "seconds")
    if not 0.001 <= seconds <= MAX_HORIZON_S:
        raise usage(name, f"is {seconds:g}", f"give 0.001 to {MAX_HORIZON_S:g} seconds")
    return seconds


def _refuse_free(file: str) -> NoReturn:
    refuse(
        file, "ego", "goes on without a contact, and nothing comes within 50 m of it",
        "name another ego or time, or a longer horizon",
    )  # fmt: skip
