#!/usr/bin/python3
"""The page of a report as a browser shows it, at the width of a desktop and of a telephone."""

import html
import json
import os
import re
import subprocess
import tempfile
import unittest

from matplotlib import image
from report_page_case import TIMEOUT, actuator_file, calibrated, read

WIDTHS = {"desktop": 1280, "phone": 390}
HEIGHT = 4000

# A window of the browser cannot be as narrow as a telephone; a frame can. The page in it tells its measures to the
# owner of the frame, which writes them to its title.
FRAME = """<!DOCTYPE html><title></title>
<script>addEventListener('message', (event) => {{ document.title = event.data; }});</script>
<iframe src="probed.html" style="width: {width}px; height: 900px; border: 0"></iframe>"""
# As of the block of linearity, which a guided session has.
LONG_NAME = "<dl class=facts><dt>Positive, from the mean of both signs</dt><dd>0.014 ± 0.024 %</dd></dl>"
PROBE = """<script>addEventListener('load', () => {
  const all = Array.from(document.body.querySelectorAll('*'));
  const wide = (node) => node.getBoundingClientRect().right > innerWidth + 1 && !node.closest('.scroll');
  parent.postMessage(JSON.stringify({
    inner: innerWidth,
    scroll: document.documentElement.scrollWidth,
    height: document.documentElement.scrollHeight,
    overflowing: all.filter(wide).map((node) => node.outerHTML.slice(0, 80)),
    cut: Array.from(document.querySelectorAll('.scroll')).filter((box) => box.scrollWidth > box.clientWidth + 1)
      .map((box) => box.getAttribute('aria-label')),
    broken: Array.from(document.images).filter((picture) => !picture.naturalWidth).length,
    narrowest: Math.min(...Array.from(document.querySelectorAll('.facts dd'), (node) => node.clientWidth)),
    smallest: Math.min(...Array.from(document.querySelectorAll('p, li, td, dd'), (node) =>
      parseFloat(getComputedStyle(node).fontSize))),
  }), '*');
});</script>"""


class ReportLayout(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        # A name without a space is what a narrow page breaks least easily.
        actuator = actuator_file(cls.folder.name, 2, "unit-" + 60 * "0")
        session = ("--joint-poses", "8", "--validation-poses", "0", "--bad-dwells", "1")
        outcome, report = calibrated(cls.folder.name, actuator, session)
        assert outcome.returncode in (0, 1), outcome.stderr
        cls.page = os.path.join(report, "report.html")
        cls.write("probed.html", read(cls.page).replace("</body>", LONG_NAME + PROBE + "</body>"))

    @classmethod
    def write(cls, name, content):
        path = os.path.join(cls.folder.name, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(content)
        return path

    def browse(self, width, page, *options):
        command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        command += ["--disable-dev-shm-usage", f"--user-data-dir={self.folder.name}/profile"]
        command += [f"--window-size={width},{HEIGHT}", "--virtual-time-budget=5000", *options, "file://" + page]
        outcome = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
        self.assertEqual(outcome.returncode, 0, outcome.stderr)
        return outcome.stdout

    def measures(self, width):
        frame = self.write("frame.html", FRAME.format(width=width))
        dom = self.browse(width + 100, frame, "--dump-dom")
        return json.loads(html.unescape(re.search(r"<title>(.*?)</title>", dom, re.DOTALL).group(1)))

    def test_nothing_is_wider_than_the_window(self):
        for name, width in WIDTHS.items():
            with self.subTest(name):
                measures = self.measures(width)
                self.assertEqual(measures["inner"], width)
                self.assertLessEqual(measures["scroll"], width)
                self.assertEqual(measures["overflowing"], [])
                self.assertEqual(measures["cut"], [])
                self.assertEqual(measures["broken"], 0)
                self.assertGreater(measures["narrowest"], 100)
                self.assertGreaterEqual(measures["smallest"], 12.0)
                self.assertGreater(measures["height"], 3000)

    def test_pictures_show_the_page(self):
        for name, width in WIDTHS.items():
            with self.subTest(name):
                path = os.path.join(self.folder.name, f"{name}.png")
                self.browse(width, self.page, f"--screenshot={path}")
                pixels = image.imread(path)[:, :, :3]
                self.assertEqual(pixels.shape[:2], (HEIGHT, width))
                # In every quarter something stands on a light ground.
                for top in range(0, HEIGHT, HEIGHT // 4):
                    quarter = pixels[top : top + HEIGHT // 4]
                    self.assertGreater(quarter.mean(), 0.85)
                    self.assertGreater((quarter.min(axis=2) < 0.5).mean(), 0.002)


if __name__ == "__main__":
    unittest.main()
