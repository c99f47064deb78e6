"""Faults of the current amplifier, each with the time that it took until there was no current, or until it was told."""

import math
import signal
import time

from fault_laboratory import Outcome, command, outcome, status_of

COMES_BACK = 0.36  # [s] after zero was set, which is confirmed after 0.3 s
TOLD_DEVIATION = "A are set: the amplifier does not do what it acknowledges"


def misbehaving(behaviour):
    """Commands go on all the time."""

    def run(laboratory):
        begin = time.monotonic()
        laboratory.amplifier.behaviour = behaviour
        laboratory.watch(3.0)
        return outcome(laboratory, begin)

    return run


def dribbling_to_the_end(laboratory):
    """Commands end when the answers begin to dribble."""
    begin = laboratory.commander.change()
    laboratory.amplifier.behaviour = "dribble"
    laboratory.watch(3.0)
    return outcome(laboratory, begin)


def zero():
    return command(current=0.0)


def not_applied(make):
    """Zero is commanded, or nothing any more, and acknowledged."""

    def run(laboratory):
        laboratory.amplifier.stick()
        begin = laboratory.commander.change(make)
        told = laboratory.told(TOLD_DEVIATION, begin, 10.0)
        laboratory.watch(1.5)
        return Outcome(watchdog=laboratory.amplifier.on_until(begin)[1], told=told)

    return run


def applied_again(laboratory):
    """When only the amplifier's own watchdog can have ended the current, no command brings it back."""
    laboratory.amplifier.stick()
    begin = laboratory.commander.change(zero)
    told = laboratory.told(TOLD_DEVIATION, begin, 10.0)
    laboratory.watch(1.0)
    laboratory.amplifier.obey()
    laboratory.watch(1.0)
    laboratory.commander.change(command)
    laboratory.watch(1.0)
    defect = "there is current again" if laboratory.amplifier.is_on() else ""
    return Outcome(watchdog=laboratory.amplifier.on_until(begin)[1], told=told, defect=defect)


def alternating(laboratory):
    """Zero is set, and 2 A of 5 Hz flow, of both signs."""
    laboratory.commander.change()
    laboratory.watch(0.5)
    begin = time.monotonic()
    laboratory.amplifier.stray = lambda now: round(2000.0 * math.sin(2.0 * math.pi * 5.0 * (now - begin)))
    told = laboratory.told(TOLD_DEVIATION, begin, 10.0)
    laboratory.watch(1.5)
    watchdog = laboratory.amplifier.on_until(begin)[1]
    laboratory.driver.process.send_signal(signal.SIGTERM)
    return Outcome(watchdog=watchdog, told=told, defect="exit status 0" if status_of(laboratory) == 0 else "")


def coming_back(laboratory):
    """Zero is obeyed when the driver ends, and 1.5 A are back a moment after it has confirmed that, when all that is left
    to do is to take leave of the master."""
    ended = time.monotonic()
    laboratory.amplifier.stray = lambda now: 1500 if now - ended > COMES_BACK else 0
    laboratory.driver.process.send_signal(signal.SIGTERM)
    return Outcome(defect="exit status 0" if status_of(laboratory) == 0 else "")


def standing_still(laboratory):
    """2 A flow, whatever is set; commands of 8 Hz pass them all the time."""
    laboratory.commander.change(lambda: command(current=2.0 * math.sin(2.0 * math.pi * 8.0 * time.monotonic())))
    laboratory.watch(0.5)
    begin = time.monotonic()
    laboratory.amplifier.stray = lambda _: 2000
    told = laboratory.told(TOLD_DEVIATION, begin, 10.0)
    laboratory.watch(1.5)
    return Outcome(watchdog=laboratory.amplifier.on_until(begin)[1], told=told)
