"""What the operator sees: sentences and one progress line. Plain text where it is no terminal."""

import re
import sys

from spherical_actuator_calibration.text_files import printable

NUMBER = re.compile(r"[-+\u2212]?\d+(\.\d+)?")


class Terminal:
    """Writes to a stream; a progress line is written over in a terminal, and left out elsewhere."""

    def __init__(self, stream=sys.stdout):
        self._stream = stream
        self._line = ""
        self._said = set()  # since the last change: sentences without their numbers

    def _write(self, text):
        self._stream.write(text)
        self._stream.flush()

    def _clear_line(self):
        if self._line:
            self._write("\r" + " " * len(self._line) + "\r")
            self._line = ""

    def _write_sentence(self, sentence):
        self._clear_line()
        self._write(printable(sentence) + "\n")

    def say(self, sentence):
        """Says what is new; from here on, all that goes on may be said once more."""
        self._write_sentence(sentence)
        self._said = {NUMBER.sub("#", sentence)}

    def say_once(self, sentence):
        """Says what goes on for a while, once, however its numbers change."""
        shape = NUMBER.sub("#", sentence)
        if shape not in self._said:
            self._said.add(shape)
            self._write_sentence(sentence)

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
            self._write_sentence(text)
