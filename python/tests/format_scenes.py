"""One small scene in every format that is read: the files of data/formats.

An ego of 4.5 m drives at 15 m/s, a person crosses from the right at 1.5 m/s, a car is parked. The
road is a rectangle. ``python python/tests/format_scenes.py FOLDER`` writes the files.
"""

import math
import pathlib
import struct
import sys

X0, Y0, YAW0 = 100.0, 50.0, 0.3
CAR, PERSON = (4.5, 1.8, 1.5), (0.5, 0.5, 1.75)
AHEAD = 0.3 * CAR[0]  # of the middle before the rear axle
STEP_S, STEPS = 0.5, 9
ROAD = ((-20.0, -4.0), (60.0, -4.0), (60.0, 4.0), (-20.0, 4.0))
EGO_MPS, PERSON_MPS = 15.0, 1.5


def world(ahead, left, yaw=0.0):
    """Return x, y and heading of a place in the scene's own frame, the ego's first pose."""
    cosine, sine = math.cos(YAW0), math.sin(YAW0)
    return X0 + cosine * ahead - sine * left, Y0 + sine * ahead + cosine * left, YAW0 + yaw


def ego(i):
    return world(EGO_MPS * STEP_S * i, 0.0)


def person(i):
    return world(35.0, -4.0 + PERSON_MPS * STEP_S * i, math.pi / 2)


PARKED = world(45.0, 2.8, 0.1)
MOVING = (("ego", CAR, ego, EGO_MPS), ("person", PERSON, person, PERSON_MPS))


def rear_axle(pose):
    x, y, yaw = pose
    return x - AHEAD * math.cos(yaw), y - AHEAD * math.sin(yaw), yaw


def number(value):
    return f"{value:.9g}"


# CommonRoad


def point(x, y):
    return f"<point><x>{number(x)}</x><y>{number(y)}</y></point>"


def exact(tag, value):
    return f"<{tag}><exact>{number(value)}</exact></{tag}>"


def cr_state(tag, pose, step, speed=None):
    x, y, yaw = pose
    more = "" if speed is None else exact("velocity", speed)
    return (
        f"<{tag}><position>{point(x, y)}</position>{exact('orientation', yaw)}"
        f"{exact('time', step)}{more}</{tag}>"
    )


def rectangle(size, more=""):
    return (
        f"<shape><rectangle><length>{size[0]}</length><width>{size[1]}</width>{more}"
        "</rectangle></shape>"
    )


def cr_trajectory(number_, kind, shape, poses, speed, first=0):
    states = "\n".join(
        cr_state("state", pose, first + i + 1, speed) for i, pose in enumerate(poses[1:])
    )
    return (
        f'<dynamicObstacle id="{number_}"><type>{kind}</type>{shape}\n'
        f"{cr_state('initialState', poses[0], first, speed)}\n"
        f"<trajectory>{states}</trajectory></dynamicObstacle>"
    )


def commonroad(body=None, problem=True, version="2020a", step_s=STEP_S):
    """Return a scenario; `body` are its obstacles."""
    left = "".join(point(*world(*ROAD[i])[:2]) for i in (3, 2))
    right = "".join(point(*world(*ROAD[i])[:2]) for i in (0, 1))
    if body is None:
        body = "\n".join(
            (
                cr_trajectory(
                    2,
                    "pedestrian",
                    rectangle(PERSON),
                    [person(i) for i in range(STEPS)],
                    PERSON_MPS,
                ),
                '<staticObstacle id="3"><type>parkedVehicle</type>'
                f"{rectangle(CAR)}{cr_state('initialState', PARKED, 0)}</staticObstacle>",
            )
        )
    begin = cr_state("initialState", ego(0), 0, EGO_MPS) if problem else ""
    problems = f'<planningProblem id="1">{begin}</planningProblem>' if problem else ""
    return (
        "<?xml version='1.0' encoding='UTF-8'?>\n"
        f'<commonRoad timeStepSize="{step_s}" commonRoadVersion="{version}" '
        'author="crashrank" affiliation="" source="made by hand" benchmarkID="ZAM_Crossing-1_1" '
        'date="2026-01-01">\n'
        f'<lanelet id="100"><leftBound>{left}</leftBound>\n<rightBound>{right}</rightBound>'
        f"</lanelet>\n{body}\n{problems}\n</commonRoad>\n"
    )


# OpenSCENARIO


def position(pose, heading=True):
    x, y, yaw = pose
    turned = f' h="{number(yaw)}"' if heading else ""
    return f'<Position><WorldPosition x="{number(x)}" y="{number(y)}"{turned}/></Position>'


def polyline(poses, times):
    vertices = "\n".join(
        f'<Vertex time="{number(t)}">{position(pose)}</Vertex>'
        for pose, t in zip(poses, times, strict=True)
    )
    return (
        "<RoutingAction><FollowTrajectoryAction><TimeReference><Timing "
        'domainAbsoluteRelative="absolute" scale="1.0" offset="0.0"/></TimeReference>'
        '<TrajectoryFollowingMode followingMode="position"/><TrajectoryRef><Trajectory name="t" '
        f'closed="false"><ParameterDeclarations/><Shape><Polyline>{vertices}</Polyline></Shape>'
        "</Trajectory></TrajectoryRef></FollowTrajectoryAction></RoutingAction>"
    )


def vehicle(name):
    return (
        f'<ScenarioObject name="{name}"><Vehicle name="{name}" vehicleCategory="car">'
        f'<BoundingBox><Center x="{AHEAD}" y="0.0" z="0.75"/><Dimensions width="{CAR[1]}" '
        f'length="{CAR[0]}" height="{CAR[2]}"/></BoundingBox>'
        '<Performance maxSpeed="70" maxDeceleration="10" maxAcceleration="5"/><Axles>'
        '<FrontAxle maxSteering="0.5" wheelDiameter="0.6" trackWidth="1.6" positionX="2.7" '
        'positionZ="0.3"/><RearAxle maxSteering="0" wheelDiameter="0.6" trackWidth="1.6" '
        'positionX="0" positionZ="0.3"/></Axles><Properties/></Vehicle></ScenarioObject>'
    )


def private(name, *actions):
    inner = "".join(f"<PrivateAction>{action}</PrivateAction>" for action in actions)
    return f'<Private entityRef="{name}">{inner}</Private>'


def teleport(pose):
    return f"<TeleportAction>{position(pose)}</TeleportAction>"


def speed(value):
    return (
        '<LongitudinalAction><SpeedAction><SpeedActionDynamics dynamicsShape="step" '
        'dynamicsDimension="time" value="0.0"/><SpeedActionTarget>'
        f'<AbsoluteTargetSpeed value="{value}"/></SpeedActionTarget></SpeedAction>'
        "</LongitudinalAction>"
    )


def story(actor, action, trigger=""):
    return (
        '<Story name="s"><Act name="a"><ManeuverGroup name="g" maximumExecutionCount="1">'
        f'<Actors selectTriggeringEntities="false"><EntityRef entityRef="{actor}"/></Actors>'
        '<Maneuver name="m"><Event name="e" priority="overwrite"><Action name="x">'
        f"<PrivateAction>{action}</PrivateAction></Action>{trigger}</Event></Maneuver>"
        "</ManeuverGroup></Act></Story>"
    )


def openscenario(init=None, stories=None, entities="", parameters=""):
    person_object = (
        '<ScenarioObject name="person"><Pedestrian name="p" mass="75" '
        'pedestrianCategory="pedestrian"><BoundingBox><Center x="0.0" y="0.0" z="0.875"/>'
        f'<Dimensions width="{PERSON[1]}" length="{PERSON[0]}" height="{PERSON[2]}"/>'
        "</BoundingBox><Properties/></Pedestrian></ScenarioObject>"
    )
    poses = [person(i) for i in range(STEPS)]
    if init is None:
        init = "\n".join(
            (
                private("Ego", teleport(rear_axle(ego(0))), speed("${$Speed_kph / 3.6}")),
                private("person", teleport(person(0))),
                private("parked", teleport(rear_axle(PARKED))),
            )
        )
        parameters = '<ParameterDeclaration name="Speed_kph" parameterType="double" value="54"/>'
    if stories is None:
        stories = story("person", polyline(poses, [STEP_S * i for i in range(STEPS)]))
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<OpenSCENARIO>\n'
        '<FileHeader revMajor="1" revMinor="2" date="2026-01-01T00:00:00" '
        'description="crossing" author="crashrank"/>\n'
        f"<ParameterDeclarations>{parameters}</ParameterDeclarations>\n<CatalogLocations/>"
        f"<RoadNetwork/>\n<Entities>{vehicle('Ego')}\n{person_object}\n{vehicle('parked')}"
        f"{entities}</Entities>\n<Storyboard><Init><Actions>\n{init}\n</Actions></Init>\n"
        f"{stories}\n<StopTrigger/></Storyboard>\n</OpenSCENARIO>\n"
    )


# Tables


def esmini_csv():
    """Return a log with the columns that are read and one that is not."""
    columns = (
        "Entity_Name [-]", "Entity_ID [-]", "Current_Speed [m/s]", "bb_x [m]", "bb_y [m]",
        "bb_length [m]", "bb_width [m]", "bb_height [m]", "World_Position_X [m]",
        "World_Position_Y [m]", "World_Heading_Angle [rad]", "collision_ids",
    )  # fmt: skip
    objects = (
        ("Ego", CAR, lambda i: rear_axle(ego(i)), AHEAD, EGO_MPS),
        ("person", PERSON, person, 0.0, PERSON_MPS),
        ("parked", CAR, lambda _: rear_axle(PARKED), AHEAD, 0.0),
    )
    names = [f"#{k + 1} {column}" for k in range(3) for column in columns]
    lines = ["Version: v1", "Scenario File Name: crossing.xosc", "Number of Vehicles: 3"]
    lines.append(", ".join(["Index [-]", "TimeStamp [s]", *names]) + ", ")
    for i in range(STEPS):
        row = [str(i), number(STEP_S * i)]
        for k, (name, size, pose, ahead, mps) in enumerate(objects):
            x, y, yaw = pose(i)
            values = (mps, ahead, 0.0, *size, x, y, yaw)
            row += [name, str(k), *map(number, values), ""]
        lines.append(", ".join(row) + ", ")
    return "\n".join(lines) + "\n"


def poses_csv():
    lines = ["t_s,id,kind,x_m,y_m,yaw_deg,length_m,width_m,height_m,speed_mps"]
    for name, size, pose, mps in MOVING:
        kind = "car" if name == "ego" else "pedestrian"
        for i in range(STEPS):
            x, y, yaw = pose(i)
            values = (x, y, math.degrees(yaw), *size, mps)
            lines.append(",".join([number(STEP_S * i), name, kind, *map(number, values)]))
    x, y, yaw = PARKED
    values = map(number, (x, y, math.degrees(yaw), *CAR))
    lines.append(",".join(["0", "parked", "car", *values, ""]))
    return "\n".join(lines) + "\n"


# OSI


def osi_messages():
    """Return the scene as messages of ground truth; lanes are in the first."""
    from osi3.osi_groundtruth_pb2 import GroundTruth
    from osi3.osi_object_pb2 import MovingObject

    messages = []
    for i in range(STEPS):
        message = GroundTruth()
        message.version.version_major = 3
        message.version.version_minor = 7
        message.timestamp.seconds = int(STEP_S * i)
        message.timestamp.nanos = round((STEP_S * i % 1) * 1e9)
        message.host_vehicle_id.value = 1
        objects = [(1, CAR, ego(i), EGO_MPS), (2, PERSON, person(i), PERSON_MPS)]
        for key, size, (x, y, yaw), mps in [*objects, (3, CAR, PARKED, 0.0)]:
            moving = message.moving_object.add()
            moving.id.value = key
            moving.type = MovingObject.TYPE_PEDESTRIAN if key == 2 else MovingObject.TYPE_VEHICLE
            if key != 2:
                moving.vehicle_classification.type = MovingObject.VehicleClassification.TYPE_CAR
            base = moving.base
            base.dimension.length, base.dimension.width, base.dimension.height = size
            base.position.x, base.position.y, base.position.z = x, y, size[2] / 2
            base.orientation.yaw = yaw
            base.velocity.x, base.velocity.y = mps * math.cos(yaw), mps * math.sin(yaw)
        if i == 0:
            add_lane(message)
        messages.append(message)
    return messages


def add_lane(message):
    from osi3.osi_lane_pb2 import Lane

    lane = message.lane.add()
    lane.id.value = 100
    lane.classification.type = Lane.Classification.TYPE_DRIVING
    for key, corners in ((101, (3, 2)), (102, (0, 1))):
        boundary = message.lane_boundary.add()
        boundary.id.value = key
        for i in corners:
            x, y, _ = world(*ROAD[i])
            boundary_point = boundary.boundary_line.add()
            boundary_point.position.x, boundary_point.position.y = x, y
    lane.classification.left_lane_boundary_id.add().value = 101
    lane.classification.right_lane_boundary_id.add().value = 102


def osi_trace():
    data = [message.SerializeToString(deterministic=True) for message in osi_messages()]
    return b"".join(struct.pack("<I", len(each)) + each for each in data)


def write_osi_mcap(path):
    from mcap.writer import Writer

    with open(path, "wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema("osi3.GroundTruth", "protobuf", b"")
        channel = writer.register_channel("ground_truth", "protobuf", schema)
        for i, message in enumerate(osi_messages()):
            stamp = round(STEP_S * i * 1e9)
            writer.add_message(channel, stamp, message.SerializeToString(), stamp)
        writer.finish()


# ROS 2


def write_bag(folder, change=None):
    """Write a bag with one message of predicted objects and the odometry of the ego.

    `change` may replace the predicted objects before they are written.
    """
    import numpy as np
    from crashrank.formats._bag import typestore
    from rosbags.rosbag2 import StoragePlugin, Writer

    store = typestore()
    types = store.types
    package = "autoware_perception_msgs/msg/"

    def make(name, **members):
        return types[name](**members)

    def vector(x=0.0, y=0.0, z=0.0):
        return make("geometry_msgs/msg/Vector3", x=x, y=y, z=z)

    def pose(place):
        x, y, yaw = place
        return make(
            "geometry_msgs/msg/Pose",
            position=make("geometry_msgs/msg/Point", x=x, y=y, z=0.0),
            orientation=make(
                "geometry_msgs/msg/Quaternion",
                x=0.0,
                y=0.0,
                z=math.sin(yaw / 2),
                w=math.cos(yaw / 2),
            ),
        )

    def covered(name, **members):
        return make(f"geometry_msgs/msg/{name}", **members, covariance=np.zeros(36))

    def twist(mps):
        return covered(
            "TwistWithCovariance",
            twist=make("geometry_msgs/msg/Twist", linear=vector(mps), angular=vector()),
        )

    def header():
        stamp = make("builtin_interfaces/msg/Time", sec=1000, nanosec=0)
        return make("std_msgs/msg/Header", stamp=stamp, frame_id="map")

    def predicted(key, label, size, poses, mps, existence):
        path = make(
            f"{package}PredictedPath",
            path=[pose(each) for each in poses],
            time_step=make("builtin_interfaces/msg/Duration", sec=0, nanosec=int(STEP_S * 1e9)),
            confidence=1.0,
        )
        accel = make("geometry_msgs/msg/Accel", linear=vector(), angular=vector())
        return make(
            f"{package}PredictedObject",
            object_id=make("unique_identifier_msgs/msg/UUID", uuid=np.full(16, key, np.uint8)),
            existence_probability=existence,
            classification=[make(f"{package}ObjectClassification", label=label, probability=1.0)],
            kinematics=make(
                f"{package}PredictedObjectKinematics",
                initial_pose_with_covariance=covered("PoseWithCovariance", pose=pose(poses[0])),
                initial_twist_with_covariance=twist(mps),
                initial_acceleration_with_covariance=covered("AccelWithCovariance", accel=accel),
                predicted_paths=[path] if mps else [],
            ),
            shape=make(
                f"{package}Shape",
                type=0,
                footprint=make("geometry_msgs/msg/Polygon", points=[]),
                dimensions=vector(*size),
            ),
        )

    objects = make(
        f"{package}PredictedObjects",
        header=header(),
        objects=[
            predicted(2, 7, PERSON, [person(i) for i in range(STEPS)], PERSON_MPS, 0.75),
            predicted(3, 1, CAR, [PARKED], 0.0, 1.0),
        ],
    )
    objects = change(objects, types) if change else objects
    odometry = make(
        "nav_msgs/msg/Odometry",
        header=header(),
        child_frame_id="base_link",
        pose=covered("PoseWithCovariance", pose=pose(rear_axle(ego(0)))),
        twist=twist(EGO_MPS),
    )
    with Writer(folder, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for topic, message in (("/objects", objects), ("/localization/kinematic_state", odometry)):
            kind = message.__msgtype__
            connection = writer.add_connection(topic, kind, typestore=store)
            writer.write(connection, 1_000_000_000_000, store.serialize_cdr(message, kind))
    return folder


TEXTS = {
    "crossing.xml": commonroad,
    "crossing.xosc": openscenario,
    "crossing_esmini.csv": esmini_csv,
    "crossing_poses.csv": poses_csv,
}


def main(folder):
    for name, text in TEXTS.items():
        (folder / name).write_text(text(), encoding="utf-8")
    (folder / "crossing.osi").write_bytes(osi_trace())


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
