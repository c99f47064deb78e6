#!/usr/bin/python3
"""What import_csv refuses, and that it leaves nothing behind."""

import math
import os
import unittest

import yaml
from session_tables_case import SOURCE, Folder, run


class Output(Folder):
    def setUp(self):
        super().setUp()
        self.description(0)
        self.table = self.write("s.csv", "\n".join(["joint_1,joint_2,joint_3"] + ["1,2,3"] * 1000) + "\n")
        self.out = self.folder / "out.bag"
        self.command = [SOURCE / "scripts/import_csv", "--actuator", self.folder / "actuator.yaml", self.table]

    def refuses(self, output, words, *options):
        """As a program, which can be given up on."""
        said = run("timeout", "60", *self.command, "--output", output, *options)
        self.assertEqual((said.returncode, said.stderr), (2, f"import_csv: {words}\n"))

    def test_on_a_full_disk_the_file_is_named_and_nothing_left(self):
        said = run("bash", "-c", 'ulimit -f 8 && exec "$@"', "bash", *self.command, "--output", self.out)
        words = f"import_csv: {self.out}: cannot be written: File too large.\n"
        self.assertEqual((said.returncode, said.stderr), (2, words))
        self.assertEqual(list(self.folder.glob("*.bag*")), [])

    def test_what_is_no_file_is_not_replaced(self):
        pipe, link = self.folder / "pipe", self.folder / "link"
        os.mkfifo(pipe)
        link.symlink_to("nowhere")
        for target in (self.folder, pipe):
            self.refuses(target, f"{target}: this is not a regular file; choose another name.", "--force")
        self.refuses(link, f"{link}: the file exists already; choose another name or give --force.")
        missing = self.folder / "no" / "out.bag"
        self.refuses(missing, f"{missing}: cannot be written: No such file or directory.")
        active = self.folder / "out.bag.active"
        active.symlink_to("precious")
        self.refuses(self.out, f"{active}: is a symbolic link, not a file; remove it.")
        active.unlink()
        os.mkfifo(active)
        self.refuses(self.out, f"{active}: is a FIFO, not a file; remove it.")


class Tables(Folder):
    HEADINGS = "joint_1,joint_2,joint_3\n"

    def setUp(self):
        super().setUp()
        self.description(0)

    def angles(self, text):
        result = self.import_csv("--force", self.write("s.csv", text))
        self.assertEqual(result.returncode, 0, result.stderr)
        return [tuple(sample.joint_position) for sample in self.messages("samples")]

    def test_remarks_and_empty_lines_before_the_headings_are_left_out(self):
        rows = "1,2,3\n4,5,6\n"
        for before in ("# by hand\n", "\n\n# a, b, c\n,,\n", "#\n"):
            self.assertEqual(self.angles(before + self.HEADINGS + rows), [(1, 2, 3), (4, 5, 6)])
        # As numpy writes them.
        self.assertEqual(self.angles("# " + self.HEADINGS + rows), [(1, 2, 3), (4, 5, 6)])
        self.assertEqual(self.angles("# one remark, and\n# " + self.HEADINGS + rows), [(1, 2, 3), (4, 5, 6)])

    def test_another_separator_is_named(self):
        text = (self.HEADINGS + "1,2,3\n").replace(",", "\t")
        self.refused("s.csv:1: tabs separate the headings", self.write("s.csv", text))

    def test_a_spreadsheet_with_decimal_commas_is_read(self):
        headings = self.HEADINGS.replace(",", ";")
        self.assertEqual(self.angles(headings + "1,5;-0,25;3\n"), [(1.5, -0.25, 3.0)])
        self.assertEqual(self.angles("# by hand, twice\n" + headings + "1e-3;2,5e1;3.5\n"), [(1e-3, 25.0, 3.5)])
        self.assertEqual(self.angles("# " + headings + "1,5;2;3\n"), [(1.5, 2.0, 3.0)])
        self.assertEqual(self.angles("sep=;\n" + headings + "1,5;2;3\n"), [(1.5, 2.0, 3.0)])
        (self.folder / "out.bag").unlink()
        # Neither is known to be the decimal mark.
        self.refused('"1.234,5" is not a number.', self.write("s.csv", headings + "1.234,5;2;3\n"))
        self.refused('"1,234,5" is not a number.', self.write("s.csv", headings + "1,234,5;2;3\n"))

    def test_numbers_of_python_alone_are_none(self):
        for text in ("1_0", "\u0661"):
            self.refused(f'"{text}" is not a number.', self.write("s.csv", self.HEADINGS + f"1,2,{text}\n"))
        self.refused("is not a whole number", self.write("s.csv", "id," + self.HEADINGS + "1_0,1,2,3\n"))


    def test_decimal_commas_between_commas_get_a_remedy(self):
        told = '"1,5" is not a number; for decimal commas let semicolons separate the columns, or write points.'
        self.refused(told, self.write("s.csv", self.HEADINGS + '"1,5","2,0","3,0"\n'))

    def test_samples_of_one_id_and_stamp_are_refused(self):
        headings = "id,stamp [ns]," + self.HEADINGS
        self.assertEqual(len(self.angles(headings + "1,5,1,2,3\n1,6,4,5,6\n")), 2)
        (self.folder / "out.bag").unlink()
        self.refused("s.csv:3: column 1 (id): id 1 and stamp are those of line 2", self.write("s.csv", headings + "1,5,1,2,3\n1,5,4,5,6\n"))


class Streams(Folder):
    """Of an entry or a file that holds something else than was expected."""

    def expect(self, part, stamp="2", **changes):
        self.description(0)
        self.write("joints.csv", f"t,a,b,c\n1,1,2,3\n{stamp},1,2,3\n")
        entry = {"file": "joints.csv", "stream": "joint_states", "time": {"column": "t"}, "values": ["a", "b", "c"]}
        entry.update(changes)
        self.refused(part, "--streams", self.write("i.yaml", yaml.safe_dump({"streams": [entry]})))

    def imported(self, text, **changes):
        """Angles and seconds of the streams of one or several texts, and what was said."""
        self.description(0)
        entries = []
        for number, lines in enumerate([text] if isinstance(text, str) else text):
            name = self.write(f"joints_{number}.csv", lines).name
            entries.append({"file": name, "stream": "joint_states", "time": {"column": "t"}, "values": ["a", "b", "c"], **changes})
        result = self.import_csv("--force", "--streams", self.write("i.yaml", yaml.safe_dump({"streams": entries})))
        self.assertEqual(result.returncode, 0, result.stderr)
        return [(*joints.position, joints.header.stamp.to_sec()) for joints in self.messages("joint_states")], result.stdout

    def test_decimal_commas(self):
        text = "t;a;b;c\n1,25;0,5;-1,5;2\n"
        self.assertEqual(self.imported(text, separator=";", decimal=",")[0], [(0.5, -1.5, 2.0, 1.25)])
        self.write("joints.csv", text)
        entry = {"file": "joints.csv", "stream": "joint_states", "separator": ";"}
        entry.update({"time": {"column": 3}, "values": ["a", "b", "c"]})
        (self.folder / "out.bag").unlink()
        key = '"0,5" is not a number; for decimal commas give the stream the key decimal: ","'
        self.refused(key, "--streams", self.write("i.yaml", yaml.safe_dump({"streams": [entry]})))
        self.expect("streams[0].decimal: it is a point or a comma.", decimal="·")

    def test_a_sensor_that_is_read_twice_is_refused(self):
        first, second = "t,a,b,c\n1,0,0,0\n2,0,0,0\n", "t,a,b,c\n2,0,0,0\n3,0,0,0\n"
        later = second.replace("2,0", "2.5,0")
        self.assertEqual([row[3] for row in self.imported([first, later])[0]], [1.0, 2.0, 2.5, 3.0])
        (self.folder / "out.bag").unlink()
        entry = {"stream": "joint_states", "time": {"column": "t"}, "values": ["a", "b", "c"]}
        for name, text in (("a.csv", first), ("b.csv", second)):
            self.write(name, text)
        streams = [{"file": "a.csv", **entry}, {"file": "b.csv", **entry}]
        self.refused(
            "streams[0] and streams[1] are both joint_states, and overlap in time",
            "--streams",
            self.write("i.yaml", yaml.safe_dump({"streams": streams})),
        )

    def test_angles_that_may_be_degrees_are_told(self):
        text = "t,a,b,c\n1,12,-31.5,3\n"
        self.assertIn("its angles reach 31.5, and count as radians", self.imported(text)[1])
        for told in ({"unit": "rad"}, {"unit": "deg"}, {"values": [2, 3, 4]}):
            named = text.replace("a,b,c", "a [deg],b [rad],c [rad]") if "values" in told else text
            self.assertNotIn("count as radians", self.imported(named, **told)[1])
        self.assertNotIn("count as radians", self.imported("t,a,b,c\n1,1,-0.5,6.28\n")[1])

    def test_streams_without_a_common_time_are_refused(self):
        self.description(0)
        self.write("joints.csv", "t,a,b,c\n1,0,0,0\n2,0,0,0\n")
        self.write("torque.csv", "t,a,b,c\n3601,0,0,0\n3602,0,0,0\n")
        entry = {"time": {"column": "t"}, "values": ["a", "b", "c"]}
        streams = [{"file": "joints.csv", "stream": "joint_states", **entry}]
        streams.append({"file": "torque.csv", "stream": "measured_torque", **entry})
        told = "measured_torque, from 3601.000 to 3602.000 s, and joint_states, from 1.000 to 2.000 s, have no time in common"
        self.refused(told, "--streams", self.write("i.yaml", yaml.safe_dump({"streams": streams})))

    def test_a_column_for_two_values_is_refused(self):
        self.expect("i.yaml: streams[0].values: one column is there twice.", values=["a", "b", "a"])

    def test_times_of_any_size(self):
        place = "joints.csv:3: column 1 (t): "
        for time in ("1e9999999", "1e999999999999999999999", "nan", "1_0", "x"):
            self.expect(f'{place}"{time}" is not a time.', time)
        for time in ("1e400", "-1e400", "1e-9999999", "inf", "1e10", "0"):
            self.expect("s is no stamp: they lie between 0 and 2^32 s", time)

    def test_values_of_another_type(self):
        for unit in (["rad"], {"rad": 1}, 1):
            self.expect("i.yaml: streams[0].unit: it is one of rad, mrad, deg.", unit=unit)
            self.expect("i.yaml: streams[0].time.unit: it is one of s, ms, us, ns.", time={"column": "t", "unit": unit})
        self.expect("i.yaml: streams[0].time.offset: it is a number", time={"column": "t", "offset": math.nan})
        orientation = {"stream": "measured_orientation", "values": ["a", "b", "c", "t"]}
        self.expect("[0].rotor_marker: it is a list of 4 finite numbers", **orientation, rotor_marker=[0, 0, 0, math.inf])


if __name__ == "__main__":
    unittest.main()
