#!/usr/bin/python3
"""The paper study as a reader meets it: results, tables beside the paper's values, every figure, one page."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import yaml

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
SOURCE = pathlib.Path(os.environ["SOURCE"])
sys.path.insert(0, str(SOURCE / "study"))
from paper_page import comparison  # noqa: E402

SEEDS = 12
FIGURES = 10
SMALLEST_PICTURE = 5000  # [bytes]


class PaperStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.results = pathlib.Path(cls.folder.name) / "study.yaml"
        cls.page = pathlib.Path(cls.folder.name) / "page"
        cls.run_study("--output", str(cls.results))
        subprocess.run(
            [
                SOURCE / "study/render_paper_study",
                cls.results,
                SOURCE / "config/paper/published_values.yaml",
                cls.page,
            ],
            check=True,
        )
        cls.study = yaml.safe_load(cls.results.read_text())
        cls.tables = (cls.page / "tables.txt").read_text()

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_study(cls, *arguments, check=True):
        return subprocess.run(
            [
                PROGRAMS / "paper_study",
                "--actuator",
                SOURCE / "config/pm_spherical_8x24.yaml",
                "--truth",
                SOURCE / "config/paper/true_actuator.yaml",
                "--seeds",
                str(SEEDS),
                *arguments,
            ],
            check=check,
            stderr=subprocess.PIPE,
            text=True,
        )

    def test_figure_14_before_and_after(self):
        errors = {(run["model"], run["loaded"]): run for run in self.study["control"]}
        self.assertAlmostEqual(errors["nominal", False]["final_error"], 0.060, delta=0.002)
        self.assertLess(errors["both_levels", False]["largest_error"], 1e-4)
        self.assertAlmostEqual(errors["nominal", True]["largest_error"], 0.090, delta=0.003)
        self.assertAlmostEqual(errors["level_1", True]["largest_error"], 0.018, delta=0.003)
        self.assertLess(errors["both_levels", True]["largest_error"], 1e-4)

    def test_tables_stand_beside_the_papers_values(self):
        for part in (
            "Table 4: Δω₁; Δω₂; Δω₃ after iteration 4",
            "-0.000620 -0.015700 0.031410",
            "Table 5: pole_8/azimuth",
            "Figure 7: iterations to full recovery",
            "Situation 2: iterations",
            "Figure 14: rotation error, nominal",
        ):
            self.assertIn(part, self.tables)

    def test_judgements_follow_from_the_numbers(self):
        self.assertEqual(comparison.iterations_verdict({3: 7, 4: 193}, "3 to 4"), "agrees in 200 of 200")
        self.assertEqual(comparison.iterations_verdict({4: 124, 5: 37, 8: 2}, 8), "fewer in 161 of 163")
        self.assertEqual(comparison.iterations_verdict({6: 9, 4: 1}, "4 to 5"), "more in 9 of 10")
        self.assertEqual(comparison.iterations_verdict({}, 8), "not shown")
        # Minimum, median and maximum of iterations 2 to 4.
        for printed, chord, newton, verdict in (
            (7e-5, (2e-5, 4e-5, 2e-4), (2e-7, 1e-6, 8e-6), "inside the chord method's spread, outside Newton's"),
            (2e-6, (2e-5, 4e-5, 2e-4), (2e-7, 1e-6, 8e-6), "inside Newton's spread, outside the chord method's"),
            (1e-6, (4e-7, 2e-6, 1e-5), (1e-14, 5e-13, 1e-11), "inside the chord method's spread, outside Newton's"),
            (0.0, (2e-8, 9e-8, 1e-6), (0.0, 4e-16, 1e-15), "inside both spreads: tells neither method"),
            (1e-3, (2e-5, 4e-5, 2e-4), (2e-7, 1e-6, 8e-6), "outside both spreads"),
        ):
            spreads = [(s[0], s[0], s[1], s[2], s[2]) for s in (chord, newton)]
            self.assertEqual(comparison.method_of(printed, *spreads), verdict)
        self.assertEqual(comparison.agrees_as_printed(0.06, 0.0613), "agrees to its last digit")
        self.assertEqual(comparison.agrees_as_printed(0, 0.0051), "differs")
        self.assertEqual(comparison.left_open(157, 200), "43 of 200 leave some open")
        self.assertEqual(comparison.left_open(200, 200), "all do")
        self.assertEqual(comparison.plotted_as([0.011, 0.027], 6.3e-4), "a mean square, without the root")
        self.assertEqual(comparison.plotted_as([0.011, 0.027], 0.02), "a root mean square")
        self.assertEqual(comparison.plotted_as([0.011, 0.027], 0.1), "neither a mean square of ours nor a root")
        self.assertRegex(self.tables, r"Situation 1: iterations .* fewer in \d+ of \d+")

    def test_every_figure_is_drawn_and_in_the_page(self):
        pictures = sorted(self.page.glob("figure_*.png"))
        self.assertEqual(len(pictures), FIGURES)
        self.assertEqual(len(list(self.page.glob("figure_*.svg"))), FIGURES)
        for picture in pictures:
            self.assertGreater(picture.stat().st_size, SMALLEST_PICTURE, picture.name)
        page = (self.page / "paper_study.html").read_text()
        self.assertEqual(page.count('<img src="data:image/png;base64,'), FIGURES)
        self.assertNotIn("http", page)

    def test_the_same_seeds_give_the_same_bytes(self):
        again = self.results.with_name("again.yaml")
        self.run_study("--output", str(again))
        self.assertEqual(again.read_bytes(), self.results.read_bytes())

    def test_refuses_to_overwrite(self):
        answer = self.run_study("--output", str(self.results), check=False)
        self.assertEqual(answer.returncode, 2)
        self.assertIn("study.yaml", answer.stderr)


if __name__ == "__main__":
    unittest.main()
