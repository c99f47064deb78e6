#!/usr/bin/python3
"""Sessions in which a coil has a single torque, or two: what they leave open is told, nothing is called identified that is
far off, and held-out samples do not contradict what they cannot judge. And sessions of few poses: none is called good
whose samples would not show a usual mistake. The seeds are those where this went wrong once."""

import unittest

import grade_study
import numpy as np


class FewTorques(unittest.TestCase):
    def outcome(self, seed):
        """Its grade, and the largest error over the stated uncertainty of what counts as identified."""
        result = grade_study.study("sound", [seed])
        (grade,) = result.grades
        return grade, np.max(np.abs(result.every[0]))

    def test_coils_with_another_place_are_not_held_against_the_session(self):
        for seed in (291, 399):
            self.assertEqual(self.outcome(seed)[0], "usable", seed)

    def test_coils_that_are_known_roughly_are_not_held_against_the_session(self):
        for seed in (32, 167):
            self.assertEqual(self.outcome(seed)[0], "usable", seed)

    def test_places_on_both_sides_of_the_peak_are_told(self):
        for seed in (104, 386, 451):
            grade, most = self.outcome(seed)
            self.assertEqual(grade, "usable", seed)
            self.assertLess(most, 4.5, seed)

    def test_a_weak_coil_that_loses_all_torques_but_one_is_not_good(self):
        for seed in (6, 16):
            (reason,) = grade_study.study("coil_20", [seed]).reasons
            self.assertIn("were left out as outliers, and the rest fits", reason)


class FewPoses(unittest.TestCase):
    def test_ten_poses_do_not_show_a_turned_torque_frame(self):
        for seed in (0, 1):
            (reason,) = grade_study.study("sound", [seed], 10, 12).reasons
            self.assertIn("torque_registration of 1 mrad would not show in so few samples", reason)

    def test_twenty_four_do(self):
        result = grade_study.study("sound", range(3), 24, 9)
        self.assertEqual(result.good(), 3, result.reasons)


if __name__ == "__main__":
    unittest.main()
