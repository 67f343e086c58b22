"""A Slurm cluster of one node with two CPUs: real munged, slurmctld and slurmd, in a folder and on ports of its own.

Its partition 'urgent' preempts 'main', the default; what is preempted is queued again. It needs no configuration of the machine, no systemd and no cgroups, runs as root or as any user, and leaves a Slurm
that already runs here alone.
"""

from __future__ import annotations

import ctypes
import getpass
import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path
from typing import Callable

PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch", "scancel", "scontrol", "sinfo", "squeue"]
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"
PR_SET_PDEATHSIG = 1  # prctl(2)


def missing_programs() -> list[str]:
    return [name for name in PROGRAMS if shutil.which(name, path=PATH) is None]


def free_ports(count: int) -> list[int]:
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def die_with_parent() -> None:
    """A test that is killed takes its daemons along."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class Cluster:
    """Between start() and stop() its commands work; `environment` makes any program use it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.host = socket.gethostname().split(".")[0]
        self.daemons: list[subprocess.Popen[bytes]] = []
        # Also inside a job of another cluster.
        inherited = {name: value for name, value in os.environ.items() if not name.startswith(("SLURM", "SBATCH"))}
        self.environment = {**inherited, "PATH": PATH, "SLURM_CONF": str(folder / "slurm.conf")}

    def __enter__(self) -> Cluster:
        try:
            self.start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def start(self) -> None:
        for name in ("munge", "state", "spool"):
            (self.folder / name).mkdir(mode=0o755)
        self._start_munge()
        (self.folder / "slurm.conf").write_text(self._configuration(), encoding="utf-8")
        self._start("slurmctld", "-D", "-i")
        self._start("slurmd", "-D")
        self.wait(lambda: self.command("sinfo", "-h", "-o", "%T", check=False).strip() == "idle", "an idle node")

    def stop(self) -> None:
        if len(self.daemons) == 3 and all(daemon.poll() is None for daemon in self.daemons):
            self.command("scancel", "--user", getpass.getuser(), check=False)
            # Steps outlive their slurmd: they must be gone before it goes.
            self.wait(lambda: not self.jobs() and not self._steps(), "the last step's end", patient=False)
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
        self.daemons = []

    def command(self, *words: str, check: bool = True) -> str:
        done = subprocess.run(words, env=self.environment, capture_output=True, text=True, check=False)
        if check and done.returncode != 0:
            raise RuntimeError(f"{' '.join(words)}: {done.stderr.strip()}")
        return done.stdout

    def jobs(self) -> dict[str, str]:
        """The state of every job and array task that waits or runs, by its id (12 or 12_3)."""
        lines = self.command("squeue", "-h", "-r", "-o", "%i %T", check=False).splitlines()
        return dict(line.split() for line in lines)

    def job(self, name: str) -> dict[str, str]:
        """What Slurm knows about a job, also for a while after its end."""
        text = self.command("scontrol", "-o", "show", "job", name)
        return dict(word.split("=", 1) for word in text.split() if "=" in word)

    def wait(self, ready: Callable[[], bool], what: str, seconds: float = 60, patient: bool = True) -> None:
        end = time.monotonic() + seconds
        while not ready():
            if patient and time.monotonic() > end:
                raise RuntimeError(f"{seconds:.0f} s passed without {what}\n{self.logs()}")
            if time.monotonic() > end:
                return
            for daemon in self.daemons:
                if daemon.poll() is not None:
                    raise RuntimeError(f"{daemon.args[0]} ended with {daemon.returncode}\n{self.logs()}")
            time.sleep(0.1)

    def logs(self) -> str:
        return "\n".join(f"--- {file.name}\n" + "\n".join(file.read_text(errors="replace").splitlines()[-15:])
                         for file in sorted(self.folder.glob("*.log")))

    def _steps(self) -> bool:
        return any(self.folder.glob(f"spool/{self.host}_*"))

    def _start_munge(self) -> None:
        folder = self.folder / "munge"
        key = folder / "key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        self._start("munged", "--foreground", "--force", f"--key-file={key}", f"--socket={folder / 'socket'}",
                    f"--pid-file={folder / 'pid'}", f"--seed-file={folder / 'seed'}")
        self.wait((folder / "socket").exists, "munged's socket")

    def _start(self, *words: str) -> None:
        with (self.folder / f"{words[0]}.log").open("wb") as log:
            self.daemons.append(subprocess.Popen(words, env=self.environment, stdout=log, stderr=log,
                                                 stdin=subprocess.DEVNULL, preexec_fn=die_with_parent))

    def _configuration(self) -> str:
        controller, node = free_ports(2)
        # cred_expire: a requeued job waits until its old credential has expired, two minutes unless set.
        # config_overrides: the node has two CPUs, whatever the machine has.
        return f"""
ClusterName=qtrace_test
SlurmctldHost={self.host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={getpass.getuser()}
SlurmdUser={getpass.getuser()}
AuthType=auth/munge
AuthInfo=socket={self.folder / "munge" / "socket"},cred_expire=5
CredType=cred/munge
SlurmctldPidFile={self.folder / "slurmctld.pid"}
SlurmdPidFile={self.folder / "slurmd.pid"}
StateSaveLocation={self.folder / "state"}
SlurmdSpoolDir={self.folder / "spool"}
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
ReturnToService=2
MailProg=/bin/true
JobRequeue=1
KillWait=5
MinJobAge=600
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
NodeName={self.host} NodeAddr=127.0.0.1 CPUs=2
PartitionName=main Nodes={self.host} Default=YES MaxTime=INFINITE State=UP PriorityTier=1
PartitionName=urgent Nodes={self.host} MaxTime=INFINITE State=UP PriorityTier=2
"""
