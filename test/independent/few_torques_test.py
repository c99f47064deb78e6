#!/usr/bin/python3
"""Sound sessions in which a coil has a single torque, or two: what they leave open is told, nothing is called identified
that is far off, and held-out samples do not contradict what they cannot judge. The seeds are those of 600 sessions where
this went wrong once."""

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

    def test_a_bent_valley_without_a_second_minimum_is_told(self):
        self.assertLess(self.outcome(38)[1], 4.5)


if __name__ == "__main__":
    unittest.main()
