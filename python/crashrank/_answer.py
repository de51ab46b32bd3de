"""Answers of a Ranker."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._ranking import Ranking


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
    """A wheel leaves the road before the first contact, in any future."""
    contact_without_force: bool
    """In a future, meshes touch and the crash model finds no force: the score may be too low."""


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
    basis : str
        What the first place rests on: "proved", "simulated", "coarse" or "braking".
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
        "basis",
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
        self.basis = answered.basis
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
            contact_without_force=bool(flags & 32),
        )

    @property
    def best(self) -> AnsweredCandidate:
        """The candidate to choose by what is known; ``basis`` says what that is."""
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


def _known(value: float) -> float | None:
    return None if math.isnan(value) else float(value)
