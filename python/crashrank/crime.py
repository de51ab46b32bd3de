"""A measure for CommonRoad CriMe: the least harm that the ego can still reach.

Needs ``crashrank[crime]``; ``import crashrank`` does not import it.

>>> from commonroad.common.file_reader import CommonRoadFileReader
>>> from commonroad_crime.data_structure.configuration import CriMeConfiguration
>>> from commonroad_crime.data_structure.crime_interface import CriMeInterface
>>> from crashrank.crime import LeastHarm
>>> scenario, _ = CommonRoadFileReader("scene.xml").open(lanelet_assignment=True)
>>> config = CriMeConfiguration()
>>> config.update(ego_id=34, sce=scenario)
>>> crime = CriMeInterface(config)
>>> crime.evaluate_scene([LeastHarm], time_step=48)
"""

from __future__ import annotations

import math
from enum import Enum
from typing import TYPE_CHECKING, Any

from ._errors import usage
from ._ranking import Ranking, rank
from ._tables import missing
from .formats._commonroad_write import as_xml, read_text
from .formats._decision import going_on_choice

try:
    from commonroad_crime.data_structure.base import CriMeBase
    from commonroad_crime.data_structure.type import TypeMonotone
except ImportError:
    raise missing("commonroad-crime", "crime") from None

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["LeastHarm", "TypeHarm"]


def _check_ego(source: Any, ego_id: int) -> None:
    """Refuse what the base class fails at: an ego without lanelets, or without a trajectory."""
    body: Any = None if source is None else source.obstacle_by_id(ego_id)
    if getattr(getattr(body, "prediction", None), "trajectory", None) is None:
        raise usage(
            "ego_id", f"is {ego_id}, no obstacle with a trajectory",
            "give CriMeConfiguration.update a scenario and the id of a vehicle in it",
        )  # fmt: skip
    if not (body.prediction.center_lanelet_assignment or {}).get(body.initial_state.time_step):
        raise usage(
            "scenario", f"assigns obstacle {ego_id} to no lanelet where it begins",
            "open it with lanelet_assignment=True, and choose an ego on a lanelet",
        )  # fmt: skip


class TypeHarm(str, Enum):
    """Names of the measures of this module, as CriMe's own are named."""

    LEAST_HARM = "least harm still reachable"


class LeastHarm(CriMeBase):  # type: ignore[misc]
    """The least harm, persons with MAIS3+, of all manoeuvres that the ego can still begin.

    At a time step the first of a grid of manoeuvres and of the ego's own recording, else its speed
    and curvature held, is found; the value is its score: 0 where the crash can still be avoided,
    and greater the fewer ways are left, as ``least`` of `crashrank.formats.find_decision_point` for
    as long a time. All obstacles of the scenario count together, those that the crash drives into
    each other too. nan where the ego has no state.

    Settings are members of the class; a subclass changes them for `CriMeInterface`.

    Attributes
    ----------
    horizon_s : float
        How long contacts count, s.
    accelerations, steerings : int
        Levels of the grid; odd numbers contain holding the speed and going straight.
    risk : str or None
        Risk model, as of `crashrank.rank`.
    workers : int
        Threads.
    ranking : Ranking or None
        Of the last step, with bounds behind its first place; None before the first.

    Raises
    ------
    crashrank.UsageError
        Where the ego is no obstacle with a trajectory that begins on a lanelet.
    """

    measure_name = TypeHarm.LEAST_HARM
    monotone = TypeMonotone.POS

    horizon_s: float = 4.0
    accelerations: int = 15
    steerings: int = 15
    risk: str | None = None
    workers: int = 1

    def __init__(self, config: Any) -> None:
        # The base class changes the states of its copy; the configuration's scenario is as read.
        source = config.scenario or getattr(config.scene, "_scenario", config.scene)
        _check_ego(source, config.vehicle.ego_id)
        super().__init__(config)
        self.ranking: Ranking | None = None
        self._text = as_xml(source)

    def compute_criticality(
        self, time_step: int, vehicle_id: int | None = None, verbose: bool = True
    ) -> float:
        """Return `compute`; the base class would ask for each other obstacle by itself."""
        return self.compute(time_step, vehicle_id, verbose)

    def compute(
        self,
        time_step: int,
        vehicle_id: int | None = None,  # noqa: ARG002
        verbose: bool = True,
    ) -> float:
        """Return the least harm that can be reached from a time step.

        Parameters
        ----------
        time_step : int
            When the manoeuvres begin.
        vehicle_id : int, optional
            Without effect: all obstacles count together.
        verbose : bool
            Whether CriMe prints that it computes.

        Raises
        ------
        crashrank.Error
            Where the scenario cannot be read or ranked.
        """
        if not self.validate_update_states_log(None, time_step, verbose):
            self.value = math.nan
            return math.nan
        ego = self.configuration.vehicle.ego_id
        found = read_text(self._text, time_step, ego, self.horizon_s)
        grid = {"accelerations": self.accelerations, "steerings": self.steerings}
        held = going_on_choice(found.scenario, found.going_on, "harm", self.risk)
        self.ranking = rank(
            {**found.scenario, "candidates": {"grid": grid}}, measure="harm", risk=self.risk,
            workers=self.workers, first_place_only=True,
        )  # fmt: skip
        best = self.ranking.best.score
        # No deadline leaves a score open.
        self.value = held.most if best is None else min(best, held.most)
        return self.value

    def visualize(self) -> Figure:
        """Return the plan of the least harmful manoeuvre of the last step, and the scores."""
        if self.ranking is None:
            self.compute(self.time_step, verbose=False)
        if self.ranking is None:
            raise usage("time_step", "has no state of the ego", "choose a step of its recording")
        return self.ranking.plot()
