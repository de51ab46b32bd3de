"""Ranker: rankings by a deadline, again and again."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._checks import (
    as_array,
    as_count,
    as_flag,
    as_floats,
    as_number,
    as_path,
    as_real,
    as_text,
    check_size,
    contiguous,
)
from ._errors import bad_input, checked_call, usage, wrong_type
from ._ranking import NO_LIMIT, Ranking
from ._scenario import Scenario, as_scenario

if TYPE_CHECKING:
    from typing_extensions import Self

MAX_CANDIDATES = 100_000
MAX_POSE_TIMES = 10_000
POSE_KEYS = ("x_m", "y_m", "z_m", "yaw_deg", "pitch_deg", "roll_deg")
RADIANS = math.pi / 180.0


class AnsweredCandidate(NamedTuple):
    """One candidate of an `Answer`. Members are named as in the JSON answer."""

    candidate: str
    """Its name."""
    position: int
    """Index into the candidates asked about."""
    score: float | None
    """In the measure's unit; None where only the interval is known."""
    score_interval: tuple[float, float]
    """Bounds on the final score, whatever was left undone."""
    in_race: bool
    """It can still be first."""
    collides: bool
    """A contact is known."""
    other: str | None
    """Actor that is hit first."""
    time_of_impact_s: float | None
    """From the decision, s."""
    closing_speed_mps: float | None
    """Of the points that meet, m/s."""
    collision_probability: float | None
    """Over all futures."""
    feasible: bool
    """The vehicle can follow it, as far as that is known."""
    leaves_road: bool
    """A wheel leaves the road before the first contact."""


class Answer(Sequence[AnsweredCandidate]):
    """What a Ranker knows at its deadline, most promising candidate first.

    Attributes
    ----------
    order : ndarray of int64
        By place, the index into the candidates asked about.
    score, lowest, highest : ndarray of float64
        By place, the score (NaN where it is not known) and its bounds.
    complete : bool
        Every score is known.
    proved : bool
        No other candidate can still be first.
    in_race : int
        Number of candidates that can.
    elapsed_s : float
        Wall time of the call, s.
    hash : int
        Fingerprint of order, scores and bounds.
    interrupted : bool
        Ctrl-C ended the call.
    """

    __slots__ = (
        "_actors",
        "_answered",
        "_chances",
        "_flags",
        "_other",
        "_session",
        "_speeds",
        "_times",
        "complete",
        "elapsed_s",
        "hash",
        "highest",
        "in_race",
        "interrupted",
        "lowest",
        "order",
        "proved",
        "score",
    )

    def __init__(
        self, session: _core.Session, answered: _core.Answered, actors: Sequence[str]
    ) -> None:
        self._session = session
        self._answered = answered
        self._actors = actors
        self.order: NDArray[np.int64] = answered.candidate()
        self.score: NDArray[np.float64] = answered.score()
        self.lowest: NDArray[np.float64] = answered.lowest()
        self.highest: NDArray[np.float64] = answered.highest()
        self.complete = answered.complete
        self.proved = answered.proved
        self.in_race = answered.in_race
        self.elapsed_s = answered.elapsed_s
        self.hash = answered.hash
        self.interrupted = answered.interrupted
        self._flags = answered.flags()
        self._other = answered.other()
        self._times = answered.time_of_impact_s()
        self._speeds = answered.closing_speed_mps()
        self._chances = answered.collision_probability()

    def __len__(self) -> int:
        """Return the number of candidates."""
        return len(self.order)

    @overload
    def __getitem__(self, index: int) -> AnsweredCandidate: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[AnsweredCandidate, ...]: ...
    def __getitem__(self, index: int | slice) -> AnsweredCandidate | tuple[AnsweredCandidate, ...]:
        """Return the candidate at that place, from 0."""
        if isinstance(index, slice):
            return tuple(self[i] for i in range(*index.indices(len(self))))
        place = range(len(self))[index]
        flags = int(self._flags[place])
        other = int(self._other[place])
        return AnsweredCandidate(
            candidate=self._answered.name(place),
            position=int(self.order[place]),
            score=_known(self.score[place]),
            score_interval=(float(self.lowest[place]), float(self.highest[place])),
            in_race=bool(flags & 2),
            collides=bool(flags & 4),
            other=self._actors[other] if other >= 0 else None,
            time_of_impact_s=_known(self._times[place]),
            closing_speed_mps=_known(self._speeds[place]),
            collision_probability=_known(self._chances[place]),
            feasible=bool(flags & 8),
            leaves_road=bool(flags & 16),
        )

    @property
    def best(self) -> AnsweredCandidate:
        """The most promising candidate: the one whose worst outcome is the best."""
        return self[0]

    def explain(self) -> Ranking:
        """Return the full ranking, off the clock: contacts, damage, samples where complete.

        Before the Ranker's next `Ranker.update` only.
        """
        return Ranking(_core.explain_session(self._session, self._answered))

    def __repr__(self) -> str:
        """Return the number of candidates and the best."""
        state = "complete" if self.complete else "proved" if self.proved else "partial"
        return f"Answer({len(self)} candidates, {state})"


class Ranker:
    """Ranks candidates against a deadline, in memory set aside beforehand.

    Prepared once; then `update` and `rank` in each cycle of a planner. One thread at a time: a
    call from another thread meanwhile raises `UsageError`.

    Parameters
    ----------
    scenario : Scenario, path, JSON text or mapping
        Bodies, horizon, road and harm, which stay; ego, actors and candidates, which change.
    measure, risk, infeasible, profile, futures
        As of `rank`.
    workers : int
        Threads that share the work, the calling one among them; 1 to 64.
    max_candidates : int
        Most candidates of one call.
    base, allow
        As of `Scenario`, where `scenario` is none yet.

    Examples
    --------
    >>> import crashrank
    >>> with crashrank.Ranker("data/scenarios/oncoming_truck.json") as ranker:
    ...     answer = ranker.rank(deadline_s=0.05)
    >>> len(answer)
    5
    """

    @checked_call
    def __init__(
        self,
        scenario: Scenario | object,
        *,
        measure: str | None = None,
        workers: int = 1,
        risk: str | None = None,
        infeasible: str = "demote",
        profile: object = None,
        futures: int = 64,
        max_candidates: int = 1024,
        base: object = None,
        allow: Iterable[object] = (),
    ) -> None:
        given = as_scenario(scenario, base, allow)
        self._session = _core.make_session(
            given._situation,
            "" if measure is None else as_text(measure, "measure"),
            "" if risk is None else as_text(risk, "risk"),
            as_text(infeasible, "infeasible"),
            "" if profile is None else as_path(profile, "profile"),
            as_count(workers, "workers", 1, _core.max_workers),
            as_count(futures, "futures", 1, _core.max_sampled_futures),
            as_count(max_candidates, "max_candidates", 1, MAX_CANDIDATES),
        )
        self._plans = self._session.plans()
        self._actors = tuple(name for name, _ in self._plans)

    def __enter__(self) -> Self:
        """Return the Ranker itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        value: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it."""
        self._session.close()

    def close(self) -> None:
        """End its threads and free its memory; every later call raises `UsageError`."""
        self._session.close()

    @property
    def actors(self) -> tuple[str, ...]:
        """Names of the actors."""
        return self._actors

    @property
    def ego_pose(self) -> tuple[float, float, float]:
        """Where the ego is now: x (m), y (m), heading (rad), world."""
        x_m, y_m, _, heading_rad = self._session.ego_pose()
        return x_m, y_m, heading_rad

    @property
    def candidates(self) -> tuple[str, ...]:
        """Names of the scenario's candidates, made from where the ego is now."""
        return tuple(self._session.candidate_names())

    @checked_call
    def update(
        self,
        *,
        ego: Mapping[str, Any] | object | None = None,
        actors: Mapping[str, Any] | None = None,
        times_s: ArrayLike | None = None,
        probabilities: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        """Change where the ego and the actors are and how they move; all or, on error, nothing.

        Parameters
        ----------
        ego : mapping or Ego, optional
            ``pose`` (mapping or `Pose`), ``speed_mps``, ``yaw_rate_dps``; what is absent stays.
        actors : mapping, optional
            By name, the motion from now on: a mapping or `Actor` with ``pose``, ``speed_mps``,
            ``acceleration_mps2``, ``yaw_rate_dps``, absent ones being 0; or a (T, 3) array of
            x (m), y (m), heading (rad) at `times_s`. Actors with predictions take a list of as
            many. What is not named stays.
        times_s : array_like, shape (T,)
            Times of the arrays in `actors`, s from now, rising from 0.
        probabilities : mapping, optional
            By name, the probabilities of an actor's predictions.
        """
        if self._session.is_joint() and (actors or probabilities):
            raise usage("actors", "joint futures cannot be updated", "make a new Ranker")
        times = None if times_s is None else _as_times(times_s)
        states = [
            state
            for name, motion in _as_mapping(actors, "actors").items()
            for state in self._actor_states(name, motion, times)
        ]
        self._session.update(_ego_state(ego), states, self._probabilities(probabilities))

    @checked_call
    def rank(
        self,
        candidates: ArrayLike | None = None,
        *,
        deadline_s: float | None = None,
        times_s: ArrayLike | None = None,
        names: Sequence[str] | None = None,
        work_budget: int | None = None,
        first_place_only: bool = False,
        progress: Callable[[int, int], object] | None = None,
    ) -> Answer:
        """Rank candidates and return what is known at the deadline.

        Parameters
        ----------
        candidates : array_like, shape (N, T, 3), optional
            Poses of the ego's origin by candidate and time: x (m), y (m), heading (rad, left
            positive), world. Each begins within 1 m and 30 degrees of the ego's pose. Copied.
            Default: the scenario's candidates, made from where the ego is now.
        deadline_s : float, optional
            Time of the call, s, from its begin. Default: until every score is known.
        times_s : array_like, shape (T,)
            Times of the poses, s from now, rising from 0.
        names : sequence of str, optional
            Names of the candidates. Default: their indices.
        work_budget : int, optional
            As of `rank`.
        first_place_only : bool
            End as soon as the first place is proved.
        progress : callable, optional
            Called about 40 times a second with the numbers of candidates whose score is known and
            of all. Returning False ends the call.

        Returns
        -------
        Answer
            Ctrl-C ends calls without a deadline or with one above 0.1 s: the partial answer is
            returned, and `Answer.interrupted` is true.
        """
        if progress is not None and not callable(progress):
            raise wrong_type("progress", f"is a {type(progress).__name__}, not callable")
        paths, times = None, None
        labels: list[str] = []
        if candidates is not None:
            paths, times = _as_candidates(candidates, times_s)
            labels = _as_names(names, len(paths))
        answered = _core.rank_session(
            self._session,
            paths,
            times,
            labels,
            math.inf if deadline_s is None else as_real(deadline_s, "deadline_s"),
            NO_LIMIT if work_budget is None else as_count(work_budget, "work_budget", 0, NO_LIMIT),
            as_flag(first_place_only, "first_place_only"),
            progress,
        )
        return Answer(self._session, answered, self._actors)

    def _actor_states(
        self, name: object, motion: Any, times: NDArray[np.float64] | None
    ) -> list[_core.ActorState]:
        text = as_text(name, "actors")
        if text not in self._actors:
            raise usage(f"actors[{text!r}]", "is not an actor of the scenario")
        index = self._actors.index(text)
        count = self._plans[index][1]
        motions = [motion] if count == 1 else motion
        if count > 1 and (not isinstance(motion, (list, tuple)) or len(motion) != count):
            raise usage(f"actors[{text!r}]", f"needs a list of {count} motions, one a prediction")
        states = []
        for prediction, one in enumerate(motions):
            state = _core.ActorState(index, prediction)
            place = f"actors[{text!r}]"
            if isinstance(one, Mapping) or dataclasses.is_dataclass(one):
                _set_motion(state, _as_mapping(one, place), place)
            else:
                if times is None:
                    raise usage("times_s", "are missing", "give the times of the poses")
                path = _as_path_array(one, place, times)
                state.set_poses(path, times, self._session.actor_height(index))
            states.append(state)
        return states

    def _probabilities(self, given: Mapping[str, ArrayLike] | None) -> list[float]:
        if given is None:
            return []
        named = _as_mapping(given, "probabilities")
        for name in named:
            if name not in self._actors:
                raise usage(f"probabilities[{name!r}]", "is not an actor of the scenario")
        values: list[float] = []
        for name, count in self._plans:
            one = [1.0] if name not in named and count == 1 else named.get(name)
            if one is None:
                raise usage(f"probabilities[{name!r}]", "are missing", "give those of all actors")
            array = as_floats(one, f"probabilities[{name!r}]")
            if array.shape != (count,):
                raise usage(f"probabilities[{name!r}]", f"has not {count} numbers")
            values.extend(array.tolist())
        return values


def _known(value: float) -> float | None:
    return None if math.isnan(value) else float(value)


def _as_mapping(value: Any, name: str) -> dict[str, Any]:
    """Return a mapping's or dataclass's members that are not None."""
    if value is None:
        return {}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        value = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    if not isinstance(value, Mapping):
        raise wrong_type(name, f"is a {type(value).__name__}, not a mapping")
    return {key: member for key, member in value.items() if member is not None}


def _check_keys(members: dict[str, Any], known: Iterable[str], place: str) -> None:
    for key in members:
        if key not in known:
            raise usage(place, f"has the unknown member {key!r}", f"know: {', '.join(known)}")


def _pose_numbers(value: Any, place: str) -> list[float]:
    """Return x, y, z in m and yaw, pitch, roll in rad."""
    members = _as_mapping(value, place)
    _check_keys(members, POSE_KEYS, place)
    numbers = [as_number(members.get(key, 0.0), f"{place}.{key}") for key in POSE_KEYS]
    return numbers[:3] + [RADIANS * angle for angle in numbers[3:]]


def _ego_state(value: object) -> _core.EgoState:
    members = _as_mapping(value, "ego")
    if not dataclasses.is_dataclass(value):
        _check_keys(members, ("pose", "speed_mps", "yaw_rate_dps"), "ego")
    state = _core.EgoState()
    if "pose" in members:
        state.set_pose(*_pose_numbers(members["pose"], "ego.pose"))
    if "speed_mps" in members:
        state.speed_mps = as_number(members["speed_mps"], "ego.speed_mps", "m/s")
    if "yaw_rate_dps" in members:
        rate = as_number(members["yaw_rate_dps"], "ego.yaw_rate_dps", "degrees/s")
        state.yaw_rate_radps = RADIANS * rate
    return state


def _set_motion(state: _core.ActorState, members: dict[str, Any], place: str) -> None:
    rates = ("speed_mps", "acceleration_mps2", "yaw_rate_dps")
    _check_keys(members, ("name", "model", "pose", *rates), place)
    numbers = [as_number(members.get(key, 0.0), f"{place}.{key}") for key in rates]
    x_m, y_m, z_m, yaw, pitch, roll = _pose_numbers(members.get("pose"), f"{place}.pose")
    rate = RADIANS * numbers[2]
    state.set_motion(x_m, y_m, z_m, yaw, pitch, roll, numbers[0], numbers[1], rate)


def _as_times(value: object) -> NDArray[np.float64]:
    array = as_array(value, "times_s", "fiu", "numbers")
    if array.ndim != 1 or array.size == 0:
        raise bad_input("times_s", f"has the shape {array.shape}", "give the shape (T,)")
    check_size(array.size, MAX_POSE_TIMES, "times_s", "times")
    times = contiguous(array, np.float64, "times_s")
    if not bool(np.isfinite(times).all()) or times[0] != 0 or bool((np.diff(times) <= 0).any()):
        raise bad_input("times_s", "do not rise from 0", "give seconds from now")
    return times


def _as_path_array(value: object, name: str, times: NDArray[np.float64]) -> NDArray[np.float64]:
    array = as_array(value, name, "fiu", "numbers")
    if array.shape != (times.size, 3):
        raise bad_input(name, f"has the shape {array.shape}", f"give the shape ({times.size}, 3)")
    return contiguous(array, np.float64, name)


def _as_candidates(
    value: object, times_s: object
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    array = as_array(value, "candidates", "fiu", "numbers")
    if array.ndim != 3 or array.shape[2] != 3:
        raise bad_input("candidates", f"has the shape {array.shape}", "give the shape (N, T, 3)")
    check_size(array.shape[0], MAX_CANDIDATES, "candidates", "candidates")
    if times_s is None:
        raise usage("times_s", "are missing", "give the times of the poses, shape (T,)")
    times = _as_times(times_s)
    if times.size != array.shape[1]:
        raise bad_input(
            "times_s", f"are {times.size}, the candidates have {array.shape[1]} poses each"
        )
    check_size(array.size, 3 * 10_000_000, "candidates", "numbers")
    return contiguous(array, np.float64, "candidates"), times


def _as_names(value: object, count: int) -> list[str]:
    if value is None:
        return [str(i) for i in range(count)]
    if isinstance(value, str) or not isinstance(value, Iterable):
        raise wrong_type("names", f"is a {type(value).__name__}, not a list of strings")
    names = [as_text(name, f"names[{i}]") for i, name in enumerate(value)]
    if len(names) != count or len(set(names)) != count:
        raise usage("names", f"are not {count} different names")
    return names
