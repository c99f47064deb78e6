#!/usr/bin/python3
"""Units far off their drawing, and any kinematics: what comes out is right, or it is told. The short form of two studies."""

import unittest

import kinematics_study
import wide_errors_study

# Of the first 200, those that once ended silently wrong: coils that one torque or two tell, in another place that fits
# as well, on the other side of the curve's peak or far off.
ONCE_SILENT = (13, 23, 35, 47, 83, 183, 187, 199)


class RightOrTold(unittest.TestCase):
    def test_units_off_by_150_mrad(self):
        counts, lines = wide_errors_study.study(0.15, ONCE_SILENT)
        self.assertEqual(counts["silent"], 0, lines)
        self.assertGreaterEqual(counts["right"], len(ONCE_SILENT) - 1, lines)

    def test_units_off_by_200_mrad(self):
        counts, lines = wide_errors_study.study(0.2, range(4))
        self.assertEqual(counts["silent"], 0, lines)

    def test_kinematics_with_parallel_axes(self):
        tallies, lines = kinematics_study.study(30)
        self.assertEqual(sum(tally.counts["wrong"] for tally in tallies.values()), 0, lines)
        self.assertGreaterEqual(sum(tally.counts["done"] for tally in tallies.values()), 29, lines)
        self.assertLess(kinematics_study.pooled_error(tallies)[0], 1.15)


if __name__ == "__main__":
    unittest.main()
