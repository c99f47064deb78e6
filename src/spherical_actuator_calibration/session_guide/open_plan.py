"""The last plan of a session without a file, so that an interrupted pose is completed when the session goes on."""

import rospy

from .progress import Pose


class OpenPlan:
    """Kept among the parameters of the master: clients, the engine and the calibration node may end meanwhile."""

    def __init__(self, ns):
        self._name = ns + "/session_engine/open_plan"

    def keep(self, poses):
        rospy.set_param(
            self._name,
            [{"joints": list(pose.joints), "patterns": [list(p) for p in pose.excitations]} for pose in poses],
        )

    def poses(self):
        return [
            Pose(tuple(map(float, pose["joints"])), tuple(tuple(map(int, p)) for p in pose["patterns"]))
            for pose in rospy.get_param(self._name, [])
        ]


def begun(poses, calibration, coils):
    """Those of planned poses of an actuator with so many coils that have samples, and lack others."""
    possible = [pose for pose in poses if all(abs(coil) <= coils for pattern in pose.excitations for coil in pattern)]
    progress = calibration.progress_of(possible)
    return [pose for pose, there in zip(possible, progress) if there.has_sample and not there.is_measured]
