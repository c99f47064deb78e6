#!/usr/bin/python3
"""Which coils measured currents excite, and whether they are those that were commanded."""

import unittest

from spherical_actuator_calibration.session_guide import progress


class CarriedCurrents(unittest.TestCase):
    def test_are_those_that_are_commanded(self):
        def are_carried(currents, pattern, current=2.0):
            return progress.are_carried(currents, pattern, current, 0.04, 0.1)

        self.assertTrue(are_carried([1.85, 0.03, -2.0], (1, -3)))
        self.assertTrue(are_carried([0.0, -0.03, 0.0], ()))
        self.assertFalse(are_carried([0.3, 0.0, 0.0], (1,)))  # excited, by far too little
        self.assertFalse(are_carried([2.0, 0.045, 0.0], (1,)))  # another one beside it
        self.assertFalse(are_carried([2.0, 0.0, 0.0], (-1,)))
        self.assertFalse(are_carried([2.0, 0.0, 0.0], (4,)))
        self.assertFalse(are_carried([], (1,)))
        self.assertFalse(are_carried([], ()))


class ExcitedCoils(unittest.TestCase):
    def test_are_those_that_carry_current_with_their_signs(self):
        self.assertEqual(progress.excited_coils([0.001, -0.002, 0.0], 0.05), ())
        self.assertEqual(progress.excited_coils([0.001, -0.05, 0.0], 0.05), (-2,))
        self.assertEqual(progress.excited_coils([2.0, -1.99, 0.0], 0.05), (1, -2))
        self.assertEqual(progress.excited_coils([], 0.05), ())

    def test_in_words(self):
        self.assertEqual(progress.in_words((3,)), "Coil 3")
        self.assertEqual(progress.in_words((1, -4, 12)), "Coils +1 -4 +12")


if __name__ == "__main__":
    unittest.main()
