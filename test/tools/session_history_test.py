#!/usr/bin/python3
"""What list_revisions tells of sessions of one unit."""

import contextlib
import math
import os
import pathlib
import sqlite3
import subprocess
import tempfile
import unittest

from spherical_actuator_calibration.session_guide.revisions import revisions_told, sessions_beside
from spherical_actuator_calibration.session_tables.export import APPLICATION, ExportError
from spherical_actuator_calibration.parameter_drift import drifts_between
from spherical_actuator_calibration.session_tables.history import histories_of, lines_of

TABLES = """
CREATE TABLE unit (name, serial, description, effects);
CREATE TABLE revisions (number, date, software, source, origin, predecessor, refined, cycle);
CREATE TABLE cycles (id, date, cycle, coil, error_unit, samples_used);
CREATE TABLE cycle_errors (cycle, iteration, error);
CREATE TABLE cycle_estimates (cycle, position, name, unit, nominal, initial, value, stddev, observable);
"""


class History(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def session(self, name, date, offset, serial="unit-7", origin="joint"):
        """A session that identified one offset [rad], known to 1 mrad."""
        path = self.folder / name
        with contextlib.closing(sqlite3.connect(path)) as database:
            database.executescript(TABLES)
            database.execute(f"PRAGMA application_id = {APPLICATION}")
            database.execute("PRAGMA user_version = 10")
            database.execute("INSERT INTO unit VALUES ('a', ?, '', '')", [serial])
            database.execute("INSERT INTO cycles VALUES (1, ?, 'joint', 0, 'rad', 40)", [date])
            for iteration, error in enumerate((0.05, 0.01, 0.002)):
                database.execute("INSERT INTO cycle_errors VALUES (1, ?, ?)", [iteration, error])
            estimates = (("joint_1/offset", offset, 1e-3, 1), ("joint_2/offset", 0.3, float("inf"), 0))
            for position, (parameter, value, stddev, observable) in enumerate(estimates):
                database.execute(
                    "INSERT INTO cycle_estimates VALUES (1, ?, ?, 'rad', 0, 0, ?, ?, ?)",
                    [position, parameter, value, stddev, observable],
                )
            database.execute("INSERT INTO revisions VALUES (0, ?, '', 'nominal', 'start', NULL, 0, NULL)", [date])
            database.execute("INSERT INTO revisions VALUES (1, ?, '', 'identified', ?, 0, 0, 1)", [date, origin])
            database.commit()
        return path

    @staticmethod
    def lines(paths):
        histories, unread = histories_of(paths)
        assert not unread, unread
        return [line for history in histories for line in lines_of(history)]

    def damaged(self, name, statement):
        """A session of the unit in which a statement changed something."""
        path = self.session(name, "2026-02-01T00:00:00Z", 0.1)
        with contextlib.closing(sqlite3.connect(path)) as database:
            database.execute(statement)
            database.commit()
        return path

    def test_lists_revisions_with_their_errors(self):
        lines = self.lines([self.session("a.db", "2026-01-02T03:04:05Z", 0.1)])
        self.assertEqual(len(lines), 3)
        self.assertEqual(lines[1].split(), ["0", "2026-01-02T03:04:05Z", "start"])
        self.assertIn("joint", lines[2])
        self.assertIn("50 \u2192 2 mrad, 40 samples", lines[2])

    def test_knows_what_earlier_formats_counted_errors_in(self):
        for measure, told in (("orientation", "50 \u2192 2 mrad"), ("torque", "50 \u2192 2 mN·m"), ("standardized", "0.05 \u2192 0.002")):
            with self.subTest(measure):
                path = self.damaged(f"{measure}.db", "ALTER TABLE cycles RENAME COLUMN error_unit TO error_measure")
                with contextlib.closing(sqlite3.connect(path)) as database:
                    database.execute("UPDATE cycles SET error_measure = ?", [measure])
                    database.execute("PRAGMA user_version = 9")
                    database.commit()
                self.assertIn(f"{told}, 40 samples", self.lines([path])[2])

    def test_counts_windows_of_a_motion(self):
        lines = self.lines([self.session("a.db", "2026-01-02T03:04:05Z", 0.1, origin="motion")])
        self.assertIn("50 \u2192 2 mrad, 40 windows", lines[2])

    def test_tells_the_drift_in_the_order_of_dates(self):
        later = self.session("later.db", "2026-03-01T00:00:00Z", 0.1 + 5e-3)
        earlier = self.session("earlier.db", "2026-01-01T00:00:00Z", 0.1)
        lines = self.lines([later, earlier])
        self.assertIn("earlier.db", lines[0])
        self.assertEqual(
            lines[-1].strip(),
            "furthest from the session before: joint_1/offset by +0.005 rad, 3.5 standard deviations of the change",
        )

    def test_tells_the_same_to_those_who_cannot_read_files(self):
        folders = {"old": ("2026-01-01T00:00:00Z", "unit-7"), "new": ("2026-03-01T00:00:00Z", "unit-7"), "other": ("", "unit-8")}
        for folder, (date, serial) in folders.items():
            (self.folder / folder).mkdir()
            self.session(f"{folder}/session.db", date, 0.1 + 5e-3 * (folder == "new"), serial)
        (self.folder / "broken").mkdir()
        (self.folder / "broken" / "session.db").write_text("no database")
        present = self.folder / "new" / "session.db"
        beside, unread = sessions_beside(present)
        self.assertEqual(beside, [self.folder / "old" / "session.db"])
        self.assertEqual(len(unread), 1)
        self.assertIn("broken/session.db: ", unread[0])
        (start, joint, present_start, present_joint), unread = revisions_told(present, beside)
        self.assertEqual(unread, [])
        self.assertEqual([start.restorable, present_joint.restorable], [False, True])
        self.assertTrue(math.isnan(present_start.error_before))
        self.assertEqual((joint.number, joint.origin, joint.error_unit, joint.samples_used), (1, "joint", "rad", 40))
        self.assertEqual((joint.error_before, joint.error_after), (0.05, 0.002))
        self.assertEqual([start.drift, joint.drift, present_start.drift], ["", "", ""])
        self.assertIn("joint_1/offset by +0.005 rad, 3.5 standard deviations", present_joint.drift)

    def test_names_damaged_sessions_and_lists_the_others(self):
        whole = self.session("whole.db", "2026-01-01T00:00:00Z", 0.1)
        damaged = [
            self.damaged("without_revisions.db", "DROP TABLE revisions"),
            self.damaged("date.db", "UPDATE revisions SET date = NULL"),
            self.damaged("text.db", "UPDATE cycle_estimates SET stddev = 'small'"),
            self.damaged("bytes.db", "UPDATE cycle_estimates SET name = CAST(x'ff41' AS TEXT)"),
            self.damaged("unit.db", "DELETE FROM unit"),
        ]
        cut = self.session("cut.db", "2026-01-01T00:00:00Z", 0.1)
        cut.write_bytes(cut.read_bytes()[:5000])
        histories, unread = histories_of([*damaged, whole, cut])
        self.assertEqual([history.path for history in histories], [whole])
        for path, sentence in zip([*damaged, cut], unread):
            self.assertIn(f"{path}: ", sentence)
        told, unread = revisions_told(whole, [damaged[0]])
        self.assertEqual(([revision.number for revision in told], len(unread)), ([0, 1], 1))
        with self.assertRaisesRegex(ExportError, "without_revisions.db: "):
            revisions_told(damaged[0], [whole])

    def test_the_program_names_damaged_sessions_and_lists_the_others(self):
        whole = self.session("whole.db", "2026-01-01T00:00:00Z", 0.1)
        damaged = self.damaged("damaged.db", "DROP TABLE cycles")
        for sessions, status in (((whole,), 0), ((damaged, whole), 1), ((damaged,), 2)):
            result = subprocess.run(
                [os.path.join(os.environ["PROGRAMS"], "list_revisions"), *sessions], capture_output=True, text=True, check=False
            )
            self.assertEqual(result.returncode, status, result.stderr)
            self.assertEqual("whole.db: revision" in result.stdout, status < 2)
            self.assertEqual("damaged.db: " in result.stderr, status > 0)

    def test_refuses_sessions_of_two_units(self):
        sessions = [self.session("a.db", "2026-01-01", 0.1), self.session("b.db", "2026-01-02", 0.1, "unit-8")]
        with self.assertRaisesRegex(ExportError, "b.db: is of another unit"):
            self.lines(sessions)

    def test_an_angle_drifts_the_short_way(self):
        (drift,) = drifts_between({"a": (3.1415, 1e-3, "rad")}, {"a": (-3.1415, 1e-3, "rad")})
        self.assertLess(abs(drift.change), 1e-3)
        self.assertEqual(drifts_between({}, {"a": (0.0, 1.0, "rad")}), [])

    def test_what_is_known_exactly_drifts_only_where_it_changed(self):
        moved, same = drifts_between({"a": (1.0, 0.0, "1"), "b": (1.0, 0.0, "1")}, {"a": (1.5, 0.0, "1"), "b": (1.0, 0.0, "1")})
        self.assertEqual((moved.name, moved.deviations), ("a", float("inf")))
        self.assertEqual((same.name, same.deviations), ("b", 0.0))


if __name__ == "__main__":
    unittest.main()
