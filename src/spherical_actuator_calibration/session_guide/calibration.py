"""The calibration node as a session sees it: its services and latched topics, through its restarts."""

import rospy
from spherical_actuator_calibration.msg import (
    ActuatorParameters,
    CalibrationStatus,
    CoilPattern,
    PlanProgress,
    PosePatterns,
)
from spherical_actuator_calibration.srv import (
    Calibrate,
    Capture,
    CapturePlanned,
    DrawValidationPoses,
    LinearityCaptures,
    ListSamples,
    LoadPlan,
    MissingPatterns,
    PlanPoses,
)
from std_srvs.srv import Trigger

from .progress import Measured, Pose, service_of
from .task import Task

SERVICES = {
    "calibrate_coil": Calibrate,
    "calibrate_joint": Calibrate,
    "calibrate_poles": Calibrate,
    "capture": Capture,
    "capture_planned": CapturePlanned,
    "draw_validation_poses": DrawValidationPoses,
    "linearity_captures": LinearityCaptures,
    "list_samples": ListSamples,
    "load_plan": LoadPlan,
    "missing_patterns": MissingPatterns,
    "plan_poses": PlanPoses,
    "refine": Calibrate,
    "save": Trigger,
    "validate": Calibrate,
}
PATIENCE = 1.0  # [s] between two looks for a node that is gone
LATEST = 1.0  # [s] after which a message counts as new, whatever its time


class PlanError(ValueError):
    """Why a file gives no poses, in a sentence that names it."""


class Topics:
    """What the calibration node told last. One of a process: rospy gives what is latched to the first subscriber only."""

    def __init__(self, ns):
        self.latest = {CalibrationStatus: None, ActuatorParameters: None, PlanProgress: None}
        self._subscribers = [
            rospy.Subscriber(ns + "/status", CalibrationStatus, self._keep),
            rospy.Subscriber(ns + "/parameters", ActuatorParameters, self._keep),
            rospy.Subscriber(ns + "/plan_progress", PlanProgress, self._keep),
        ]

    def _keep(self, message):
        self.latest[type(message)] = message


class Calibration:
    """Calls the services of the calibration node, and waits for it where it is gone."""

    def __init__(self, ns, narrator, topics=None):
        self._node = ns + "/calibration"
        self._narrator = narrator
        self._task = Task()
        self._latest = (topics or Topics(ns)).latest
        self._answered = rospy.Time()  # time of what the node answered last

    def serve(self, task, narrator):
        """From now on calls are of a task, whose Cancelled they raise, and tell its narrator what they wait for."""
        self._task = task
        self._narrator = narrator

    def wait_until_up(self):
        self._wait_for("save")
        while None in self._latest.values():
            self._task.pause(0.05)

    def status(self):
        """The status that goes with the last answer."""
        return self._of_the_answer(CalibrationStatus)

    def parameters(self):
        """The parameters that the last answer, of a successful cycle, has put in force."""
        return self._of_the_answer(ActuatorParameters)

    def _of_the_answer(self, kind):
        """Topics may be slower than services."""
        end = self._task.time() + LATEST
        while self._latest[kind].header.stamp < self._answered and self._task.time() < end:
            self._task.pause(0.02)
        return self._latest[kind]

    def _wait_for(self, service):
        while True:
            try:
                self._task.answer_of(lambda: rospy.wait_for_service(f"{self._node}/{service}", PATIENCE))
                return
            except rospy.ROSInterruptException:
                raise
            except rospy.ROSException:
                self._narrator.say_once(
                    f"Waiting for the node {self._node}: start it, for example by lab.launch."
                )

    def _call(self, service, **fields):
        """Answer of a service; None when the node went away, and is back."""
        try:
            proxy = rospy.ServiceProxy(f"{self._node}/{service}", SERVICES[service])
            answer = self._task.answer_of(lambda: proxy(**fields))
        except rospy.ROSInterruptException:
            raise
        except (rospy.ServiceException, rospy.ROSException):
            if rospy.is_shutdown():
                raise
            self._narrator.say("The calibration node does not answer; its samples are safe.")
            self._wait_for(service)
            self._narrator.say("The calibration node is back; the session goes on.")
            return None
        for part in ("sample", "report"):
            if hasattr(answer, part):
                self._answered = getattr(answer, part).header.stamp
        return answer

    def call(self, service, **fields):
        """Answer of a service that may be asked twice."""
        while True:
            answer = self._call(service, **fields)
            if answer is not None:
                return answer

    def capture(self, duration, validation):
        """Answer, or None when it is not known whether a sample was stored."""
        return self._call("capture", duration=duration, validation=validation)

    def capture_planned(self, pose, pattern, current, duration):
        """Likewise, of one pattern of a pose at so much current [A]: the node keeps only what serves it, and answers
        with the flaw."""
        return self._call(
            "capture_planned",
            joint_position=pose.joints,
            coils=pattern,
            current=current if pattern else 0.0,
            duration=duration,
            validation=pose.validation,
        )

    def run(self, cycle):
        """Answer of a cycle, as the status names it."""
        service, coil = service_of(cycle)
        return self.call(service, coil=coil)

    def measured(self):
        """Samples that are held."""
        answer = self.call("list_samples")
        told = zip(answer.places, answer.excited, answer.samples)
        return [Measured(place, tuple(excited.coils), bool(sample.validation)) for place, excited, sample in told]

    def progress_of(self, poses):
        """A PoseProgress of each pose: what the samples that are held now lack there. Asked for, not listened to: what
        was captured before counts."""
        answer = self.call("missing_patterns", poses=[message_of(pose) for pose in poses])
        if not answer.success:
            raise RuntimeError(answer.message)
        return answer.poses

    def linearity_captures(self, pose, current):
        """What it takes there to tell whether torque is proportional to current, for coils at so much current [A]."""
        answer = self.call("linearity_captures", pose=message_of(pose), current=current)
        if not answer.success:
            raise RuntimeError(answer.message)
        return answer

    def pose_tolerance(self):
        """Joint angles that differ by no more than this from a pose are at it [rad]."""
        return self._latest[CalibrationStatus].pose_tolerance

    def has_open_poses(self):
        """Whether a plan is followed, and poses of it are not measured."""
        progress = self._latest[PlanProgress]
        return progress is not None and not all(there.is_measured for there in progress.poses)

    def begun(self):
        """Poses of the plan in force, in their order, that have samples, and lack others."""
        poses = [pose_of(there.pose) for there in self._latest[PlanProgress].poses]
        # Of what is held now: a topic may be of a moment ago.
        there = zip(poses, self.progress_of(poses))
        return [pose for pose, progress in there if progress.has_sample and not progress.is_measured]

    def plan(self, poses, wanted_stddev, cycle="refine", first=(), **excitation):
        """Planned poses, in their order; raises RuntimeError with the reason when there is no plan.

        first: poses that stay in the plan, before these; excitation: patterns, current and total_current of the request.
        """
        answer = self.call(
            "plan_poses",
            cycle=cycle,
            coil=0,
            max_poses=poses,
            wanted_stddev=wanted_stddev,
            first=[message_of(pose) for pose in first],
            **excitation,
        )
        if not answer.success:
            raise RuntimeError("No plan: " + answer.message)
        return poses_from(answer.poses), answer.message

    def draw_validation(self, poses, coils_each, seed):
        """Poses that judge the result, with so many coils each; the same for the same seed."""
        answer = self.call("draw_validation_poses", poses=poses, coils_per_pose=coils_each, seed=seed % 2**32)
        if not answer.success:
            raise RuntimeError("No poses to judge: " + answer.message)
        return [pose_of(pose) for pose in answer.poses]

    def load_plan(self, path):
        """Poses of a plan of plan_session, or of an earlier session in its session.db, which the node follows then, and
        the current [A] that excites a coil. Raises PlanError."""
        answer = self.call("load_plan", path=path)
        if not answer.success:
            raise PlanError(answer.message)
        return [pose_of(pose) for pose in answer.poses], answer.current


def message_of(pose):
    """The PosePatterns of a Pose."""
    patterns = [CoilPattern(coils=list(pattern)) for pattern in pose.excitations]
    return PosePatterns(joint_position=list(pose.joints), patterns=patterns, validation=pose.validation)


def pose_of(message):
    """The Pose of a PosePatterns."""
    patterns = tuple(tuple(pattern.coils) for pattern in message.patterns)
    return Pose(tuple(message.joint_position), patterns, bool(message.validation))


def poses_from(planned):
    """Poses of PlannedPoses, in their order."""
    return [Pose(tuple(pose.joint_position), excitations_of(pose)) for pose in planned]


def excitations_of(planned):
    """Patterns of a PlannedPose."""
    if not planned.patterns:
        return tuple((coil,) for coil in planned.coils)
    return tuple(_signed_coils(pattern.current) for pattern in planned.patterns)


def _signed_coils(currents):
    """Numbers of the coils that are to have current, negative where that is."""
    return tuple(coil if current > 0.0 else -coil for coil, current in enumerate(currents, 1) if current)
