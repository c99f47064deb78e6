"""The calibration node as a session sees it: its services and latched topics, through its restarts."""

import rospy
from spherical_actuator_calibration.msg import CalibrationStatus
from spherical_actuator_calibration.srv import Calibrate, Capture, ListSamples, PlanPoses, RemoveSample
from std_srvs.srv import Trigger

from .progress import Measured, Pose, excited_coil

SERVICES = {
    "calibrate_coil": Calibrate,
    "calibrate_joint": Calibrate,
    "calibrate_poles": Calibrate,
    "capture": Capture,
    "list_samples": ListSamples,
    "plan_poses": PlanPoses,
    "refine": Calibrate,
    "remove_sample": RemoveSample,
    "save": Trigger,
    "validate": Calibrate,
}
PATIENCE = 1.0  # [s] between two looks for a node that is gone


class Calibration:
    """Calls the services of the calibration node, and waits for it where it is gone."""

    def __init__(self, ns, terminal):
        self._node = ns + "/calibration"
        self._terminal = terminal
        self.status = None
        self._subscriber = rospy.Subscriber(ns + "/status", CalibrationStatus, self._keep)

    def _keep(self, status):
        self.status = status

    def wait_until_up(self):
        self._wait_for("save")
        while self.status is None:
            rospy.sleep(0.05)

    def _wait_for(self, service):
        while True:
            try:
                rospy.wait_for_service(f"{self._node}/{service}", PATIENCE)
                return
            except rospy.ROSInterruptException:
                raise
            except rospy.ROSException:
                self._terminal.say_once(
                    f"Waiting for the node {self._node}: start it, for example by lab.launch."
                )

    def _call(self, service, **fields):
        """Answer of a service; None when the node went away, and is back."""
        try:
            return rospy.ServiceProxy(f"{self._node}/{service}", SERVICES[service])(**fields)
        except rospy.ROSInterruptException:
            raise
        except (rospy.ServiceException, rospy.ROSException):
            if rospy.is_shutdown():
                raise
            self._terminal.say("The calibration node does not answer; its samples are safe.")
            self._wait_for(service)
            self._terminal.say("The calibration node is back; the session goes on.")
            return None

    def call(self, service, **fields):
        """Answer of a service that may be asked twice."""
        while True:
            answer = self._call(service, **fields)
            if answer is not None:
                return answer

    def capture(self, duration, validation):
        """Answer, or None when it is not known whether a sample was stored."""
        return self._call("capture", duration=duration, validation=validation)

    def measured(self, current):
        """Samples that are held."""
        samples = self.call("list_samples").samples
        return [
            Measured(tuple(s.joint_position), excited_coil(s.current, current), s.validation)
            for s in samples
        ]

    def plan(self, poses, wanted_stddev, cycle="refine"):
        """Planned poses, in their order; raises RuntimeError with the reason when there is no plan."""
        answer = self.call(
            "plan_poses", cycle=cycle, coil=0, max_poses=poses, wanted_stddev=wanted_stddev
        )
        if not answer.success:
            raise RuntimeError("No plan: " + answer.message)
        return [Pose(tuple(p.joint_position), tuple(p.coils)) for p in answer.poses], answer.message
