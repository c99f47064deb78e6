"""What the actions do, each with what its client hears. See job.py for how they run.

An action has: name, type; end: what is so when it was cancelled, in a sentence; work(goal, task, account), which returns
whether it succeeded, and the result; failure(message, account): the result of work that did not come to its end;
feedback(account); let_go(), which ends what it holds.
"""

from spherical_actuator_calibration import msg
from spherical_actuator_calibration.msg import MeasurementProgress, SessionResult

from .calibration import PlanError
from .goals import checked_pattern, options_of, options_of_capture, pose_of_capture, require_patterns
from .options import OptionError, Options
from .pose_course import POLL, SLOW, PoseCourse
from .progress import Pose, in_words
from .session import Session
from .wanted_pose import WantedPose

EXCITATION = 5.0  # [s] where none is asked for
SILENCE = 3.0  # [s] in which a calibration node is started again
UNKNOWN = 0.5  # [s] for which it may be unknown at the end what coils carry
VALIDATING = "validating"


def _require_duration(course):
    """Raises OptionError of a CaptureGoal."""
    try:
        course.require_dwell()
    except OptionError as error:
        raise OptionError("duration", error.reason) from None


class _AtTheBench:
    """Of actions that excite coils: while one works, it holds the laboratory."""

    end = "The currents are zero; what was captured stays."

    def __init__(self, ns, calibration, laboratory):
        self._ns = ns
        self._calibration = calibration
        self._laboratory = laboratory

    def let_go(self):
        self._laboratory.release()

    def _take(self, task, account):
        self._calibration.serve(task, account)
        self._calibration.wait_until_up()
        account.set(joint_names=self._laboratory.readings.names)
        self._laboratory.hold()
        task.check()

    def _progress(self, account):
        message = account.message(self._laboratory.readings.fresh())
        message.carries = self._laboratory.carries() is True
        return message


class SessionAction(_AtTheBench):
    """A whole session."""

    name = "session"
    type = msg.SessionAction

    def __init__(self, ns, calibration, laboratory):
        super().__init__(ns, calibration, laboratory)
        self._wanted_pose = WantedPose(ns, laboratory.readings.names)

    def work(self, goal, task, account):
        self._take(task, account)
        try:
            options = options_of(goal, self._ns)
            session = Session(self._calibration, self._laboratory, options, task, account)
            is_complete = session.run()
        except (OptionError, PlanError) as error:
            return False, self._result(SessionResult.UNUSABLE, str(error), account)
        finally:
            account.lead_to(None)
        outcome = SessionResult.COMPLETE if is_complete else SessionResult.INCOMPLETE
        return is_complete, self._result(outcome, account.last(), account)

    def failure(self, message, account):
        return self._result(SessionResult.INCOMPLETE, message, account)

    def _result(self, outcome, message, account):
        account.set(stage=MeasurementProgress.ENDED, coils=[], pose=0)
        return SessionResult(outcome=outcome, message=message, progress=self._progress(account))

    def feedback(self, account):
        self._wanted_pose.show(account.pose())
        return msg.SessionFeedback(progress=self._progress(account))

    def let_go(self):
        super().let_go()
        self._wanted_pose.show(None)


class CaptureAction(_AtTheBench):
    """One pose."""

    name = "capture"
    type = msg.CaptureAction

    def __init__(self, ns, calibration, laboratory, coils):
        super().__init__(ns, calibration, laboratory)
        self._coils = coils

    def work(self, goal, task, account):
        if not goal.here:
            require_patterns(goal.pose, self._coils)
        options = options_of_capture(goal, self._ns)
        self._take(task, account)
        course = PoseCourse(self._calibration, self._laboratory, options, task, account)
        _require_duration(course)
        if goal.here:
            course.measure_here(bool(goal.validation))
        else:
            self._measure(course, pose_of_capture(goal), account)
        count = len(course.samples)
        samples = f"{count} sample{'' if count == 1 else 's'}"
        message = f"The pose is measured: {samples}."
        if goal.here:
            others = " Planned poses that it does not serve wait as before." if self._calibration.has_open_poses() else ""
            message = f"Captured without current where the rotor rests: {samples}.{others}"
        return True, msg.CaptureResult(success=True, message=message, samples=course.samples)

    def _measure(self, course, pose, account):
        course.require_current([pose])
        wanted = sum(map(len, course.to_capture([pose])))
        account.set(pose=1, poses=1, captures_wanted=wanted)
        if wanted:
            course.measure(pose, "", lambda: account.set(captures=len(course.samples)))

    @staticmethod
    def failure(message, _account):
        return msg.CaptureResult(message=message)

    def feedback(self, account):
        return msg.CaptureFeedback(progress=self._progress(account))


class ExciteAction(_AtTheBench):
    """A look at coils."""

    name = "excite"
    type = msg.ExciteAction

    def __init__(self, ns, calibration, laboratory, coils):
        super().__init__(ns, calibration, laboratory)
        self._coils = coils

    def work(self, goal, task, account):
        pattern = checked_pattern(goal.coils, self._coils)
        duration = goal.duration or EXCITATION
        if not 0.0 < duration <= goal.LONGEST_DURATION:
            raise ValueError(f"duration: {duration:g} s is outside (0, {goal.LONGEST_DURATION:g}].")
        if not goal.current > 0.0:
            raise ValueError(f"current: {goal.current:g} A is no current.")
        self._take(task, account)
        options = Options(ns=self._ns, current=goal.current, total_current=max(goal.current, Options().total_current))
        course = PoseCourse(self._calibration, self._laboratory, options, task, account)
        course.require_current([Pose((), (pattern,))])
        account.set(stage=MeasurementProgress.EXCITING)
        course.excite(pattern)
        begin = heard = task.time()
        was_there = False
        while task.time() < begin + duration:
            task.pause(min(POLL, duration))
            is_there = self._laboratory.carries()
            if is_there is None:
                self._require_answer(pattern, task.time() - heard, SILENCE)
                continue
            heard = task.time()
            if not is_there and (was_there or task.time() > begin + SLOW):
                complaint = self._laboratory.driver_complaint() or "the coil driver does not say why"
                raise RuntimeError(f"{in_words(pattern)}: {self._missed(goal.current, pattern)}: {complaint}.")
            was_there = was_there or is_there
        self._require_answer(pattern, task.time() - heard, UNKNOWN)
        result = msg.ExciteResult(success=was_there, measured=self._laboratory.currents())
        flowed = "excited" if was_there else self._missed(goal.current, pattern)
        result.message = f"{in_words(pattern)}: {flowed}; the currents are zero again."
        return was_there, result

    def _require_answer(self, pattern, silence, most):
        """Raises RuntimeError where nobody has told for more than `most` [s] what the coils carry."""
        if silence > most:
            raise RuntimeError(f"{in_words(pattern)}: {self._laboratory.trouble()}")

    def _flowing(self, pattern):
        """What the coils carry, in words."""
        currents = self._laboratory.currents()
        measured = [currents[abs(coil) - 1] for coil in pattern if abs(coil) <= len(currents)]
        if not measured:
            return "none is measured"
        return f"{', '.join(f'{current:.3f}' for current in measured)} A, see the limits of the coil driver"

    def _missed(self, current, pattern):
        return f"not the {current:g} A that were commanded, but {self._flowing(pattern)}"

    def failure(self, message, _account):
        return msg.ExciteResult(message=message, measured=self._laboratory.currents())

    def feedback(self, account):
        return msg.ExciteFeedback(progress=self._progress(account), measured=self._laboratory.currents())


class _OfTheNode:
    """Of actions that only ask the calibration node."""

    end = "The calibration node still ends what it has begun."

    def __init__(self, calibration):
        self._calibration = calibration

    def let_go(self):
        """It holds nothing."""

    def _take(self, task, account):
        self._calibration.serve(task, account)
        self._calibration.wait_until_up()


class PlanAction(_OfTheNode):
    """Poses to measure next."""

    name = "plan"
    type = msg.PlanAction

    def work(self, goal, task, account):
        self._take(task, account)
        request = {field: getattr(goal, field) for field in goal.__slots__}
        answer = self._calibration.call("plan_poses", **{**request, "cycle": goal.cycle or "refine"})
        result = msg.PlanResult(**{field: getattr(answer, field) for field in msg.PlanResult.__slots__})
        return answer.success, result

    @staticmethod
    def failure(message, _account):
        return msg.PlanResult(message=message)

    @staticmethod
    def feedback(account):
        return msg.PlanFeedback(elapsed=account.elapsed())


class SaveAction(_OfTheNode):
    """The result's files."""

    name = "save"
    type = msg.SaveAction

    def work(self, goal, task, account):
        self._take(task, account)
        if goal.validate:
            account.set(stage=VALIDATING)
            answer = self._calibration.call("validate", coil=0)
            if not answer.success:
                return False, msg.SaveResult(message="Not saved: " + answer.message)
        account.set(stage=MeasurementProgress.SAVING)
        answer = self._calibration.call("save")
        return answer.success, msg.SaveResult(success=answer.success, message=answer.message)

    @staticmethod
    def failure(message, _account):
        return msg.SaveResult(message=message)

    @staticmethod
    def feedback(account):
        return msg.SaveFeedback(stage=account.message().stage, elapsed=account.elapsed())
