"""Ranker: rankings by a deadline, again and again."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._answer import Answer
from ._checks import as_count, as_floats, as_number, as_text
from ._errors import UsageError, checked_call, usage
from ._motions import (
    MAX_CANDIDATES,
    as_candidates,
    as_mapping,
    as_names,
    as_path_array,
    as_times,
    ego_state,
    set_motion,
)
from ._options import as_budget, as_progress, as_request
from ._scenario import Scenario, as_scenario

if TYPE_CHECKING:
    from typing_extensions import Self


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
        request = as_request(measure, workers, risk, infeasible, "score", profile, futures)
        most = as_count(max_candidates, "max_candidates", 1, MAX_CANDIDATES)
        self._session = _core.make_session(given._situation, request, most)
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
        times = None if times_s is None else as_times(times_s)
        states = [
            state
            for name, motion in as_mapping(actors, "actors").items()
            for state in self._actor_states(name, motion, times)
        ]
        self._session.update(ego_state(ego), states, self._probabilities(probabilities))

    @checked_call
    def enter(
        self,
        actor: str,
        model: str,
        motion: Mapping[str, Any] | ArrayLike | object,
        *,
        times_s: ArrayLike | None = None,
        occupants: float | None = None,
    ) -> None:
        """Let a body enter the scene in place of an actor that keeps a place; on error, nothing.

        An actor keeps a place if the Ranker was made with its ``existence_probability`` 0, one
        motion, a model that moves and no joint futures. Until a body enters and after `leave`
        no future has the actor, and it costs next to nothing.

        Parameters
        ----------
        actor : str
            Name of the actor, which answers give to the body.
        model : str
            Name of any model of the scenario that moves.
        motion : mapping, Actor or array_like, shape (T, 3)
            As in `update`.
        times_s : array_like, shape (T,)
            Times of the array, s from now, rising from 0.
        occupants : float, optional
            Persons in or on it, 0 to 1000. Default: those of its kind.
        """
        times = None if times_s is None else as_times(times_s)
        index = self._index(actor)
        state = self._state(index, 0, motion, times)
        persons = None if occupants is None else as_number(occupants, "occupants", "persons")
        self._session.enter(index, as_text(model, "model"), state, persons)

    @checked_call
    def leave(self, actor: str) -> None:
        """Take the body out of such a place, which is free again; on error, nothing."""
        self._session.leave(self._index(actor))

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
        paths, times = None, None
        labels: list[str] = []
        if candidates is not None:
            paths, times = as_candidates(candidates, times_s)
            labels = as_names(names, len(paths))
        answered = _core.rank_session(
            self._session,
            paths,
            times,
            labels,
            as_budget(deadline_s, work_budget, first_place_only),
            as_progress(progress),
        )
        return Answer(self._session, answered, self._actors)

    def _unknown(self, place: str) -> UsageError:
        return usage(place, "is not an actor of the scenario", "see Ranker.actors for the names")

    def _actor_states(
        self, name: object, motion: Any, times: NDArray[np.float64] | None
    ) -> list[_core.ActorState]:
        index = self._index(name)
        text = self._actors[index]
        count = self._plans[index][1]
        motions = [motion] if count == 1 else motion
        if count > 1 and (not isinstance(motion, (list, tuple)) or len(motion) != count):
            raise usage(
                f"actors[{text!r}]",
                f"has {count} predictions",
                f"give a list of {count} motions, one for each",
            )
        return [
            self._state(index, prediction, one, times) for prediction, one in enumerate(motions)
        ]

    def _index(self, name: object) -> int:
        text = as_text(name, "actors")
        if text not in self._actors:
            raise self._unknown(f"actors[{text!r}]")
        return self._actors.index(text)

    def _state(
        self, index: int, prediction: int, motion: Any, times: NDArray[np.float64] | None
    ) -> _core.ActorState:
        state = _core.ActorState(index, prediction)
        place = f"actors[{self._actors[index]!r}]"
        if isinstance(motion, Mapping) or dataclasses.is_dataclass(motion):
            set_motion(state, as_mapping(motion, place), place)
        else:
            if times is None:
                raise usage("times_s", "are missing", "give the times of the poses")
            path = as_path_array(motion, place, times)
            state.set_poses(path, times, self._session.actor_height(index))
        return state

    def _probabilities(self, given: Mapping[str, ArrayLike] | None) -> list[float]:
        if given is None:
            return []
        named = as_mapping(given, "probabilities")
        for name in named:
            if name not in self._actors:
                raise self._unknown(f"probabilities[{name!r}]")
        values: list[float] = []
        for name, count in self._plans:
            one = [1.0] if name not in named and count == 1 else named.get(name)
            if one is None:
                raise usage(f"probabilities[{name!r}]", "are missing", "give those of all actors")
            array = as_floats(one, f"probabilities[{name!r}]")
            if array.shape != (count,):
                raise usage(
                    f"probabilities[{name!r}]",
                    f"has the shape {array.shape}",
                    f"give {count} numbers, one for each prediction",
                )
            values.extend(array.tolist())
        return values
