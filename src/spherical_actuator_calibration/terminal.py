"""What the operator sees: sentences and one progress line. Plain text where it is no terminal."""

import sys

from spherical_actuator_calibration.text_files import printable

from .narrator import Narrator


class Terminal(Narrator):
    """Writes to a stream; a progress line is written over in a terminal, and left out elsewhere."""

    def __init__(self, stream=sys.stdout):
        super().__init__()
        self._stream = stream
        self._line = ""

    def _write(self, text):
        self._stream.write(text)
        self._stream.flush()

    def _clear_line(self):
        if self._line:
            self._write("\r" + " " * len(self._line) + "\r")
            self._line = ""

    def _tell(self, sentence):
        self._clear_line()
        self._write(printable(sentence) + "\n")

    def progress(self, text):
        """A line that the next one takes the place of."""
        if not self._stream.isatty():
            return
        self._clear_line()
        self._line = printable(text)
        self._write(self._line)

    def milestone(self, text):
        """How far things are, at a moment that is worth a line where there is no progress line."""
        if not self._stream.isatty():
            self._tell(text)
