"""OpenSCENARIO: what is read, and the one line for what needs an engine."""

import math

import crashrank
import format_scenes as scenes
import pytest
from conftest import DATA

pytest.importorskip("lxml")
from crashrank.formats import read_openscenario
from crashrank.formats._parameters import Parameters
from crashrank.formats._xml import Node

TIMES = [scenes.STEP_S * i for i in range(scenes.STEPS)]
POSES = [scenes.person(i) for i in range(scenes.STEPS)]
LANE = (
    '<TeleportAction><Position><LanePosition roadId="1" laneId="-1" s="5"/></Position>'
    "</TeleportAction>"
)


def read(tmp_path, text, **options):
    path = tmp_path / "a.xosc"
    path.write_text(text, encoding="utf-8")
    return read_openscenario(path, **options)


def start(seconds):
    return (
        '<StartTrigger><ConditionGroup><Condition name="c" delay="0" conditionEdge="none">'
        f'<ByValueCondition><SimulationTimeCondition value="{seconds}" rule="greaterThan"/>'
        "</ByValueCondition></Condition></ConditionGroup></StartTrigger>"
    )


def person_of(found):
    return next(each for each in found.scenario["actors"] if each["name"] == "person")


def test_relative_times_start_with_the_event(tmp_path):
    line = scenes.polyline(POSES, TIMES).replace('"absolute"', '"relative"')
    text = scenes.openscenario(stories=scenes.story("person", line, start(1.0)))
    poses = person_of(read(tmp_path, text))["poses"]
    assert poses[1]["t_s"] == 1.0
    assert (poses[1]["x_m"], poses[1]["y_m"]) == pytest.approx(POSES[0][:2], abs=1e-3)
    assert poses[2]["t_s"] == 1.5
    assert (poses[2]["x_m"], poses[2]["y_m"]) == pytest.approx(POSES[1][:2], abs=1e-3)


def test_times_have_no_meaning_without_a_reference(tmp_path):
    line = scenes.polyline(POSES, [0.0] * len(POSES))
    line = line.replace(
        '<Timing domainAbsoluteRelative="absolute" scale="1.0" offset="0.0"/>', "<None/>"
    )
    text = scenes.openscenario(stories=scenes.story("person", line))
    with pytest.raises(crashrank.BadInputError, match="no Timing"):
        read(tmp_path, text)
    walking = scenes.private("person", scenes.teleport(POSES[0]), scenes.speed(3.0))
    text = text.replace(scenes.private("person", scenes.teleport(POSES[0])), walking)
    poses = person_of(read(tmp_path, text))["poses"]
    # 3 m/s along 6 m: the last vertex is reached after 2 s.
    assert poses[8]["t_s"] == pytest.approx(2.0)
    assert (poses[8]["x_m"], poses[8]["y_m"]) == pytest.approx(POSES[-1][:2], abs=1e-3)


def test_trajectories_among_the_initial_actions_are_followed(tmp_path):
    line = scenes.polyline(POSES, TIMES)
    init = scenes.private("Ego", scenes.teleport(scenes.rear_axle(scenes.ego(0))), scenes.speed(15))
    text = scenes.openscenario(init + scenes.private("person", line), stories="")
    found = read(tmp_path, text)
    assert len(person_of(found)["poses"]) == scenes.STEPS
    assert any("parked: it has no position" in each for each in found.report.left_out)


def test_headings_follow_the_line_where_none_is_stated(tmp_path):
    line = scenes.polyline(POSES, TIMES)
    for _, _, yaw in POSES:
        line = line.replace(f' h="{scenes.number(yaw)}"', "")
    found = read(tmp_path, scenes.openscenario(stories=scenes.story("person", line)))
    for pose in person_of(found)["poses"]:
        assert pose["yaw_deg"] == pytest.approx(math.degrees(POSES[0][2]), abs=1e-3)


CATALOGUE = (
    '<OpenSCENARIO><FileHeader revMajor="1" revMinor="2"/><Catalog name="Cars">'
    '<Vehicle name="small" vehicleCategory="car"><ParameterDeclarations>'
    '<ParameterDeclaration name="Length" parameterType="double" value="3.5"/>'
    '</ParameterDeclarations><BoundingBox><Center x="1.2" y="0" z="0.7"/>'
    '<Dimensions length="$Length" width="1.6" height="1.4"/></BoundingBox></Vehicle>'
    "</Catalog></OpenSCENARIO>"
)


def with_catalogue(name="Cars", entry="small", given="", directory=""):
    reference = (
        f'<ScenarioObject name="third"><CatalogReference catalogName="{name}" entryName="{entry}">'
        f"{given}</CatalogReference></ScenarioObject>"
    )
    init = scenes.private("Ego", scenes.teleport((0, 0, 0)), scenes.speed(15))
    init += scenes.private("third", scenes.teleport((30, 0, 0)))
    text = scenes.openscenario(init, stories="", entities=reference)
    stated = f'<VehicleCatalog><Directory path="{directory}"/></VehicleCatalog>'
    locations = f"<CatalogLocations>{stated}</CatalogLocations>"
    return text.replace("<CatalogLocations/>", locations) if directory else text


def test_catalogues_in_the_folder_are_read(tmp_path):
    (tmp_path / "lists").mkdir()
    (tmp_path / "lists/cars.xosc").write_text(CATALOGUE)
    (tmp_path / "lists/broken.xosc").write_text("<OpenSCENARIO>")
    found = read(tmp_path, with_catalogue())
    (third,) = found.scenario["actors"]
    assert found.scenario["models"][third["model"]]["box"] == [3.5, 1.6, 1.4]
    assert third["pose"]["x_m"] == pytest.approx(30 + 1.2 - 0.3 * 3.5)
    given = (
        '<ParameterAssignments><ParameterAssignment parameterRef="Length" value="4.2"/>'
        "</ParameterAssignments>"
    )
    found = read(tmp_path, with_catalogue(given=given))
    (third,) = found.scenario["actors"]
    assert found.scenario["models"][third["model"]]["box"] == [4.2, 1.6, 1.4]


def test_nothing_outside_of_the_folder_is_read(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    (tmp_path / "cars.xosc").write_text(CATALOGUE)
    (inner / "link.xosc").symlink_to(tmp_path / "cars.xosc")
    with pytest.raises(crashrank.BadInputError, match="not in the folder"):
        read(inner, with_catalogue())
    (inner / "cars.xosc").write_text(CATALOGUE)
    with pytest.raises(crashrank.BadInputError, match="does not have"):
        read(inner, with_catalogue(entry="huge"))


def test_catalogues_are_those_of_the_stated_directory(tmp_path):
    for name, length in (("a", 3.5), ("b", 4.2), ("c", 4.8)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "cars.xosc").write_text(CATALOGUE.replace("3.5", str(length)))
    for directory, length in (("./b", 4.2), ("a", 3.5), (f"{tmp_path}/c/", 4.8)):
        found = read(tmp_path, with_catalogue(directory=directory))
        (third,) = found.scenario["actors"]
        assert found.scenario["models"][third["model"]]["box"][0] == length
    with pytest.raises(crashrank.BadInputError, match=r"both a/cars\.xosc and b/cars\.xosc have"):
        read(tmp_path, with_catalogue())


def test_directories_that_cannot_be_followed_are_refused(tmp_path):
    inner = tmp_path / "inner"
    (inner / "broken").mkdir(parents=True)
    (inner / "broken/cars.xosc").write_text(CATALOGUE[:300])
    (tmp_path / "cars.xosc").write_text(CATALOGUE)
    (inner / "link").symlink_to(tmp_path)
    for directory, text in (
        ("./none", r"Directory \(line 5\) names \./none, which is no folder"),
        ("..", r"Directory \(line 5\) leads out of the folder of the file: \.\."),
        ("link", "leads out of the folder of the file: link"),
        (".", "not in the directories of CatalogLocations"),
        ("broken", r"'Cars', but broken/cars\.xosc, line 1, is no XML"),
    ):
        with pytest.raises(crashrank.BadInputError, match=text) as caught:
            read(inner, with_catalogue(directory=directory))
        assert "CatalogReference (line" in caught.value.place


CHANGE = "<LateralAction><LaneChangeAction><LaneChangeTarget/></LaneChangeAction></LateralAction>"
NEAR = (
    '<StartTrigger><ConditionGroup><Condition name="c" delay="0" conditionEdge="none">'
    "<ByEntityCondition><TriggeringEntities/><EntityCondition><TimeToCollisionCondition/>"
    "</EntityCondition></ByEntityCondition></Condition></ConditionGroup></StartTrigger>"
)
FOLLOW = scenes.polyline(POSES, TIMES)
STANDING = scenes.private("Ego", scenes.teleport((0, 0, 0)), scenes.speed(15))


@pytest.mark.parametrize(
    ("text", "element"),
    [
        (scenes.openscenario(stories=scenes.story("person", CHANGE)), "LaneChangeAction"),
        (scenes.openscenario(stories=scenes.story("person", FOLLOW, NEAR)), "TimeToCollision"),
        (scenes.openscenario(STANDING + scenes.private("person", LANE), ""), "LanePosition"),
        (scenes.openscenario(scenes.private("Ego", LANE), ""), "LanePosition"),
        (
            scenes.openscenario(
                stories=scenes.story("person", FOLLOW.replace("Polyline", "Clothoid"))
            ),
            "Shape",
        ),
        (
            scenes.openscenario(
                stories=scenes.story("person", scenes.speed(3).replace('"step"', '"linear"'))
            ),
            "SpeedAction",
        ),
    ],
)
def test_what_needs_an_engine_is_one_line(tmp_path, text, element):
    with pytest.raises(crashrank.BadInputError) as caught:
        read(tmp_path, text)
    assert element in caught.value.reason
    assert "needs a simulation engine" in caught.value.reason
    assert "line" in caught.value.place
    assert "esmini" in caught.value.remedy


def test_what_the_ego_would_do_is_left_out(tmp_path):
    text = scenes.openscenario(stories=scenes.story("Ego", CHANGE, NEAR))
    found = read(tmp_path, text)
    assert any("of the ego" in each for each in found.report.left_out)
    with pytest.raises(crashrank.BadInputError, match="engine"):
        read(tmp_path, text, time_s=1.0)


def test_an_ego_of_one_state_is_moved_on_for_a_minute_at_most():
    for time_s in (-2.0, 61.0):
        with pytest.raises(crashrank.BadInputError, match="a time from -1 to 60 s"):
            read_openscenario(DATA / "formats/crossing.xosc", time_s)


def test_versions_and_catalogues_are_no_scenarios(tmp_path):
    with pytest.raises(crashrank.BadInputError, match="version"):
        read(tmp_path, scenes.openscenario().replace('revMajor="1"', 'revMajor="2"'))
    with pytest.raises(crashrank.BadInputError, match="catalogue"):
        read(tmp_path, CATALOGUE)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("${54 / 3.6}", 15.0),
        ("${$a * (2 + $b) - 1}", 3 * 6 - 1),
        ("${-$a + 7 % 4}", 0.0),
        ("${pow($a, 2) + sqrt(16) + abs(-1) + round(2.4)}", 16.0),
        ("$b", 4.0),
        ("12", 12.0),
    ],
)
def test_expressions(text, value):
    etree = pytest.importorskip("lxml.etree")
    node = Node(etree.Element("a", v=text), "file")
    assert Parameters({"a": "3", "b": "4"}).number(node, "v") == pytest.approx(value)


@pytest.mark.parametrize(
    "text",
    [
        "${__import__('os').system('true')}", "${$a.real}", "${[1][0]}", "${(lambda: 1)()}",
        "${9**9**9**9}", "${1/0}", "${" + "(" * 300 + "1" + ")" * 300 + "}", "${$c}", "$c", "${}",
        "${'a' * 1000000000}", "${1 if 1 else 2}", "${" + "1+" * 400 + "1}", "${max()}", "${True}x",
    ],
)  # fmt: skip
def test_what_is_no_expression_is_refused(text):
    etree = pytest.importorskip("lxml.etree")
    node = Node(etree.Element("a", v=text), "file")
    with pytest.raises(crashrank.BadInputError) as caught:
        Parameters({"a": "3", "b": "4"}).number(node, "v")
    assert len(str(caught.value)) < 600
