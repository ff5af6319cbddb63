#!/usr/bin/python3
"""A full disk at every write: each program with room for only so many bytes, for more and more of
them.

  tests/fuzz/fuzz_disk.py --bin build/bin
  tests/fuzz/fuzz_disk.py --bin build/bin --way disk --points 40     (a file system of 1 MB; needs root)

Two ways to fail a write. "limit": RLIMIT_FSIZE with SIGXFSZ ignored, so that every write beyond n
bytes of a file fails with EFBIG, as one on a full disk fails with ENOSPC. This reaches the writes
inside glibc's stdio, which no preloaded library sees, as they are not called through the linker's
table. With "disk", a tmpfs of 1 MB is filled up to n bytes, so that calls which make files and
folders fail too. n runs from 0 to a size with enough room for the program.

A program must end with status 0 and whole files, or with 2 or 3 and one sentence that names a file.
Results of an earlier run must stay whole, unchanged or replaced. No .part file may be left. Status
1: something was found.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile

from limited_run import limit_this_process, run, spelled
from studies import STUDIES, write_scenes
from written_tables import faults

SIMULATE = (
    "--scene steady.toml --method verlet --step-size 1e-4 --until 0.02 --final results/final.csv --trajectory "
    "results/trajectory.csv --energy results/energy.csv --motion results/motion.vtkhdf --every 1e-4 --write-scene results/scene.toml"
)
COMMANDS = {name: words + " --out results" for name, words in STUDIES.items()} | {
    "simulate": SIMULATE,
    "equilibrium": "--scene steady.toml --final results/rest.csv",
    "advise": "--scene steady.toml --accuracy 1e-3 --out results",
}


def arguments_of(caller):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--bin", required=True, help="the folder of the programs")
    parser.add_argument("--programs", help="a,b,... (default: all)")
    parser.add_argument("--way", choices=["limit", "disk", "both"], default="both")
    parser.add_argument("--points", type=int, default=24, help="how many values of n")
    a = parser.parse_args(caller)
    a.bin = os.path.abspath(a.bin)
    return a


class Place:
    """A folder of 1 MB, or one where files may have n bytes; with scenes, and earlier results or
    none.
    """

    def __init__(self, root, way):
        self.root, self.way = root, way
        self.disk = os.path.join(root, "disk")
        self.here = os.path.join(self.disk, "here")
        os.makedirs(self.disk)
        if way == "disk":
            subprocess.run(
                ["mount", "-t", "tmpfs", "-o", "size=1m", "none", self.disk],
                check=True,
                capture_output=True,
            )
        os.makedirs(self.here)
        write_scenes(self.here)

    def start(self, files):
        """Makes the folder of results anew, with these files in it (name to bytes)."""
        folder = os.path.join(self.here, "results")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        for name, data in files.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(data)

    def results(self):
        """Name to bytes of what is in the folder of results."""
        folder, files = os.path.join(self.here, "results"), {}
        for name in os.listdir(folder):
            if os.path.isdir(os.path.join(folder, name)):
                continue
            with open(os.path.join(folder, name), "rb") as file:
                files[name] = file.read()
        return files

    def run(self, argv, room):
        """Runs with room for that many bytes (None: for all)."""
        filler = os.path.join(self.disk, "filler")
        if room is not None and self.way == "disk":
            state = os.statvfs(self.disk)
            with open(filler, "wb") as file:
                file.write(b"x" * max(0, state.f_bavail * state.f_bsize - room))
        elif room is not None:
            # The soft limit only, which this process can raise again.
            resource.setrlimit(resource.RLIMIT_FSIZE, (room, resource.RLIM_INFINITY))
        try:
            return run(
                argv,
                self.here,
                {"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "OMP_NUM_THREADS": "1"},
                60,
                120,
            )
        finally:
            resource.setrlimit(
                resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
            )
            if os.path.exists(filler):
                os.remove(filler)

    def close(self):
        if self.way == "disk":
            subprocess.run(["umount", self.disk], check=True)
        shutil.rmtree(self.root)


def wrong(place, program, ended, earlier):
    """Sentences on what is wrong after a run with too little room."""
    said = ended.err.decode(errors="replace").strip()
    if ended.status not in (0, 2, 3):
        yield f"status {ended.status}: {said[-200:]}"
    elif ended.status:
        last = said.split("\n")[-1]
        if not last.startswith(program + ": ") or "results" not in last:
            yield f"status {ended.status}, and no sentence that names a file: {last[:200]}"
    now = place.results()
    if ended.status:  # what is replaced has to be whole; what is not has to be as it was
        for name in sorted(set(earlier) - set(now)):
            yield f"{name} of an earlier run is lost"
    for name, data in now.items():
        sidecar = name[:-4] + ".json"
        if (
            name.endswith(".csv")
            and data != earlier.get(name, data)
            and now.get(sidecar) == earlier.get(sidecar)
        ):
            yield f"{name} is new and its sidecar is of an earlier run"
    yield from faults(os.path.join(place.here, "results"), now)


def sweep(a, program, way):
    """Tries one program with more and more room; prints a line and what is wrong."""
    place = Place(tempfile.mkdtemp(prefix="fuzz_disk."), way)
    argv = [os.path.join(a.bin, program)] + COMMANDS[program].split()
    try:
        place.start({})
        first = place.run(argv, None)
        if first.status != 0:
            print(
                f"{program:<16}{way:<7} cannot be tried: status {first.status}: {first.err.decode()[-200:]}"
            )
            return 1
        earlier = place.results()
        full = 1 << 10
        while full < 1 << 20:
            place.start({})
            if place.run(argv, full).status == 0:
                break
            full *= 2
        rooms = sorted(
            {round(full * (k / a.points) ** 2) for k in range(a.points + 1)} | set(range(0, 3))
        )
        bad, statuses = {}, {}
        for room in rooms:
            for there in (True, False):  # once over earlier results, once into a folder without
                place.start(earlier if there else {})
                ended = place.run(argv, room)
                statuses[ended.status] = statuses.get(ended.status, 0) + 1
                for fault in wrong(place, program, ended, earlier if there else {}):
                    bad.setdefault(fault.split(": ")[0].split(".")[0], []).append(
                        (room, there, fault)
                    )
    finally:
        place.close()
    count = sum(map(len, bad.values()))
    print(
        f"{program:<16}{way:<7}{2 * len(rooms):>5} runs with room for 0 to {full} bytes, statuses {statuses}, {count} faults",
        flush=True,
    )
    for cases in bad.values():
        room, there, fault = cases[0]
        print(
            f"    {len(cases)} x {fault}\n        room for {room} bytes{', over earlier results' * there}: "
            f"{spelled([program] + argv[1:])}"
        )
    return count


def main(caller=None):
    a = arguments_of(caller)
    limit_this_process()
    names = a.programs.split(",") if a.programs else sorted(COMMANDS)
    names = [name for name in names if os.access(os.path.join(a.bin, name), os.X_OK)]
    if not names:
        sys.exit(f"fuzz_disk: {a.bin}: no program of {', '.join(COMMANDS)} is there")
    found = 0
    for way in ["limit", "disk"] if a.way == "both" else [a.way]:
        if way == "disk" and os.getuid() != 0:
            print("disk: left out, as only root may mount a file system of 1 MB")
            continue
        found += sum(sweep(a, name, way) for name in names)
    print(f"{found} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
