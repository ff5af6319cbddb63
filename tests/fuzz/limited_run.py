"""Runs of programs under limits of memory, file size and time, with what they cost."""

import os
import resource
import shlex
import signal
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path


@dataclass
class Run:
    """How a run ended: `status` as a shell has it, negative for a signal; None if nothing ended
    it."""

    status: int | None
    out: bytes
    err: bytes
    wall: float  # s
    cpu: float  # s
    asked_to_end: bool  # whether a signal was sent since the time was over
    seconds_to_end: float = 0  # from then on


def limit_this_process(memory=None, file_size=None):
    """Limits this process and all that it starts: bytes of address space and of a file, no core
    files. SIGINT is no longer ignored, as it is in what a shell starts in the background."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if memory:
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    if file_size:
        resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))


def become_nobody(reachable):
    """Gives up root's rights, where this process has them and `reachable` can be read without."""
    path = Path(os.path.abspath(reachable))
    is_readable = all(place.stat().st_mode & 0o005 == 0o005 for place in [path, *path.parents])
    if os.getuid() != 0 or not is_readable:
        return
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)


def environment_of(home):
    """The variables that programs are run with."""
    names = {name: home for name in ("HOME", "TMPDIR", "XDG_CACHE_HOME")}
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return {"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8"} | names | threads


def spelled(argv):
    """The command line for a shell, bytes that are no text escaped."""
    return ascii(shlex.join(argv))[1:-1]


def cpu_of(pid):
    """Seconds of the processor that a process had so far."""
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            fields = file.read().rsplit(b")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    except (OSError, IndexError):
        return 0


def _ended(process, cpu, wall):
    """Waits until the process ends, or has had `cpu` s of the processor from now on or `wall` s
    passed."""
    until, most = time.monotonic() + wall, cpu_of(process.pid) + cpu
    while (left := until - time.monotonic()) > 0 and cpu_of(process.pid) < most:
        try:
            process.communicate(timeout=min(left, 0.05))
            return True
        except subprocess.TimeoutExpired:
            pass
    return False


def run(
    argv, folder, environment, cpu, wall, patience=5, stop_after=None, stop_signal=signal.SIGINT
):
    """Runs `argv` in `folder` for at most `cpu` s of processor time or `wall` s, or `stop_after` s.

    After that sends `stop_signal` and waits for the end as long as `patience` (processor time) or
    four times that, before the process is killed and the status is None."""
    started, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    # SIGXFSZ stays ignored as it is in Python: to write too much is an error, no signal.
    process = subprocess.Popen(
        argv, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, restore_signals=False, start_new_session=True,
    )  # fmt: skip
    # So that it ends even if nobody is left to end it.
    last = int(cpu + patience) + 2
    resource.prlimit(process.pid, resource.RLIMIT_CPU, (last, last))
    asked, to_end = False, 0.0
    ended = _ended(process, cpu, wall if stop_after is None else stop_after)
    if not ended:
        asked, sent = True, time.monotonic()
        os.killpg(process.pid, stop_signal)
        ended = _ended(process, patience, 4 * patience)
        to_end = time.monotonic() - sent
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    out, err = process.communicate()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return Run(
        process.returncode if ended else None, out, err, time.monotonic() - started,
        after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, asked, to_end,
    )  # fmt: skip
