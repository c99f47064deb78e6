#!/usr/bin/python3
"""When joint angles count as known, without a master."""

import unittest
from types import SimpleNamespace
from unittest import mock

from spherical_actuator_calibration import joint_readings


class JointReadings(unittest.TestCase):
    def setUp(self):
        self.now = 5.0
        for name, value in (("get_time", lambda: self.now), ("Subscriber", mock.Mock())):
            patch = mock.patch.object(joint_readings.rospy, name, value)
            patch.start()
            self.addCleanup(patch.stop)
        self.readings = joint_readings.JointReadings("/actuator", ["a", "b"])

    def receive(self, **angles):
        self.readings.keep(SimpleNamespace(name=list(angles), position=list(angles.values())))

    def test_are_in_the_order_of_the_description(self):
        self.receive(b=0.2, other=0.3, a=0.1)
        self.assertEqual(self.readings.fresh(), (0.1, 0.2))

    def test_are_none_before_any_and_of_a_part_of_the_joints(self):
        self.assertIsNone(self.readings.fresh())
        self.receive(a=0.1)
        self.assertIsNone(self.readings.fresh())

    def test_are_none_when_no_more_come(self):
        self.receive(a=0.1, b=0.2)
        self.now += joint_readings.FRESH
        self.assertEqual(self.readings.fresh(), (0.1, 0.2))
        self.now += 0.01
        self.assertIsNone(self.readings.fresh())


if __name__ == "__main__":
    unittest.main()
