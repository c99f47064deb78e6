"""How far a session is, in one line, or drawn into a terminal."""

import math

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text
from spherical_actuator_calibration.msg import MeasurementProgress
from spherical_actuator_calibration.text_files import printable

from . import progress
from ..terminal import Terminal

MEASURING = (MeasurementProgress.TURNING, MeasurementProgress.EXCITING, MeasurementProgress.CAPTURING)
FULL = math.radians(45.0)  # [rad] that fill the bar of a joint
WIDTH = 24  # of that bar


def line_of(told, doing_now=""):
    """A MeasurementProgress as a bar with what is known."""
    known = told.orientation_uncertainty
    parts = (
        progress.bar(told.captures, told.captures_wanted, told.remaining_time),
        doing_now,
        f"orientation ± {1e3 * known:.2f} mrad" if known else "",
    )
    return "  ".join(part for part in parts if part)


def doing(told):
    """What is under way at a pose, in a few words."""
    if told.stage != MeasurementProgress.TURNING:
        return progress.in_words(told.coils).lower() if told.coils else "without current"
    if not told.way:
        return ""
    return "turn" if max(map(abs, told.way)) > told.tolerance else "there: clamp the rotor"


def picture_of(told):
    """A MeasurementProgress as a table: pose, way of each joint, captures."""
    table = Table.grid(padding=(0, 2))
    held_out = " (held out)" if told.held_out else ""
    table.add_row(Text(f"pose {told.pose} of {told.poses}{held_out}", style="bold"), "", Text(doing(told)))
    for name, way in zip(told.joint_names, told.way):
        is_there = abs(way) <= told.tolerance
        filled = 0 if is_there else max(1, round(min(1.0, abs(way) / FULL) * WIDTH))
        style = "green" if is_there else "yellow"
        shown = Text(progress.in_degrees(way), style=style, justify="right")
        table.add_row(Text(printable(name)), shown, Text("there" if is_there else "#" * filled, style=style))
    table.add_row("captures", "", Text(line_of(told)))
    if told.joint_stddev:
        table.add_row("joint", "", Text(f"the worst axis or offset is known to ± {1e3 * told.joint_stddev:.2f} mrad"))
    return table


class LiveTerminal(Terminal):
    """Draws below the sentences."""

    def __init__(self, stream, **console):
        super().__init__(stream)
        self._console = Console(file=stream, **console)
        self._live = Live(console=self._console, auto_refresh=False, transient=True)
        self._is_live = False

    def _tell(self, sentence):
        self._console.print(Text(printable(sentence)), soft_wrap=True)

    def milestone(self, text):
        """Is drawn anyway."""

    def show(self, told):
        """A MeasurementProgress."""
        if told.stage not in MEASURING:
            self.close()
            return
        if not self._is_live:
            self._live.start()
            self._is_live = True
        self._live.update(picture_of(told), refresh=True)

    def close(self):
        """Takes the drawing away."""
        if self._is_live:
            self._live.stop()
            self._is_live = False


class LineTerminal(Terminal):
    """Without a terminal: a line where things have changed."""

    def show(self, told):
        """A MeasurementProgress, whose progress is told by milestones."""

    def close(self):
        """Nothing is drawn."""


def terminal_on(stream):
    """What shows a session on a stream."""
    return LiveTerminal(stream) if stream.isatty() else LineTerminal(stream)
