"""One coil at three currents in one rest, which tells whether torque is proportional to current."""

SHARES = (1.0, 0.5, -1.0)  # of the session's current
NEAR = 0.2  # of a current: it is that which is wanted
MOST_RESTS = 3  # that are begun anew where one was interrupted


class LinearityTest:
    """Adds to the captures of a pose. `course`: of the poses, whose current it changes meanwhile."""

    def __init__(self, calibration, course, account, is_wanted):
        self._calibration = calibration
        self._course = course
        self._account = account
        self._is_wanted = is_wanted

    def captures(self, pose):
        """How many it will take at a pose whose patterns are measured before; 0: it is not to be done there."""
        if not self._is_open() or pose.validation or not pose.excitations:
            return 0
        return len(SHARES) - any(len(pattern) == 1 for pattern in pose.excitations)

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

    def _is_open(self):
        status = self._calibration.status()
        can_be_told = min(map(abs, SHARES)) * self._course.current >= status.least_current
        return self._is_wanted and can_be_told and not status.linearity_is_told

    def _lacking(self, coil, rest, measured):
        """Patterns of a coil, each with its current [A], that a rest lacks."""
        held = [(s.pattern, s.current) for s in measured if s.rest == rest]
        wanted = [((coil if share > 0.0 else -coil,), abs(share) * self._course.current) for share in SHARES]
        return [
            (pattern, current)
            for pattern, current in wanted
            if not any(pattern == other and abs(near - current) <= NEAR * current for other, near in held)
        ]

    def _missing(self, pose):
        """The same of the coil that makes most torque, in the last rest at a pose."""
        (progress,) = self._calibration.progress_of([pose])
        measured = self._calibration.measured()
        there = [sample for sample in measured if sample.number in progress.samples]
        excited = [s for s in there if s.pattern]
        alone = [s for s in excited if len(s.pattern) == 1] or excited
        if not alone:
            return []
        strongest = max(alone, key=lambda sample: sample.torque)
        return self._lacking(abs(strongest.pattern[0]), max(s.rest for s in there), measured)
