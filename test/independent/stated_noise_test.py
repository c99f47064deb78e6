#!/usr/bin/python3
"""A session whose samples state another noise than they have is not called good for its parameters, and the sensor is
named; one that states it as it is has no such doubt. The short form of grade_study.py."""

import unittest

import grade_study

SEEDS = range(6)


class StatedNoise(unittest.TestCase):
    def told(self, kind, words):
        """Of the sessions, those whose grade names the sensor, and the reasons."""
        result = grade_study.study(kind, SEEDS)
        return sum(words in reason for reason in result.reasons), result

    def test_noise_as_stated_raises_no_doubt(self):
        count, result = self.told("sound", "scatter by")
        self.assertEqual(count, 0, result.reasons)
        self.assertGreaterEqual(result.good(), 2, result.reasons)

    def test_orientations_with_twice_their_noise(self):
        count, result = self.told("orientation_noise_2", " times what their samples state (by chance")
        self.assertGreaterEqual(count, 2, result.reasons)
        self.assertLessEqual(result.good(), 1, result.reasons)

    def test_orientations_with_a_third_of_their_noise(self):
        count, result = self.told("orientation_noise_third", "the orientations scatter by only 0.3")
        self.assertGreaterEqual(count, 2, result.reasons)
        self.assertEqual(result.good(), 0, result.reasons)


if __name__ == "__main__":
    unittest.main()
