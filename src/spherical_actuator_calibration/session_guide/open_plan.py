"""The last plan of a session without a file, so that an interrupted pose is completed when the session goes on."""

import rospy

from .progress import Pose, missing_patterns


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


def begun(poses, measured, tolerance, coils):
    """Those of planned poses of an actuator with so many coils that have samples, and lack others."""
    places = [sample.joints for sample in measured if not sample.validation]
    return [
        pose
        for pose in poses
        if all(abs(coil) <= coils for pattern in pose.excitations for coil in pattern)
        and any(pose.is_at(place, tolerance) for place in places)
        and missing_patterns(pose, measured, tolerance)
    ]
