#!/usr/bin/python3
"""Poles and coils of rotors that are off their axes by a smooth rotation, torques and all: judged by an independent
laboratory. mapped_torques_study.py is the long form."""

import unittest

import mapped_torques_study

UNITS = 6
BEND = 4e-4  # [rad], twice the noise of the tracker


class MappedTorques(unittest.TestCase):
    def test_poles_and_coils_are_found_beside_a_bend(self):
        mapped = mapped_torques_study.study(UNITS, BEND)
        self.assertEqual(mapped.refined, UNITS)
        self.assertGreater(mapped.coverage, 0.90)
        self.assertLess(mapped.coverage, 0.985)
        straight = mapped_torques_study.study(UNITS, 0.0)
        self.assertLess(mapped.rms, 1.5 * straight.rms)

    def test_without_a_map_they_are_not(self):
        unmapped = mapped_torques_study.study(UNITS, BEND, use="never")
        mapped = mapped_torques_study.study(UNITS, BEND)
        self.assertGreater(unmapped.rms, 1.2 * mapped.rms)


if __name__ == "__main__":
    unittest.main()
