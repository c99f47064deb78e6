#!/usr/bin/python3
"""What a guided session does next, and what it tells, without ROS."""

import io
import math
import threading
import time
import unittest
from types import SimpleNamespace
from unittest import mock

import actionlib
import rospy
from spherical_actuator_calibration.msg import CoilPattern, JointAxis, PoseProgress
from spherical_actuator_calibration.session_guide import client, coil_watch, laboratory, progress
from spherical_actuator_calibration.session_guide.account import Account
from spherical_actuator_calibration.session_guide.calibration import excitations_of, message_of
from spherical_actuator_calibration.session_guide.options import OptionError, Options, parse
from spherical_actuator_calibration.session_guide.pose_course import PoseCourse
from spherical_actuator_calibration.session_guide.progress import Pose, Progress
from spherical_actuator_calibration.session_guide.task import Task
from spherical_actuator_calibration.srv import CheckCoilsResponse
from spherical_actuator_calibration.terminal import Terminal

TOLERANCE = 0.05  # [rad] of one pose
STATUS = SimpleNamespace(least_current=0.09)


class AcceptedAtOnce(unittest.TestCase):
    def test_is_heard_of_without_an_error(self):
        """By the thread of the status, before there is a handle here, as on a busy computer."""
        handle = SimpleNamespace(get_comm_state=lambda: actionlib.CommState.ACTIVE)
        threads, accepted = [], []

        def send_goal(_goal, transition, _feedback):
            threads.append(threading.Thread(target=transition, args=(handle,)))
            threads[0].start()
            threads[0].join(0.1)
            return handle

        with mock.patch("actionlib.simple_action_client.ActionClient") as sender:
            sender.return_value.send_goal = send_goal
            sender.return_value.ns = "/engine"
            goals = client.GoalClient("/engine", None)
            with mock.patch.object(rospy, "logerr") as logged:
                goals.send_goal(None, active_cb=lambda: accepted.append(True))
                threads[0].join(60.0)
        self.assertEqual((logged.call_args_list, accepted), ([], [True]))


class KnownJoint(unittest.TestCase):
    def setUp(self):
        self.joints = [JointAxis(offset_stddev=1e-4, axis_stddev=[2e-4, 3e-4]) for _ in range(3)]

    def test_is_as_good_as_its_worst_axis_or_offset(self):
        self.assertEqual(progress.joint_stddev(self.joints), 3e-4)
        self.joints[2].offset_stddev = 5e-4
        self.assertEqual(progress.joint_stddev(self.joints), 5e-4)

    def test_is_not_told_by_corrections_of_readings(self):
        self.joints[1].linear_stddev = [2e-3, math.inf, math.inf]
        self.joints[0].harmonics_stddev = [1e-3, 1e-3, math.inf, math.inf]
        self.assertEqual(progress.joint_stddev(self.joints), 3e-4)

    def test_with_a_part_that_is_not_identified_is_not_known(self):
        self.joints[0].axis_stddev[1] = math.inf
        self.assertEqual(progress.joint_stddev(self.joints), 0.0)


class Words(unittest.TestCase):
    def test_of_coils(self):
        self.assertEqual(progress.in_words((3,)), "Coil 3")
        self.assertEqual(progress.in_words((1, -4, 12)), "Coils +1 -4 +12")


class PlannedPatterns(unittest.TestCase):
    def test_without_patterns_each_coil_is_alone(self):
        self.assertEqual(excitations_of(SimpleNamespace(coils=[2, 5], patterns=[])), ((2,), (5,)))

    def test_patterns_have_their_signs(self):
        patterns = [SimpleNamespace(current=[2.0, -2.0, 0.0]), SimpleNamespace(current=[0.0, 2.0, 2.0])]
        self.assertEqual(excitations_of(SimpleNamespace(coils=[1, 2, 3], patterns=patterns)), ((1, -2), (2, 3)))


class Judge:
    """Of what coils carry, in the place of a node's service."""

    def __init__(self):
        self.asked = []
        self.answer = CheckCoilsResponse(success=True, carried=True, measured=[1.4, 0.1])

    def __call__(self, coils, current):
        self.asked.append((tuple(coils), current))
        if self.answer is None:
            raise rospy.ServiceException("gone")
        return self.answer

    def close(self):
        """Nothing is open."""


class CarriedCurrents(unittest.TestCase):
    """By what the calibration node says, of what is commanded now."""

    def setUp(self):
        self.judge = Judge()
        for target, fake in ((rospy, "ServiceProxy"), (coil_watch, "LATEST"), (coil_watch, "PERIOD")):
            value = {"ServiceProxy": lambda *_, **__: self.judge, "LATEST": 0.5, "PERIOD": 0.001}[fake]
            patch = mock.patch.object(target, fake, value)
            patch.start()
            self.addCleanup(patch.stop)
        self.watch = coil_watch.CoilWatch("/actuator")
        self.addCleanup(self.watch.end)

    def becomes(self, carried, currents, trouble=coil_watch.SILENT):
        def told():
            return self.watch.carries(), self.watch.currents(), self.watch.trouble()

        end = time.monotonic() + 30.0
        while told() != (carried, currents, trouble):
            self.assertLess(time.monotonic(), end, told())
            time.sleep(0.001)

    def test_are_those_of_the_command_in_force(self):
        self.assertIsNone(self.watch.carries())
        self.watch.begin()
        self.watch.expect((1, -3), 1.5)
        self.becomes(True, (1.4, 0.1))
        self.assertEqual(self.judge.asked[-1], ((1, -3), 1.5))
        self.judge.answer = CheckCoilsResponse(success=True, carried=False, measured=[0.0, 0.1])
        self.becomes(False, (0.0, 0.1))
        self.judge.answer = CheckCoilsResponse(message="No currents are measured.")
        self.becomes(None, (), "No currents are measured.")
        self.judge.answer = None
        self.watch.expect((2,), 1.5)
        self.assertIsNone(self.watch.carries())  # that was of another command
        self.becomes(None, (), coil_watch.SILENT)

    def test_are_not_known_any_more_at_the_end(self):
        self.watch.begin()
        self.becomes(True, (1.4, 0.1))
        self.watch.end()
        self.assertEqual((self.watch.carries(), self.watch.currents()), (None, ()))


class Excitation(unittest.TestCase):
    def test_commands_the_signs_of_a_pattern_at_once(self):
        commanded = []
        bench = laboratory.Laboratory.__new__(laboratory.Laboratory)
        bench._coils, bench._lock, bench._is_held = 4, threading.Lock(), False
        bench._is_listening, bench._watch = True, coil_watch.CoilWatch("/actuator")
        bench._commands = SimpleNamespace(publish=lambda message: commanded.append(message.current))
        bench.excite((1,), 1.5)
        self.assertEqual((bench._command, commanded), ([0.0] * 4, []))
        bench.hold()
        bench.excite((1, -3), 1.5)
        self.assertEqual(bench._command, [1.5, 0.0, -1.5, 0.0])
        bench.excite((), 0.0)
        self.assertEqual(bench._command, [0.0] * 4)
        self.assertEqual(commanded, [[1.5, 0.0, -1.5, 0.0], [0.0] * 4])

    def test_with_less_than_the_node_tells_from_none_is_refused(self):
        course = PoseCourse(SimpleNamespace(status=lambda: STATUS), None, Options(), Task(), Account())
        poses = [Pose((0.0, 0.0, 0.0), ((1,),))]
        course.current = 0.05
        with self.assertRaisesRegex(RuntimeError, "take 0.09 A or more"):
            course.require_current(poses)
        course.require_current([Pose((0.0, 0.0, 0.0), ())])
        course.current = 0.09
        course.require_current(poses)


class PatternsToCapture(unittest.TestCase):
    """By what the node says of a pose."""

    @staticmethod
    def to_capture(*missing, is_measured=False):
        patterns = [CoilPattern(coils=list(pattern)) for pattern in missing]
        return progress.patterns_to_capture(PoseProgress(is_measured=is_measured, missing=patterns))

    def test_the_one_without_current_comes_first_on_each_visit(self):
        self.assertEqual(self.to_capture((3,), (1, -7)), [(), (3,), (1, -7)])
        self.assertEqual(self.to_capture((1, -7)), [(), (1, -7)])

    def test_a_pose_without_coils_is_captured_once(self):
        self.assertEqual(self.to_capture(), [()])

    def test_of_a_measured_pose_are_none(self):
        self.assertEqual(self.to_capture(is_measured=True), [])

    def test_a_pose_is_asked_about_with_signs_and_purpose(self):
        message = message_of(Pose((0.1, -0.2, 1.5), ((3,), (1, -7)), True))
        self.assertEqual(message.joint_position, [0.1, -0.2, 1.5])
        self.assertEqual([pattern.coils for pattern in message.patterns], [[3], [1, -7]])
        self.assertTrue(message.validation)
        self.assertFalse(message_of(Pose((0.0, 0.0, 0.0), ())).validation)


class WayToAPose(unittest.TestCase):
    def test_names_the_joints_that_are_left_in_degrees(self):
        pose = Pose((0.5, -0.2, 1.5), ())
        way = progress.way_to(pose, ("a", "b", "c"), (0.0, -0.21, 2.0), TOLERANCE)
        self.assertEqual(way, "a by +28.6\N{DEGREE SIGN}, c by -28.6\N{DEGREE SIGN}")
        self.assertEqual(progress.way_to(pose, ("a", "b", "c"), (0.5, -0.16, 1.46), TOLERANCE), "")

    def test_is_the_shorter_one_round(self):
        pose = Pose((0.0, 0.0, 3.1), ())
        way = progress.way_to(pose, ("a", "b", "c"), (0.0, 0.0, -3.0), TOLERANCE)
        self.assertEqual(way, "c by -10.5\N{DEGREE SIGN}")
        self.assertEqual(progress.way_to(pose, ("a", "b", "c"), (0.0, 0.0, 3.1 - 2.0 * math.pi), TOLERANCE), "")


class Cycles(unittest.TestCase):
    def test_each_has_its_service(self):
        self.assertEqual(progress.service_of("joint"), ("calibrate_joint", 0))
        self.assertEqual(progress.service_of("poles:2"), ("calibrate_poles", 2))
        self.assertEqual(progress.service_of("coil:14"), ("calibrate_coil", 14))
        self.assertEqual(progress.service_of("refine"), ("refine", 0))


class ProgressOfASession(unittest.TestCase):
    def test_tells_the_remaining_time_from_the_rate_so_far(self):
        now = [100.0]
        done = Progress(10, lambda: now[0])
        self.assertIsNone(done.remaining_time())
        now[0] = 120.0
        done.advance(4)
        self.assertAlmostEqual(done.remaining_time(), 30.0)

    def test_as_a_bar(self):
        self.assertEqual(progress.bar(0, 10, -1.0, 10), "[..........] 0/10")
        self.assertEqual(progress.bar(4, 10, 30.0, 10), "[####......] 4/10, 30 s left")
        self.assertEqual(progress.bar(0, 0, None, 4), "[####] 0/0")

    def test_durations_are_for_people(self):
        texts = [progress.duration(seconds) for seconds in (0.4, 99.0, 200.0, 3600.0 * 2 + 300.0)]
        self.assertEqual(texts, ["0 s", "99 s", "3 min", "2 h 05 min"])


class CommandLine(unittest.TestCase):
    def test_defaults_are_those_of_the_options(self):
        self.assertEqual(parse([]), Options())
        self.assertEqual(parse(["--yes", "--plan", "p.yaml"]), Options(plan="p.yaml"))
        arguments = ["--plan", "p.yaml", "--poses", "12", "--wanted-stddev", "1e-4"]
        self.assertEqual(parse(arguments), Options(plan="p.yaml", poses=12, wanted_stddev=1e-4))

    def test_names_the_option_that_cannot_be_used(self):
        for arguments, name in (
            (["--poses", "2"], "--poses"),
            (["--current", "-1"], "--current"),
            (["--dwell", "nan"], "--dwell"),
            (["--patterns", "all"], "--patterns"),
            (["--total-current", "1.9"], "--total-current"),
            (["--ns", "actuator"], "--ns"),
            (["--pose-timeout", "0"], "--pose-timeout"),
            (["--plan", "a", "--repeat", "b"], "--repeat"),
            (["--plan", "a", "--poses", "10"], "--poses"),
            (["--repeat", "a", "--poses", "8"], "--poses"),
        ):
            with self.assertRaisesRegex(OptionError, name):
                parse(arguments)


class Screen(io.StringIO):
    def __init__(self, is_terminal):
        super().__init__()
        self._is_terminal = is_terminal

    def isatty(self):
        return self._is_terminal


class TerminalOutput(unittest.TestCase):
    def test_a_file_gets_sentences_and_milestones_only(self):
        screen = Screen(False)
        terminal = Terminal(screen)
        terminal.progress("[##..]")
        terminal.say("One.")
        terminal.say_once("One.")
        terminal.milestone("[##..] 2/4")
        self.assertEqual(screen.getvalue(), "One.\n[##..] 2/4\n")

    def test_what_goes_on_is_said_once_however_its_numbers_change(self):
        screen = Screen(False)
        terminal = Terminal(screen)
        for seconds in ("0.417", "1.2", "-3"):
            terminal.say_once(f"The stream is silent for {seconds} s.")
            terminal.say_once("The rotor moves.")
        self.assertEqual(screen.getvalue(), "The stream is silent for 0.417 s.\nThe rotor moves.\n")
        terminal.say("It is back.")
        terminal.say_once("The stream is silent for 9 s.")
        self.assertEqual(screen.getvalue().count("silent"), 2)

    def test_a_sentence_takes_the_place_of_the_progress_line(self):
        screen = Screen(True)
        terminal = Terminal(screen)
        terminal.progress("[##..]")
        terminal.say("One.")
        self.assertEqual(screen.getvalue(), "[##..]\r      \rOne.\n")


if __name__ == "__main__":
    unittest.main()
