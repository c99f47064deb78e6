#!/usr/bin/python3
"""study/slurm_study on a cluster of one node: killed tasks are submitted again, and the merge is the whole study."""

import os
import pathlib
import socket
import subprocess
import tempfile
import unittest

import slurm_cluster

PROGRAM = pathlib.Path(os.environ["PROGRAMS"]) / "calibration_study"
SOURCE = pathlib.Path(os.environ["SOURCE"])
STUDY = ("--actuator", SOURCE / "config" / "pm_spherical_8x24.yaml", "--trials", "9")
PATIENCE = 300  # [s]

# The second shard is killed in its first attempt, as a node that runs out of memory does it.
KILLED_ONCE = """\
#!/bin/sh
if [ "${{SLURM_ARRAY_TASK_ID:-}}" = 2 ] && mkdir {folder}/was_killed 2>/dev/null; then kill -KILL $$; fi
exec {program} "$@"
"""
KILLED_ALWAYS = """\
#!/bin/sh
if [ "${{SLURM_ARRAY_TASK_ID:-}}" = 2 ] && ! [ -e {folder}/is_mended ]; then kill -KILL $$; fi
exec {program} "$@"
"""


class SlurmStudy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if [name for _, name in socket.if_nameindex()] == ["lo"]:
            raise unittest.SkipTest("Slurm has no address to listen at where loopback is all the network")
        cls.cluster_folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.cluster_folder.cleanup)
        cls.cluster = slurm_cluster.Cluster(cls.cluster_folder.name)
        cls.addClassCleanup(cls.cluster.stop)
        cls.cluster.start()
        cls.whole = pathlib.Path(cls.cluster_folder.name) / "whole.yaml"
        subprocess.run([PROGRAM, *STUDY, "--output", cls.whole], check=True, stdout=subprocess.DEVNULL)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.study = self.folder / "study.yaml"

    def submit(self, program, arguments=STUDY, status=0, **environment):
        wrapper = self.folder / "calibration_study"
        wrapper.write_text(program.format(folder=self.folder, program=PROGRAM))
        wrapper.chmod(0o755)
        result = subprocess.run(
            [SOURCE / "study" / "slurm_study", self.study, "3", *arguments],
            env={**self.cluster.environment, "CALIBRATION_STUDY": str(wrapper), **environment},
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=False,
        )
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def wait_until_all_jobs_ended(self):
        self.cluster.wait_until(lambda: self.cluster.command("squeue", "--noheader") == "", PATIENCE)

    def merge_log(self):
        return (self.folder / "study.yaml.shards" / "merge.log").read_text()

    def test_a_killed_task_is_submitted_again_and_the_merge_is_the_whole(self):
        said = self.submit(KILLED_ONCE)
        self.assertIn("shards 1,2,3: job array", said)
        self.cluster.wait_until(self.study.exists, PATIENCE)
        self.assertTrue((self.folder / "was_killed").is_dir())
        self.assertEqual(self.study.read_bytes(), self.whole.read_bytes())

    def test_after_the_last_attempt_it_names_what_is_missing_and_goes_on_when_called_again(self):
        self.submit(KILLED_ALWAYS, ATTEMPTS="2")
        self.wait_until_all_jobs_ended()
        self.assertFalse(self.study.exists())
        self.assertIn("shards 2 ended without a result", self.merge_log())
        (self.folder / "is_mended").touch()
        self.assertIn("shards 2: job array", self.submit(KILLED_ALWAYS))
        self.cluster.wait_until(self.study.exists, PATIENCE)
        self.assertEqual(self.study.read_bytes(), self.whole.read_bytes())

    def test_shards_of_another_study_are_not_taken(self):
        self.submit(KILLED_ONCE)
        said = self.submit(KILLED_ONCE, arguments=(*STUDY, "--seed", "7"), status=2)
        self.assertIn("holds another study", said)
        self.wait_until_all_jobs_ended()


if __name__ == "__main__":
    unittest.main()
