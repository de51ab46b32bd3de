"""Opens a report in headless Chromium: its script has to run to the end without an error, the
3-D view has to show both bodies with red damage, and on desks, tablets and telephones nothing may
stand beyond the right edge. Skipped where no Chromium is installed."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import zlib

CRASHRANK, SCENARIO = sys.argv[1:3]


def pixels_of(png):
    """Rows of RGB(A) bytes of an eight-bit PNG without interlace, and bytes a pixel."""
    at, data, width, channels = 8, b"", 0, 0
    while at < len(png):
        size = int.from_bytes(png[at:at + 4], "big")
        kind, body = png[at + 4:at + 8], png[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width = int.from_bytes(body[:4], "big")
            assert body[8] == 8 and body[12] == 0
            channels = {2: 3, 6: 4}[body[9]]
        if kind == b"IDAT":
            data += body
        at += 12 + size
    raw, rows, above = zlib.decompress(data), [], bytes(width * channels)
    stride = width * channels
    for start in range(0, len(raw), stride + 1):
        filtered, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            if filtered == 1:
                row[i] = (row[i] + left) & 255
            elif filtered == 2:
                row[i] = (row[i] + above[i]) & 255
            elif filtered == 3:
                row[i] = (row[i] + (left + above[i]) // 2) & 255
            elif filtered == 4:
                guess = left + above[i] - corner
                near = min((abs(guess - left), 0, left), (abs(guess - above[i]), 1, above[i]),
                           (abs(guess - corner), 2, corner))
                row[i] = (row[i] + near[2]) & 255
        rows.append(bytes(row))
        above = row
    return rows, channels


def check_width(arguments, page, width):
    """A window is never narrower than some 500 pixels; a frame in it is."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    probe = ("<script>addEventListener('load', () => { const d = document.documentElement;"
             "parent.document.title = d.scrollWidth + '/' + d.clientWidth; });</script></body>")
    inner = os.path.join(os.path.dirname(page), "inner.html")
    with open(inner, "w", encoding="utf-8") as file:
        file.write(text.replace("</body>", probe))
    outer = os.path.join(os.path.dirname(page), "outer.html")
    with open(outer, "w", encoding="utf-8") as file:
        file.write(f"<title>-</title><iframe src='inner.html' style='width:{width}px;height:900px'>"
                   "</iframe>")
    shown = subprocess.run(arguments + ["--allow-file-access-from-files", "--dump-dom",
                                        "file://" + outer],
                           capture_output=True, text=True, timeout=120, check=True)
    told = re.search(r"<title>(\d+)/(\d+)</title>", shown.stdout)
    assert told, shown.stdout[:300]
    print("width", width, "needs", told[1], "of", told[2])
    assert int(told[1]) <= int(told[2]) <= width


def main():
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which(
        "google-chrome")
    if not browser:
        print("no Chromium to open the page with")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "report.html")
        subprocess.run([CRASHRANK, "rank", SCENARIO, "--report", page], check=True,
                       stdout=subprocess.DEVNULL, timeout=60)
        with open(page, encoding="utf-8") as file:
            if "built without three.js" in file.read():
                print("crashrank was built without three.js")
                return 77
        arguments = [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--use-gl=angle",
                     "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     "--user-data-dir=" + os.path.join(folder, "profile"), "--enable-logging=stderr",
                     "--window-size=1200,1000", "--virtual-time-budget=8000"]
        shown = subprocess.run(arguments + ["--dump-dom", "file://" + page], capture_output=True,
                               text=True, timeout=120, check=True)
        assert "Uncaught" not in shown.stderr, shown.stderr
        assert 'data-view="ready"' in shown.stdout, shown.stderr
        assert "Least harmful" in shown.stdout
        for width in (1400, 820, 390):
            check_width(arguments, page, width)
        picture = os.path.join(folder, "page.png")
        subprocess.run(arguments + ["--screenshot=" + picture, "file://" + page],
                       capture_output=True, timeout=120, check=True)
        with open(picture, "rb") as file:
            rows, step = pixels_of(file.read())
        red = blue = 0
        for row in rows[200:700:2]:  # where the view stands
            for i in range(0, len(row), 2 * step):
                r, g, b = row[i], row[i + 1], row[i + 2]
                red += r > 150 and g < 60 and b < 60
                blue += b > r + 40 and b > 80
        print("damaged pixels:", red, "of the ego:", blue)
        assert red > 50 and blue > 500
    return 0


sys.exit(main())
