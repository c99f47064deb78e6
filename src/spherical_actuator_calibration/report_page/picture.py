"""One picture of the page: its style, its layout, and the SVG that it becomes."""

import base64
import io

import matplotlib
import matplotlib.figure
from matplotlib.backends.backend_svg import FigureCanvasSVG

SIZE = (4.7, 3.0)  # [inch]
LINE = 0.24  # [inch] of text with what is around it
MARGIN = 0.12  # [inch]
CHARACTER = 0.08  # [inch] that a digit takes at most
PIXELS_PER_INCH = 150  # of what is drawn as pixels
INK = "#1f2933"

STYLE = {
    "axes.axisbelow": True,
    "axes.edgecolor": "#b6c0ca",
    "axes.formatter.useoffset": False,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "grid.color": "#e6ebf0",
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "lines.markersize": 4,
    "svg.fonttype": "none",
    "text.color": INK,
    "xtick.color": "#52606d",
    "ytick.color": "#52606d",
}


class Figure:
    """One picture while it is drawn: with Figure(title) as figure: figure.axes.plot(...)"""

    def __init__(self, name, title, rows=1, size=SIZE, sharex=True):
        self.title = title
        self.alt = title
        self.source = ""
        self._name = name
        self._context = matplotlib.rc_context({**STYLE, "svg.hashsalt": name})
        self._context.__enter__()
        self.figure = matplotlib.figure.Figure(figsize=size)
        self._bar = None
        self._shares_x = sharex
        axes = self.figure.subplots(rows, 1, squeeze=False, sharex=sharex)
        self.panels = list(axes[:, 0])
        self.axes = self.panels[0]
        self.axes.set_title(title)

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        if kind is None:
            content = io.BytesIO()
            canvas = FigureCanvasSVG(self.figure)
            self.figure.dpi = PIXELS_PER_INCH
            self._lay_out()
            # Figure.savefig() would draw everything twice, to lay it out first.
            # Without date and creator the same report gives the same bytes.
            canvas.print_svg(content, metadata={"Date": None, "Creator": None})
            self.source = "data:image/svg+xml;base64," + base64.b64encode(content.getvalue()).decode("ascii")
        self._context.__exit__(kind, error, trace)


    def bar(self, points, label, **options):
        """A bar of colours beside the picture; its axes."""
        self._bar = self.figure.colorbar(points, ax=self.axes, **options)
        self._bar.set_label(label)
        return self._bar.ax

    def _lay_out(self):
        """Room for numbers and words, by their number and size: matplotlib would draw the text of every axis twice to
        measure it, in a third of the time of a page."""
        width, height = self.figure.get_size_inches()
        right = _room_for_numbers(self._bar.ax.yaxis) if self._bar else MARGIN
        room = {
            "left": max(_room_for_numbers(axes.yaxis) for axes in self.panels) / width,
            "right": 1.0 - right / width,
            "bottom": 2.0 * LINE / height,
            "top": 1.0 - (LINE + MARGIN) / height,
        }
        rows = len(self.panels)
        if rows > 1:
            # Numbers and name below each row, or nothing where they are those of the last one.
            between = MARGIN if self._shares_x else 2.0 * LINE + MARGIN
            row = ((room["top"] - room["bottom"]) * height - (rows - 1) * between) / rows
            room["hspace"] = between / row
        self.figure.subplots_adjust(**room)


def _room_for_numbers(axis):
    """Beside an axis that stands upright, for its numbers and its name [inch]."""
    longest = max((len(label.get_text()) for label in axis.get_majorticklabels()), default=0)
    return LINE + MARGIN + CHARACTER * longest
