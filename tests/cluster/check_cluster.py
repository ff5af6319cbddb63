#!/usr/bin/python3
"""Runs a study as jobs of a Slurm cluster, one of whose nodes dies in the middle, and compares the
points with those of one process.

  tests/cluster/with_cluster /usr/bin/python3 -B tests/cluster/check_cluster.py

`sweep submit` makes an array of jobs for the references, one for the points and a job that merges.
While a job of the points runs on node2, that node and all that runs there is killed. Slurm has to
requeue the job; the node comes back; the queue has to become empty. All columns but measured times
have to be equal, to the digit. The programs are in the folder QDDOT_BIN. Status 1: something was
found.
"""

import concurrent.futures
import difflib
import glob
import os
import re
import subprocess
import sys
import tempfile
import time

from check_sweep import untimed
from programs import header, words_of, write

# No run of these methods comes near the limit of time, so that no point depends on the machine's
# speed. All of them are of order 2 or more: others need billions of steps for the last digits.
METHODS = """
implicit_midpoint trapezoidal generalized_alpha hht bdf2 trbdf2 discrete_gradient rodas4 verlet
position_verlet rk4 blanes_moan4 blanes_moan6 kahan_li8 takahashi_imada4 symmetric4 symmetric6
symmetric8 symmetric10 dprkn6 dprkn8 dprkn12 linear_midpoint linear_midpoint4 arkode_dirk3
arkode_dirk4 arkode_dirk5 arkode_dirk3_klu arkode_dirk4_klu arkode_dirk5_klu arkode_erk3 arkode_erk4
arkode_erk5 arkode_erk6 arkode_erk8 ida ida_klu cvode_bdf cvode_bdf_klu cvode_adams
""".split()
MEASURES = f"--until 0.02 --methods {','.join(METHODS)} --point-limit 60 --repeats 1"
SCENES = {"pendulum": "pendulum", "chain": "chain.toml"}
CHAIN = '[generator]\nkind = "chain"\nnodes = 8\n'
STUDY = f"""scenes = ["pendulum", {{ generator = "chain", nodes = 8 }}]
until = 0.02
methods = {METHODS}
[options]
point-limit = 60
repeats = 1
"""
SHARDS = 4
NODE = "node2"


class Fault(Exception):
    """A finding, in a sentence."""


def seconds_since(start):
    """The seconds since a time of time.monotonic, as they are printed."""
    return f"{time.monotonic() - start:.1f} s"


def said_by(argv):
    """The output of a command; a Fault where it fails."""
    done = subprocess.run(argv, capture_output=True, text=True)
    if done.returncode != 0:
        said = done.stdout[-2000:] + done.stderr[-2000:]
        raise Fault(f"{' '.join(argv)}: status {done.returncode}\n{said}")
    return done.stdout


def wait_for(seconds, what, condition):
    """The first value of the condition that is true; a Fault where there is none in time."""
    end = time.monotonic() + seconds
    while not (value := condition()):
        if time.monotonic() > end:
            raise Fault(f"{what} did not come about in {seconds} s")
        time.sleep(0.3)
    return value


def queue():
    """The jobs that have not ended, one a task: (job and task, name, state, node)."""
    lines = said_by(["squeue", "--noheader", "--array", "--format=%i|%j|%T|%N"]).splitlines()
    return [tuple(line.split("|")) for line in lines]


def fields_of(job):
    """The fields of a job in Slurm, or of each task of its array, by name."""
    said = said_by(["scontrol", "--oneliner", "show", "job", job])
    return [dict(re.findall(r"(\w+)=(\S*)", line)) for line in said.splitlines()]


def task_on(node):
    """The job of points that runs on the node, or None; a Fault where no job is left."""
    jobs = queue()
    if not any("points" in name for _, name, _, _ in jobs):
        raise Fault(f"no job of points came to {node}")
    for job, name, state, where in jobs:
        if "points" in name and state == "RUNNING" and where == node:
            return job
    return None


def processes_on(node):
    """The ids of the processes that Slurm started for jobs on the node."""
    found = []
    for path in glob.glob("/proc/[0-9]*/environ"):
        try:
            with open(path, "rb") as file:
                if f"SLURMD_NODENAME={node}".encode() in file.read().split(b"\0"):
                    found.append(int(path.split("/")[2]))
        except OSError:
            pass  # it has ended
    return found


def kill_a_node(script):
    """Kills the node in the middle of a job of points; returns the job, how often it had started
    anew and how many of its processes were killed."""
    while True:
        job = wait_for(120, f"a job of points on {NODE}", lambda: task_on(NODE))
        # A moment, so that some of the job's points are measured and others are not.
        time.sleep(1)
        fields = fields_of(job)[-1]
        killed = processes_on(NODE)
        if fields["JobState"] == "RUNNING" and fields["NodeList"] == NODE and killed:
            break  # else it was a short one, and the next may be longer
    said_by([script, "--kill-node", NODE])
    wait_for(5, f"the end of all processes on {NODE}", lambda: not processes_on(NODE))
    return job, int(fields["Restarts"]), len(killed)


def requeued(job, restarts):
    """The fields of the job in Slurm where it has been requeued, else None."""
    fields = fields_of(job)[-1]
    return fields if int(fields["Restarts"]) > restarts else None


def is_usable(node):
    """Whether a node takes jobs."""
    state = said_by(["sinfo", "--noheader", "--nodes", node, "--format=%T"]).strip()
    return state in ("idle", "allocated", "mixed", "completing")


def revive(script):
    """Starts the node again and waits until it takes jobs; says whether an administrator had to."""
    said_by([script, "--start-node", NODE])
    try:
        wait_for(20, f"the return of {NODE}", lambda: is_usable(NODE))
        return "by itself"
    except Fault:
        said_by(["scontrol", "update", f"nodename={NODE}", "state=resume"])
        wait_for(20, f"the return of {NODE}", lambda: is_usable(NODE))
        return "when it was told to resume"


def jobs_that_failed(ids):
    """A line for each job and task of these ids that did not complete."""
    return [
        f"job {job} {fields.get('ArrayTaskId', '')} ({fields['JobName']}): {fields['JobState']}"
        for job in ids
        for fields in fields_of(job)
        if fields["JobState"] != "COMPLETED"
    ]


def in_one_process():
    """Runs the study's scenes without a cluster; the points and the header of their table."""
    points = []
    for name, scene in SCENES.items():
        line = f"work_precision --scene {scene} {MEASURES} --progress none --out one/{name}"
        said_by(words_of(line))
        points += untimed(f"one/{name}/points.csv")
    return sorted(points), header(f"one/{name}/points.csv")


def check(script):
    """Runs all here, printing the seconds of each part; a Fault where something is wrong."""
    write("study.toml", STUDY)
    write("chain.toml", CHAIN)
    start = time.monotonic()
    said_by(words_of("sweep plan study.toml --out S"))
    submitted = said_by(words_of(f"sweep submit S --slurm --shards {SHARDS} --go"))
    jobs = queue()
    ids = sorted({re.match(r"\d+", job).group() for job, _, _, _ in jobs}, key=int)
    unsaid = [job for job in ids if not re.search(rf"\b{job}\b", submitted)]
    if len(ids) != 3 or unsaid:
        raise Fault(f"three jobs are submitted and printed, not {jobs}:\n{submitted}")
    print(f"planned and submitted as jobs {', '.join(ids)}: {seconds_since(start)}", flush=True)

    start = time.monotonic()
    job, restarts, processes = kill_a_node(script)
    print(f"until {NODE} was killed in the middle of points: {seconds_since(start)}", flush=True)
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        # The core of the node that is dead is free.
        alone = pool.submit(in_one_process)
        start = time.monotonic()
        fields = wait_for(120, f"a requeue of {job}", lambda: requeued(job, restarts))
        print(
            f"{job} ran on {NODE}, which was killed and all that ran there (processes of the job: "
            f"{processes}); Slurm requeued it after {seconds_since(start)} (restarts: "
            f"{fields['Restarts']})",
            flush=True,
        )
        print(f"{NODE} came back {revive(script)}", flush=True)
        wait_for(300, "the end of all jobs", lambda: not queue())
        print(f"until all jobs had ended: {seconds_since(start)}", flush=True)
        one, columns = alone.result()

    found = jobs_that_failed(ids)
    if not os.path.exists("S/points.csv"):
        raise Fault("\n".join(["there is no points.csv", *found]))
    if header("S/points.csv") != columns:
        found.append(f"{columns} in one process, in the cluster {header('S/points.csv')}")
    many = untimed("S/points.csv")
    found += difflib.unified_diff(one, many, "one process", "the cluster", n=0, lineterm="")
    found += [f"{part} is left" for part in glob.glob("S/**/*.part", recursive=True)]
    if not one:
        found.append("there is no point")
    if found:
        raise Fault("\n".join([f"{len(found)} differences", *found[:20]]))
    print(f"{len(one)} points of {len(SCENES)} scenes, all equal", flush=True)


def tell_more():
    """Prints what Slurm and the study say of themselves."""
    logs = glob.glob(os.path.join(os.path.dirname(os.environ["SLURM_CONF"]), "*.log"))
    for path in sorted(logs + glob.glob("S/log/*")):
        subprocess.run(["tail", "-v", "-n", "30", path], check=False)
    for argv in (
        ["squeue", "--array"], ["sinfo", "--Node", "--long"], words_of("sweep status S"),
    ):  # fmt: skip
        print(f"--- {' '.join(argv)}", flush=True)
        subprocess.run(["timeout", "30", *argv], check=False)


def main():
    """Status 0: all is equal; 1: something was found; 2: it cannot be tried."""
    script = os.environ.get("CLUSTER_SCRIPT")
    if not script or "SLURM_CONF" not in os.environ:
        sys.exit("check_cluster: this runs inside of with_cluster only")
    # Times are measured, and jobs share two cores; what jobs get is the environment of sbatch.
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", LC_ALL="C.UTF-8")
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="check_cluster.") as place:
        os.chdir(place)
        try:
            check(script)
        except Fault as fault:
            print(f"check_cluster: {fault}")
            tell_more()
            return 1
    print(f"all of this: {seconds_since(start)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
