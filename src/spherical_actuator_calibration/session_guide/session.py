"""The course of a guided session."""

import math

import rospy
from spherical_actuator_calibration.srv import CapturePlannedResponse

from . import progress
from .calibration import Calibration
from .laboratory import STILL, Laboratory
from .plans import read_plan, read_session
from .progress import Progress

POLL = 0.05  # [s]
FURTHER_POSES = 2  # that are added at a time until the calibration is complete
MOST_ROUNDS = 4
SLOW = 5.0  # [s] after which the operator is told what the session waits for
# [s] without current before it is tried again: a driver whose currents deviated follows again after zero was commanded
# and measured.
PAUSE = 1.0
FIXTURE_SETTLING = 0.3  # [s] at rest before a capture
HAND_SETTLING = 3.0  # [s] a hand has to clamp the rotor
FIXTURE_TOLERANCE = 0.02  # [rad] of a fixture that has arrived


class Session:
    """Leads through one session; everything measured is with the calibration node."""

    def __init__(self, options, terminal, actuator):
        self._options = options
        self._terminal = terminal
        self._actuator = actuator
        self._tilt = actuator["workspace"]["tilt_limit"]
        self._coils = len(actuator.get("coils", []))
        self._names = [joint["name"] for joint in actuator["joints"]]
        self._current = options.current  # [A] of an excited coil
        self._plan_file = read_plan(options.plan, actuator) if options.plan else None
        self._calibration = Calibration(options.ns, terminal)
        self._laboratory = Laboratory(options.ns, self._coils, self._names)
        self._progress = None
        self._uncertainty = ""

    def run(self):
        """Returns whether all cycles succeeded and the result was saved."""
        try:
            self._calibration.wait_until_up()
            poses = self._wanted_poses()
            self._require_current(poses)
            self._measure(poses)
            is_complete = self._estimate()
            for _ in range(MOST_ROUNDS):
                if is_complete:
                    break
                self._terminal.say(f"The calibration is not complete: {FURTHER_POSES} poses are added.")
                self._measure(self._plan(FURTHER_POSES))
                is_complete = self._estimate()
            return self._conclude() and is_complete
        finally:
            self._laboratory.release()

    def _require_current(self, poses):
        least = self._calibration.status().least_current
        excited = [pattern for pose in poses for pattern in pose.excitations]
        if excited and self._current < least:
            raise RuntimeError(
                f"--current: {self._current:g} A are too little to tell a coil from one that is off: "
                f"take {least:g} A or more."
            )
        total = max((len(pattern) for pattern in excited), default=0) * self._current
        if total > self._options.total_current:
            raise RuntimeError(f"--total-current: a pattern of the plan needs {total:.1f} A.")

    # -- measuring -----------------------------------------------------------------------------------

    def _measured(self):
        return self._calibration.measured()

    def _wanted_poses(self):
        """Poses of this session, those that the node holds samples of left out or complete."""
        done = progress.poses_of(self._measured(), self._calibration.pose_tolerance())
        training = sum(not pose.validation for pose in done)
        if training:
            self._terminal.say(f"The session goes on: {training} poses are measured already.")
        planned = list(self._poses_of_files())
        if not planned and training < self._options.poses:
            planned = self._plan(self._options.poses - training)
        if any(pose.validation for pose in planned):
            return planned
        return planned + progress.validation_poses(
            self._options.validation_poses,
            self._options.coils_per_validation_pose,
            self._coils,
            0.8 * self._tilt,
            self._options.seed,
        )

    def _poses_of_files(self):
        plan = self._plan_file
        if self._options.repeat:
            threshold = self._calibration.status().current_threshold
            tolerance = self._calibration.pose_tolerance()
            plan = read_session(self._options.repeat, self._actuator, threshold, tolerance)
        if plan is None:
            return ()
        self._current = plan.current
        source = self._options.plan or self._options.repeat
        self._terminal.say(f"{len(plan.poses)} poses of {source}, coils at {plan.current:g} A.")
        return plan.poses

    def _plan(self, count):
        poses, message = self._calibration.plan(
            count,
            self._options.wanted_stddev,
            patterns=self._options.patterns,
            current=self._current,
            total_current=self._options.total_current,
        )
        self._terminal.say("Plan: " + message)
        return poses

    def _to_capture(self, pose, measured):
        return progress.patterns_to_capture(pose, measured, self._calibration.pose_tolerance())

    def _measure(self, poses):
        measured = self._measured()
        open_poses = [pose for pose in poses if self._to_capture(pose, measured)]
        captures = sum(len(self._to_capture(pose, measured)) for pose in open_poses)
        self._progress = Progress(captures, rospy.get_time)
        for number, pose in enumerate(open_poses, 1):
            self._measure_pose(pose, f"{'held-out pose' if pose.validation else 'pose'} {number} of {len(open_poses)}")
            self._look_at_the_joint()
            self._terminal.milestone(f"{self._progress.text()}  {self._uncertainty}".rstrip())
        self._laboratory.excite((), 0.0)

    def _measure_pose(self, pose, which):
        self._laboratory.excite((), 0.0)
        if self._options.drive_fixture:
            self._laboratory.drive_to(pose.joints)
        else:
            angles = zip(self._names, pose.joints)
            self._terminal.say(
                f"Turn the rotor to {which}: {', '.join(f'{name} {progress.in_degrees(q)}' for name, q in angles)}, "
                f"each within {math.degrees(self._calibration.pose_tolerance()):.1f}\N{DEGREE SIGN}, and clamp it. "
                f"After {self._settling():g} s at rest coils are excited by itself: hands off then."
            )
        self._wait_for_rest(pose)
        for pattern in self._to_capture(pose, self._measured()):
            self._capture(pose, pattern)
            self._progress.advance()
            self._show()

    def _settling(self):
        """[s] of rest before a capture."""
        if self._options.settling is not None:
            return self._options.settling
        return FIXTURE_SETTLING if self._options.drive_fixture else HAND_SETTLING

    def _wait_for_rest(self, pose):
        """Until the joint sensors see the rotor at rest at the pose. Raises RuntimeError when that takes too long."""
        begin = still_since = rospy.get_time()
        last = None
        while True:
            joints = self._laboratory.joints()
            now = rospy.get_time()
            way = None if joints is None else progress.way_to(pose, self._names, joints, self._tolerance())
            if joints is None:
                self._terminal.say_once("No joint angles arrive: check the joint sensor.")
                still_since = now
            elif last is None or max(abs(a - b) for a, b in zip(joints, last)) > STILL:
                last, still_since = joints, now
            elif now - still_since >= self._settling() and not way:
                return
            elif way and now - begin > SLOW and self._options.drive_fixture:
                self._terminal.say_once(f"The rotor is not at the pose ({way}): check fixture and joint sensor.")
            if now - begin > self._options.pose_timeout:
                raise RuntimeError(
                    f"The rotor did not come to rest at the pose in {now - begin:.0f} s "
                    f"({'no joint angles' if joints is None else way or 'it moves'}). "
                    "See to that, and start guided_session again: it goes on."
                )
            self._show("" if way is None else f"turn {way}" if way else "there: clamp the rotor")
            rospy.sleep(POLL)

    def _tolerance(self):
        """[rad] of arrival. A hand does not meet the angles as a fixture does; any pose nearby tells as much."""
        return FIXTURE_TOLERANCE if self._options.drive_fixture else self._calibration.pose_tolerance()

    def _answer_with_current(self, pose, pattern):
        """To a capture while the coils carry what is commanded. Raises RuntimeError when that takes too long."""
        begin = rospy.get_time()
        while True:
            answer = self._answer_soon(pose, pattern)
            if answer is None or answer.flaw != CapturePlannedResponse.EXCITATION:
                return answer
            waited = rospy.get_time() - begin
            complaint = self._laboratory.driver_complaint() or "it does not say why"
            if waited > self._options.current_timeout:
                raise RuntimeError(
                    f"{answer.message} After {waited:.0f} s: {complaint}. See to that, and start guided_session again."
                )
            self._terminal.say_once(f"{answer.message} The driver: {complaint}.")
            self._laboratory.excite((), 0.0)
            rospy.sleep(PAUSE)
            self._laboratory.excite(pattern, self._current)

    def _answer_soon(self, pose, pattern):
        """Answer to a capture; asked again for a moment while coils do not carry what is commanded."""
        end = rospy.get_time() + SLOW
        while True:
            answer = self._calibration.capture_planned(pose, pattern, self._current, self._options.dwell)
            is_amiss = answer is not None and answer.flaw == CapturePlannedResponse.EXCITATION
            if not is_amiss or rospy.get_time() > end:
                return answer
            rospy.sleep(POLL)

    def _capture(self, pose, pattern):
        """Captures one pattern; repeats, and says why, until a sample of it is held."""
        while True:
            self._laboratory.excite(pattern, self._current)
            rospy.sleep(min(self._settling(), 0.1))
            answer = self._answer_with_current(pose, pattern)
            if answer is None:
                if pattern and self._holds(pose, pattern):
                    return
                continue
            if answer.success:
                return
            self._terminal.say_once(answer.message)
            self._mend(answer.flaw, pose)
            rospy.sleep(POLL)

    def _holds(self, pose, pattern):
        """Whether a sample has the pattern, though its answer was lost."""
        missing = progress.missing_patterns(pose, self._measured(), self._calibration.pose_tolerance())
        return pattern not in missing

    def _mend(self, flaw, pose):
        """What is to be done about a flaw that the node tells of, beside another capture."""
        if flaw == CapturePlannedResponse.POSE:
            self._laboratory.excite((), 0.0)
            self._wait_for_rest(pose)
        elif flaw == CapturePlannedResponse.REST:
            self._capture(pose, ())

    def _look_at_the_joint(self):
        """Tells how well the joint is known so far, as soon as enough poses are measured."""
        status = self._calibration.status()
        if status.refined or "joint" not in status.next_cycles:
            return
        answer = self._calibration.run("joint")
        if answer.success:
            self._uncertainty = f"orientation ± {1e3 * answer.report.orientation_uncertainty:.2f} mrad"

    def _show(self, doing=""):
        parts = (self._progress.text(), doing, self._uncertainty)
        self._terminal.progress("  ".join(part for part in parts if part))

    # -- estimating ----------------------------------------------------------------------------------

    def _estimate(self):
        """Runs the cycles that the samples are enough for; returns whether the calibration is complete."""
        for cycle in self._calibration.status().next_cycles:
            answer = self._calibration.run(cycle)
            self._terminal.say(("" if answer.success else "Not done: ") + answer.message)
        status = self._calibration.status()
        self._terminal.say(status.grade_reason)
        return status.complete

    def _conclude(self):
        """Validates and saves; returns whether the result can be used."""
        if self._options.validation_poses:
            answer = self._calibration.call("validate", coil=0)
            self._terminal.say(answer.message)
            if not answer.success:
                self._terminal.say("Not saved: see to that, and start guided_session again, with more poses.")
                return False
        answer = self._calibration.call("save")
        self._terminal.say(answer.message)
        return answer.success
