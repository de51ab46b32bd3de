#!/usr/bin/env bash
# CriMe's delta-v has the sign of the other's speed the wrong way round.
#
# The change of speed in a plastic impact of two equal cars is half of the speed at which they approach each other:
# 15 m/s where both drive 15 m/s head-on, 0 where one follows the other as fast. DeltaV returns 0 for the head-on crash
# and 15 m/s for the pair that never touches, since it adds v_b cos(heading_ego - heading_b) instead of subtracting it.
. "$(dirname "$0")/crime.sh"
crime <<'PYTHON'
import math

from commonroad_crime.measure.velocity.delta_v import DeltaV
from crime_scene import conclude, configured

found = []
for title, heading, right in (("head-on", math.pi, 15.0), ("one behind the other", 0.0, 0.0)):
    config = configured((0.0, 0.0, 15.0), (40.0, heading, 15.0))
    found.append(float(DeltaV(config).compute(0, 2, verbose=False)))
    print(f"{title}, both 15 m/s: delta-v {found[-1]:.1f} m/s, by momentum {right:.1f} m/s")
conclude(found == [0.0, 15.0])
PYTHON
