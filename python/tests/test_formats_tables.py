"""Tables of poses and logs of esmini."""

import crashrank
import format_scenes as scenes
import pytest
from crashrank.formats import read_esmini_csv, read_poses_csv

HEAD = "t_s,id,x_m,y_m,yaw_deg"


def read(tmp_path, text, reader=read_poses_csv, **options):
    path = tmp_path / "a.csv"
    path.write_text(text, encoding="utf-8")
    return reader(path, **options)


def test_the_least_table(tmp_path):
    found = read(tmp_path, f"{HEAD}\n0,ego,0,0,0\n1,ego,15,0,0\n0,wall,40,0,90\n")
    assert found.scenario["ego"]["speed_mps"] == 15
    (wall,) = found.scenario["actors"]
    assert wall["pose"]["yaw_deg"] == 90
    assert any("no kind" in each for each in found.report.assumed)


def test_columns_in_any_order_with_predictions(tmp_path):
    text = (
        "id,prediction,probability,yaw_deg,y_m,x_m,t_s,kind,speed_mps,colour\n"
        "ego,,,0,0,0,0,car,15,red\n"
        "cyclist,a,0.25,90,-5,30,0,bicycle,4,\ncyclist,a,,90,3,30,2,bicycle,4,\n"
        "cyclist,b,0.75,90,-5,30,0,bicycle,4,\ncyclist,b,,90,-4,30,2,bicycle,0,\n"
    )
    found = read(tmp_path, text)
    (cyclist,) = found.scenario["actors"]
    assert [p["probability"] for p in cyclist["predictions"]] == [0.25, 0.75]
    assert found.report.left_out == ["columns colour"]


@pytest.mark.parametrize(
    ("text", "place", "reason"),
    [
        ("t_s,id,x_m,y_m\n0,a,0,0\n", "line 1", "no column yaw_deg"),
        (f"{HEAD},t_s\n0,a,0,0,0,0\n", "line 1", "twice"),
        (f"{HEAD}\n0,a,0,0\n", "line 2", "has 4 values"),
        (f"{HEAD}\n0,a,zero,0,0\n", "line 2, x_m", "'zero', not a number"),
        (f"{HEAD}\n0,a,inf,0,0\n", "line 2, x_m", "not a number"),
        (f"{HEAD}\n0,,0,0,0\n", "line 2, id", "is empty"),
        (f"{HEAD},kind\n0,a,0,0,0,lorry\n", "line 2, kind", "is 'lorry'"),
        (f"{HEAD},length_m\n0,a,0,0,0,-4\n", "line 2, length_m", "is -4"),
        (f"{HEAD}\n0,a,0,0,0\n1,a,9,0,0\n0.0,a,5,0,0\n", "line 4, t_s", "of a in line 2"),
        (f"{HEAD}\n", "", "has no poses"),
        ("\n", "line 1", "no column t_s"),
    ],
)
def test_refusals_name_line_and_column(tmp_path, text, place, reason):
    with pytest.raises(crashrank.BadInputError) as caught:
        read(tmp_path, text)
    assert caught.value.place == place
    assert reason in caught.value.reason


def test_a_table_without_a_vehicle_has_no_ego(tmp_path):
    with pytest.raises(crashrank.UsageError, match="no vehicle"):
        read(tmp_path, f"{HEAD},kind\n0,a,0,0,0,pedestrian\n")


def test_a_log_begins_where_its_columns_are_named(tmp_path):
    text = scenes.esmini_csv()
    found = read(tmp_path, text, read_esmini_csv, time_s=1.0, ego="parked")
    assert {each["name"] for each in found.scenario["actors"]} == {"Ego", "person"}
    units = text.replace("\n0, 0,", "\n-, -,\n0, 0,", 1)
    assert read(tmp_path, units, read_esmini_csv).scenario["ego"]["speed_mps"] == 15
    for broken in (
        text.replace("World_Heading", "Heading"), text.replace("TimeStamp", "Time"), "a,b\n1,2\n",
    ):  # fmt: skip
        with pytest.raises(crashrank.BadInputError):
            read(tmp_path, broken, read_esmini_csv)


def test_a_log_of_entities_that_come_and_go(tmp_path):
    lines = scenes.esmini_csv().splitlines()
    for i in (4, 5):  # the first two seconds have the ego and the person only
        lines[i] = ", ".join(lines[i].split(", ")[:26])
    found = read(tmp_path, "\n".join(lines), read_esmini_csv)
    assert {each["name"] for each in found.scenario["actors"]} == {"person", "parked"}
    assert any("appears" in each for each in found.report.warnings)
