"""Recordings for rerun of a report's scene; needs ``crashrank[rerun]``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ._played import (
    ARROW_S,
    CONTACT_COLOUR,
    EGO,
    EGO_COLOUR,
    FUTURE_COLOUR,
    OTHER_COLOUR,
    ROAD_COLOUR,
    PlayedCandidate,
    PlayedScene,
)

if TYPE_CHECKING:
    import rerun

TIMELINE = "decision"


def to_rerun(page: str) -> rerun.RecordingStream:
    """Return a recording of the scene of a report's page; see `Ranking.to_rerun`."""
    from ._tables import missing

    try:
        import rerun
        import rerun.blueprint as blueprint
    except ImportError:
        raise missing("rerun-sdk", "rerun") from None
    scene = PlayedScene(page)
    stream = rerun.RecordingStream("crashrank")
    # Wall time has no meaning in a simulated motion.
    stream.set_log_time_enabled(False)
    stream.set_log_tick_enabled(False)
    stream.log("/", rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    road = rerun.LineStrips3D(scene.road(), colors=ROAD_COLOUR, radii=0.05)
    stream.log("road", road, static=True)
    stream.log("ranking", _table(scene), static=True)
    views = []
    for candidate in scene.candidates:
        recorder = _Recorder(stream, scene, candidate)
        recorder.record()
        contents = ["$origin/**", "/road/**"]
        view = blueprint.Spatial3DView(
            origin=recorder.root, name=f"{candidate.place}. {candidate.name}", contents=contents
        )
        views.append(view)
    words = blueprint.TextDocumentView(origin="ranking", name="ranking")
    shown = blueprint.Horizontal(blueprint.Tabs(*views), words, column_shares=[3, 1])
    stream.send_blueprint(blueprint.Blueprint(shown, collapse_panels=True))
    return stream


def _table(scene: PlayedScene) -> rerun.TextDocument:
    import rerun

    def line(*cells: str) -> str:
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

    lines = [line("place", "candidate", str(scene.data["measure"]), "contact"), "|---|---|---|---|"]
    for each in scene.candidates:
        lines.append(line(each.place, each.name, each.score_words, each.contact_words))
    return rerun.TextDocument("\n".join(lines), media_type="text/markdown")


class _Recorder:
    def __init__(
        self, stream: rerun.RecordingStream, scene: PlayedScene, candidate: PlayedCandidate
    ) -> None:
        import rerun

        self._rerun = rerun
        self._stream = stream
        self._scene = scene
        self._candidate = candidate
        self._names = ["candidates", f"{candidate.row + 1} {candidate.name}"]
        self.root = rerun.new_entity_path(self._names)

    def _path(self, *names: str) -> str:
        path: str = self._rerun.new_entity_path([*self._names, *names])
        return path

    def record(self) -> None:
        self._ways()
        for body in self._scene.bodies:
            self._body(body)
        for i, _ in enumerate(self._candidate.contacts):
            self._contact(i)

    def _ways(self) -> None:
        labels, lines = zip(("", self._candidate.way()), *self._scene.elsewhere(), strict=True)
        colours = [EGO_COLOUR, *(FUTURE_COLOUR for _ in lines[1:])]
        ways = self._rerun.LineStrips3D(
            lines, colors=colours, radii=0.08, labels=labels, show_labels=len(labels) > 1
        )
        self._stream.log(self._path("ways"), ways, static=True)

    def _body(self, body: int) -> None:
        rr, candidate, name = self._rerun, self._candidate, self._scene.name(body)
        times = candidate.times
        points, turns = candidate.poses(body, times)
        if not (np.any(np.diff(points, axis=0)) or np.any(np.diff(turns, axis=0))):
            times, points, turns = times[:1], points[:1], turns[:1]
        self._stream.send_columns(
            self._path(name),
            indexes=[rr.TimeColumn(TIMELINE, duration=times)],
            columns=rr.Transform3D.columns(translation=points, quaternion=turns),
        )
        mesh = self._scene.mesh(body)
        # Corners of its own for every triangle, so that each has a colour of its own.
        corners = mesh.corners[mesh.triangles].reshape(-1, 3)
        for time_s in [0.0, *(each.time_s for each in candidate.contacts if body in each.bodies)]:
            damage = candidate.damage(body, time_s)
            colours = np.repeat(mesh.painted(damage), 3, axis=0)
            self._stream.set_time(TIMELINE, duration=time_s)
            self._stream.log(
                self._path(name, "mesh"),
                rr.Mesh3D(vertex_positions=corners, vertex_colors=colours)
                if time_s == 0.0
                else rr.Mesh3D.from_fields(vertex_colors=colours),
            )
            if damage is not None:
                break  # it is all there from the first contact on
        colour = EGO_COLOUR if body == EGO else OTHER_COLOUR
        at = [self._scene.label_point(body)]
        label = rr.Points3D(at, labels=[name], show_labels=True, radii=0.02, colors=colour)
        self._stream.log(self._path(name, "name"), label, static=True)

    def _contact(self, i: int) -> None:
        rr, contact = self._rerun, self._candidate.contacts[i]
        words = self._scene.contact_words(contact)
        self._stream.set_time(TIMELINE, duration=contact.time_s)
        point = rr.Points3D(
            [contact.point_m], labels=[words], show_labels=True, radii=0.15, colors=CONTACT_COLOUR
        )
        self._stream.log(self._path("contacts", str(i + 1)), point)
        kicks = rr.Arrows3D(
            origins=[contact.point_m, contact.point_m],
            vectors=[ARROW_S * kick for kick in contact.kicks_mps],
            colors=[EGO_COLOUR if body == EGO else OTHER_COLOUR for body in contact.bodies],
            radii=0.06,
        )
        self._stream.log(self._path("contacts", str(i + 1), "delta-v"), kicks)
