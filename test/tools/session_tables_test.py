#!/usr/bin/python3
"""Sessions as CSV files, and recordings of the CSV files of others."""

import contextlib
import math
import os
import random
import shutil
import sqlite3
import subprocess
import sys
import unittest

import numpy as np
import yaml
from session_tables_case import CALIBRATE_BAG, SOURCE, Folder, call, run
from spherical_actuator_calibration.session_tables.export import quaternion

BEGIN = 1700000000.0
LEVER = np.array([0.0, 0.0, 0.06])


def matrix(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def about(axis, angle):
    """Rotation about one of the axes x, y, z."""
    q = np.zeros(4)
    q[axis], q[3] = math.sin(0.5 * angle), math.cos(0.5 * angle)
    return matrix(q)


class ImportOfSamples(Folder):
    HEADINGS = "joint_1 [deg],joint_2 [rad],joint_3,torque_x [N.mm],torque_y,torque_z [mNm],current_1 [mA],current_2 [A]"

    def test_a_recording_with_its_description_is_calibrated_by_its_name_alone(self):
        self.description(0)
        lines = ["joint_1,joint_2,joint_3,orientation_x,orientation_y,orientation_z,orientation_w"]
        for k in range(12):
            q = np.array([0.4 * math.sin(k), 0.4 * math.cos(2.0 * k), 0.5 * k])
            R = about(0, q[0]) @ about(1, q[1]) @ about(2, q[2])
            w = 0.5 * math.sqrt(1.0 + np.trace(R))
            x, y, z = R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]
            lines.append(",".join(map(repr, map(float, [*q, 0.25 * x / w, 0.25 * y / w, 0.25 * z / w, w]))))
        self.assertEqual(self.import_csv(self.write("samples.csv", "\n".join(lines) + "\n")).returncode, 0)
        said = run(CALIBRATE_BAG, self.folder / "out.bag")
        self.assertEqual(said.returncode, 0, said.stdout + said.stderr)
        for part in ("Description: as recorded", "joint_3/axis_v", "Nothing is written", "grade: not_validated"):
            self.assertIn(part, said.stdout)

    def test_units_of_headings(self):
        self.description(2)
        table = self.write("s.csv", f"{self.HEADINGS}\n# by hand\n180,0.5,0.25,1000,2,500,1500,-1\n\n90,0,0,,,,,\n")
        result = self.import_csv(table)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout, "2 samples\n")
        first, second = self.messages("samples")
        np.testing.assert_allclose(first.joint_position, [math.pi, 0.5, 0.25], rtol=1e-15)
        np.testing.assert_allclose([first.torque.x, first.torque.y, first.torque.z], [1.0, 2.0, 0.5])
        self.assertEqual(list(first.current), [1.5, -1.0])
        self.assertTrue(first.has_torque and not first.has_orientation)
        self.assertFalse(second.has_torque)
        self.assertEqual([first.id, second.id], [1, 2])
        self.assertEqual(self.messages("parameters")[0].serial, "unit-7")

    def test_errors_name_file_line_and_column(self):
        self.description(2)
        path = self.folder / "s.csv"

        def refuse(text, part):
            self.write("s.csv", text)
            self.refused(part, path)

        refuse(f"{self.HEADINGS}\n1,2,x,,,,,\n", f'{path}:2: column 3 (joint_3): "x" is not a number.')
        refuse(f"{self.HEADINGS}\n1,2,3,,,,,\n1,nan,3,,,,,\n", f"{path}:3: column 2 (joint_2 [rad])")
        refuse(f"{self.HEADINGS}\n1,,3,,,,,\n", f"{path}:2: column 2 (joint_2 [rad]): it is empty")
        refuse(f"{self.HEADINGS}\n1,2,3,4,,6,1,1\n", "column 5 (torque_y): torque_y is empty")
        refuse(f"{self.HEADINGS}\n1,2,3,4,5,6,,\n", f"{path}:2: a torque needs the currents of all 2 coils")
        refuse(f"{self.HEADINGS}\n1,2,3,4,5,6,7,8,9\n", f"{path}:2: 9 cells, but 8 headings")
        refuse("joint_1,joint_2\n1,2\n", f'{path}:1: "joint_3": there is no such column')
        refuse("joint_1 [kg],joint_2,joint_3\n", "the unit must be one of rad, mrad, deg")
        refuse("joint_1,joint_2,joint_3,speed\n", 'column 4 ("speed") is none of samples.csv')
        refuse("joint_1,joint_2,joint_3,joint_1\n", "is there twice")
        refuse("joint_1,joint_2,joint_3\n", "there is no sample")
        refuse("", "there is no line 1 with headings")
        quaternions = "joint_1,joint_2,joint_3,orientation_x,orientation_y,orientation_z,orientation_w\n"
        refuse(quaternions + "1,2,3,0,0,0,2\n", "the quaternion has norm 2 instead of 1")
        refuse("joint_1,joint_2,joint_3,validation\n1,2,3,4\n", "4 is outside [0, 1]")
        refuse("joint_1,joint_2,joint_3,joint_1_stddev\n1,2,3,-1\n", "-1 is less than 0")
        self.refused("no.csv: cannot be read", self.folder / "no.csv")
        self.write("s.csv", "joint_1,joint_2,joint_3\n1,2,3\n")
        self.write("actuator.yaml", "actuator: [1\n")
        self.refused("actuator.yaml:2: this is not valid YAML", path)

    def test_the_table_of_the_torque_curve_is_in_the_description(self):
        self.description(2)
        (self.folder / "curves").mkdir()
        points = [(float(k), 0.01 * k * (30.0 - k)) for k in range(31)]
        self.write("curves/curve.csv", "".join(f"{angle!r},{torque!r}\n" for angle, torque in points))
        path = self.folder / "actuator.yaml"
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
        content["actuator"]["torque_curve"] = {"angle_unit": "deg", "table": "curves/curve.csv"}
        self.write(path.name, yaml.safe_dump(content))
        table = self.write("s.csv", "joint_1,joint_2,joint_3\n1,2,3\n")
        result = self.import_csv(table)
        self.assertEqual(result.returncode, 0, result.stderr)
        (text,) = self.messages("calibration_description")
        curve = yaml.safe_load(text.data)["actuator"]["torque_curve"]["table"]
        np.testing.assert_allclose(curve["torques"], [torque for _, torque in points], rtol=1e-15)
        (self.folder / "out.bag").unlink()
        (self.folder / "curves" / "curve.csv").unlink()
        self.refused("curve.csv: cannot be read", table)

    def test_a_description_that_calibrate_bag_would_refuse_is_refused(self):
        table = self.write("s.csv", "joint_1,joint_2,joint_3\n1,2,3\n")
        path = self.description(2)
        plain = path.read_text(encoding="utf-8")
        for serial in ("007", "1.10"):
            self.write(path.name, plain.replace("unit-7", serial))
            self.refused(f'actuator.serial: "{serial}" is not a string', table)
        # A number of YAML 1.1 alone, and a text for the core.
        for serial in ('"007"', "1_000"):
            self.write(path.name, plain.replace("unit-7", serial))
            self.assertEqual(self.import_csv("--force", table).returncode, 0)
            self.assertEqual(self.messages("parameters")[0].serial, serial.strip('"'))
        (self.folder / "out.bag").unlink()
        self.write(path.name, plain.replace("name: positioner", "name: 42"))
        self.refused('actuator.name: "42" is not a string', table)
        self.write(path.name, plain.replace("polarity: 1", "polarity: 3"))
        self.refused("actuator.poles[0].polarity", table)
        self.write(path.name, plain.replace("name: axis_0", "name: [a]"))
        self.refused("actuator.joints[0].name", table)
        self.write(path.name, "- 1\n")
        self.refused(path.name, table)


class ImportOfStreams(Folder):
    """A model of a session in the formats of three neighbours, by the file of the example."""

    def setUp(self):
        super().setUp()
        shutil.copy(SOURCE / "config/examples/import_csv/import.yaml", self.folder)
        self.description(2)
        random.seed(1)
        self.times = [0.01 * n for n in range(300)]
        self.orientation = about(2, 0.4) @ about(0, 0.2)
        self.torque = np.array([0.1, -0.2, 0.3])
        self.write_joints()
        self.write_motion_capture()
        self.write_force_torque()
        rows = [f"{BEGIN + time:.6f},0.5,-0.25" for time in self.times]
        self.write("currents.csv", "\n".join(["time,coil_1 [A],coil_2 [A]", *rows]) + "\n")

    def write_joints(self):
        headings = "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.name0,field.name1,field.name2,"
        headings += "field.position0,field.position1,field.position2"
        rows = [f"{int(BEGIN) * 10**9 + n * 10**7 + 77},{n},{int(BEGIN) * 10**9 + n * 10**7},,a,b,c,0.1,0.2,0.3" for n in range(300)]
        self.write("joints.csv", "\n".join([headings, *rows]) + "\n")

    def write_motion_capture(self):
        # R_stator_rotor = R_stator_tracker R_tracker_marker R_rotor_marker^T, with the example's registrations.
        measured = about(2, 0.5 * math.pi).T @ self.orientation @ about(1, math.pi / 3.0)
        x, y, z, w = quaternion(measured.ravel())
        head = ["Format Version,1.23,Take Name,Take 1", "", ",,Rigid Body,Rigid Body,Rigid Body,Rigid Body"]
        head += [",,marker,marker,marker,marker", ",,id,id,id,id", ",,Rotation,Rotation,Rotation,Rotation"]
        head += ["Frame,Time (Seconds),X,Y,Z,W,X,Y,Z"]
        rows = [f"{n},{time:.6f},{x:.12f},{y:.12f},{z:.12f},{w:.12f},1,2,3" for n, time in enumerate(self.times)]
        rows[7] = "7,0.070000,,,,,,,"
        self.write("motion_capture.csv", "\n".join(head + rows) + "\n")

    def write_force_torque(self):
        rotation, force = about(2, math.pi / 6.0), np.array([1.0, 2.0, -3.0])
        torque = 1e3 * rotation.T @ (self.torque - np.cross(LEVER, rotation @ force))
        cells = ";".join(f"{value:.12g}" for value in (*force, *torque))
        rows = [f"{1e3 * time:.3f};{cells}" for time in self.times]
        self.write("force_torque.csv", "\n".join(["t_ms;Fx;Fy;Fz;Tx;Ty;Tz", *rows]) + "\n")

    def test_streams_are_those_of_the_rotor(self):
        result = self.import_csv("--streams", self.folder / "import.yaml")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("measured_orientation: 299 measurements, 1 lines without values left out", result.stdout)
        joints = self.messages("joint_states")
        self.assertEqual(joints[3].header.stamp.to_nsec(), int(BEGIN) * 10**9 + 3 * 10**7)
        self.assertEqual((joints[0].name, joints[0].position), (["axis_0", "axis_1", "axis_2"], (0.1, 0.2, 0.3)))
        orientation = self.messages("measured_orientation")[0]
        q = orientation.quaternion
        np.testing.assert_allclose(matrix([q.x, q.y, q.z, q.w]), self.orientation, atol=1e-10)
        self.assertEqual(orientation.header.frame_id, "stator")
        torque = self.messages("measured_torque")[5]
        np.testing.assert_allclose([torque.vector.x, torque.vector.y, torque.vector.z], self.torque, atol=1e-10)
        self.assertAlmostEqual(torque.header.stamp.to_sec(), BEGIN + 0.05, places=6)
        self.assertEqual(self.messages("coil_currents")[0].current, (0.5, -0.25))
        self.assertEqual(len(self.messages("calibration_description")), 1)
        # They can be read: bad would be a status of 2.
        result = run(CALIBRATE_BAG, "--output", self.folder / "o.yaml", "--cycles", "joint", self.folder / "out.bag")
        self.assertIn("1 dwell at rest gave 1 sample;", result.stdout)
        self.assertEqual(result.returncode, 1, result.stderr)

    def changed(self, part, **changes):
        content = yaml.safe_load((self.folder / "import.yaml").read_text())
        content["streams"][1].update(changes)
        self.refused(part, "--streams", self.write("other.yaml", yaml.safe_dump(content)))

    def test_errors_name_key_or_line(self):
        self.changed("streams[1].values: 3 columns; 4 are needed", values=[1, 2, 3])
        self.changed('motion_capture.csv:7: "X": 2 columns are called so; name one by its number', values=["X", 4, 5, 6])
        self.changed("motion_capture.csv:7: there is no column 12: it has 9", values=[12, 4, 5, 6])
        self.changed("streams[1].speed: a stream measured_orientation has no such key", speed=1)
        self.changed("streams[1].stream: \"pose\" is none of joint_states", stream="pose")
        self.changed("streams[1].stator_tracker: the quaternion x, y, z, w has norm 2", stator_tracker=[0, 0, 0, 2])
        self.changed("streams[1].time.unit: it is one of s, ms, us, ns", time={"column": 2, "unit": "h"})
        self.changed("is no stamp", time={"column": 2, "offset": -5})
        lines = (self.folder / "motion_capture.csv").read_text().splitlines()
        lines[9] = lines[9].replace(",1,2,3", "").replace("0.", "O.", 1)
        self.write("motion_capture.csv", "\n".join(lines))
        self.refused("motion_capture.csv:10: column 2 (Time (Seconds))", "--streams", self.folder / "import.yaml")


class Export(Folder):
    def test_what_is_no_session_is_refused(self):
        with contextlib.closing(sqlite3.connect(self.folder / "other.db")) as database:
            database.execute("CREATE TABLE a (b)")
        for name, part in (("no.db", "no such file"), ("other.db", "not a session"), ("text.db", "cannot be read")):
            if name == "text.db":
                self.write(name, "no database" * 1000)
            result = call("export_session", self.folder / name, self.folder / "out")
            self.assertEqual(result.returncode, 2)
            self.assertIn(part, result.stderr)

    def test_what_would_be_waited_for_is_refused(self):
        session = self.folder / "session.db"
        os.mkfifo(session)
        # As a program, which can be given up on.
        program = SOURCE / "scripts" / "export_session"
        self.assertIn(f"{session}: is a FIFO, not a file.", run(program, session, self.folder / "out").stderr)
        session.unlink()
        with contextlib.closing(sqlite3.connect(session)) as database:
            database.execute("CREATE TABLE a (b)")
        for ending in ("-journal", "-wal", "-shm"):
            beside = self.folder / f"session.db{ending}"
            os.mkfifo(beside)
            result = run("timeout", "60", program, session, self.folder / "out")
            self.assertEqual(result.returncode, 2, result)
            self.assertIn(f"{beside} is a FIFO, not a file; remove it.", result.stderr)
            beside.unlink()

    def test_what_is_no_table_is_refused(self):
        session = self.folder / "session.db"
        endless = "WITH RECURSIVE r(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM r) SELECT n FROM r"
        for number, (sql, part) in enumerate(
            (
                (f"CREATE VIEW samples AS {endless}", 'the view "samples"'),
                ("CREATE TRIGGER t AFTER INSERT ON a BEGIN DELETE FROM a; END", 'the trigger "t"'),
                ("CREATE TABLE samples (id, date AS (hex(zeroblob(400000000))))", 'the column "date"'),
                ("CREATE VIRTUAL TABLE samples USING fts5(id)", 'the table "samples"'),
            )
        ):
            session.unlink(missing_ok=True)
            with contextlib.closing(sqlite3.connect(session)) as database:
                database.execute("PRAGMA application_id = 1396786003")
                database.execute("PRAGMA user_version = 4")
                database.execute("CREATE TABLE a (b)")
                database.execute(sql)
            program = SOURCE / "scripts" / "export_session"
            result = run("timeout", "60", program, session, self.folder / f"out{number}")
            self.assertEqual(result.returncode, 2, result)
            self.assertIn(f"{session}: holds {part}, which this package does not make", result.stderr)

    def test_what_was_left_half_written_is_refused(self):
        killed = (
            "import os, sqlite3\n"
            "database = sqlite3.connect('session.db', isolation_level=None)\n"
            "database.execute('CREATE TABLE a (b)')\n"
            "database.execute('PRAGMA cache_size = 5')\n"
            "database.execute('BEGIN')\n"
            "for _ in range(200):\n"
            "    database.execute('INSERT INTO a VALUES (?)', ('x' * 500,))\n"
            "os._exit(0)"
        )
        subprocess.run([sys.executable, "-c", killed], cwd=self.folder, check=True)
        result = call("export_session", self.folder / "session.db", self.folder / "out")
        self.assertEqual(result.returncode, 2)
        self.assertIn("its node was ended while it stored something; start it once", result.stderr)

    def test_quaternions_give_back_the_rotation(self):
        random.seed(2)
        for _ in range(100):
            q = np.array([random.gauss(0.0, 1.0) for _ in range(4)])
            q[random.randrange(4)] *= 1e-9
            q /= np.linalg.norm(q)
            found = quaternion(matrix(q).ravel())
            self.assertGreaterEqual(found[3], 0.0)
            np.testing.assert_allclose(matrix(found), matrix(q), atol=1e-14)


if __name__ == "__main__":
    unittest.main()
