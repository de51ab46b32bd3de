#!/usr/bin/env bash
# CriMe's braking vehicle drives backwards instead of standing still.
#
# SimulationLong ends braking once the speed is below 0.2 m/s (braking_vel_threshold). With its 8 m/s2 a step of 0.1 s
# takes 0.8 m/s, which mostly leads past that: the speed becomes negative, braking then accelerates forwards, and so on.
# From 10 m/s with the default limits it reaches -1.2 m/s; without a jerk limit it swings between 0.4 and -0.4 m/s until
# the horizon.
. "$(dirname "$0")/crime.sh"
crime <<'PYTHON'
from commonroad_crime.measure.time.ttb import TTB
from commonroad_crime.utility.simulation import Maneuver, SimulationLong
from crime_scene import conclude, configured

found = []
for title, jerk in (("default limits", None), ("no jerk limit", 1e6)):
    config = configured((0.0, 0.0, 10.0))
    if jerk:
        config.vehicle.cartesian.j_x_min, config.vehicle.cartesian.j_x_max = -jerk, jerk
    measure = TTB(config)  # completes the states
    states = SimulationLong(Maneuver.BRAKE, measure.ego_vehicle, config).simulate_state_list(0)
    found.append([round(float(state.velocity), 2) for state in states])
    print(f"{title}, m/s each 0.1 s:", *found[-1][:24])
conclude(min(found[0]) == -1.2 and set(found[1][-10:]) == {0.4, -0.4})
PYTHON
