#!/usr/bin/python3
"""What a guided session waits for and captures at a pose, without ROS."""

import itertools
import unittest
from types import SimpleNamespace

from spherical_actuator_calibration.msg import CoilPattern, PoseProgress
from spherical_actuator_calibration.session_guide.account import Account
from spherical_actuator_calibration.session_guide.options import OptionError, Options
from spherical_actuator_calibration.session_guide.pose_course import PoseCourse
from spherical_actuator_calibration.session_guide.progress import Measured, Pose
from spherical_actuator_calibration.session_guide.task import Task
from spherical_actuator_calibration.srv import CapturePlannedResponse

POSE = Pose((0.1, 0.0, 0.0), ((3,),))


class Coils:
    """Of a laboratory whose driver follows again once it was commanded zero for a while, if at all, and the node that
    looks at them."""

    def __init__(self, clock, cured_at, needs_zero):
        self._clock = clock
        self._cured_at = cured_at
        self._needs_zero = needs_zero
        self._pattern = (3,)

    def excite(self, pattern, _current):
        self._pattern = pattern
        if not pattern and self._clock[0] >= self._cured_at:
            self._needs_zero = False

    def capture_planned(self, _pose, pattern, _current, _duration):
        assert pattern == self._pattern == (3,)
        if self._clock[0] >= self._cured_at and not self._needs_zero:
            return SimpleNamespace(flaw="", message="Stored.")
        message = "Coil 3 does not carry its current: check the amplifier."
        return SimpleNamespace(flaw=CapturePlannedResponse.EXCITATION, message=message)

    @staticmethod
    def driver_complaint():
        return "coil 3 carries 0.00 A"


class Hour(Task):
    """A task whose time passes only while it waits."""

    def __init__(self, clock):
        super().__init__()
        self._clock = clock

    def time(self):
        return self._clock[0]

    def pause(self, seconds):
        self._clock[0] += seconds
        self.check()


class Trembling:
    """A rotor at a pose, whose readings are noisy, and the node that says how far they may be apart."""

    names, quantity, device = ["joint_1", "joint_2", "joint_3"], "joint angles", "joint sensor"

    def __init__(self, noise, rest_spread):
        self._noise = noise
        self._status = SimpleNamespace(rest_spread=rest_spread)
        self.readings = self

    def fresh(self):
        self._noise = -self._noise
        return (0.1 + self._noise, 0.0, 0.0)

    def status(self):
        return self._status

    @staticmethod
    def pose_tolerance():
        return 0.05


class WaitingForRest(unittest.TestCase):
    def waited(self, **rotor):
        clock, rotor = [0.0], Trembling(**rotor)
        PoseCourse(rotor, rotor, Options(pose_timeout=60.0), Hour(clock), Account()).wait_for_rest(POSE)
        return clock[0]

    def test_goes_by_what_the_node_calls_rest(self):
        self.assertLess(self.waited(noise=1e-3, rest_spread=3e-3), 10.0)
        self.assertLess(self.waited(noise=1e-2, rest_spread=3e-2), 10.0)
        with self.assertRaisesRegex(RuntimeError, "it moves"):
            self.waited(noise=1e-2, rest_spread=3e-3)


class Deaf(Trembling):
    """A rotor in a fixture that has not heard where to go."""

    def __init__(self):
        super().__init__(noise=0.0, rest_spread=3e-3)
        self._joints = (0.4, 0.0, 0.0)

    def fresh(self):
        return self._joints

    def drive_to(self, joints):
        self._joints = joints


class WaitingForAFixture(unittest.TestCase):
    def test_tells_it_its_pose_again_where_it_rests_elsewhere(self):
        clock, rotor = [0.0], Deaf()
        options = Options(pose_timeout=60.0, drive_fixture=True)
        PoseCourse(rotor, rotor, options, Hour(clock), Account()).wait_for_rest(POSE)
        self.assertLess(clock[0], 10.0)


class WaitingForCurrent(unittest.TestCase):
    def waited(self, cured_at, needs_zero=False, timeout=60.0):
        """Time [s] until the coils carried current, and what was said meanwhile."""
        clock = [0.0]
        account = Account()
        coils = Coils(clock, cured_at, needs_zero)
        course = PoseCourse(coils, coils, Options(current_timeout=timeout), Hour(clock), account)
        try:
            self.assertEqual(course._answer_with_current(POSE, (3,)).message, "Stored.")
        except RuntimeError as error:
            return clock[0], str(error)
        return clock[0], "\n".join([*account.message().sentences, ""])

    def test_says_nothing_of_a_moment(self):
        waited, said = self.waited(0.5)
        self.assertLess(waited, 1.0)
        self.assertEqual(said.strip(), "")

    def test_tells_once_why_and_goes_on(self):
        waited, said = self.waited(30.0)
        self.assertLess(waited, 40.0)
        self.assertEqual(said.count("\n"), 1)
        self.assertIn("Coil 3 does not carry its current: check the amplifier. The driver: ", said)
        self.assertIn("coil 3 carries 0.00 A", said)

    def test_commands_the_zero_that_a_driver_in_fault_waits_for(self):
        waited, _ = self.waited(0.0, needs_zero=True)
        self.assertLess(waited, 10.0)

    def test_ends_and_tells_why_after_its_time(self):
        waited, said = self.waited(1e9, timeout=60.0)
        self.assertGreater(waited, 60.0)
        self.assertLess(waited, 75.0)
        self.assertIn("coil 3 carries 0.00 A. See to that", said)


class Bench:
    """A calibration node and its laboratory at one pose; `flaws` are what the node says of each capture."""

    def __init__(self, flaws):
        self._flaws = iter(flaws)
        self.pattern = ()
        self.held = []
        self.log = []
        self.loses = False  # the sample, too, where an answer is lost

    def excite(self, pattern, _current):
        self.pattern = pattern

    def capture_planned(self, pose, pattern, _current, _duration):
        assert pose is POSE and pattern == self.pattern
        flaw = next(self._flaws)
        self.log.append(pattern)
        if not flaw and not (flaw is None and self.loses):
            self.held.append(Measured(1, pattern, pose.validation))
        if flaw is None:
            return None
        return SimpleNamespace(success=not flaw, message=f"Flaw: {flaw}.", flaw=flaw, sample=(pose, pattern))

    def progress_of(self, poses):
        """What is missing of the pose, by what is held now."""
        held = {sample.pattern for sample in self.held}
        missing = [CoilPattern(coils=list(pattern)) for pattern in POSE.excitations if pattern not in held]
        return [PoseProgress(is_measured=not missing and bool(held), missing=missing) for _ in poses]


class DurationOfACapture(unittest.TestCase):
    def test_is_one_that_the_node_takes(self):
        node = SimpleNamespace(status=lambda: SimpleNamespace(shortest_capture=0.2, longest_capture=60.0))
        for dwell in (0.2, 60.0):
            PoseCourse(node, node, Options(dwell=dwell), Hour([0.0]), Account()).require_dwell()
        for dwell in (0.1, 61.0):
            with self.assertRaisesRegex(OptionError, "^dwell: .* takes 0.2 to 60 s"):
                PoseCourse(node, node, Options(dwell=dwell), Hour([0.0]), Account()).require_dwell()


class CapturingAPose(unittest.TestCase):
    def captured(self, flaws):
        """The bench after a pose, and what was said."""
        bench, account = Bench(flaws), Account()
        course = PoseCourse(bench, bench, Options(), Hour([0.0]), account)
        course.wait_for_rest = lambda pose: bench.log.append("rest" if not bench.pattern else "current is on")
        (patterns,) = course.to_capture([POSE])
        for pattern in patterns:
            course.capture(POSE, pattern)
        return bench, "\n".join(account.message().sentences)

    def test_in_one_rest(self):
        bench, said = self.captured(["", ""])
        self.assertEqual(bench.log, [(), (3,)])
        self.assertEqual(said, "")

    def test_after_an_interrupted_rest_that_without_current_is_captured_anew(self):
        bench, said = self.captured(["", CapturePlannedResponse.REST, "", ""])
        self.assertEqual(bench.log, [(), (3,), (), (3,)])
        self.assertIn("Flaw: rest.", said)

    def test_a_rotor_that_has_left_is_waited_for(self):
        bench, said = self.captured(["", CapturePlannedResponse.POSE, ""])
        self.assertEqual(bench.log, [(), (3,), "rest", (3,)])
        self.assertIn("Flaw: pose.", said)

    def test_another_flaw_asks_for_another_capture(self):
        for flaw in (CapturePlannedResponse.CURRENTS, CapturePlannedResponse.TORQUE, CapturePlannedResponse.ORIENTATION):
            bench, _ = self.captured(["", flaw, ""])
            self.assertEqual(bench.log, [(), (3,), (3,)])

    def test_what_is_refused_again_and_again_ends_and_tells_why(self):
        clock, bench = [0.0], Bench(itertools.repeat("orientation"))
        course = PoseCourse(bench, bench, Options(current_timeout=20.0, pose_timeout=60.0), Hour(clock), Account())
        with self.assertRaisesRegex(RuntimeError, r"Flaw: orientation\. It is so for 2\d s\. See to that, and start again"):
            course.capture(POSE, (3,))
        clock[0] = 0.0
        with self.assertRaisesRegex(RuntimeError, r"It is so for 6\d s"):
            course.capture(POSE, ())

    def test_a_rest_that_ends_whenever_current_flows_ends_it_too(self):
        clock, bench = [0.0], Bench(itertools.cycle([CapturePlannedResponse.REST, ""]))
        course = PoseCourse(bench, bench, Options(current_timeout=20.0), Hour(clock), Account())
        with self.assertRaisesRegex(RuntimeError, r"Flaw: rest\. It is so for 2\d s"):
            course.capture(POSE, (3,))

    def test_the_time_that_a_hand_needs_is_none_of_a_refusal(self):
        clock, bench = [0.0], Bench(["pose", "orientation", ""])
        course = PoseCourse(bench, bench, Options(current_timeout=20.0), Hour(clock), Account())

        def wait_for_hand(_pose):
            clock[0] += 500.0

        course.wait_for_rest = wait_for_hand
        course.capture(POSE, (3,))
        self.assertEqual(bench.log, [(3,)] * 3)

    def test_a_sample_whose_answer_was_lost_counts(self):
        bench, _ = self.captured(["", None])
        self.assertEqual(bench.log, [(), (3,)])

    def test_what_the_answer_was_lost_of_is_captured_anew_where_no_sample_has_it(self):
        bench, account = Bench([None, ""]), Account()
        bench.loses = True
        PoseCourse(bench, bench, Options(), Hour([0.0]), account).capture(POSE, (3,))
        self.assertEqual(bench.log, [(3,), (3,)])


if __name__ == "__main__":
    unittest.main()
