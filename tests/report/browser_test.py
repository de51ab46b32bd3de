"""Opens reports in headless Chromium, light and dark, on desks, tablets and telephones: nothing may
stand beyond the right edge, the slider moves bodies, keys, wheel and touches work, the table sorts,
filters and opens, paper has pictures, and the console stays silent. Skipped without Chromium."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

from chromium import Browser, find_browser

CRASHRANK, SCENARIOS = sys.argv[1:3]
MOST_BYTES = 1_200_000
READY = "document.body.dataset.view === 'ready'"
# Pixels of the picture in 3-D: red ones are damage, blue ones the ego's paint.
COUNT = """(() => {
  const from = document.querySelector(".view-canvas");
  const canvas = document.createElement("canvas");
  canvas.width = from.width;
  canvas.height = from.height;
  const context = canvas.getContext("2d");
  context.drawImage(from, 0, 0);
  const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
  let red = 0, blue = 0;
  for (let i = 0; i < data.length; i += 4) {
    red += data[i] > 130 && data[i + 1] < 70 && data[i + 2] < 70;
    blue += data[i + 2] > data[i] + 40 && data[i + 2] > 60;
  }
  return [red, blue];
})()"""

# What scrolls sideways, or cuts what it holds.
SCROLLED = """[...document.querySelectorAll("main *")].filter((each) => each.clientWidth > 0 &&
  each.scrollWidth > each.clientWidth + 1 && getComputedStyle(each).overflowX !== "visible")
  .map((each) => each.tagName + each.id + each.className)"""
# Vehicles that the edge of the plan cuts: some of their corners are in the picture, others are not.
CUT = """BODIES.filter((body) => !modelOf(body).fixed).filter((body) => {
  const plan = stage.views[0].plan;
  const seen = outlineAt(body, stage.candidate.poseOf(body, stage.clock.time)).map((corner) => {
    const [x, y] = plan.to(...corner);
    return x > 0 && y > 0 && x < plan.width && y < plan.height;
  });
  return seen.includes(true) && seen.includes(false);
}).map(nameOf)"""


class ReportTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        cls.pages = {}
        cls.browser = cls.enterClassContext(Browser())

    def page(self, name):
        if name not in self.pages:
            path = os.path.join(self.folder, name + ".html")
            scenario = os.path.join(self.folder if name == "long" else SCENARIOS, name + ".json")
            models = os.path.join(SCENARIOS, "..", "models")
            subprocess.run([CRASHRANK, "rank", scenario, "--allow", models, "--report", path],
                           check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=300)
            self.pages[name] = path
        return self.pages[name]

    def open(self, name, width=1400, dark=False, touch=False):
        self.browser.messages.clear()
        self.browser.shape(width, dark=dark, touch=touch)
        self.browser.open(self.page(name))
        self.browser.wait(READY)
        return self.browser

    def test_nothing_is_wider_than_the_page_and_the_console_is_silent(self):
        for name in ("oncoming_truck", "oncoming_may_turn", "room_to_spare"):
            self.assertLessEqual(os.path.getsize(self.page(name)), MOST_BYTES, name)
            for width in (1400, 1200, 1010, 820, 390):
                for dark in (False, True):
                    with self.subTest(page=name, width=width, dark=dark):
                        browser = self.open(name, width, dark, touch=width == 390)
                        needed = browser.run("document.documentElement.scrollWidth")
                        self.assertLessEqual(needed, width)
                        self.assertEqual(browser.run(SCROLLED), [])
                        # Nor does what is known of a candidate.
                        browser.run("document.querySelector('tr[data-row] .open').click()")
                        self.assertTrue(browser.run("!!document.querySelector('.detail .contacts')"
                                                    " || stage.candidate.first === null"))
                        self.assertEqual(browser.run(SCROLLED), [])
                        self.assertLessEqual(
                            browser.run("document.documentElement.scrollWidth"), width)
                        shade = browser.run("getComputedStyle(document.body).backgroundColor")
                        red = int(re.match(r"rgb\((\d+)", shade)[1])
                        self.assertEqual(red < 128, dark)
                        self.assertEqual(browser.messages, [])

    def test_long_names_and_long_bodies_are_not_cut(self):
        with open(os.path.join(SCENARIOS, "oncoming_truck.json"), encoding="utf-8") as file:
            scenario = json.load(file)
        for model in scenario["models"].values():
            model["mesh"] = os.path.abspath(os.path.join(SCENARIOS, model["mesh"]))
        truck = scenario["models"]["truck"]
        truck["mesh"] = truck["mesh"].replace("truck.obj", "semitrailer.obj")
        for actor in scenario["actors"]:
            actor["name"] += "_with_a_name_that_no_line_can_break_anywhere_at_all"
        for candidate in scenario["candidates"]["listed"]:
            candidate["name"] += " as long as the grip allows and no other vehicle is in its way"
        with open(os.path.join(self.folder, "long.json"), "w", encoding="utf-8") as file:
            json.dump(scenario, file)
        for width in (1200, 820, 390):
            with self.subTest(width=width):
                browser = self.open("long", width, touch=width == 390)
                needed = browser.run("document.documentElement.scrollWidth")
                self.assertLessEqual(needed, width)
                self.assertEqual(browser.run(SCROLLED), [])
                browser.run("document.querySelector('tr[data-row] .open').click()")
                self.assertEqual(browser.run(SCROLLED), [])
                inside = browser.run("""[...document.querySelectorAll(".bump .name")].every((name) =>
                    name.getBoundingClientRect().right <= innerWidth)""")
                self.assertTrue(inside)
        browser = self.open("long", 1200)
        for row in range(2):
            browser.run(f"stage.show({row})")
            for time in ("0", "stage.candidate.begin", "stage.candidate.first"):
                browser.run(f"stage.clock.set({time})")
                self.assertEqual(browser.run(CUT), [], (row, time))

    def test_the_slider_moves_bodies_and_damage_is_red(self):
        browser = self.open("oncoming_truck")
        self.assertIn("in 100", browser.run("document.querySelector('h2').textContent"))
        first = browser.run("stage.candidate.first")
        start = browser.run("stage.clock.time")
        self.assertAlmostEqual(start, max(0, first - 1), places=2)
        before = browser.run("document.querySelector('.plan-canvas').toDataURL()")
        red, blue = browser.run(COUNT)
        self.assertEqual(red, 0)
        self.assertGreater(blue, 100)
        x = browser.run("stage.candidate.poseOf(EGO, stage.clock.time).x")
        browser.run(f"""(() => {{ const slider = document.getElementById("time");
            slider.value = {first + 0.4}; slider.dispatchEvent(new Event("input")); }})()""")
        self.assertGreater(browser.run("stage.candidate.poseOf(EGO, stage.clock.time).x"), x + 5)
        self.assertNotEqual(browser.run("document.querySelector('.plan-canvas').toDataURL()"),
                            before)
        browser.run("stage.views[0].view.fit(stage.candidate)")
        self.assertGreater(browser.run(COUNT)[0], 10)

    def test_keys_play_step_and_leap(self):
        browser = self.open("oncoming_truck")
        browser.run("document.querySelector('.plan-canvas').focus()")
        start = browser.run("stage.clock.time")
        browser.key("ArrowRight")
        self.assertAlmostEqual(browser.run("stage.clock.time"), start + 0.05, places=3)
        browser.key("n", "KeyN", "n")
        self.assertAlmostEqual(browser.run("stage.clock.time"),
                               browser.run("stage.candidate.first"), places=3)
        browser.key("Home")
        self.assertEqual(browser.run("stage.clock.time"), 0)
        browser.key(" ", "Space", " ")
        browser.wait("stage.clock.time > 0.1")
        browser.key(" ", "Space", " ")
        self.assertFalse(browser.run("stage.clock.isPlaying"))
        self.assertEqual(browser.messages, [])

    def test_the_wheel_scrolls_unless_the_picture_has_focus(self):
        browser = self.open("oncoming_truck")
        browser.run("document.querySelector('.plan-canvas').scrollIntoView({block: 'center'})")
        place = "(() => { const b = document.querySelector('.plan-canvas')" \
                ".getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]; })()"
        scroll, zoom = browser.run("scrollY"), browser.run("stage.views[0].plan.zoom")
        browser.wheel(*browser.run(place), -60)
        browser.wait(f"scrollY < {scroll}")
        self.assertEqual(browser.run("stage.views[0].plan.zoom"), zoom)
        browser.click(*browser.run(place))
        scroll = browser.run("scrollY")
        browser.wheel(*browser.run(place), -60)
        browser.wait(f"stage.views[0].plan.zoom > {zoom}")
        self.assertEqual(browser.run("scrollY"), scroll)

    def test_two_fingers_come_nearer(self):
        browser = self.open("oncoming_truck", 390, touch=True)
        browser.run("document.querySelector('.plan-canvas').scrollIntoView({block: 'center'})")
        x, y = browser.run("(() => { const b = document.querySelector('.plan-canvas')"
                           ".getBoundingClientRect();"
                           "return [b.x + b.width / 2, b.y + b.height / 2]; })()")
        browser.touch([(x - 20, y), (x + 20, y)], [(x - 40, y), (x + 40, y)],
                      [(x - 80, y), (x + 80, y)])
        self.assertGreater(browser.run("stage.views[0].plan.zoom"), 1.5)

    def test_two_candidates_play_in_step(self):
        browser = self.open("oncoming_truck")
        browser.run("""(() => { stage.beside.value = "1";
            stage.beside.dispatchEvent(new Event("change")); })()""")
        self.assertEqual(browser.run("document.querySelectorAll('.scene').length"), 2)
        browser.run("stage.clock.set(1)")
        self.assertEqual(browser.run("stage.views.map((view) => view.time)"), [1, 1])
        self.assertLessEqual(browser.run("document.documentElement.scrollWidth"), 1400)
        self.assertEqual(browser.messages, [])

    def test_rows_sort_filter_and_open(self):
        browser = self.open("oncoming_truck")
        names = "[...document.querySelectorAll('tr[data-row] .open')].map((b) => b.textContent)"
        ranked = browser.run(names)
        browser.run("document.querySelectorAll('.ranking th button')[0].click()")
        self.assertEqual(browser.run(names), ranked[::-1])
        browser.run("""(() => { const box = document.getElementById("filter");
            box.value = "lorry"; box.dispatchEvent(new Event("input")); })()""")
        self.assertLess(len(browser.run(names)), len(ranked))
        browser.run("document.querySelector('tr[data-row] .open').click()")
        self.assertIn("CDC", browser.run("document.querySelector('tr.detail').textContent"))
        # Every column of the tables within has its title above it.
        self.assertTrue(browser.run("""[...document.querySelectorAll("tr.detail table")].every(
            ({tHead, tBodies}) => [...tBodies[0].rows[0].cells].every((cell, i) =>
              tHead.rows[0].cells[i].offsetWidth === cell.offsetWidth))"""))
        row = int(browser.run("document.querySelector('tr[data-row]').dataset.row"))
        self.assertEqual(browser.run("stage.candidate.row"), row)
        self.assertEqual(browser.messages, [])

    def test_ten_thousand_rows_are_drawn_where_they_are_seen(self):
        with open(self.page("oncoming_truck"), encoding="utf-8") as file:
            text = file.read()
        opening = "id='page-data'>"
        begin = text.index(opening) + len(opening)
        end = text.index("</script>", begin)
        data = json.loads(text[begin:end])
        data["rows"] += [data["rows"][-1]] * 10_000
        self.pages["many"] = os.path.join(self.folder, "many.html")
        with open(self.pages["many"], "w", encoding="utf-8") as file:
            file.write(text[:begin] + json.dumps(data).replace("<", "\\u003c") + text[end:])
        browser = self.open("many")
        rows = "document.querySelectorAll('tr[data-row]').length"
        self.assertLess(browser.run(rows), 100)
        # Where rows are not as high as they are taken for, others are drawn than are seen.
        self.assertEqual(browser.run("[...document.querySelectorAll('tr[data-row]')].filter((row) =>"
                                     " row.offsetHeight !== table.rowHeight).length"), 0)
        browser.run("document.getElementById('rows').scrollTop = 230000")
        browser.wait("Number(document.querySelector('tr[data-row]').dataset.row) > 4000")
        self.assertLess(browser.run(rows), 100)
        self.assertEqual(browser.messages, [])

    def test_futures_have_strips_and_ghosts(self):
        browser = self.open("oncoming_may_turn")
        self.assertGreater(browser.run("document.querySelectorAll('.strip > span').length"), 2)
        self.assertGreater(browser.run("document.querySelectorAll('.pictures canvas').length"), 1)
        self.assertEqual(browser.run("ELSEWHERE.map(({p}) => p)"), [0.3])
        self.assertGreater(browser.run("document.querySelectorAll('.bump polyline').length"), 1)

    def test_ghosts_end_with_the_first_contact(self):
        browser = self.open("oncoming_may_turn")
        # Bodies of other candidates and futures in the view in 3-D.
        ghosts = """(() => { const view = stage.views[0].view; const mesh = view.mesh; let count = 0;
            view.mesh = function (candidate, ...rest) {
              count += candidate === null;
              mesh.call(this, candidate, ...rest);
            };
            stage.clock.set(%s);
            view.mesh = mesh;
            return count; })()"""
        self.assertGreater(browser.run(ghosts % "stage.candidate.first - 0.1"), 0)
        self.assertEqual(browser.run(ghosts % "stage.candidate.first + 0.1"), 0)
        # A future that is not the likeliest is seen up to its crash.
        browser.run("stage.show(2)")
        self.assertIsNone(browser.run("stage.candidate.first"))
        hit = browser.run("stage.candidate.source.futures.find(({t}) => t !== undefined).t")
        self.assertGreater(browser.run(ghosts % hit), 0)
        self.assertEqual(browser.run(ghosts % (hit + 1)), 0)

    def test_every_name_in_3d_stands_at_the_end_of_a_line(self):
        for width in (1400, 390):
            browser = self.open("oncoming_truck", width, touch=width == 390)
            left_out = browser.run("""(() => { let names = 0, lines = 0;
                const {led, lead} = Labels.prototype;
                Labels.prototype.led = function (text, [x, y], colour) {
                  names += x >= 0 && x <= this.width && y >= 0 && y <= this.height;
                  led.call(this, text, [x, y], colour);
                };
                const {plan} = stage.views[0];
                plan.labels = () => {};  // whose names have lines as well
                Labels.prototype.lead = function (...at) { ++lines; lead.call(this, ...at); };
                for (const {row} of CANDIDATES) {
                  stage.show(row);
                  for (let time = 0; time < 3; time += 0.1) stage.clock.set(time);
                }
                return names > 300 ? names - lines : NaN; })()""")
            self.assertEqual(left_out, 0)

    def test_the_crash_is_seen_large_and_the_hand_keeps_the_camera(self):
        browser = self.open("oncoming_truck")
        distance = "stage.views[0].view.distance"
        far = browser.run(distance)
        browser.run("stage.clock.set(stage.candidate.first)")
        self.assertLess(browser.run(distance), 0.8 * far)
        browser.run("stage.views[0].view.nearer(0.5)")
        held = browser.run(distance)
        browser.run("stage.clock.set(0)")
        self.assertEqual(browser.run(distance), held)

    def test_the_decision_says_what_is_hit_and_who_is_hurt_in_one_unit_each(self):
        browser = self.open("oncoming_may_turn")
        rows = browser.run("[...document.querySelectorAll('.choices tbody tr')].map((row) => "
                           "[...row.cells].map((cell) => cell.textContent))")
        self.assertEqual([row[0] for row in rows], [
            "bestbrake along the parked cars", "next bestbrake hard before the saloon",
            "worst of 3keep going"])
        self.assertRegex(rows[0][1], r"^second parked car after .* km/h")
        self.assertRegex(rows[2][1], r"; but motorcyclist after .* km/h with .* 30 %$")
        self.assertIn("motorcyclist", rows[2][3])
        for name in ("oncoming_truck", "oncoming_may_turn", "room_to_spare"):
            browser = self.open(name)
            said = browser.run("[...document.querySelectorAll('.decision, .uncertainty')]"
                               ".map((each) => each.textContent).join(' ')")
            self.assertNotRegex(said, r"\d m/s(?!2)", name)
            self.assertNotIn("in 1000", said, name)

    def test_paper_has_pictures_on_few_pages(self):
        browser = self.open("oncoming_truck", dark=True)
        paper = browser.print()
        pages = len(re.findall(rb"/Type\s*/Page\b(?!s)", paper))
        self.assertIn(pages, range(1, 5))
        # The plan is of lines; the view in 3-D is an image that stands over its blank canvas.
        self.assertGreaterEqual(len(re.findall(rb"/Subtype\s*/Image", paper)), 1)
        browser.run("window.dispatchEvent(new Event('beforeprint'))")
        middle = browser.run("""(() => { const canvas = document.querySelector(".words-canvas");
            return [...canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2,
              1, 1).data]; })()""")
        browser.run("window.dispatchEvent(new Event('afterprint'))")
        self.assertEqual(middle[3], 255)
        self.assertGreater(sum(middle[:3]), 3 * 100)
        self.assertEqual(browser.messages, [])

    def test_without_webgl_a_still_picture_stands_in(self):
        with Browser("--disable-3d-apis") as browser:
            browser.shape(1400)
            browser.open(self.page("oncoming_truck"))
            browser.wait(READY)
            self.assertEqual(browser.run("document.querySelectorAll('.view-canvas').length"), 0)
            self.assertGreater(browser.run("document.querySelector('.still img').clientWidth"), 300)
            self.assertEqual(browser.run("document.querySelectorAll('.plan-canvas').length"), 1)

    def test_axe_finds_nothing(self):
        try:
            subprocess.run(["npm", "install", "--silent", "--no-save", "--prefix", self.folder,
                            "axe-core@4"], check=True, capture_output=True, timeout=90)
        except (OSError, subprocess.SubprocessError) as error:
            self.skipTest(f"axe-core cannot be installed: {error}")
        with open(os.path.join(self.folder, "node_modules/axe-core/axe.min.js"),
                  encoding="utf-8") as file:
            axe = file.read()
        for dark in (False, True):
            browser = self.open("oncoming_may_turn", dark=dark)
            browser.run(axe + "; 0")
            found = browser.run(
                "axe.run(document, {runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa']}).then((told) => "
                "told.violations.map((each) => each.id + ': ' + each.nodes.map("
                "(node) => node.target + ' ' + node.failureSummary).join(' | ')))")
            self.assertEqual(found, [])


if __name__ == "__main__":
    if find_browser() is None:
        print("no Chromium to open the page with")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1], verbosity=2)
