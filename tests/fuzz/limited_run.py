"""Runs of programs under limits of memory, file size and time, with what they cost."""

import fcntl
import os
import resource
import select
import shlex
import signal
import subprocess
import time
from dataclasses import dataclass

_TICKS = os.sysconf("SC_CLK_TCK")


@dataclass
class Run:
    """How a run ended: `status` as a shell has it, negative for a signal; None if nothing ended
    it.
    """

    status: int | None
    out: bytes
    err: bytes
    wall: float  # s
    cpu: float  # s
    asked_to_end: bool  # whether SIGINT was sent since the time was over
    seconds_to_end: float = 0  # from then on


def limit_this_process(memory=None, file_size=None):
    """Limits this process and all that it starts: bytes of address space and of a file, no core
    files. SIGINT is no longer ignored, as it is in what a shell starts in the background.
    """
    signal.signal(signal.SIGINT, signal.default_int_handler)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if memory:
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
    if file_size:
        resource.setrlimit(resource.RLIMIT_FSIZE, (file_size, file_size))


def become_nobody(reachable):
    """Gives up root's rights, where this process has them and `reachable` can be read without."""
    if os.getuid() != 0:
        return
    path = os.path.abspath(reachable)
    while path != "/":
        if not os.stat(path).st_mode & 0o005 == 0o005:
            return
        path = os.path.dirname(path)
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
    return " ".join(
        (
            shlex.quote(a)
            if a.isprintable()
            else "$'"
            + "".join(
                (
                    c
                    if c.isprintable() and c not in "'\\"
                    else "".join(f"\\x{b:02x}" for b in c.encode(errors="surrogateescape"))
                )
                for c in a
            )
            + "'"
        )
        for a in argv
    )


def _cpu_of(pid):
    try:
        with open(f"/proc/{pid}/stat", "rb") as file:
            fields = file.read().rsplit(b")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / _TICKS
    except (OSError, IndexError):
        return 0


def _ended(poll, pid, cpu, wall):
    """Waits until the process ends, or has had `cpu` s of the processor from now on or `wall` s
    passed.
    """
    start, until = _cpu_of(pid), time.monotonic() + wall
    slice_ = cpu
    while True:
        left = until - time.monotonic()
        if left <= 0:
            return False
        if poll.poll(1000 * min(slice_, left)):
            return True
        spent = _cpu_of(pid) - start
        if spent >= cpu:
            return False
        slice_ = max(0.05, cpu - spent)


def _pipe():
    """Ends of a pipe that takes 1 MB before anyone reads: no limit of file sizes is one of what is
    said.
    """
    ends = os.pipe()
    fcntl.fcntl(ends[0], fcntl.F_SETPIPE_SZ, 1 << 20)
    os.set_blocking(ends[1], False)
    return ends


def _all_of(descriptor):
    with open(descriptor, "rb") as file:
        return file.read()


def _started(argv, folder, environment, out, err):
    """The process; waits up to a minute for a program that is being built anew."""
    for seconds_left in range(60, -1, -1):
        try:
            # SIGXFSZ stays ignored as it is in Python: to write too much is an error, no signal.
            return subprocess.Popen(
                argv,
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                restore_signals=False,
                start_new_session=True,
            )
        except (PermissionError, FileNotFoundError):
            if seconds_left == 0:
                raise
            time.sleep(1)


def run(
    argv, folder, environment, cpu, wall, patience=5, stop_after=None, stop_signal=signal.SIGINT
):
    """Runs `argv` in `folder` for at most `cpu` s of processor time or `wall` s.

    After that, or after `stop_after` s, sends `stop_signal` and waits for the end as long as
    `patience` (processor time) or four times that, before the process is killed and the status is
    None.
    """
    started = time.monotonic()
    out, err = _pipe(), _pipe()
    try:
        process = _started(argv, folder, environment, out[1], err[1])
    finally:
        os.close(out[1]), os.close(err[1])
    # So that it ends even if nobody is left to end it.
    last = int(cpu + patience) + 2
    resource.prlimit(process.pid, resource.RLIMIT_CPU, (last, last))
    poll, descriptor = select.poll(), os.pidfd_open(process.pid)
    poll.register(descriptor, select.POLLIN)
    asked, to_end, ended = False, 0.0, False
    try:
        if stop_after is not None:
            ended = bool(poll.poll(1000 * stop_after))
        else:
            ended = _ended(poll, process.pid, cpu, wall)
        if not ended:
            asked, sent = True, time.monotonic()
            os.killpg(process.pid, stop_signal)
            ended = _ended(poll, process.pid, patience, 4 * patience)
            to_end = time.monotonic() - sent
    finally:
        os.close(descriptor)
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
    _, raw, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(raw)
    return Run(
        process.returncode if ended else None,
        _all_of(out[0]),
        _all_of(err[0]),
        time.monotonic() - started,
        usage.ru_utime + usage.ru_stime,
        asked,
        to_end,
    )
