#!/usr/bin/python3
"""Rules that programs in Python have beside the core: each answers as the core does (shared_rules_main.cpp)."""

import dataclasses
import json
import os
import pathlib
import re
import subprocess
import unittest

import numpy
import yaml
from spherical_actuator_calibration import bounded_links, rotor_readings, text_files
from spherical_actuator_calibration.calibrated_actuator import COIL_CURRENT
from spherical_actuator_calibration.session_guide.options import TOTAL_CURRENT, Options
from spherical_actuator_calibration.session_tables import export
from spherical_actuator_calibration.unit_identity import other_unit
from spherical_actuator_calibration.unit_quaternion import normalised

EXACT = 1e-12
SOURCE = pathlib.Path(os.environ["SOURCE"])


class SharedRules(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        told = subprocess.run([os.environ["SHARED_RULES"]], stdout=subprocess.PIPE, check=True, text=True).stdout
        cls.cases = {}
        for line in told.splitlines():
            case = json.loads(line)
            cls.cases.setdefault(case["rule"], []).append((case["given"], case["answer"]))

    def hold(self, rule, answer):
        """Exactly as the core; where it says yes or no, of both there are many."""
        cases = self.cases[rule]
        for given, expected in cases:
            with self.subTest(rule=rule, given=given):
                self.assertEqual(answer(*given), expected)
        if len(cases) > 100 and isinstance(cases[0][1], bool):
            yes = sum(expected for _, expected in cases)
            self.assertTrue(0.1 < yes / len(cases) < 0.9, f"{rule}: {yes} of {len(cases)} say yes")

    def hold_angles(self, rule, answer):
        for given, expected in self.cases[rule]:
            with self.subTest(rule=rule, given=given):
                numpy.testing.assert_allclose(answer(*given), expected, rtol=0.0, atol=EXACT)

    def test_turns_of_a_rotor_without_joints(self):
        self.hold_angles("turns_of", lambda xyzw: rotor_readings.turns_of(*xyzw))
        self.assertEqual(list(rotor_readings.TURNS), [name for _, name in self.cases["turn_name"]])

    def test_quaternions_of_rotations(self):
        def answer(rotation):
            x, y, z, w = export.quaternion(rotation)
            return numpy.array([x, y, z, w])

        for (rotation,), xyzw in self.cases["quaternion"]:
            expected = numpy.array(xyzw) * (1.0 if xyzw[3] >= 0.0 else -1.0)
            numpy.testing.assert_allclose(answer(rotation), expected, rtol=0.0, atol=EXACT)

    def test_what_is_a_unit_quaternion(self):
        self.hold("is_unit", lambda xyzw: normalised(xyzw)[0] is not None)

    def test_whose_unit_something_is(self):
        self.hold("other_unit", lambda *given: "|".join(other_unit(*given) or ()))

    def test_defaults(self):
        self.hold("default", lambda name: Options().excitation if name == "current" else getattr(Options(), name))

    def test_limits_of_what_comes_from_outside(self):
        limits = {
            "file": text_files.LARGEST,
            "description": text_files.LARGEST_DESCRIPTION,
            "configuration": text_files.LARGEST_CONFIGURATION,
            "depth": text_files.DEEPEST,
            "nodes": text_files.MOST_NODES,
            "message": bounded_links.LONGEST_MESSAGE,
            "header": bounded_links.LONGEST_HEADER,
        }
        self.hold("limit", limits.get)

    def test_actions_name_the_defaults_of_the_options(self):
        named = {}
        for action, of_field in {"Session": {}, "Plan": {}, "Capture": {"duration": "dwell"}}.items():
            goal = (SOURCE / "action" / f"{action}.action").read_text().split("---")[0]
            for field, told in re.findall(r"^\w+ (\w+) .*\b0: ([\d.]+)", goal, re.MULTILINE):
                named[action, field] = (float(told), of_field.get(field, field))
        self.assertEqual(len(named), 13, named)
        for (action, field), (told, option) in named.items():
            default = Options(drive_fixture=True)
            values = {**dataclasses.asdict(default), "current": default.excitation, "settling": default.rest}
            self.assertEqual(told, values[option], f"{field} of {action}.action")

    def test_usual_currents(self):
        controller = yaml.safe_load((SOURCE / "config" / "orientation_controller.yaml").read_text())
        for amplifier in ("coil_driver.yaml", "coil_driver_one_request.yaml"):
            self.hold("usual_current", yaml.safe_load((SOURCE / "config" / amplifier).read_text())["limits"].get)
        self.hold("usual_current", {"coil": controller["current_limit"], "total": controller["total_current_limit"]}.get)
        self.hold("usual_current", {"coil": COIL_CURRENT, "total": TOTAL_CURRENT}.get)


if __name__ == "__main__":
    unittest.main()
