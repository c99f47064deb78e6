"""What a guided session is asked for, checked in one place."""

import dataclasses
import typing

from spherical_actuator_calibration.command_line import parser


FIXTURE_SETTLING = 0.3  # [s] at rest before a capture
CURRENT = 2.0  # [A] of an excited coil where nobody states one
TOTAL_CURRENT = 8.0  # [A] of the sum of all |currents| of a pattern, likewise
HAND_SETTLING = 3.0  # [s] a hand has to clamp the rotor


class OptionError(ValueError):
    """An option that cannot be used; the text names it, as whoever stated it knows it."""

    def __init__(self, option, reason):
        super().__init__(f"{option}: {reason}")
        self.option = option
        self.reason = reason


@dataclasses.dataclass(frozen=True)
class Options:
    """Options of one session. Angles in rad, currents in A, times in s."""

    ns: str = "/actuator"
    poses: int = 10
    validation_poses: int = 2
    coils_per_validation_pose: int = 2
    current: typing.Optional[float] = None  # None: that of the plan, or CURRENT
    patterns: str = "single"  # several coils at once do not tell which of them is wired wrongly
    total_current: float = TOTAL_CURRENT
    dwell: float = 0.5
    settling: typing.Optional[float] = None  # None: as long as what turns the rotor needs
    current_timeout: float = 120.0
    pose_timeout: float = 900.0
    wanted_stddev: float = 0.0
    drive_fixture: bool = False
    skip_linearity: bool = False
    seed: int = 1
    plan: typing.Optional[str] = None
    repeat: typing.Optional[str] = None

    def __post_init__(self):
        ranges = {
            "poses": (3, 1000),
            "validation_poses": (0, 1000),
            "coils_per_validation_pose": (1, 1000),
            "current": (0.01, 1000.0),
            "total_current": (self.excitation, 1e6),
            "dwell": (0.001, 3600.0),  # the calibration node has its own: PoseCourse.require_dwell
            "settling": (0.0, 600.0),
            "current_timeout": (1.0, 3600.0),
            "pose_timeout": (10.0, 86400.0),
            "wanted_stddev": (0.0, 1.0),
        }
        for name, (least, most) in ranges.items():
            value = getattr(self, name)
            if value is not None and not least <= value <= most:
                raise OptionError(name, f"{value} is outside [{least}, {most}].")
        if self.patterns not in ("single", "weighing"):
            raise OptionError("patterns", f'"{self.patterns}" is neither single nor weighing.')
        if self.plan is not None and self.repeat is not None:
            raise OptionError("repeat", "a plan says already which poses are measured.")
        if not self.ns.startswith("/") or self.ns.endswith("/"):
            raise OptionError("ns", f'"{self.ns}" must begin with a slash and not end with one.')

    @property
    def excitation(self):
        """[A] of an excited coil, where no plan states it."""
        return CURRENT if self.current is None else self.current

    @property
    def rest(self):
        """[s] before a capture."""
        if self.settling is not None:
            return self.settling
        return FIXTURE_SETTLING if self.drive_fixture else HAND_SETTLING


def _add_what_is_measured(add, default):
    add("--ns", default=default.ns, help="namespace of the actuator (%(default)s)")
    add("--poses", type=int, help=f"planned poses ({default.poses}, or those of a file)")
    add(
        "--validation-poses",
        type=int,
        default=default.validation_poses,
        help="poses that judge the result (%(default)s)",
    )
    add("--current", type=float, default=default.current, help=f"of an excited coil [A] ({CURRENT}, or that of a plan)")
    add(
        "--patterns",
        default=default.patterns,
        help="single: one coil at a time; weighing: several at once with chosen signs (%(default)s)",
    )
    add(
        "--total-current",
        type=float,
        default=default.total_current,
        help="sum of all |currents| of a pattern, at most, as the amplifier's limit [A] (%(default)s)",
    )
    add(
        "--skip-linearity",
        action="store_true",
        help="do not measure one coil at half and at negative current, too, which tells whether torque is proportional to it",
    )
    add("--seed", type=int, default=default.seed, help="of the validation poses (%(default)s)")
    add("--plan", metavar="FILE", help="the poses, coils and current of a plan by plan_session")
    add("--repeat", metavar="FILE", help="those of an earlier session, from its session.db")


def _add_how_it_is_measured(add, default):
    add("--dwell", type=float, default=default.dwell, help="of each capture [s] (%(default)s)")
    add("--settling", type=float, help="rest before it [s] (0.3 in a fixture, 3 by hand)")
    add(
        "--current-timeout",
        type=float,
        default=default.current_timeout,
        help="end when coils do not carry what is commanded for so long [s] (%(default)s)",
    )
    add(
        "--pose-timeout",
        type=float,
        default=default.pose_timeout,
        help="end when the rotor does not come to a pose for so long [s] (%(default)s)",
    )
    add(
        "--wanted-stddev",
        type=float,
        default=default.wanted_stddev,
        help="fewer poses where parameters get this good [rad], up to --poses where not (%(default)s: all)",
    )
    add(
        "--drive-fixture",
        action="store_true",
        help="publish fixture/target instead of asking the operator to turn the rotor",
    )
    add("--yes", action="store_true", help="nothing is asked any more: for scripts that say so")


def _poses(values, default):
    """How many are planned. A plan, or an earlier session, tells the poses: a number of them would be ignored beside it,
    unless more may be added. Raises OptionError."""
    if values["poses"] is None:
        return default.poses
    from_file = values["plan"] is not None or values["repeat"] is not None
    if from_file and values["wanted_stddev"] == default.wanted_stddev:
        raise OptionError("poses", "the file says how many: leave it out, or let --wanted-stddev add some up to it.")
    return values["poses"]


def parse(arguments):
    """Options of a command line. Raises OptionError; prints help and exits for --help."""
    default = Options()
    command_line = parser(
        "guided_session",
        "Leads through a whole calibration: poses, excitations, cycles, validation, saving.\n"
        "Started again, it goes on where the session stands.",
    )
    _add_what_is_measured(command_line.add_argument, default)
    _add_how_it_is_measured(command_line.add_argument, default)
    values = vars(command_line.parse_args(arguments))
    del values["yes"]
    try:
        return Options(**{**values, "poses": _poses(values, default)})
    except OptionError as error:
        raise OptionError("--" + error.option.replace("_", "-"), error.reason) from None
