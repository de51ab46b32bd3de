"""A headless Chromium that a script drives through its debugging pipe: pages of any width, light and
dark, keys, wheel and touches, pictures and prints."""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def find_browser():
    """Return the program's path, or None where none is installed."""
    for name in ("chromium", "chromium-browser", "google-chrome"):
        if path := shutil.which(name):
            return path
    return None


class Browser:
    """One window; `messages` holds what its pages wrote to the console, errors included."""

    def __init__(self, *options):
        self._folder = tempfile.TemporaryDirectory()
        to_read, self._out = os.pipe()
        self._in, to_write = os.pipe()
        self._log = open(os.path.join(self._folder.name, "log"), "w")
        self._process = subprocess.Popen(
            ["/bin/bash", "-c", f'exec "$0" "$@" 3<&{to_read} 4>&{to_write}', find_browser(),
             "--headless=new", "--no-sandbox", "--disable-gpu", "--use-gl=angle",
             "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars",
             "--remote-debugging-pipe", "--user-data-dir=" + self._folder.name, *options,
             "about:blank"],
            pass_fds=(to_read, to_write), stdin=subprocess.DEVNULL, stdout=self._log,
            stderr=self._log)
        os.close(to_read)
        os.close(to_write)
        self._last, self._buffer, self._session, self.messages = 0, b"", None, []
        targets = self._ask("Target.getTargets")["targetInfos"]
        page = next(each for each in targets if each["type"] == "page")
        self._session = self._ask("Target.attachToTarget", targetId=page["targetId"],
                                  flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self._ask(domain + ".enable")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._session = None
        try:
            self._ask("Browser.close")
            self._process.wait(20)
        except (OSError, RuntimeError, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        os.close(self._in)
        os.close(self._out)
        self._log.close()
        try:
            self._folder.cleanup()
        except OSError:
            pass  # a helper of the browser that ends late writes there

    def _ask(self, method, **parameters):
        self._last += 1
        order = {"id": self._last, "method": method, "params": parameters}
        if self._session:
            order["sessionId"] = self._session
        os.write(self._out, json.dumps(order).encode() + b"\0")
        until = time.monotonic() + 120
        while True:
            answer = self._next(until)
            if answer.get("id") == self._last:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]

    def _next(self, until):
        while b"\0" not in self._buffer:
            if not select.select([self._in], [], [], max(0, until - time.monotonic()))[0]:
                raise RuntimeError("the browser does not answer")
            part = os.read(self._in, 1 << 20)
            if not part:
                raise RuntimeError("the browser has ended")
            self._buffer += part
        text, self._buffer = self._buffer.split(b"\0", 1)
        message = json.loads(text)
        told = message.get("params", {})
        if message.get("method") == "Runtime.consoleAPICalled":
            self.messages.append(" ".join(str(each.get("value")) for each in told["args"]))
        elif message.get("method") == "Runtime.exceptionThrown":
            details = told["exceptionDetails"]
            self.messages.append(details.get("exception", {}).get("description", details["text"]))
        elif (message.get("method") == "Log.entryAdded"
              and "GL Driver Message" not in told["entry"]["text"]):
            self.messages.append(told["entry"]["text"])
        return message

    def shape(self, width, height=900, dark=False, touch=False):
        """Set the size of the page, its scheme of colours, and whether it is touched."""
        self._ask("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=1, mobile=touch)
        self._ask("Emulation.setTouchEmulationEnabled", enabled=touch)
        self._ask("Emulation.setEmulatedMedia", features=[
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])

    def open(self, path):
        """Open a file or a URL and wait until it is loaded."""
        url = path if "://" in str(path) else "file://" + os.path.abspath(path)
        self._ask("Page.navigate", url=url)
        self.wait("document.readyState === 'complete' && location.href !== 'about:blank'")

    def run(self, script):
        """Return the value of an expression."""
        answer = self._ask("Runtime.evaluate", expression=script, returnByValue=True,
                           awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(answer["exceptionDetails"])
        return answer["result"].get("value")

    def wait(self, condition, seconds=60):
        """Wait until an expression is true."""
        until = time.monotonic() + seconds
        while not self.run(condition):
            if time.monotonic() > until:
                raise RuntimeError("never true: " + condition)
            time.sleep(0.05)

    def key(self, key, code="", text=""):
        """Press and release a key."""
        for kind in ("keyDown", "keyUp"):
            self._ask("Input.dispatchKeyEvent", type=kind, key=key, code=code or key,
                      **({"text": text} if text and kind == "keyDown" else {}))

    def wheel(self, x, y, delta):
        """Turn the wheel over a point."""
        self._ask("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=delta)

    def click(self, x, y):
        """Click on a point."""
        for kind in ("mousePressed", "mouseReleased"):
            self._ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def touch(self, *steps):
        """Touch with the fingers at the points of the first step, move them, and let go."""
        for i, points in enumerate(steps):
            self._ask("Input.dispatchTouchEvent", type="touchMove" if i else "touchStart",
                      touchPoints=[{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)])
        self._ask("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def picture(self, whole=False):
        """Return the page as a PNG file's bytes."""
        return base64.b64decode(self._ask("Page.captureScreenshot", format="png",
                                          captureBeyondViewport=whole)["data"])

    def print(self):
        """Return the page as a PDF file's bytes, A4."""
        return base64.b64decode(self._ask("Page.printToPDF", preferCSSPageSize=True,
                                          printBackground=True)["data"])
