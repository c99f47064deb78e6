#!/usr/bin/python3
"""What is told when a drive by the coils ends by a fault."""

import unittest
from unittest import mock

from spherical_actuator_calibration.coil_drive.drive import CoilDrive


class Stop(unittest.TestCase):
    def stopped(self, fixture):
        """What is raised after a reason, by a drive whose services have gone."""
        drive = CoilDrive.__new__(CoilDrive)
        services = []

        def gone(service, value, _patience):
            services.append((service, value))
            raise RuntimeError(f"{service} does not answer")

        with mock.patch.object(drive, "_set", gone, create=True), self.assertRaises(RuntimeError) as raised:
            drive.stop_after(fixture, RuntimeError("The controller is silent."))
        self.assertIn(("orientation_controller/enable", False), services)
        return str(raised.exception)

    def test_the_reason_is_told_and_not_what_fails_because_of_it(self):
        self.assertEqual(self.stopped("lab_emulator"), "The controller is silent.")

    def test_a_rotor_that_nothing_holds_is_told(self):
        self.assertIn("keep away until it rests", self.stopped(""))


if __name__ == "__main__":
    unittest.main()
