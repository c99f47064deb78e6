"""The emulated laboratory with rviz on a screen that nobody sees."""

import os
import re
import subprocess
import tempfile
import time
import unittest

import rosgraph
from calibration_client import DEADLINE, NAMESPACE, wait_for
from emulated_lab import EmulatedLab, LabCase
from launch_client import launch_file

SIZE = (1280, 720)
FEWEST_BUTTON_PIXELS = 40  # in a row, beside its text
FIRST_DISPLAY, DISPLAYS = 1000, 50_000
PICTURES = 0.3  # [s] from one to the next: each takes half a second of a processor, which rviz needs itself
PAUSE = 1.0  # [s] between two presses of a key that did nothing: buttons are disabled while a service runs


class Screen:
    """A virtual display, and pictures of it."""

    def __init__(self):
        # Two servers that look for a free number at once may both find the same, and one of them ends.
        number = FIRST_DISPLAY + os.getpid() % DISPLAYS
        read, write = os.pipe()
        self._server = subprocess.Popen(
            ["Xvfb", f":{number}", "-displayfd", str(write), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"],
            pass_fds=(write,),
            stderr=subprocess.DEVNULL,
        )
        os.close(write)
        with os.fdopen(read) as ready:
            shown = ready.readline().strip()
        if not shown:
            raise RuntimeError(f"Xvfb has no screen of number {number}.")
        self.display = ":" + shown

    def pixels(self):
        """Red, green and blue of every pixel, a little later."""
        time.sleep(PICTURES)
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


def has_ended(node):
    """Whether a node has been there, and its process is no more."""
    try:
        EmulatedLab.process_of(node)
    except rosgraph.MasterException:
        return False  # not there yet
    except OSError:
        return True
    return False


class ViewedCase(unittest.TestCase):
    """Tests with rviz on `screen`."""

    is_second_rviz = False

    @classmethod
    def make_screen(cls):
        """The environment of what is shown on it, by `view`."""
        cls.screen = Screen()
        cls.addClassCleanup(cls.screen.stop)
        cls.view = cls.quick_view()
        return {"DISPLAY": cls.screen.display, "LIBGL_ALWAYS_SOFTWARE": "1"}

    @classmethod
    def quick_view(cls):
        """The view with few pictures a second, as nobody sees them, and without a graphics card half a processor draws
        them; and with short captures, of emulated streams that are as good as long ones."""
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        config = os.path.join(os.path.dirname(launch_file("view.launch")), "..", "config")
        with open(os.path.join(config, "view.rviz"), encoding="utf-8") as file:
            text = file.read()
        for key, value in (("Frame Rate", "4"), ("Capture Duration", "0.2")):
            text, count = re.subn(rf"{key}: \d+", f"{key}: {value}", text)
            if count != 1:
                raise AssertionError(f"the view has no {key}")
        path = os.path.join(folder.name, "view.rviz")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    @classmethod
    def wait_for_panel(cls):
        """rviz itself ends at its start at times, in the compiler of the renderer in software: then it is started once
        more, also in the first moments after it has shown its panel. One that is gone again fails the test."""
        is_seen = []

        def is_seen_or_gone():
            is_seen[:] = [find_button(cls.screen.pixels())]
            return is_seen[0] or has_ended("rviz")

        wait_for(is_seen_or_gone, "the panel")
        if not is_seen[0]:
            cls.start_rviz_again()

    @classmethod
    def picture(cls):
        """Pixels of the screen with an rviz that is there."""
        cls.see_to_rviz()
        return cls.screen.pixels()

    @classmethod
    def see_to_rviz(cls):
        if has_ended("rviz"):
            cls.start_rviz_again()

    @classmethod
    def start_rviz_again(cls):
        if cls.is_second_rviz:
            raise AssertionError("rviz has ended twice")
        cls.is_second_rviz = True
        cls.start_rviz()
        wait_for(lambda: find_button(cls.screen.pixels()), "the panel of a second rviz", 2.0 * DEADLINE)

    @classmethod
    def start_rviz(cls):
        """As view.launch does."""
        print("rviz ended at its start; it is started once more.")
        rviz = subprocess.Popen(
            ["rosrun", "rviz", "rviz", "-d", cls.view, "-f", "stator", f"__ns:={NAMESPACE}", "__name:=rviz"],
            env={**os.environ, "DISPLAY": cls.screen.display, "LIBGL_ALWAYS_SOFTWARE": "1"},
        )
        cls.addClassCleanup(rviz.wait)
        cls.addClassCleanup(rviz.terminate)

    def press(self, keys, done, what, pause=PAUSE):
        """One key or several, again after a pause [s] where the panel was still busy, until something is so."""
        end = [0.0]

        def is_done():
            if done():
                return True
            if time.monotonic() > end[0]:
                self.see_to_rviz()
                end[0] = time.monotonic() + pause
                self.key(keys)
            return False

        wait_for(is_done, what)

    def key(self, keys):
        """Keys one after the other, with a space between their names."""
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
        subprocess.run(["xdotool", "key", *keys.split()], check=True, env=environment)


class ViewedLabCase(ViewedCase, LabCase):
    """Tests in one laboratory with rviz."""

    @classmethod
    def make_lab(cls, **arguments):
        super().make_lab(environment=cls.make_screen(), rviz=True, view=cls.view, **arguments)
