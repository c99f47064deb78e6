#!/usr/bin/python3
"""Small single mistakes, copies and outliers: never a wrong "good", and sound sessions are left in peace. The short form of
small_effects_study.py."""

import unittest

import small_effects_study

SESSIONS = range(6)  # two of each geometry


class SmallEffects(unittest.TestCase):
    def study(self, kind):
        return small_effects_study.study(kind, SESSIONS)

    def check_found(self, kind, least):
        result = self.study(kind)
        self.assertGreaterEqual(result.found, least, result.grades)
        self.assertEqual(result.beyond(), 0, result.blamed)

    def check_copies(self, kind):
        result = self.study(kind)
        self.assertEqual(result.found, len(SESSIONS), result.grades)
        self.assertGreaterEqual(result.good, len(SESSIONS) - 2, result.blamed)
        self.assertGreater(result.coverage(), 0.90)
        self.assertTrue(all("repeat an earlier sample" in line for line in result.blamed), result.blamed)

    def test_sound_sessions_are_not_blamed(self):
        result = self.study("sound")
        self.assertEqual(result.found, 0, result.blamed)
        self.assertGreater(result.coverage(), 0.90)

    def test_torque_frame_that_is_stated_exact_and_is_not(self):
        self.check_found("torque_frame", len(SESSIONS))

    def test_marker_bumped_in_the_middle(self):
        self.check_found("marker_bumped", 4)

    def test_joint_sensor_that_jumps(self):
        self.check_found("joint_jumps", len(SESSIONS))

    def test_rows_that_are_doubled_count_once(self):
        self.check_copies("rows_doubled")

    def test_a_recording_that_is_taken_four_times_counts_once(self):
        self.check_copies("replayed")

    def test_one_orientation_beside_each_torque_counts_once(self):
        self.check_copies("orientation_repeated")

    def test_honest_outliers_among_held_out_samples_do_not_condemn(self):
        result = self.study("outliers_5")
        self.assertNotIn("contradicted", result.grades, result.blamed)
        self.assertEqual(result.beyond(), 0)


if __name__ == "__main__":
    unittest.main()
