"""A cost function for commonroad-reactive-planner that ranks once no trajectory is free.

Needs ``crashrank[planner]``; ``import crashrank`` does not import it.

>>> from crashrank.reactive_planner import HarmCost
>>> planner = ReactivePlanner(config)
>>> cost = HarmCost(planner)  # changes the planner
>>> planner.plan()  # the least harmful trajectory where it would have been None
>>> cost.ranking.best.score
"""

from __future__ import annotations

import copy
import math
from typing import Any

import numpy as np

from ._ranking import Ranking, rank
from ._tables import missing
from .formats._commonroad_write import as_xml, read_text
from .formats._scene import Pose, moved, origin_of_box

try:
    from commonroad_rp.cost_function import DefaultCostFunction
except ImportError:
    raise missing("commonroad-reactive-planner", "planner") from None

__all__ = ["HarmCost"]


class HarmCost(DefaultCostFunction):  # type: ignore[misc]
    """The planner's default costs while a trajectory is free of contacts, else harm.

    A plan of the planner is None once `_get_optimal_trajectory` has found no free trajectory on any
    level of sampling. Then all trajectories of the last level that the vehicle can follow are
    ranked against the obstacles of the planner's scenario, their cost is their harm, and the least
    harmful is the plan. Contacts after the planner's horizon do not count.

    Parameters
    ----------
    planner : ReactivePlanner
        Takes this cost function; its `plan` is replaced.
    risk : str, optional
        Risk model, as of `crashrank.rank`.
    deadline_s : float, optional
        Time for a ranking, s; trajectories that it leaves open cost the upper bound of their harm.
    workers : int
        Threads.

    Attributes
    ----------
    ranking : Ranking or None
        Of the last plan; None where a trajectory was free. Candidates have the numbers of the
        trajectories as names.
    """

    def __init__(
        self,
        planner: Any,
        *,
        risk: str | None = None,
        deadline_s: float | None = None,
        workers: int = 1,
    ) -> None:
        usual = planner.cost_function
        super().__init__(usual.desired_speed, usual.desired_d, usual.desired_s)
        self.ranking: Ranking | None = None
        self._options: dict[str, Any] = {
            "measure": "harm", "risk": risk, "deadline_s": deadline_s, "workers": workers,
            "infeasible": "keep",
        }  # fmt: skip
        self._planner, self._plan = planner, planner.plan
        self._choose, self._tried = planner._get_optimal_trajectory, None
        self._harm: dict[int, float] = {}
        planner.plan, planner._get_optimal_trajectory = self.plan, self._remember
        planner.set_cost_function(self)

    def evaluate(self, trajectory: Any) -> float:
        """Return the harm of a trajectory that was ranked, persons; else the default costs."""
        if id(trajectory) in self._harm:
            return self._harm[id(trajectory)]
        return float(super().evaluate(trajectory))

    def plan(self, current_sampling_level: int | None = None) -> Any:
        """Return what the planner's own `plan` does, in place of None the least harmful plan."""
        self.ranking, self._tried = None, None
        self._harm.clear()
        answer = self._plan(current_sampling_level)
        if answer is not None or self._tried is None or not self._tried.trajectories:
            return answer
        trajectories = list(self._tried.trajectories)
        self.ranking = self._rank(trajectories)
        for i, trajectory in enumerate(trajectories):
            row = self.ranking[str(i)]
            self._harm[id(trajectory)] = row.score_interval[1] if row.score is None else row.score
            trajectory.cost = self
        least = trajectories[int(self.ranking.best.candidate)]
        self._planner._optimal_cost = least.cost
        return self._planner._create_output(least)

    def _remember(self, bundle: Any) -> Any:
        self._tried = bundle
        return self._choose(bundle)

    def _rank(self, trajectories: list[Any]) -> Ranking:
        """Rank trajectories, each until its last pose, as candidates of the ego at its state."""
        planner = self._planner
        scenario = copy.deepcopy(planner.config.scenario)
        number = scenario.generate_object_id()
        states = planner._create_output(trajectories[0])[0].state_list
        scenario.add_objects(planner.convert_state_list_to_commonroad_object(states, number))
        horizon_s = planner.dt * (len(trajectories[0].cartesian.x) - 1)
        found = read_text(as_xml(scenario), planner.x_0.time_step, number, horizon_s)
        ego = found.scenario["ego"]
        # The planner's positions are those of the rear axle, and counted from the file's origin.
        ahead, kind = planner.vehicle_params.wb_rear_axle, found.scenario["models"][ego["model"]]
        listed = []
        for i, trajectory in enumerate(trajectories):
            path = trajectory.cartesian
            poses = [
                origin_of_box(moved(Pose(*pose), ahead, 0.0), kind["kind"], kind["box"][0])
                for pose in zip(path.x, path.y, np.unwrap(path.theta), strict=True)
            ]
            dx, dy = ego["pose"]["x_m"] - poses[0].x_m, ego["pose"]["y_m"] - poses[0].y_m
            timed = [
                {"t_s": round(j * planner.dt, 6), "x_m": pose.x_m + dx, "y_m": pose.y_m + dy,
                 "yaw_deg": math.degrees(pose.yaw_rad)} for j, pose in enumerate(poses)
            ]  # fmt: skip
            listed.append({"name": str(i), "poses": timed})
        alone = {"listed": listed, "grid": False, "add_straight_braking": False}
        return rank({**found.scenario, "candidates": alone}, **self._options)
