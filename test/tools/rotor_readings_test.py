#!/usr/bin/python3
"""When readings of a rotor count as known, and what they are without joints; without a master."""

import math
import unittest
from types import SimpleNamespace
from unittest import mock

import numpy
from spherical_actuator_calibration import rotor_readings
from spherical_actuator_calibration.coil_drive.rotations import rotation_exp, rotation_of

TURNS = ((0.3, -0.5, 2.9), (-0.6, 0.6, -3.1), (0.0, 0.0, 0.0), (3.0, 1.5, -0.2))


class Readings(unittest.TestCase):
    def setUp(self):
        self.now = 5.0
        patches = {
            "get_time": lambda: self.now,
            "get_param": lambda _name, default: default,
            "Subscriber": mock.Mock(),
            "Time": SimpleNamespace(now=lambda: None),
        }
        for name, value in patches.items():
            patch = mock.patch.object(rotor_readings.rospy, name, value)
            patch.start()
            self.addCleanup(patch.stop)


class JointReadings(Readings):
    def setUp(self):
        super().setUp()
        self.readings = rotor_readings.readings_of("/actuator", {"joints": [{"name": "a"}, {"name": "b"}]})

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
        self.now += rotor_readings.FRESH
        self.assertEqual(self.readings.fresh(), (0.1, 0.2))
        self.now += 0.01
        self.assertIsNone(self.readings.fresh())

    def test_a_fixture_is_told_their_names(self):
        message = self.readings.target((0.1, 0.2))
        self.assertEqual((message.name, message.position), (["a", "b"], [0.1, 0.2]))


class OrientationReadings(Readings):
    def setUp(self):
        super().setUp()
        self.readings = rotor_readings.readings_of("/actuator", {"joints": []})

    def receive(self, x, y, z, w):
        self.readings.keep(SimpleNamespace(quaternion=SimpleNamespace(x=x, y=y, z=z, w=w)))

    def test_are_turns_about_x_then_y_then_z(self):
        for turns in TURNS:
            message = self.readings.target(turns)
            expected = numpy.eye(3)
            for axis, turn in zip(numpy.eye(3), turns):
                expected = expected @ rotation_exp(turn * axis)
            self.assertLess(abs(rotation_of(message.quaternion) - expected).max(), 1e-14)
            q = message.quaternion
            for sign in (1.0, -1.0):
                self.receive(sign * q.x, sign * q.y, sign * q.z, sign * q.w)
                self.assertLess(max(abs(a - b) for a, b in zip(self.readings.fresh(), turns)), 1e-14)

    def test_at_a_quarter_turn_about_y_the_orientation_is_right(self):
        message = self.readings.target((0.4, 0.5 * math.pi, 0.3))
        q = message.quaternion
        again = self.readings.target(rotor_readings.turns_of(q.x, q.y, q.z, q.w))
        difference = rotation_of(again.quaternion) - rotation_of(q)
        self.assertLess(abs(difference).max(), 1e-7)

    def test_are_none_of_what_is_no_unit_quaternion(self):
        self.receive(0.0, 0.0, 0.0, 1.1)
        self.receive(math.nan, 0.0, 0.0, 1.0)
        self.assertIsNone(self.readings.fresh())
        self.receive(0.0, 0.0, 0.0, 1.0005)
        self.assertEqual(self.readings.fresh(), (0.0, 0.0, 0.0))

    def test_a_fixture_is_told_the_frame_of_the_stator(self):
        self.assertEqual(self.readings.target((0.0, 0.0, 0.0)).header.frame_id, "stator")


if __name__ == "__main__":
    unittest.main()
