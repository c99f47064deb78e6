"""The course of one pose: arrival, rest, excitation, capture, and what to do when something disturbs it."""

import contextlib
import math

from spherical_actuator_calibration.msg import MeasurementProgress
from spherical_actuator_calibration.srv import CapturePlannedResponse

from . import progress
from .options import OptionError

POLL = 0.05  # [s]
AGAIN = 2.0  # [s] of rest elsewhere after which a fixture is told its pose once more, which may have been lost
SLOW = 5.0  # [s] after which the operator is told what is waited for
# [s] without current before it is tried again: a driver whose currents deviated follows again after zero was commanded
# and measured.
PAUSE = 1.0
FIXTURE_TOLERANCE = 0.02  # [rad] of a fixture that has arrived


class PoseCourse:
    """Measures poses; everything measured is with the calibration node. Raises RuntimeError with a sentence where a
    person has to see to something, and Cancelled of its task."""

    def __init__(self, calibration, laboratory, options, task, account):
        self._calibration = calibration
        self._laboratory = laboratory
        self._options = options
        self._task = task
        self._account = account
        self.current = options.excitation  # [A] of an excited coil
        self.samples = []  # that were captured

    def to_capture(self, poses):
        """For each pose the patterns that are to be captured there, in their order."""
        return [progress.patterns_to_capture(there) for there in self._calibration.progress_of(poses)]

    def require_current(self, poses):
        """Raises RuntimeError where a coil would not be told from one that is off, or a pattern needs too much."""
        least = self._calibration.status().least_current
        excited = [pattern for pose in poses for pattern in pose.excitations]
        if excited and self.current < least:
            raise RuntimeError(
                f"{self.current:g} A are too little to tell a coil from one that is off: take {least:g} A or more."
            )
        total = max((len(pattern) for pattern in excited), default=0) * self.current
        if total > self._options.total_current:
            raise RuntimeError(f"A pattern needs {total:.1f} A, and the total current is to be {self._options.total_current:g} A: plan with "
                "less current or fewer coils at a time, or allow more (--total-current) where the amplifier bears it.")

    def require_dwell(self):
        """Raises OptionError where the calibration node averages no such capture."""
        status = self._calibration.status()
        if not status.shortest_capture <= self._options.dwell <= status.longest_capture:
            raise OptionError(
                "dwell",
                f"{self._options.dwell:g} s cannot be captured: the calibration node takes "
                f"{status.shortest_capture:g} to {status.longest_capture:g} s.",
            )

    def measure(self, pose, which, done, further=None):
        """Measures what samples lack of a pose, then calls further(pose, done); calls done() after each capture.
        `which`: the pose in words, for a hand that is told where to turn it; empty: it is not."""
        self._lead_to(pose, which)
        self.wait_for_rest(pose)
        (patterns,) = self.to_capture([pose])
        for pattern in patterns:
            self.capture(pose, pattern)
            done()
        if further:
            further(pose, done)
        self._account.lead_to(None)

    def measure_here(self, validation):
        """One capture without current, wherever the rotor rests. Raises RuntimeError when that takes too long."""
        self.excite(())
        self.wait_for_rest(None)
        self._account.set(stage=MeasurementProgress.CAPTURING)
        begin = self._task.time()
        while True:
            answer = self._calibration.capture(self._options.dwell, validation)
            if answer is not None and answer.success:
                self.samples.append(answer.sample)
                return
            if answer is not None:
                self._give_up_after(self._options.pose_timeout, begin, answer.message)
                self._account.say_once(answer.message)
            self._task.pause(POLL)

    def _give_up_after(self, most, begin, message):
        """Raises RuntimeError with the message of a refused capture once it is asked for since `most` seconds."""
        waited = self._task.time() - begin
        if waited > most:
            raise RuntimeError(f"{message} It is so for {waited:.0f} s. See to that, and start again: it goes on.")

    @contextlib.contextmanager
    def at_current(self, current):
        """Excited coils carry another current meanwhile [A]."""
        usual, self.current = self.current, current
        try:
            yield
        finally:
            self.current = usual

    def excite(self, pattern):
        """Commands a pattern; empty: no current."""
        self._laboratory.excite(pattern, self.current)
        self._account.set(coils=list(pattern), current=self.current)

    def _lead_to(self, pose, which):
        self.excite(())
        self._account.lead_to(pose, self._tolerance())
        if self._options.drive_fixture:
            self._laboratory.drive_to(pose.joints)
        if self._options.drive_fixture or not which:
            return
        angles = zip(self._laboratory.readings.names, pose.joints)
        self._account.say(
            f"Turn the rotor to {which}: {', '.join(f'{name} {progress.in_degrees(q)}' for name, q in angles)}, "
            f"each within {math.degrees(self._calibration.pose_tolerance()):.1f}\N{DEGREE SIGN}, and clamp it. "
            f"After {self._options.rest:g} s at rest coils are excited by itself: hands off then."
        )

    def wait_for_rest(self, pose):
        """Until joint sensors, or without joints the tracker, see the rotor at rest at the pose; None: anywhere.
        Raises RuntimeError when that takes too long."""
        self._account.set(stage=MeasurementProgress.TURNING, is_at_rest=False)
        begin = still_since = told = self._task.time()
        readings = self._laboratory.readings
        spread = self._calibration.status().rest_spread
        last = None
        while True:
            joints = readings.fresh()
            now = self._task.time()
            way = None if joints is None else self._way(pose, joints)
            if joints is None:
                self._account.say_once(f"No {readings.quantity} arrive: check the {readings.device}.")
                still_since = now
            elif last is None or progress.distance(joints, last) > spread:
                last, still_since = joints, now
            elif now - still_since >= self._options.rest and not way:
                self._account.set(is_at_rest=True)
                return
            elif way and self._options.drive_fixture:
                if min(now - told, now - still_since) > AGAIN:
                    self._laboratory.drive_to(pose.joints)
                    told = now
                if now - begin > SLOW:
                    self._account.say_once(f"The rotor is not at the pose ({way}): check fixture and {readings.device}.")
            if now - begin > self._options.pose_timeout:
                raise RuntimeError(
                    f"The rotor did not come to rest at the pose in {now - begin:.0f} s "
                    f"({f'no {readings.quantity}' if joints is None else way or 'it moves'}). "
                    "See to that, and start again: it goes on."
                )
            self._task.pause(POLL)

    def _way(self, pose, joints):
        return "" if pose is None else progress.way_to(pose, self._laboratory.readings.names, joints, self._tolerance())

    def _tolerance(self):
        """[rad] of arrival. A hand does not meet the angles as a fixture does; any pose nearby tells as much."""
        return FIXTURE_TOLERANCE if self._options.drive_fixture else self._calibration.pose_tolerance()

    def _answer_with_current(self, pose, pattern):
        """To a capture while the coils carry what is commanded. Raises RuntimeError when that takes too long."""
        begin = self._task.time()
        while True:
            answer = self._answer_soon(pose, pattern)
            if answer is None or answer.flaw != CapturePlannedResponse.EXCITATION:
                return answer
            waited = self._task.time() - begin
            complaint = self._laboratory.driver_complaint() or "it does not say why"
            if waited > self._options.current_timeout:
                raise RuntimeError(
                    f"{answer.message} After {waited:.0f} s: {complaint}. See to that, and start again."
                )
            self._account.say_once(f"{answer.message} The driver: {complaint}.")
            self.excite(())
            self._task.pause(PAUSE)
            self.excite(pattern)

    def _answer_soon(self, pose, pattern):
        """Answer to a capture; asked again for a moment while coils do not carry what is commanded."""
        end = self._task.time() + SLOW
        while True:
            answer = self._calibration.capture_planned(pose, pattern, self.current, self._options.dwell)
            is_amiss = answer is not None and answer.flaw == CapturePlannedResponse.EXCITATION
            if not is_amiss or self._task.time() > end:
                return answer
            self._task.pause(POLL)

    def capture(self, pose, pattern):
        """Captures one pattern; repeats, and says why, until a sample of it is held. Raises RuntimeError when that
        takes too long, with current sooner than without."""
        begin = self._task.time()
        most = self._options.current_timeout if pattern else self._options.pose_timeout
        while True:
            self._account.set(stage=MeasurementProgress.CAPTURING)
            self.excite(pattern)
            self._task.pause(min(self._options.rest, 0.1))
            answer = self._answer_with_current(pose, pattern)
            if answer is None:
                if pattern and self._holds(pose, pattern):
                    return
                continue
            if answer.success:
                self.samples.append(answer.sample)
                return
            self._give_up_after(most, begin, answer.message)
            self._account.say_once(answer.message)
            if self._mend(answer.flaw, pose):
                begin = self._task.time()
            self._task.pause(POLL)

    def _holds(self, pose, pattern):
        """Whether a sample has the pattern, though its answer was lost."""
        (patterns,) = self.to_capture([pose])
        return pattern not in patterns

    def _mend(self, flaw, pose):
        """What is to be done about a flaw that the node tells of, beside another capture. Returns whether
        somebody had to bring the rotor back: that takes its time."""
        if flaw == CapturePlannedResponse.POSE:
            self.excite(())
            self.wait_for_rest(pose)
        elif flaw == CapturePlannedResponse.REST:
            self.capture(pose, ())
        return flaw == CapturePlannedResponse.POSE
