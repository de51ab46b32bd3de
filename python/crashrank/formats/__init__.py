"""Readers of scenarios of other tools; each returns a scenario and a report.

`scenario_at` and `read_scenario` give a crashrank scenario at another moment.

`find_decision_point` steps back from a contact and says when it could last be avoided;
`to_markers` writes a ranking for RViz and Foxglove.

``python -m crashrank import FORMAT FILE -o SCENARIO.json`` is the same as a command.
`read_commonroad` and `read_openscenario` need ``crashrank[formats]``, `read_osi` needs
``crashrank[osi]``, `read_bag` needs ``crashrank[ros]``; tables need nothing.
"""

from __future__ import annotations

from ._advance import read_scenario, scenario_at
from ._bag import read_bag
from ._commonroad import read_commonroad
from ._curve import Choice, DecisionCurve, DecisionStep
from ._decision import find_decision_point
from ._document import Imported
from ._markers import to_markers
from ._openscenario import read_openscenario
from ._osi import read_osi
from ._scene import Report
from ._tables import read_esmini_csv, read_poses_csv

__all__ = [
    "Choice",
    "DecisionCurve",
    "DecisionStep",
    "Imported",
    "Report",
    "find_decision_point",
    "read_bag",
    "read_commonroad",
    "read_esmini_csv",
    "read_openscenario",
    "read_osi",
    "read_poses_csv",
    "read_scenario",
    "scenario_at",
    "to_markers",
]
