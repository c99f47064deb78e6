"""The rotor under control of its coils, as a program sees it."""

import contextlib

import rospy
from geometry_msgs.msg import QuaternionStamped
from sensor_msgs.msg import JointState
from spherical_actuator_calibration.msg import ActuatorParameters
from spherical_actuator_calibration.rotor_readings import readings_of
from std_srvs.srv import SetBool

from .rotations import quaternion_of, rotation_of

TARGET_RATE = 100.0  # [Hz]
STARTING = 5.0  # [s] for the inputs of the controller
PATIENCE = 30.0  # [s] for topics and services that must be there
STOPPING = 3.0  # [s] for services that may have gone when all is to stop


class CoilDrive:
    """Enables the orientation controller, and gives it targets. Raises RuntimeError with the reason when it cannot
    go on."""

    def __init__(self, ns):
        self._ns = ns
        self._frame = rospy.get_param(f"{ns}/orientation_controller/frames/stator", "stator")
        self._readings = readings_of(ns, rospy.get_param(f"{ns}/actuator")).listen()
        self.parameters = None
        self._targets = rospy.Publisher(f"{ns}/orientation_target", QuaternionStamped, queue_size=1)
        self._joint_targets = rospy.Publisher(f"{ns}/joint_target", JointState, queue_size=1)
        self._subscriber = rospy.Subscriber(f"{ns}/parameters", ActuatorParameters, self._keep_parameters)

    def _keep_parameters(self, message):
        self.parameters = message

    def _set(self, service, value, patience=PATIENCE):
        name = f"{self._ns}/{service}"
        try:
            rospy.wait_for_service(name, patience)
            answer = rospy.ServiceProxy(name, SetBool)(value)
        except (rospy.ServiceException, rospy.ROSException) as error:
            raise RuntimeError(f"{name} does not answer: {error}") from error
        if not answer.success:
            raise RuntimeError(answer.message)

    def start(self, fixture):
        """Enables the control; with the name of an emulated laboratory, its fixture lets the rotor go."""
        end = rospy.get_time() + PATIENCE
        while self.parameters is None or self._readings.fresh() is None:
            if rospy.get_time() > end:
                raise RuntimeError(f"{self._ns}/parameters and {self._readings.quantity} do not come: start the laboratory.")
            rospy.sleep(0.05)
        self._enable()
        if fixture:
            self._set(f"{fixture}/release_fixture", True)

    def _enable(self):
        """A controller that has just been started may still wait for its inputs."""
        end = rospy.get_time() + STARTING
        while True:
            try:
                self._set("orientation_controller/enable", True)
                return
            except RuntimeError:
                if rospy.get_time() > end:
                    raise
            rospy.sleep(0.1)

    def stop(self, fixture):
        """The fixture takes the rotor, then the currents go to zero, whatever becomes of the fixture."""
        try:
            if fixture:
                self._set(f"{fixture}/release_fixture", False, STOPPING)
        finally:
            self._set("orientation_controller/enable", False, STOPPING)

    def stop_after(self, fixture, error):
        """Likewise, and raises a RuntimeError as that which was the reason: what fails in stopping comes of that. Without a
        fixture nothing holds the rotor then."""
        with contextlib.suppress(RuntimeError):
            self.stop(fixture)
        held = "" if fixture else " Without currents nothing holds the rotor: it coasts or falls; keep away until it rests."
        raise type(error)(f"{error}{held}") from error

    def joints(self):
        """Joint angles [rad]; raises RuntimeError without fresh ones."""
        joints = self._readings.fresh()
        if joints is None:
            raise RuntimeError(f"No {self._readings.quantity} arrive: check the {self._readings.device}.")
        return joints

    def send(self, rotation):
        message = QuaternionStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = self._frame
        target = message.quaternion
        target.x, target.y, target.z, target.w = quaternion_of(rotation)
        self._targets.publish(message)

    def send_joints(self, joints):
        """Where the joint sensors read these angles [rad]: the controller knows the kinematics in force."""
        message = JointState(name=self._readings.names, position=list(joints))
        message.header.stamp = rospy.Time.now()
        self._joint_targets.publish(message)

    def turn_to(self, rotation, duration):
        """Sends a target again and again for so long [s]."""
        self._repeat(self.send, rotation, duration)

    def turn_to_joints(self, joints, duration):
        """Likewise."""
        self._repeat(self.send_joints, joints, duration)

    @staticmethod
    def _repeat(send, target, duration):
        rate = rospy.Rate(5.0)
        end = rospy.get_time() + duration
        while rospy.get_time() < end:
            send(target)
            rate.sleep()

    def track(self, pattern, duration, observe):
        """Follows one of patterns.py for so long [s]; calls observe(time, desired) at every target."""
        rate = rospy.Rate(TARGET_RATE)
        begin = rospy.get_time()
        while True:
            time = rospy.get_time() - begin
            if time > duration:
                return
            desired = pattern.rotation(time)
            self.send(desired)
            observe(time, desired)
            rate.sleep()


class TrueOrientation:
    """What an emulated laboratory knows: the true orientation of its rotor."""

    def __init__(self, topic):
        self._message = None
        self._subscriber = rospy.Subscriber(topic, QuaternionStamped, self._keep)

    def _keep(self, message):
        self._message = message

    def rotation(self):
        """Rotor to stator; None without a message."""
        return None if self._message is None else rotation_of(self._message.quaternion)
