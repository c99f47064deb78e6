"""How well a motion that goes on has told the parameters, in words, and whether that is enough."""

import math

import rospy
from spherical_actuator_calibration.msg import MotionProgress
from std_srvs.srv import Trigger

PATIENCE = 2.0  # [s] for a calibration node that may not be there
EVERY = 5.0  # [s] of motion between sentences about it


def time_left(progress, wanted):
    """Of such motion until all is known as well as wanted [rad], where variances fall with the inverse of the time [s]."""
    worst = max((group.stddev for group in progress.groups), default=math.inf)
    return progress.duration * max(0.0, (worst / wanted) ** 2 - 1.0)


def is_enough(progress, wanted):
    """Whether all is known as well as wanted [rad], and some windows can judge it."""
    worst = max((group.stddev for group in progress.groups), default=math.inf)
    return bool(progress.told and progress.can_be_judged) and worst <= wanted


def in_words(progress, wanted):
    """One sentence: what is known of each group, and what is left to `wanted` [rad]."""
    known = ", ".join(f"{group.group} {1e3 * group.stddev:.3f}" for group in progress.groups)
    words = f"{progress.duration:.0f} s of motion: {known} mrad"
    if progress.left_out:
        words += f", {progress.left_out} of {progress.windows} windows left out"
    left = [group.least_known for group in progress.groups if group.stddev > wanted]
    if not left:
        return f"{words}; all within {1e3 * wanted:.3f} mrad."
    seconds = math.ceil(time_left(progress, wanted))
    return f"{words}; left to {1e3 * wanted:.3f} mrad: {', '.join(left)}, some {seconds} s more."


class ProgressWatch:
    """Listens to the calibration node while a motion goes on, and says now and then what it has told. With `wanted`
    [rad], `enough()` is called once, when all is known as well as that; without, the node's own counts in words only."""

    def __init__(self, ns, say, wanted=None, enough=lambda: None):
        self._ns, self._say, self._wanted, self._enough = ns, say, wanted, enough
        self._progress = None
        self._subscriber = None
        self._told = 0.0
        self._is_enough = False

    def begin(self):
        """What was told of other motions does not count. RuntimeError where `wanted` needs a node that is not there."""
        service = f"{self._ns}/calibration/forget_motion"
        try:
            rospy.wait_for_service(service, PATIENCE)
            answer = rospy.ServiceProxy(service, Trigger)()
        except (rospy.ServiceException, rospy.ROSException) as error:
            if self._wanted is not None:
                raise RuntimeError(f"What is known while it moves the calibration node tells: {error}") from error
            self._say("No calibration node is running: how well parameters are known is told at the end.")
            return
        if not answer.success:
            raise RuntimeError(f"The motion of before cannot be forgotten: {answer.message}")
        # What is latched is of after the service.
        self._subscriber = rospy.Subscriber(f"{self._ns}/motion_progress", MotionProgress, self.receive, queue_size=1)

    def receive(self, message):
        """What the node tells."""
        self._progress = message

    def look(self):
        """Says what is new."""
        progress = self._progress
        if progress is None or not progress.told:
            return
        wanted = progress.wanted_stddev if self._wanted is None else self._wanted
        ends = self._wanted is not None and is_enough(progress, wanted) and not self._is_enough
        if ends or progress.duration >= self._told + EVERY:
            self._told = progress.duration
            self._say(in_words(progress, wanted))
        if ends:
            self._is_enough = True
            self._enough()

    def end(self):
        """Whether all that was wanted is known; says what is left."""
        if self._subscriber is not None:
            self._subscriber.unregister()
        if self._wanted is None or self._is_enough:
            return True
        progress = self._progress
        if progress is None or not progress.told:
            self._say("The motion ended before anything was known of it.")
            return False
        if not is_enough(progress, self._wanted):
            self._say(f"The motion ended before that was reached. {in_words(progress, self._wanted)}")
            return False
        return True
