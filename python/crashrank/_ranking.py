"""Rankings: the crashes that a scenario leaves, least harmful first."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._checks import as_count, as_path
from ._errors import NotFoundError, checked_call, no_candidate, usage
from ._options import as_budget, as_progress, as_request
from ._record import Record, wrap
from ._scenario import Scenario, as_scenario

if TYPE_CHECKING:
    import pandas
    import pyarrow
    import rerun
    from matplotlib.figure import Figure


class BodyMotion(NamedTuple):
    """Simulated motion of a body that contact forces acted on, in the likeliest future.

    Of its centre of mass, world axes, from its state before the first force to the end of the
    simulation. The arrays have one length.
    """

    body: str
    """Name of the actor; ``ego`` for the ego."""
    t_s: NDArray[np.float64]
    """From the decision, rising."""
    x_m: NDArray[np.float64]
    y_m: NDArray[np.float64]
    yaw_deg: NDArray[np.float64]
    """Heading from x, left positive."""
    vx_mps: NDArray[np.float64]
    vy_mps: NDArray[np.float64]
    yaw_rate_dps: NDArray[np.float64]
    pressed: NDArray[np.bool_]
    """A contact force acted since the time before."""


class RankedCandidate(Record):
    """One candidate of a ranking. Attributes are named as in the JSON answer.

    Distances in m, times in s from the decision, speeds in m/s, angles in degrees. None where a
    value is not known or does not exist. ``data/schemas/rank.schema.json`` says what each is.
    """

    __slots__ = ()

    rank: int
    candidate: str
    tied_with: tuple[str, ...]
    feasible: bool | None
    grip_demand: float | None
    demand: Record | None
    leaves_road: Record | None
    least_distance_m: float | None
    nearest: str | None
    least_time_gap_s: float | None
    soonest: str | None
    time_to_collision_s: float | None
    imminent: str | None
    at_horizon: Record | None
    score: float | None
    score_interval: tuple[float, float]
    score_estimate: float | None
    numerical_interval: tuple[float, float] | None
    sampling_error: float | None
    sampling_error_to_next: float | None
    collision_probability: float | None
    people: tuple[Record, ...]
    futures: tuple[Record, ...]
    places: tuple[int, int]
    separable_from_next: bool | None
    overtaken_share: float | None
    collides: bool | None
    contacts: tuple[Record, ...]
    crowded: bool
    other: str | None
    time_of_impact_s: float | None
    closing_speed_mps: float | None
    delta_v_mps: Record | None
    pdof_deg: Record | None
    damaged_triangles: Record | None
    damaged_area_m2: Record | None
    damaged_parts: Record | None
    grazes: tuple[Record, ...]
    origin: str
    acceleration_mps2: float
    curvature_per_m: float

    @property
    def motion(self) -> tuple[BodyMotion, ...] | None:
        """Motions of the bodies that are hit, the ego first; None unless `rank` recorded them."""
        if "motion" not in self._members:
            return None
        return tuple(_body_motion(each) for each in self._members["motion"])


def _body_motion(members: dict[str, Any]) -> BodyMotion:
    body, *columns = (members[key] for key in BodyMotion._fields)
    return BodyMotion(body, *(np.array(column) for column in columns))


class _Unpickled:
    """What is left of a ranking elsewhere: the answer and its table, without the bodies."""

    def __init__(self, document: str, table: str, interrupted: bool) -> None:
        self._document = document
        self._table = table
        self.interrupted = interrupted

    def json(self) -> str:
        return self._document

    def text(self) -> str:
        return self._table

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        raise usage(
            "",
            "the ranking was pickled, and its bodies were not",
            "draw it or write its report where it was ranked",
        )


class Ranking(Sequence[RankedCandidate]):
    """The candidates of a scenario, least harmful first.

    A sequence of `RankedCandidate`. The members of the JSON answer are attributes: ``measure``,
    ``measure_unit``, ``complete``, ``proved``, ``basis``, ``in_race``, ``warnings``,
    ``stability``, ...

    A pickled ranking keeps its answer and its table; `report`, `plot`, `to_mcap` and `to_rerun`
    need the one that was ranked. Copies are the ranking itself: it never changes.
    """

    __slots__ = ("__weakref__", "_document", "_ranked")

    _ranked: _core.Ranked
    _document: dict[str, Any]

    scenario: str
    measure: str
    measure_unit: str
    harm: Record | None
    stability: Record
    futures: Record
    infeasible: str
    order: str
    first_by: Record
    dropped: tuple[str, ...]
    complete: bool
    proved: bool
    basis: str
    in_race: tuple[str, ...]
    elapsed_s: float
    warnings: tuple[str, ...]
    effort: Record
    ego: Record
    actors: tuple[Record, ...]
    work: Record

    def __init__(self, ranked: Any) -> None:
        self._ranked = ranked
        self._document = json.loads(ranked.json())

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        """Pickle the answer and its table."""
        kept = _Unpickled(self.to_json(), str(self), self.interrupted)
        return Ranking, (kept,)

    def __copy__(self) -> Ranking:
        return self

    def __deepcopy__(self, memo: object) -> Ranking:
        return self

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and name in self._document:
            return wrap(self._document[name])
        raise AttributeError(f"Ranking has no attribute {name!r}", name=name, obj=self)

    def __dir__(self) -> list[str]:
        """List the members of the JSON answer, too."""
        return sorted({*super().__dir__(), *self._document})

    @overload
    def __getitem__(self, index: int | str) -> RankedCandidate: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[RankedCandidate, ...]: ...
    def __getitem__(
        self, index: int | str | slice
    ) -> RankedCandidate | tuple[RankedCandidate, ...]:
        """Return the candidate at that place, from 0, or of that name.

        Raises `UsageError` where no candidate has the name.
        """
        rows = self._document["ranking"]
        if isinstance(index, slice):
            return tuple(RankedCandidate(row) for row in rows[index])
        if not isinstance(index, str):
            return RankedCandidate(rows[index])
        for row in rows:
            if row["candidate"] == index:
                return RankedCandidate(row)
        raise no_candidate(index)

    def __len__(self) -> int:
        """Return the number of candidates."""
        return len(self._document["ranking"])

    def __iter__(self) -> Iterator[RankedCandidate]:
        """Iterate from the least harmful on."""
        return (RankedCandidate(row) for row in self._document["ranking"])

    @property
    def best(self) -> RankedCandidate:
        """The least harmful candidate."""
        return self[0]

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended the ranking: `complete` is then false."""
        return self._ranked.interrupted

    def to_dict(self) -> dict[str, Any]:
        """Return the answer as ``crashrank rank --json`` prints it: plain dicts and lists."""
        return Record(self._document).to_dict()

    def to_json(self) -> str:
        """Return the document that ``crashrank rank --json`` prints."""
        return self._ranked.json()

    def to_arrow(self) -> pyarrow.Table:
        """Return a table with one row for each candidate; needs ``crashrank[arrow]``.

        Units stand in the names of the columns. Scenario, measure and its unit are in the
        schema's metadata.
        """
        from ._tables import to_arrow

        return to_arrow(self._document)

    def to_pandas(self) -> pandas.DataFrame:
        """Return the table of `to_arrow` as a data frame; needs pandas."""
        from ._tables import to_pandas

        return to_pandas(self._document)

    @checked_call
    def report(self, path: object, *, drawn: int = 24) -> None:
        """Write the report: one HTML page that works offline.

        Ranks again to record the motion that the page plays, unless `rank` was asked for it or
        had a budget.

        Parameters
        ----------
        path : path
            The file to write. Replaced where it exists.
        drawn : int
            Most candidates that the page plays and describes, best first; 0 for all.
        """
        file = as_path(path, "path")
        page = self._ranked.html(as_count(drawn, "drawn", 0, 2**31))
        try:
            with open(file, "w", encoding="utf-8", newline="\n") as out:
                out.write(page)
        except OSError as error:
            raise NotFoundError(
                "not_found", file, "", f"cannot be written: {error.strerror}", "choose another file"
            ) from error

    @checked_call
    def to_mcap(self, path: object, *, drawn: int = 24) -> None:
        """Write the report's scene as Foxglove's messages; needs ``crashrank[mcap]``.

        Every body of every candidate moves in a frame of its own, with damage in red from its
        first contact on. Time is counted from the decision. A layout is written beside the file:
        ``out.layout.json`` for ``out.mcap``.

        Parameters
        ----------
        path : path
            The file to write. Replaced where it exists.
        drawn : int
            Most candidates that are written, best first, and the worst; 0 for all.
        """
        from ._mcap import write_mcap

        file = as_path(path, "path")
        write_mcap(self._ranked.html(as_count(drawn, "drawn", 0, 2**31)), file)

    @checked_call
    def to_rerun(self, *, drawn: int = 24) -> rerun.RecordingStream:
        """Return the report's scene as a recording; needs ``crashrank[rerun]``.

        ``ranking.to_rerun().save("out.rrd")`` writes it, ``.spawn()`` shows it. One view for each
        candidate, on the timeline ``decision``.

        Parameters
        ----------
        drawn : int
            Most candidates that are recorded, best first, and the worst; 0 for all.
        """
        from ._rerun import to_rerun

        return to_rerun(self._ranked.html(as_count(drawn, "drawn", 0, 2**31)))

    @checked_call
    def plot(self, *, candidate: str | int | None = None, top: int = 12) -> Figure:
        """Draw the plan of one candidate, and scores with intervals; needs matplotlib.

        Parameters
        ----------
        candidate : str or int, optional
            Whose plan is drawn, by name or by place from 0, from the last with -1. Default: the
            best.
        top : int
            Most candidates whose scores are drawn.

        Returns
        -------
        matplotlib.figure.Figure
            Two axes: the plan, world coordinates in m, at the candidate's first contact or at the
            horizon; and the scores in the measure's unit.
        """
        from ._plot import plot

        return plot(self, self._ranked, candidate, as_count(top, "top", 1, 1000))

    def _repr_html_(self) -> str:
        """Return a small report in a frame that may run its own script and nothing else.

        `report` writes the whole one.
        """
        # Its data is full of double quotes: in single ones they stay as they are.
        page = self._ranked.html(3, True).replace("&", "&amp;").replace("'", "&#39;")
        return (
            '<iframe sandbox="allow-scripts" referrerpolicy="no-referrer" '
            'style="width:100%;height:640px;border:0" title="crashrank report" '
            f"srcdoc='{page}'></iframe>"
        )

    def __str__(self) -> str:
        """Return the table that ``crashrank rank`` prints, 100 columns wide."""
        return self._ranked.text()

    def __repr__(self) -> str:
        """Return the number of candidates and the best."""
        state = "" if self.complete else ", partial"
        return f"Ranking({len(self)} candidates, best {self.best.candidate!r}{state})"


@checked_call
def rank(
    scenario: Scenario | object,
    *,
    measure: str | None = None,
    workers: int = 1,
    risk: str | None = None,
    deadline_s: float | None = None,
    work_budget: int | None = None,
    first_place_only: bool = False,
    infeasible: str = "demote",
    order: str = "score",
    profile: object = None,
    futures: int = 64,
    motion: bool = False,
    smooth: bool = False,
    progress: Callable[[int, int], object] | None = None,
    base: object = None,
    allow: Iterable[object] = (),
) -> Ranking:
    """Rank the crashes that a scenario leaves, least harmful first.

    The answer has the bits of ``crashrank rank --json`` for every number of workers. The
    interpreter's lock is released.

    Ctrl-C ends the ranking: the partial answer is returned, `Ranking.interrupted` is true, and
    candidates that were not evaluated have bounds in place of a score. Before anything is ranked
    Ctrl-C raises KeyboardInterrupt.

    Parameters
    ----------
    scenario : Scenario, path, JSON text or mapping
        What to rank.
    measure : {'harm', 'delta-v', 'energy', 'intrusion', 'polygons', 'area', 'closing-energy'}
        What is compared. Default: the scenario's.
    workers : int
        Threads that share the work, 1 to 64.
    risk : str, optional
        How scores of several futures become one: ``expected``, ``worst``, ``cvar:X``,
        ``quantile:X``. Default: the scenario's.
    deadline_s : float, optional
        Time for the search, s, after its preparation. At its end bounds stand in place of
        scores that are not known.
    work_budget : int, optional
        Tests of boxes, triangles and outline pieces after which the search ends: the same answer
        on every machine.
    first_place_only : bool
        End as soon as the first place is proved.
    infeasible : {'demote', 'drop', 'keep'}
        What becomes of manoeuvres beyond grip, engine, brakes or steering.
    order : {'score', 'upper'}
        What orders the candidates: the score, or the upper end of its interval. ``upper`` without
        a budget only.
    profile : path, optional
        File of weights and ranges, over those of the scenario.
    futures : int
        Futures drawn where predictions have too many combinations.
    motion : bool
        Record `RankedCandidate.motion` of every candidate. Without a budget only.
    smooth : bool
        Score by the mean over small errors of every state that has none (5 cm, 0.2 degrees,
        0.1 m/s), the same for all candidates: no centimetre decides. Takes 16 times as long.
        ``ranking.first_by.without_errors`` is the first without them.
    progress : callable, optional
        Called about 40 times a second, in the calling thread, with the numbers of candidates
        evaluated and of all. Returning False ends the ranking with the partial answer. Without a
        budget only.
    base, allow
        As of `Scenario`, where `scenario` is none yet.

    Returns
    -------
    Ranking
    """
    given = as_scenario(scenario, base, allow)
    request = as_request(
        measure, workers, risk, infeasible, order, profile, futures, motion, smooth
    )
    budget = as_budget(deadline_s, work_budget, first_place_only)
    if deadline_s is not None and deadline_s < 0:
        raise usage("deadline_s", f"is {deadline_s:g} s", "give 0 s or more, or leave it out")
    if motion and (deadline_s is not None or work_budget is not None or first_place_only):
        raise usage(
            "motion",
            "is not recorded by an answer within a budget",
            "leave out deadline_s, work_budget and first_place_only, or motion",
        )
    return Ranking(_core.rank(given._situation, request, budget, as_progress(progress)))
