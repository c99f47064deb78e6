#!/usr/bin/python3
"""examples/calibrate_samples as this build makes it."""

import os
import unittest

from example_case import check_calibrate_samples, run

PROGRAM = os.environ["CALIBRATE_SAMPLES"]
SOURCE = os.environ["SOURCE"]


class CalibrateSamples(unittest.TestCase):
    def test_calibrates_the_positioner(self):
        check_calibrate_samples(self, PROGRAM, SOURCE)

    def test_tells_what_it_cannot_read(self):
        description = os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml")
        result = run(PROGRAM, description, "no_such_file.yaml")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no_such_file.yaml", result.stderr)
        self.assertEqual(run(PROGRAM).returncode, 2)


if __name__ == "__main__":
    unittest.main()
