"""What the operator sees: sentences, one progress line, questions. Plain text where it is no terminal."""

import sys

from spherical_actuator_calibration.text_files import printable


class Terminal:
    """Writes to a stream; a progress line is written over in a terminal, and left out elsewhere."""

    def __init__(self, stream=sys.stdout, assume_yes=False):
        self._stream = stream
        self._assume_yes = assume_yes
        self._line = ""
        self._last = None

    def _write(self, text):
        self._stream.write(text)
        self._stream.flush()

    def _clear_line(self):
        if self._line:
            self._write("\r" + " " * len(self._line) + "\r")
            self._line = ""

    def say(self, sentence):
        self._clear_line()
        self._write(printable(sentence) + "\n")
        self._last = sentence

    def say_once(self, sentence):
        """Says what goes on for a while, once."""
        if sentence != self._last:
            self.say(sentence)

    def progress(self, text):
        if not self._stream.isatty():
            return
        self._clear_line()
        self._line = printable(text)
        self._write(self._line)

    def ask(self, question):
        """Waits for the return key."""
        self._clear_line()
        if self._assume_yes:
            self.say(question)
            return
        self._write(printable(question) + " Then press Return. ")
        sys.stdin.readline()
