#!/usr/bin/python3
"""examples/use_calibration as this build makes it, and the same in Python."""

import os
import sys
import unittest

from example_case import check_use_calibration, run

PROGRAM = os.environ["USE_CALIBRATION"]
SOURCE = os.environ["SOURCE"]


class UseCalibration(unittest.TestCase):
    def test_in_both_languages_the_same(self):
        script = os.path.join(SOURCE, "examples", "use_calibration.py")
        in_cpp = check_use_calibration(self, [PROGRAM], SOURCE)
        in_python = check_use_calibration(self, [sys.executable, script], SOURCE)
        self.assertEqual(in_cpp.replace("-0.0000", "0.0000"), in_python.replace("-0.0000", "0.0000"))

    def test_tells_what_it_cannot_read(self):
        result = run(PROGRAM, "no_such_file.yaml", "0", "0", "0")
        self.assertEqual(result.returncode, 2)
        self.assertIn("no_such_file.yaml", result.stderr)
        self.assertEqual(run(PROGRAM).returncode, 2)
        for word in ("abc", "0.1rad", "", "1e999"):
            result = run(PROGRAM, os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml"), "0", word, "0")
            self.assertEqual(result.returncode, 2, word)
            self.assertEqual(result.stderr, f'use_calibration: "{word}" is no joint reading: give a number of radians.\n')
        script = os.path.join(SOURCE, "examples", "use_calibration.py")
        for words in (("no_such_file.yaml", "0"), (os.path.join(SOURCE, "config", "pm_spherical_8x24.yaml"), "abc")):
            result = run(sys.executable, script, *words, "0", "0")
            self.assertEqual(result.returncode, 2)
            self.assertTrue(result.stderr.startswith("use_calibration: ") and words[-1 if words[1] == "abc" else 0] in result.stderr)


if __name__ == "__main__":
    unittest.main()
