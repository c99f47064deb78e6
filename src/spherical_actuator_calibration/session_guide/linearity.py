"""One coil at three currents in one rest, which tells whether torque is proportional to current."""

MOST_RESTS = 3  # that are begun anew where one was interrupted


class LinearityTest:
    """Adds to the captures of a pose, as the calibration node says. `course`: of the poses, whose current it changes
    meanwhile."""

    def __init__(self, calibration, course, account, is_wanted):
        self._calibration = calibration
        self._course = course
        self._account = account
        self._is_wanted = is_wanted

    def captures(self, pose):
        """How many it will take at a pose whose patterns are measured before; 0: it is not to be done there."""
        return self._asked(pose).captures if self._is_wanted else 0

    def measure(self, pose, done):
        """At a pose whose patterns are measured, if no other has told it; calls done() after each capture."""
        if not self.captures(pose):
            return
        for _ in range(MOST_RESTS):
            missing = self._missing(pose)
            if not missing:
                return
            for pattern, current in missing:
                with self._course.at_current(current):
                    self._course.capture(pose, pattern)
                done()
        if self._missing(pose):
            self._account.say("One coil could not be measured at three currents in one rest; the next pose is to show it.")

    def _asked(self, pose):
        return self._calibration.linearity_captures(pose, self._course.current)

    def _missing(self, pose):
        """Patterns, each with its current [A], that the last rest at the pose lacks."""
        answer = self._asked(pose)
        return [(tuple(pattern.coils), current) for pattern, current in zip(answer.patterns, answer.currents)]
