"""The course of a guided session."""

from spherical_actuator_calibration.msg import MeasurementProgress

from . import progress
from .linearity import LinearityTest
from .options import OptionError
from .pose_course import PoseCourse
from .progress import Progress

FURTHER_POSES = 2  # that are added at a time until the calibration is complete
MOST_ROUNDS = 4


class Session:
    """Leads through one session; everything measured is with the calibration node. Raises PlanError for a file that
    gives no poses, RuntimeError with a sentence where a person has to see to something, and Cancelled of its task."""

    def __init__(self, calibration, laboratory, options, task, account):
        self._options = options
        self._task = task
        self._account = account
        self._calibration = calibration
        self._course = PoseCourse(calibration, laboratory, options, task, account)
        self._linearity = LinearityTest(calibration, self._course, account, not options.skip_linearity)
        self._progress = None

    def run(self):
        """Returns whether all cycles succeeded and the result was saved."""
        self._calibration.wait_until_up()
        self._course.require_dwell()
        poses = self._wanted_poses()
        self._course.require_current(poses)
        if self._options.wanted_stddev and not (self._asks_for_files() or self._training_poses()):
            poses = self._learn_the_noise(poses)
        self._measure(poses)
        is_complete = self._estimate()
        for _ in range(MOST_ROUNDS):
            if is_complete:
                break
            self._account.say(f"The calibration is not complete: {FURTHER_POSES} poses are added.")
            self._measure(self._plan(FURTHER_POSES, self._options.wanted_stddev))
            is_complete = self._estimate()
        if not is_complete:
            self._account.say(f"It is still not complete. {self._calibration.status().next_step}")
        if is_complete and self._options.wanted_stddev:
            self._reach_wanted_stddev()
        return self._conclude() and is_complete

    # -- measuring -----------------------------------------------------------------------------------

    def _wanted_poses(self):
        """Poses of this session, those that the node holds samples of left out or complete."""
        interrupted = [] if self._asks_for_files() else self._interrupted()
        training = self._training_poses(interrupted)
        if training:
            measured = "1 pose is" if training == 1 else f"{training} poses are"
            partly = f", {len(interrupted)} of them in part" if interrupted else ""
            self._account.say(f"The session goes on: {measured} measured already{partly}.")
        planned = self._poses_of_files() or interrupted
        if not self._asks_for_files() and training < self._options.poses:
            planned = self._plan(self._options.poses - training, self._options.wanted_stddev, interrupted)
        options = self._options
        if not options.validation_poses or any(pose.validation for pose in planned):
            return planned
        return planned + self._calibration.draw_validation(
            options.validation_poses, options.coils_per_validation_pose, options.seed
        )

    def _asks_for_files(self):
        return bool(self._options.plan or self._options.repeat)

    def _learn_the_noise(self, poses):
        """Measures the first pose, and plans the others by the noise of its samples: how many poses a wanted accuracy
        takes is known only then."""
        self._account.say("The first pose tells the noise of the sensors; the others are planned after it.")
        self._measure(poses[:1])
        return self._wanted_poses()

    def _training_poses(self, interrupted=()):
        """How many are measured that are not held out, with those that a session has begun. What was captured without
        current tells nothing of poles and coils: a calibration of the joint is no part of the session."""
        excites = bool(self._calibration.parameters().coils)
        measured = [one for one in self._calibration.measured() if not one.validation and (one.pattern or not excites)]
        begun = self._calibration.progress_of(interrupted) if interrupted else []
        others = [pose for pose in begun if not (pose.has_current or not excites)]
        return len({one.place for one in measured}) + len(others)

    def _poses_of_files(self):
        source = self._options.plan or self._options.repeat
        if not source:
            return []
        poses, current = self._calibration.load_plan(source)
        if self._options.current not in (None, current):
            raise OptionError("current", f"{source} has its coils at {current:g} A: leave it away, or plan with another one.")
        self._course.current = current
        self._account.say(f"{len(poses)} poses of {source}, coils at {self._course.current:g} A.")
        return poses

    def _interrupted(self):
        """Poses of the plan in force that were begun, and that the currents of this session can complete."""
        most = self._options.total_current / self._course.current
        return [
            pose
            for pose in self._calibration.begun()
            if not pose.validation and all(len(pattern) <= most for pattern in pose.excitations)
        ]

    def _plan(self, count, wanted_stddev, interrupted=()):
        """The interrupted poses and as many others."""
        self._account.set(stage=MeasurementProgress.PLANNING)
        poses, message = self._calibration.plan(
            count,
            wanted_stddev,
            patterns=self._options.patterns,
            current=self._course.current,
            total_current=self._options.total_current,
            first=interrupted,
        )
        self._account.say("Plan: " + message)
        return [*interrupted, *poses]

    def _measure(self, poses):
        """What samples lack of the poses; again what was taken out of use meanwhile."""
        self._measure_once(poses)
        for _ in range(MOST_ROUNDS):
            lacking = sum(1 for patterns in self._course.to_capture(poses) if patterns)
            if not lacking:
                return
            which = "one pose" if lacking == 1 else f"{lacking} poses"
            self._account.say(f"Samples of {which} were taken out of use meanwhile: that is measured again.")
            self._measure_once(poses)

    def _measure_once(self, poses):
        captures = [len(patterns) for patterns in self._course.to_capture(poses)]
        open_poses = [pose for pose, count in zip(poses, captures) if count]
        further = max((self._linearity.captures(pose) for pose in open_poses), default=0)
        self._progress = Progress(sum(captures) + further, self._task.time)
        self._account.count(self._progress)
        for number, pose in enumerate(open_poses, 1):
            self._account.set(pose=number, poses=len(open_poses))
            which = f"{'held-out pose' if pose.validation else 'pose'} {number} of {len(open_poses)}"
            self._course.measure(pose, which, self._count, self._linearity.measure)
            self._look_at_the_joint()
        self._course.excite(())
        self._account.set(pose=0)

    def _count(self):
        self._progress.advance()
        self._account.count(self._progress)

    def _look_at_the_joint(self):
        """Tells how well the joint is known so far, as soon as enough poses are measured."""
        status = self._calibration.status()
        if status.refined or "joint" not in status.next_cycles:
            return
        answer = self._calibration.run("joint")
        if answer.success:
            self._account.set(
                joint_stddev=progress.joint_stddev(self._calibration.parameters().joints),
                orientation_uncertainty=answer.report.orientation_uncertainty,
            )

    # -- estimating ----------------------------------------------------------------------------------

    def _estimate(self):
        """Runs the cycles that the samples are enough for; returns whether the calibration is complete."""
        self._account.set(stage=MeasurementProgress.ESTIMATING)
        for cycle in self._calibration.status().next_cycles:
            answer = self._calibration.run(cycle)
            self._account.say(("" if answer.success else "Not done: ") + answer.message)
        status = self._calibration.status()
        self._account.say(status.grade_reason)
        return status.complete

    def _reach_wanted_stddev(self):
        """Adds poses until every parameter is known as well as wanted, or as many are measured as were asked for: what
        a plan expects, noise may not hold."""
        wanted = f"{1e3 * self._options.wanted_stddev:.3g} mrad wanted"
        left = self._options.poses - self._training_poses()
        while True:
            worst = self._calibration.status().worst_stddev
            known = f"The worst standard deviation is {1e3 * worst:.3g} mrad, {wanted}"
            if worst <= self._options.wanted_stddev:
                self._account.say(f"{known}: that is reached.")
                return
            if left <= 0:
                self._account.say(f"{known}: that takes more than {self._options.poses} poses, which were asked for.")
                return
            count = min(left, FURTHER_POSES)
            self._account.say(f"{known}: {count} {'pose is' if count == 1 else 'poses are'} added.")
            # Planned, not measured: a pose at the place of an earlier one counts, too.
            left -= count
            self._measure(self._plan(count, wanted_stddev=0.0))
            self._estimate()

    def _conclude(self):
        """Validates and saves; returns whether the result can be used."""
        linearity = self._calibration.status().torque_linearity
        if linearity:
            self._account.say(linearity)
        self._account.set(stage=MeasurementProgress.SAVING)
        if self._options.validation_poses:
            answer = self._calibration.call("validate", coil=0)
            self._account.say(answer.message)
            if not answer.success:
                self._account.say("Not saved: see to that, and start again, with more poses.")
                return False
        answer = self._calibration.call("save")
        self._account.say(answer.message)
        return answer.success
