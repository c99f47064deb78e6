#!/usr/bin/python3
"""An actuator of 4 poles and 6 coils in the emulated laboratory by its description alone: a guided session to the true
parameters."""

import pathlib
import shutil
import sys
import tempfile

import rospy
import rostest
from calibration_client import NAMESPACE, PACKAGE, run_tool
from emulated_lab import LabCase
from guided_program import GuidedProgram
from spherical_actuator_calibration.msg import ActuatorParameters
from true_parameters import expect_truth

OPTIONS = ("--drive-fixture", "--yes", "--poses", "8", "--dwell", "0.2", "--settling", "0.15")
OPTIONS += ("--validation-poses", "1", "--patterns", "weighing")


class SmallSession(LabCase):
    @classmethod
    def setUpClass(cls):
        drawings = tempfile.TemporaryDirectory()
        cls.addClassCleanup(drawings.cleanup)
        unit = pathlib.Path(drawings.name) / "small_4x6"
        drawing = f"{unit}.yaml"
        shutil.copy(pathlib.Path(rospy.get_param("~drawing")), drawing)
        run_tool("generate_urdf", actuator=drawing, output=f"{unit}.urdf")
        cls.make_lab(seed=5, commands=False, unit=str(unit))
        cls.start_lab()

    def test_a_whole_session(self):
        parameters = rospy.wait_for_message(f"{NAMESPACE}/parameters", ActuatorParameters)
        self.assertEqual((len(parameters.poles), len(parameters.coils)), (4, 6))
        session = GuidedProgram(*OPTIONS)
        self.assertEqual(session.wait(), 0, "\n".join(session.lines))
        self.assertTrue(session.says("all 29 parameters are identified"), session.lines)
        self.assertTrue(session.says("Grade: good."), session.lines)
        (live,) = pathlib.Path(self.lab.directory).glob("*.yaml")
        expect_truth(self, str(live), self.lab.truth)


if __name__ == "__main__":
    rospy.init_node("small_session_test")
    rostest.rosrun(PACKAGE, "small_session", SmallSession, sys.argv)
