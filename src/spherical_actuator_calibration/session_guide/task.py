"""Something that takes time, and may be cancelled while it waits. No ROS."""

import threading
import time

LOOK = 0.02  # [s] between two looks for an answer


class Cancelled(Exception):
    """The task is not wanted any more; the text says why, in a sentence."""


class Task:
    """Waits for what one thread does; another one may cancel it, once and for all."""

    def __init__(self):
        self._reason = ""
        self._is_cancelled = threading.Event()
        self._calls = []

    def cancel(self, reason):
        """Whoever waits gets Cancelled at once; the first reason counts."""
        if not self._is_cancelled.is_set():
            self._reason = reason
            self._is_cancelled.set()

    def is_cancelled(self):
        return self._is_cancelled.is_set()

    def check(self):
        """Raises Cancelled if it is."""
        if self._is_cancelled.is_set():
            raise Cancelled(self._reason)

    def pause(self, seconds):
        """Waits so long [s]. Raises Cancelled."""
        self._is_cancelled.wait(seconds)
        self.check()

    @staticmethod
    def time():
        """[s], of a clock that nobody sets."""
        return time.monotonic()

    def answer_of(self, call):
        """What a call returns or raises that may take long. Raises Cancelled at once; the call then ends by itself."""
        self.check()
        found = _Call(call)
        self._calls.append(found)
        while not found.is_done.wait(LOOK):
            self.check()
        self._calls.remove(found)
        return found.answer()

    def wait_for_calls(self):
        """Until those that were left alone have ended, too."""
        for call in self._calls:
            call.is_done.wait()


class _Call:
    """A call in a thread of its own, which nobody needs to wait for."""

    def __init__(self, call):
        self._call = call
        self._answer = None
        self._error = None
        self.is_done = threading.Event()
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        try:
            self._answer = self._call()
        except Exception as error:  # pylint: disable=broad-except; whoever waits for it gets it
            self._error = error
        self.is_done.set()

    def answer(self):
        if self._error is not None:
            raise self._error
        return self._answer
