"""The course of a guided session."""

import rospy

from . import progress
from .calibration import Calibration
from .laboratory import STILL, Laboratory
from .progress import Progress

POLL = 0.05  # [s]
# Times as long without current as with it: all torques of a pose share the bias that is measured then.
ZERO_CAPTURE = 3.0
FURTHER_POSES = 2  # that are added at a time where parameters stay open
MOST_ROUNDS = 4
SLOW = 5.0  # [s] after which the operator is told what the session waits for
# [s] without current before it is tried again: a driver whose currents deviated follows again after zero was commanded
# and measured.
PAUSE = 1.0


class Session:
    """Leads through one session; everything measured is with the calibration node."""

    def __init__(self, options, terminal, actuator):
        self._options = options
        self._terminal = terminal
        self._tilt = actuator["workspace"]["tilt_limit"]
        self._coils = len(actuator.get("coils", []))
        names = [joint["name"] for joint in actuator["joints"]]
        self._calibration = Calibration(options.ns, terminal)
        self._laboratory = Laboratory(options.ns, self._coils, names)
        self._progress = None
        self._uncertainty = ""

    def run(self):
        """Returns whether all cycles succeeded and the result was saved."""
        try:
            self._calibration.wait_until_up()
            self._require_current()
            self._measure(self._planned_poses())
            is_complete = self._estimate()
            for _ in range(MOST_ROUNDS):
                if is_complete:
                    break
                self._terminal.say(f"Parameters stay open: {FURTHER_POSES} poses are added.")
                self._measure(self._plan(FURTHER_POSES))
                is_complete = self._estimate()
            return self._conclude() and is_complete
        finally:
            self._laboratory.release()

    def _require_current(self):
        threshold = self._calibration.status().current_threshold
        if self._coils and self._options.current < threshold:
            raise RuntimeError(f"--current: below {threshold} A a coil counts as off.")

    # -- measuring -----------------------------------------------------------------------------------

    def _measured(self):
        return self._calibration.measured()

    def _planned_poses(self):
        """Poses that are still to be measured, after those that the node holds."""
        done = progress.poses_of(self._measured())
        training = sum(not pose.validation for pose in done)
        planned = []
        if training:
            self._terminal.say(f"The session goes on: {training} poses are measured already.")
        if training < self._options.poses:
            left = self._options.poses - training
            planned = self._plan(left)
        validation = progress.validation_poses(
            self._options.validation_poses,
            self._options.coils_per_validation_pose,
            self._coils,
            0.8 * self._tilt,
            self._options.seed,
        )
        return planned + validation

    def _plan(self, count):
        poses, message = self._calibration.plan(
            count,
            self._options.wanted_stddev,
            patterns=self._options.patterns,
            current=self._options.current,
            total_current=self._options.total_current,
        )
        self._terminal.say("Plan: " + message)
        return poses

    def _measure(self, poses):
        measured = self._measured()
        open_poses = [pose for pose in poses if progress.missing_patterns(pose, measured)]
        captures = sum(len(progress.missing_patterns(pose, measured)) for pose in open_poses)
        self._progress = Progress(captures, rospy.get_time)
        for number, pose in enumerate(open_poses, 1):
            self._measure_pose(pose, number, len(open_poses))
            self._look_at_the_joint()
        self._laboratory.excite((), 0.0)

    def _measure_pose(self, pose, number, count):
        self._laboratory.excite((), 0.0)
        angles = ", ".join(f"{angle:.2f}" for angle in pose.joints)
        kind = "held-out pose" if pose.validation else "pose"
        if self._options.drive_fixture:
            self._laboratory.drive_to(pose.joints)
        else:
            self._terminal.ask(f"Turn the rotor to {kind} {number} of {count}: joints {angles} rad.")
        self._wait_for_rest(pose, angles)
        for pattern in progress.missing_patterns(pose, self._measured()):
            self._capture(pose, pattern)
            self._progress.advance()
            self._show()

    def _wait_for_rest(self, pose, angles):
        """Until the joint sensors see the rotor at rest at the pose."""
        begin = still_since = rospy.get_time()
        last = None
        while True:
            joints = self._laboratory.joints()
            now = rospy.get_time()
            if joints is None:
                self._terminal.say_once("No joint angles arrive: check the joint sensor.")
                still_since = now
            elif last is None or max(abs(a - b) for a, b in zip(joints, last)) > STILL:
                last, still_since = joints, now
            elif now - still_since >= self._options.settling and self._is_there(pose, joints):
                return
            elif now - begin > SLOW:
                seen = ", ".join(f"{angle:.2f}" for angle in joints)
                self._terminal.say_once(
                    f"The rotor is at joints {seen} rad, not at {angles}: check fixture and joint sensor."
                )
                begin = now
            self._show()
            rospy.sleep(POLL)

    def _is_there(self, pose, joints):
        # A hand does not meet the angles as a fixture does; any pose nearby tells as much.
        tolerance = progress.SAME_POSE if self._options.drive_fixture else 0.1
        return pose.is_at(joints, tolerance)

    def _wait_for_current(self, pattern):
        """Until the coils carry what is commanded. Raises RuntimeError when that takes too long."""
        begin = rospy.get_time()
        while not self._has_current():
            waited = rospy.get_time() - begin
            what = "A coil carries current"
            if pattern:
                verb = "does not carry its current" if len(pattern) == 1 else "do not carry their currents"
                what = f"{progress.in_words(pattern)} {verb}"
            complaint = self._laboratory.driver_complaint() or "the coil driver does not say why"
            if waited > self._options.current_timeout:
                raise RuntimeError(
                    f"{what}, after {waited:.0f} s: {complaint}. See to that, and start guided_session again."
                )
            self._terminal.say_once(
                f"{what}: check the amplifier (tripped?) and the coil driver ({complaint})."
            )
            self._laboratory.excite((), 0.0)
            rospy.sleep(PAUSE)
            self._laboratory.excite(pattern, self._options.current)

    def _has_current(self):
        """Whether the coils carry what is commanded, soon."""
        end = rospy.get_time() + SLOW
        while not self._laboratory.is_excited():
            if rospy.get_time() > end:
                return False
            rospy.sleep(POLL)
        return True

    def _capture(self, pose, pattern):
        """Captures one pattern; repeats, and says why, until it is held."""
        self._laboratory.excite(pattern, self._options.current)
        duration = self._options.dwell * (1.0 if pattern else ZERO_CAPTURE)
        while True:
            self._wait_for_current(pattern)
            rospy.sleep(min(self._options.settling, 0.1))
            answer = self._calibration.capture(duration, pose.validation)
            if answer is None:
                if pattern not in progress.missing_patterns(pose, self._measured()):
                    return
                continue
            if not answer.success:
                self._terminal.say_once(answer.message)
                rospy.sleep(POLL)
                continue
            if self._is_useful(answer.sample, pattern):
                return
            self._calibration.call("remove_sample", id=answer.sample.id)

    def _is_useful(self, sample, pattern):
        """Whether a sample holds what it was made for; says what it lacks."""
        if not sample.has_orientation:
            self._terminal.say_once("The sample has no orientation: check the tracker.")
            return False
        if self._calibration.pattern_of(sample) != pattern:
            self._terminal.say_once("The currents changed during the capture: check the amplifier.")
            return False
        if pattern and not sample.has_torque:
            self._terminal.say_once("The sample has no torque: check the force/torque sensor.")
            return False
        return True

    def _look_at_the_joint(self):
        """Tells how well the joint is known so far, as soon as enough poses are measured."""
        status = self._calibration.status()
        if status.refined or "joint" not in status.next_cycles:
            return
        answer = self._calibration.run("joint")
        if answer.success:
            self._uncertainty = f"orientation ± {1e3 * answer.report.orientation_uncertainty:.2f} mrad"

    def _show(self):
        self._terminal.progress(f"{self._progress.text()}  {self._uncertainty}")

    # -- estimating ----------------------------------------------------------------------------------

    def _estimate(self):
        """Runs the cycles that the samples are enough for; returns whether every parameter is identified."""
        for cycle in self._calibration.status().next_cycles:
            answer = self._calibration.run(cycle)
            self._terminal.say(("" if answer.success else "Not done: ") + answer.message)
        status = self._calibration.status()
        self._terminal.say(status.grade_reason)
        return progress.all_identified(status)

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
