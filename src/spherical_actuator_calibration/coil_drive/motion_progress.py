"""How well a motion that goes on has told the parameters, and whether that is enough."""

import rospy
from spherical_actuator_calibration.msg import MotionProgress
from spherical_actuator_calibration.srv import BeginMotion

PATIENCE = 2.0  # [s] for a calibration node that may not be there
EVERY = 5.0  # [s] of motion between sentences about it


class ProgressWatch:
    """Listens to the calibration node while a motion goes on, and says now and then what it has told. With `wanted`
    [rad], `enough()` is called once, when the node says that all is known as well as that; without, the node's own counts,
    in words only."""

    def __init__(self, ns, say, wanted=None, enough=lambda: None):
        self._ns, self._say, self._wanted, self._enough = ns, say, wanted, enough
        self._progress = None
        self._subscriber = None
        self._told = 0.0
        self._is_enough = False

    def begin(self):
        """What was told of other motions does not count. RuntimeError where `wanted` needs a node that is not there."""
        service = f"{self._ns}/calibration/begin_motion"
        try:
            rospy.wait_for_service(service, PATIENCE)
            answer = rospy.ServiceProxy(service, BeginMotion)(self._wanted or 0.0)
        except (rospy.ServiceException, rospy.ROSException) as error:
            if self._wanted is not None:
                raise RuntimeError(f"What is known while it moves the calibration node tells: {error}") from error
            self._say("No calibration node is running: how well parameters are known is told at the end.")
            return
        if not answer.success:
            raise RuntimeError(f"The calibration node begins no motion: {answer.message}")
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
        ends = self._wanted is not None and progress.is_enough and not self._is_enough
        if ends or progress.duration >= self._told + EVERY:
            self._told = progress.duration
            self._say(progress.message)
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
        if not progress.is_enough:
            self._say(f"The motion ended before that was reached. {progress.message}")
            return False
        return True
