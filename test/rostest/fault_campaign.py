#!/usr/bin/python3
"""Tries faults of commands, processes, amplifiers and sensors against the drivers: fault_campaign --help.

For each fault the table tells how long there was current at most after it began: by the registers of the amplifier,
and of an amplifier with a watchdog of 0.5 s of its own; then, how long it took until the driver told it; each beside
its limit [s]. Exit status: 0 all is within the limits, 1 something is not.
"""

import contextlib
import dataclasses
import math
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
from typing import Callable

import hostile_peer
import rospy
from amplifier_faults import (
    alternating,
    applied_again,
    coming_back,
    dribbling_to_the_end,
    misbehaving,
    not_applied,
    standing_still,
    zero,
)
from calibration_client import NAMESPACE
from fault_laboratory import CURRENT, Laboratory, Master, Outcome, command, outcome, status_of
from links import free_port
from sensor_faults import sensor_fault
from spherical_actuator_calibration.command_line import parser
from spherical_actuator_calibration.msg import CoilCurrents

SIMULATED = rospy.Time(978307200)  # the year 2001
JUMP = 3600  # [s] of the wall clock
LARGEST = 200.0  # [MB] of the driver
LEAVE = 6.0  # [s] for the driver to end, whether its master answers or not


@dataclasses.dataclass(frozen=True)
class Fault:
    """One fault, how it is tried, and its limits [s]; None: no limit."""

    name: str
    run: Callable[[Laboratory], Outcome]
    limits: tuple  # registers, watchdog, told
    is_short: bool = False  # part of the short form
    preload: bool = False
    needs_laboratory: bool = True
    is_repeatable: bool = True


# -- commands ---------------------------------------------------------------------------------------------------


def commands(make):
    """From now on these commands instead of good ones."""

    def run(laboratory):
        begin = laboratory.commander.change(make)
        laboratory.watch(1.2)
        return outcome(laboratory, begin)

    return run


def stamped(stamp):
    def make():
        message = command()
        message.header.stamp = stamp
        return message

    return make


def repeated(laboratory):
    return commands(stamped(command().header.stamp))(laboratory)


def flood(laboratory):
    laboratory.commander.pause = 0.0
    time.sleep(1.0)
    begin = laboratory.commander.change()
    laboratory.watch(1.2)
    return outcome(laboratory, begin)


def second_commander(rate):
    """It must not get through while the first one commands, and both end together."""

    def run(laboratory):
        other = laboratory.second_commander(-CURRENT, rate)
        time.sleep(2.0)
        owner = laboratory.driver.value("output", "commander")
        other.kill()
        begin = laboratory.commander.change()
        other.wait()
        laboratory.watch(1.2)
        defect = "" if owner == rospy.get_name() else f"{owner} commands"
        if any(word >= 0x8000 for word in laboratory.amplifier.words_of(3)):
            defect = "the second one drove the coil"
        return outcome(laboratory, begin, defect=defect)

    return run


# -- the driver's process -----------------------------------------------------------------------------------------


def killed(number):
    def run(laboratory):
        begin = time.monotonic()
        laboratory.driver.process.send_signal(number)
        laboratory.watch(1.5)
        return outcome(laboratory, begin)

    return run


def stopped(laboratory):
    """Stopped, and continued when the commands are old."""
    begin = time.monotonic()
    laboratory.driver.process.send_signal(signal.SIGSTOP)
    time.sleep(0.3)
    laboratory.commander.change()
    time.sleep(1.2)
    laboratory.driver.process.send_signal(signal.SIGCONT)
    laboratory.watch(1.0)
    return outcome(laboratory, begin)


def ended(number):
    def run(laboratory):
        begin = time.monotonic()
        laboratory.driver.process.send_signal(number)
        status = status_of(laboratory)
        return outcome(laboratory, begin, defect=f"exit status {status}" if status != 0 else "")

    return run


def ended_while_stuck(watchdog):
    """Current flows on until the amplifier's watchdog [s] acts, and whoever ended the driver must know."""

    def run(laboratory):
        laboratory.amplifier.watchdog = watchdog
        laboratory.amplifier.stick()
        laboratory.driver.process.send_signal(signal.SIGTERM)
        return Outcome(defect="exit status 0" if status_of(laboratory) == 0 else "")

    return run


def thrown(laboratory):
    begin = laboratory.faults.throw()
    status = status_of(laboratory)
    return outcome(laboratory, begin, defect="exit status 0" if status == 0 else "")


def lying_lengths(laboratory):
    """Connections, and commanders, say that they send more than the driver may have."""
    announced = struct.pack("<I", 900000000)

    def greet_and_announce(publisher, link):
        publisher.greet(link)
        link.sendall(announced)

    commanders = [
        hostile_peer.HostilePublisher(f"{NAMESPACE}/coil_command", CoilCurrents, greet_and_announce) for _ in range(3)
    ]
    with contextlib.ExitStack() as links:
        for commander in commanders:
            links.callback(commander.close)
            commander.wait_for_visits(1)
        for _ in range(4):
            link = links.enter_context(hostile_peer.connect(laboratory.driver.name))
            link.sendall(announced)
        time.sleep(1.0)
        defect = "" if laboratory.amplifier.is_on() else "the driver does not go on"
    size = 0.0 if defect else hostile_peer.largest_memory(laboratory.driver.process.pid)
    if size > LARGEST:
        defect = f"it has {size:.0f} MB"
    begin = laboratory.commander.change()
    laboratory.watch(1.2)
    return outcome(laboratory, begin, defect=defect)


def clock_jump(seconds):
    """Of the driver alone: the commands are of another time."""

    def run(laboratory):
        begin = laboratory.faults.jump(seconds)
        laboratory.watch(1.2)
        return outcome(laboratory, begin)

    return run


def common_clock_jump(laboratory):
    """Of driver and commander: they go on."""
    laboratory.commander.change()
    laboratory.faults.jump(-JUMP)
    laboratory.commander.change(lambda: command(age=JUMP))
    time.sleep(2.0)
    defect = "" if laboratory.amplifier.is_on() else "commands are not followed any more"
    begin = laboratory.commander.change()
    laboratory.watch(1.2)
    return outcome(laboratory, begin, defect=defect)


# -- the master -----------------------------------------------------------------------------------------------------


def master_hangs(master):
    def run(laboratory):
        master.process.send_signal(signal.SIGSTOP)
        time.sleep(0.5)
        defect = "" if laboratory.amplifier.is_on() else "there is no current without it"
        begin = time.monotonic()
        laboratory.driver.process.send_signal(signal.SIGTERM)
        try:
            status = laboratory.driver.process.wait(LEAVE)
            defect = defect or (f"exit status {status}" if status else "")
        except subprocess.TimeoutExpired:
            defect = defect or f"it is still there after {LEAVE:g} s"
        master.process.send_signal(signal.SIGCONT)
        status_of(laboratory)
        return outcome(laboratory, begin, defect=defect)

    return run


def master_gone(master):
    def run(laboratory):
        master.close()
        time.sleep(0.5)
        defect = "" if laboratory.amplifier.is_on() else "there is no current without it"
        begin = laboratory.commander.change()
        laboratory.watch(1.2)
        laboratory.driver.process.terminate()
        status = status_of(laboratory)
        return outcome(laboratory, begin, defect=defect or (f"exit status {status}" if status else ""))

    return run


def faults_of(master):
    """All faults. That of the lost master is the last."""
    stop, kill, end, amplifier = (0.3, 0.3, None), (None, 0.6, None), (0.1, 0.1, None), (0.5, 0.7, None)
    return [
        Fault("commands stop", commands(lambda: None), stop, is_short=True),
        Fault("commands are NaN", commands(lambda: command(current=math.nan)), stop),
        Fault("commands for three coils", commands(lambda: command(coils=3)), stop),
        Fault("commands without a stamp", commands(stamped(rospy.Time(0))), stop, is_short=True),
        Fault("commands of 1 s ago", commands(lambda: command(age=1.0)), stop, is_short=True),
        Fault("commands of tomorrow", commands(lambda: command(age=-86400.0)), stop, is_short=True),
        Fault("commands of a simulated clock", commands(stamped(SIMULATED)), stop, is_short=True),
        Fault("one command again and again", repeated, stop),
        Fault("flood of commands, until it ends", flood, stop),
        Fault("second commander, until both end", second_commander(100.0), stop, is_short=True),
        Fault("second commander that floods", second_commander(0.0), stop),
        Fault("driver: SIGKILL", killed(signal.SIGKILL), kill, is_short=True),
        Fault("driver: SIGABRT", killed(signal.SIGABRT), kill),
        Fault("driver: SIGSTOP, then SIGCONT", stopped, kill, is_short=True),
        Fault("driver: SIGTERM", ended(signal.SIGTERM), end, is_short=True),
        Fault("driver: SIGINT", ended(signal.SIGINT), end),
        Fault("driver: SIGHUP", ended(signal.SIGHUP), end, is_short=True),
        Fault("driver: SIGQUIT", ended(signal.SIGQUIT), end),
        Fault("driver: SIGALRM", ended(signal.SIGALRM), end, is_short=True),
        Fault("driver: SIGUSR1", ended(signal.SIGUSR1), end),
        Fault("driver: SIGUSR2", ended(signal.SIGUSR2), end),
        Fault("driver: SIGXCPU", ended(signal.SIGXCPU), end),
        Fault("driver: SIGTERM, never applied", ended_while_stuck(math.inf), (None, None, None)),
        Fault("the same, watchdog of 0.3 s", ended_while_stuck(0.3), (None, None, None), is_short=True),
        Fault("driver: SIGTERM, current comes back", coming_back, (None, None, None), is_short=True),
        Fault("driver: exception", thrown, end, is_short=True, preload=True),
        Fault("lying lengths, then commands stop", lying_lengths, stop, is_short=True),
        Fault("driver's clock +1 h", clock_jump(JUMP), stop, preload=True),
        Fault("driver's clock -1 h", clock_jump(-JUMP), stop, preload=True),
        Fault("all clocks -1 h, then commands stop", common_clock_jump, stop, preload=True),
        Fault("amplifier: silence", misbehaving("silence"), amplifier),
        Fault("amplifier: slow", misbehaving("slow"), amplifier, is_short=True),
        Fault("amplifier: dribble", misbehaving("dribble"), amplifier),
        Fault("amplifier: dribble, commands stop", dribbling_to_the_end, amplifier, is_short=True),
        Fault("amplifier: resets", misbehaving("reset"), amplifier),
        Fault("amplifier: wrong ids", misbehaving("wrong id"), amplifier, is_short=True),
        Fault("amplifier: wrong unit id", misbehaving("wrong unit"), amplifier, is_short=True),
        Fault("amplifier: wrong protocol id", misbehaving("wrong protocol"), amplifier),
        Fault("amplifier: wrong length", misbehaving("wrong length"), amplifier),
        Fault("amplifier: endless answers", misbehaving("endless"), amplifier),
        Fault("amplifier: link cut", misbehaving("cut"), (None, 0.7, None)),
        Fault("zero acknowledged, not applied", not_applied(zero), (None, 1.0, 0.5), is_short=True),
        Fault("the same, commands stop", not_applied(lambda: None), (None, 1.0, 0.75)),
        Fault("the same, then applied again", applied_again, (None, 1.0, 0.5)),
        Fault("zero set, current alternates", alternating, (None, 1.0, 0.5), is_short=True),
        Fault("commands of 8 Hz, current stands still", standing_still, (None, 1.0, 0.5), is_short=True),
        *(
            Fault(f"joint sensor: {how}", sensor_fault(how), (None, None, 1.0), needs_laboratory=False)
            for how in ("silence", "dribble", "reset", "wrong id", "wrong unit", "endless")
        ),
        Fault("master hangs, driver: SIGTERM", master_hangs(master), end),
        Fault("master gone, then commands stop", master_gone(master), stop, is_repeatable=False),
    ]


def cell(value, limit):
    if limit is None or value is None:
        return "–"
    return "never" if math.isinf(value) else f"{value:.3f} / {limit:.2f}"


def is_good(result, limits):
    values = (result.registers, result.watchdog, result.told)
    return not result.defect and all(limit is None or value <= limit for value, limit in zip(values, limits))


def tried(fault, folder, limits):
    if not fault.needs_laboratory:
        return fault.run(folder)
    laboratory = Laboratory(folder, fault.preload, max(limit or 0.0 for limit in limits))
    try:
        return fault.run(laboratory)
    except AssertionError as error:
        return Outcome(defect=str(error))
    finally:
        laboratory.close()


def first_good(fault, folder, limits, attempts):
    """The first outcome within the limits, or the last one."""
    for _ in range(attempts):
        result = tried(fault, folder, limits)
        if is_good(result, limits) or not fault.is_repeatable:
            break
    return result


def parse(arguments):
    command_line = parser("fault_campaign", __doc__)
    command_line.add_argument("--short", action="store_true", help="one of each kind")
    command_line.add_argument("--only", default="", help="faults whose names have this part")
    command_line.add_argument(
        "--attempts", type=int, default=1, help="until each is within its limits, on a busy computer (%(default)s)"
    )
    command_line.add_argument("--patience", type=float, default=1.0, help="factor of all limits (%(default)s)")
    return command_line.parse_args(arguments)


def main():
    """Returns the exit status."""
    options = parse(sys.argv[1:])
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # under nohup the driver would outlive it, as it should
    master = Master(free_port())
    rospy.init_node("first_commander", disable_signals=True)
    failures = count = 0
    row = "{:38}{:>16}{:>16}{:>16}  {}"
    print(row.format("fault", "registers", "watchdog 0.5 s", "told", ""), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for fault in faults_of(master):
            if options.only not in fault.name or (options.short and not fault.is_short):
                continue
            limits = tuple(limit and limit * options.patience for limit in fault.limits)
            result = first_good(fault, pathlib.Path(folder), limits, options.attempts)
            good = is_good(result, limits)
            count += 1
            failures += not good
            cells = map(cell, (result.registers, result.watchdog, result.told), limits)
            print(row.format(fault.name, *cells, "" if good else f"FAILED {result.defect}"), flush=True)
    master.close()
    print(f"{count} faults, {failures} beyond their limits")
    return 1 if failures or not count else 0


if __name__ == "__main__":
    sys.exit(main())
