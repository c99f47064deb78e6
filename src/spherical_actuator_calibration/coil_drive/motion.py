"""A motion plan under way, as a program sees it."""

import rospy
from spherical_actuator_calibration.msg import MotionStatus
from spherical_actuator_calibration.srv import FollowMotion
from std_srvs.srv import Trigger

RUNNING = (MotionStatus.APPROACH, MotionStatus.MOTION, MotionStatus.ENDING)
PATIENCE = 30.0  # [s] for services that must be there
SILENCE = 3.0  # [s] without a status: the controller has gone
POLL = 0.05  # [s]


class RotorLost(RuntimeError):
    """The controller has stopped because the rotor was too far from its reference."""


class Motion:
    """Begins a motion of the orientation controller, which must be enabled, and watches it to its end. Raises
    RuntimeError with the reason when it cannot go on."""

    def __init__(self, ns):
        self._controller = f"{ns}/orientation_controller"
        self._status = None
        self._time = None
        self._is_begun = False
        self._subscriber = rospy.Subscriber(f"{self._controller}/motion_status", MotionStatus, self._keep, queue_size=50)
        self.errors = []  # tracking errors during the motion [rad]
        self.least_excitation = 1.0

    def _keep(self, message):
        self._time = rospy.get_time()
        if not self._is_begun:
            return
        self._status = message
        if message.phase == MotionStatus.MOTION:
            self.errors.append(message.tracking_error)
            self.least_excitation = min(self.least_excitation, message.excitation_share)

    def _call(self, service, kind, *arguments):
        name = f"{self._controller}/{service}"
        try:
            rospy.wait_for_service(name, PATIENCE)
            answer = rospy.ServiceProxy(name, kind)(*arguments)
        except (rospy.ServiceException, rospy.ROSException) as error:
            raise RuntimeError(f"{name} does not answer: {error}") from error
        if not answer.success:
            raise RuntimeError(answer.message)

    def begin(self, plan):
        """`plan`: text of a plan file."""
        self._call("follow_motion", FollowMotion, plan)
        self._time = rospy.get_time()
        self._is_begun = True

    def end(self):
        """Slows down, and returns at rest; whatever goes wrong then, the currents are zero or will be."""
        self._call("end_motion", Trigger)
        self.wait(lambda _status: None)

    def wait(self, tell):
        """Returns the last status, of the phase done; tell(status) hears of each new one before it."""
        told = None
        while True:
            status = self._status
            if status is not None and status is not told:
                told = status
                if status.phase in RUNNING:
                    tell(status)
                elif status.phase == MotionStatus.DONE:
                    return status
                elif status.phase == MotionStatus.NONE:
                    raise RuntimeError(
                        f"{self._controller} has ended, and was started anew: its commands have ended, and so have the currents."
                    )
                else:
                    raise RotorLost(status.message) if status.is_lost else RuntimeError(status.message)
            if rospy.get_time() - self._time > SILENCE:
                raise RuntimeError(f"{self._controller} is silent: its commands have ended, and so have the currents.")
            rospy.sleep(POLL)
