"""The emulated laboratory with rviz on a screen that nobody sees."""

import os
import subprocess
import time
import unittest

from calibration_client import wait_for
from emulated_lab import LabCase

SIZE = (1280, 720)
FEWEST_BUTTON_PIXELS = 40  # in a row, beside its text
PAUSE = 1.0  # [s] between two presses of a key that did nothing: buttons are disabled while a service runs


class Screen:
    """A virtual display, and pictures of it."""

    def __init__(self):
        read, write = os.pipe()
        self._server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"],
            pass_fds=(write,),
            stderr=subprocess.DEVNULL,
        )
        os.close(write)
        with os.fdopen(read) as number:
            self.display = ":" + number.readline().strip()

    def pixels(self):
        """Red, green and blue of every pixel."""
        picture = subprocess.run(
            ["import", "-display", self.display, "-window", "root", "-depth", "8", "rgb:-"],
            check=True,
            stdout=subprocess.PIPE,
        ).stdout
        return list(zip(picture[0::3], picture[1::3], picture[2::3]))

    def click(self, x, y, *options):
        """By the first button of the mouse, where `options` do not say otherwise."""
        subprocess.run(
            ["xdotool", "mousemove", str(x), str(y), "click", *(options or ("1",))],
            check=True,
            env={**os.environ, "DISPLAY": self.display},
        )

    def scroll_down(self, x, y):
        self.click(x, y, "--repeat", "20", "5")

    def stop(self):
        self._server.terminate()
        self._server.wait()


def is_button(red, green, blue):
    return green > 100 and red < 0.5 * green and blue < 0.6 * green


def find_button(pixels):
    """Middle of the capture button, the only wide thing in its green; None when it is not there."""
    width = SIZE[0]
    rows = {}
    for y in range(SIZE[1]):
        line = [x for x in range(width) if is_button(*pixels[y * width + x])]
        if len(line) > FEWEST_BUTTON_PIXELS:
            rows[y] = sum(line) / len(line)
    if not rows:
        return None
    return round(sum(rows.values()) / len(rows)), round(sum(rows) / len(rows))


class ViewedCase(unittest.TestCase):
    """Tests with rviz on `screen`."""

    @classmethod
    def make_screen(cls):
        """The environment of what is shown on it."""
        cls.screen = Screen()
        cls.addClassCleanup(cls.screen.stop)
        return {"DISPLAY": cls.screen.display, "LIBGL_ALWAYS_SOFTWARE": "1"}

    def press(self, key, done, what, pause=PAUSE):
        """A key, again after a pause [s] where the panel was still busy, until something is so."""
        end = [0.0]

        def is_done():
            if done():
                return True
            if time.monotonic() > end[0]:
                end[0] = time.monotonic() + pause
                self.key(key)
            return False

        wait_for(is_done, what)

    def key(self, key):
        environment = {**os.environ, "DISPLAY": self.screen.display}
        windows = subprocess.run(
            ["xdotool", "search", "--onlyvisible", "--class", "rviz"],
            stdout=subprocess.PIPE,
            text=True,
            check=False,
            env=environment,
        ).stdout.split()
        for window in windows[:1]:
            subprocess.run(["xdotool", "windowfocus", window], check=False, env=environment)
        subprocess.run(["xdotool", "key", key], check=True, env=environment)


class ViewedLabCase(ViewedCase, LabCase):
    """Tests in one laboratory with rviz."""

    @classmethod
    def make_lab(cls, **arguments):
        super().make_lab(environment=cls.make_screen(), rviz=True, **arguments)
