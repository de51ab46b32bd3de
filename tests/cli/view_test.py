"""`crashrank view` on a copy of a shipped scenario: pages and versions over HTTP, changes and errors of
its files, strangers' requests, and its end."""

import http.client
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

PROGRAM, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
sys.path.append(str(pathlib.Path(__file__).parents[1] / "report"))
from chromium import Browser, find_browser

NAME = "room_to_spare"
TIMEOUT = 60


class View(unittest.TestCase):
    def setUp(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        shutil.copytree(DATA / "models", folder / "models")
        (folder / "crashrank.root").touch()
        (folder / "scenarios").mkdir()
        self.models = folder / "models"
        self.scenario = folder / "scenarios" / "scenario.json"
        self.text = (DATA / "scenarios" / f"{NAME}.json").read_text(encoding="utf-8")
        self.scenario.write_text(self.text, encoding="utf-8")
        self.start()

    def start(self, *options):
        self.program = subprocess.Popen(
            [PROGRAM, "view", str(self.scenario), *options], stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.stop)
        self.url = self.program.stdout.readline().strip()
        if not self.url:
            error = self.program.communicate()[1]
            if "built without cpp-httplib" in error:
                self.skipTest(error)
            self.fail(error)
        self.port = int(re.fullmatch(r"http://127\.0\.0\.1:(\d+)/", self.url)[1])

    def stop(self):
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGINT)
        self.out, self.err = self.program.communicate(timeout=TIMEOUT)
        return self.program.returncode

    def ask(self, path, host=None, method="GET"):
        """Return status and text of an answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIMEOUT)
        connection.request(method, path, headers={"Host": host} if host else {})
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, text

    def page(self):
        """Return the page and its version."""
        status, page = self.ask("/")
        self.assertEqual(status, 200)
        return page, re.search(r"<body data-version='(\d+)'", page)[1]

    def next_page(self, version):
        """Return the page that follows a version."""
        status, newer = self.ask("/version?after=" + version)
        self.assertEqual(status, 200)
        self.assertGreater(int(newer), int(version))
        page, shown = self.page()
        self.assertEqual(shown, newer)
        return page, newer

    def test_the_page_follows_its_files_and_shows_their_errors(self):
        page, version = self.page()
        self.assertIn("img-src data:; connect-src 'self'\"", page)
        self.assertNotIn("role='alert'", page)
        self.scenario.write_text(self.text.replace('"name": "', '"name": "again ', 1),
                                 encoding="utf-8")
        page, version = self.next_page(version)
        self.assertIn("<h1>again ", page)

        self.scenario.write_text('{"<img src=x>": 1}', encoding="utf-8")
        page, version = self.next_page(version)
        alert = re.search(r"<p class='note' role='alert'>(.*?)</p>", page)[1]
        self.assertIn("&lt;img src=x&gt;", alert)
        self.assertIn("scenario.json", alert)
        self.assertIn("<h1>again ", page)  # the last report is still there

        # An editor that writes a new file and renames it.
        other = self.scenario.with_suffix(".new")
        other.write_text(self.text, encoding="utf-8")
        other.rename(self.scenario)
        page, version = self.next_page(version)
        self.assertNotIn("role='alert'", page)

        mesh = self.models / "hatch.obj"
        kept = mesh.read_bytes()
        mesh.unlink()
        page, version = self.next_page(version)
        self.assertIn("hatch.obj", re.search(r"role='alert'>(.*?)</p>", page)[1])
        mesh.write_bytes(kept)
        page, version = self.next_page(version)
        self.assertNotIn("role='alert'", page)

        self.assertEqual(self.stop(), 0)
        self.assertEqual(self.out, "")
        self.assertEqual(len(self.err.splitlines()), 2, self.err)  # the two errors

    def test_nothing_else_is_served_and_no_other_host(self):
        _, version = self.page()
        for host in (f"localhost:{self.port}", f"127.0.0.1:{self.port}"):
            self.assertEqual(self.ask("/", host)[0], 200)
        for host in ("evil.example", f"evil.example:{self.port}", "127.0.0.1", "localhost:1"):
            status, text = self.ask("/version?after=0", host)
            self.assertEqual(status, 403, host)
            self.assertNotIn(version, text)
        for path in ("/scenario.json", "/../scenario.json", "//", "/version/", "/index.html"):
            self.assertEqual(self.ask(path)[0], 404, path)
        self.assertIn(self.ask("/", method="POST")[0], (400, 404, 405))
        # Nor is it reached by another address of this machine.
        with socket.socket() as other, self.assertRaises(OSError):
            other.connect(("127.0.0.2", self.port))
        second = subprocess.run([PROGRAM, "view", str(self.scenario), "--port", str(self.port)],
                                capture_output=True, text=True, check=False, timeout=TIMEOUT)
        self.assertEqual(second.returncode, 2)
        self.assertIn(f"port {self.port} of 127.0.0.1 cannot be listened on", second.stderr)

    def test_it_ends_while_a_page_waits(self):
        _, version = self.page()
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=TIMEOUT)
        connection.request("GET", "/version?after=" + version)
        self.assertEqual(self.stop(), 0)
        connection.close()

    def test_an_error_at_the_start_ends_it(self):
        self.stop()
        self.scenario.write_text("{", encoding="utf-8")
        done = subprocess.run([PROGRAM, "view", str(self.scenario)], capture_output=True,
                              text=True, check=False, timeout=TIMEOUT)
        self.assertEqual(done.returncode, 3)
        self.assertEqual(done.stdout, "")
        self.assertIn("line 1, column 2", done.stderr)

    @unittest.skipUnless(find_browser(), "no Chromium")
    def test_a_browser_reloads_the_page(self):
        with Browser() as browser:
            browser.open(self.url)
            browser.wait("document.body.dataset.view === 'ready'")
            self.scenario.write_text(self.text.replace('"name": "', '"name": "again ', 1),
                                     encoding="utf-8")
            browser.wait("document.title.startsWith('again ')")
            browser.wait("document.body.dataset.view === 'ready'")
            messages = [each for each in browser.messages if "favicon" not in str(each)]
            self.assertEqual(messages, [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
