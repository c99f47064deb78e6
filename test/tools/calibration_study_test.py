#!/usr/bin/python3
"""calibration_study as a cluster runs it: shards by GNU parallel, their merge, a planned session, the plot."""

import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAMS = pathlib.Path(os.environ["PROGRAMS"])
SOURCE = pathlib.Path(os.environ["SOURCE"])
ACTUATOR = SOURCE / "config" / "pm_spherical_8x24.yaml"
STUDY = ("calibration_study", "--actuator", ACTUATOR, "--trials", "10", "--threads", "1")


class CalibrationStudy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_program(self, name, *arguments, status=0):
        """Output of a program that must end with the status."""
        command = [str(argument) for argument in (PROGRAMS / name, *arguments)]
        result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=self.folder)
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def content(self, name):
        return (self.folder / name).read_bytes()

    def test_shards_of_a_job_array_merge_to_the_whole(self):
        self.run_program(*STUDY, "--output", "whole.yaml")
        command = ["parallel", "--will-cite", "-j", "2", str(PROGRAMS / STUDY[0])]
        command += [str(argument) for argument in STUDY[1:]]
        command += ["--shard", "{}/4", "--output", "{}.yaml", ":::", "1", "2", "3", "4"]
        subprocess.run(command, check=True, cwd=self.folder, stdout=subprocess.DEVNULL)
        shards = [f"{n}.yaml" for n in (3, 1, 4, 2)]
        self.run_program("calibration_study", "--merge", "--output", "merged.yaml", *shards)
        self.assertEqual(self.content("merged.yaml"), self.content("whole.yaml"))
        self.assertNotEqual(self.content("1.yaml"), self.content("whole.yaml"))

    def test_shards_of_other_contents_do_not_merge(self):
        actuator = self.folder / "actuator.yaml"
        wide = self.folder / "wide.yaml"
        wide.write_text("tolerance: {coil: 0.5}\n")
        text = ACTUATOR.read_text()
        study = ("calibration_study", "--actuator", actuator, "--trials", "2", "--threads", "1", "--force")
        for change, options in (("# another\n", ()), ("", ("--config", wide))):
            actuator.write_text(text)
            self.run_program(*study, "--shard", "1/2", "--output", "1.yaml")
            actuator.write_text(change + text)
            self.run_program(*study, *options, "--shard", "2/2", "--output", "2.yaml")
            output = self.run_program("calibration_study", "--merge", "--output", "m.yaml", "1.yaml", "2.yaml", status=2)
            self.assertIn("2.yaml: its settings are not those of 1.yaml", output)

    def test_a_shard_that_is_missing_is_named(self):
        self.run_program(*STUDY, "--shard", "1/2", "--output", "1.yaml")
        said = self.run_program("calibration_study", "--merge", "--output", "m.yaml", "1.yaml", status=2)
        self.assertIn("calibration_study: ", said)
        self.assertFalse((self.folder / "m.yaml").exists())

    def test_a_planned_session_is_studied_and_drawn(self):
        self.run_program("plan_session", "--actuator", ACTUATOR, "--tilt", "0.3", "--output", "plan.yaml")
        said = self.run_program(*STUDY, "--plan", "plan.yaml", "--tracker", "every", "--output", "s.yaml")
        self.assertIn("refinement: 10 of 10 trials converged", said)
        for plot in ("plot.png", "plot.svg"):
            subprocess.run([SOURCE / "scripts" / "plot_study", "s.yaml", plot], check=True, cwd=self.folder)
            self.assertGreater(len(self.content(plot)), 10000)

    def test_the_plot_says_what_it_cannot_read(self):
        (self.folder / "broken.yaml").write_text("study: 3\n")
        result = subprocess.run(
            [SOURCE / "scripts" / "plot_study", "broken.yaml", "plot.png"],
            check=False,
            capture_output=True,
            text=True,
            cwd=self.folder,
        )
        self.assertEqual(result.returncode, 2)
        self.assertIn("plot_study: broken.yaml", result.stderr)


if __name__ == "__main__":
    unittest.main()
