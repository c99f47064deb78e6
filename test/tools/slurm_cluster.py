"""A Slurm cluster of one node on loopback, as Debian's packages give it, for as long as a test runs."""

import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import time

DAEMONS = ("/usr/sbin/slurmctld", "/usr/sbin/slurmd")

CONFIGURATION = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={node_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/none
CredType=cred/none
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_res
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1
ReturnToService=2
MpiDefault=none
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def is_installed():
    return all(os.access(daemon, os.X_OK) for daemon in DAEMONS) and shutil.which("sbatch") is not None


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """Daemons that end with stop(); `environment` leads Slurm's commands to them."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.processes = []
        for name in ("state", "spool"):
            (self.folder / name).mkdir()
        configuration = self.folder / "slurm.conf"
        configuration.write_text(
            CONFIGURATION.format(
                host=socket.gethostname(),
                user=getpass.getuser(),
                folder=self.folder,
                controller_port=free_port(),
                node_port=free_port(),
            )
        )
        self.environment = {**os.environ, "SLURM_CONF": str(configuration)}

    def start(self):
        for daemon in DAEMONS:
            self.processes.append(
                subprocess.Popen(
                    [daemon, "-D", "-f", self.environment["SLURM_CONF"]],
                    env=self.environment,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                )
            )
        self.wait_until(lambda: "idle" in self.command("sinfo", "--noheader", "--format=%T"), 60)

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
            process.wait(timeout=30)

    def command(self, *words):
        """What a command of Slurm says; nothing while it cannot reach the controller."""
        result = subprocess.run(words, env=self.environment, capture_output=True, text=True, check=False)
        return result.stdout

    def wait_until(self, condition, seconds):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(self.logs())
            time.sleep(0.2)

    def logs(self):
        logs = [self.folder / "slurmctld.log", self.folder / "slurmd.log"]
        return "\n".join(log.read_text()[-2000:] for log in logs if log.exists())
