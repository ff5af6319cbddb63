"""Ctrl-C, threads and processes."""

import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest
from multiprocessing import get_context

import numpy as np

import problems
import qddot
from limited_run import cpu_of

# The work of each script until Ctrl-C comes, by itself for many minutes.
ENDLESS = {
    "run": "qddot.solve(cloth, 'verlet', step_size=1e-7, until=1e3)",
    "implicit": "qddot.solve(cloth, 'implicit_midpoint', step_size=1e-6, until=1e3)",
    "sundials": "qddot.solve(cloth, 'arkode_erk4', rtol=1e-14, until=1e3)",
    "callable": "qddot.solve(system, 'verlet', step_size=1e-6, until=1e3, q0=[1.0])",
    "looks": "qddot.solve(cloth, 'verlet', step_size=1e-7, until=1e3, save_at=np.linspace(0, 1e3, 9))",
    "answer": "qddot.solve(qddot.scenes.lattice(until=400.0), accuracy=1e-8)",
    "reference": "qddot.reference(qddot.scenes.lattice(until=10.0), seconds=1e7)",
    "chart": "qddot.work_precision(cloth, 0.5, point_limit=1e5)",
    "trend": "qddot.energy_trend(cloth, 'verlet', step_size=1e-4, until=1e5, seconds=600)",
    "exchange": "qddot.exchange(qddot.scenes.fpu(), ['verlet'], [1e-4, 1e-5], until=1e4)",
}


# How all scripts begin.
BEGIN = """
import os, signal, threading, time
import numpy as np
import qddot
cloth = qddot.scenes.cloth(nodes=10)
system = qddot.System([1.0], lambda q, f: np.copyto(f, -q))
handler_before = signal.getsignal(signal.SIGINT)
"""


def script(endless, before=""):
    return f"""{BEGIN}{before}
print("ready", flush=True)
try:
    answer = {endless}
    print("ended", answer.outcome)
except KeyboardInterrupt:
    print("interrupted")
# All goes on as if nothing had been.
again = qddot.solve(cloth, "verlet", step_size=1e-3, until=0.05)
assert again.outcome == "reached_end", again.outcome
assert qddot.reference(cloth, 0.05).certified.position < 1e-6
assert signal.getsignal(signal.SIGINT) is handler_before
"""


def interrupted(text):
    """The output of a script that gets Ctrl-C once it has worked for a while after it was ready, however
    busy the machine is."""
    with subprocess.Popen(
        [sys.executable, "-c", text], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    ) as process:
        assert process.stdout.readline() == "ready\n"
        until = cpu_of(process.pid) + 0.3
        while process.poll() is None and cpu_of(process.pid) < until:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=120)
    return out, process.returncode


class Interrupts(unittest.TestCase):
    def test_control_c_ends_whatever_goes_on(self):
        for name, endless in ENDLESS.items():
            with self.subTest(name):
                out, status = interrupted(script(endless))
                self.assertEqual((out, status), ("interrupted\n", 0))

    def test_own_handlers_and_runs_within_runs(self):
        ours = "signal.signal(signal.SIGINT, handler_before)"
        raising = f"""
def handler_before(*_):
    raise KeyError("mine")
{ours}
"""
        within = """
def force(q, f):
    qddot.solve(cloth, "verlet", step_size=1e-7, until=1e3)
system = qddot.System([1.0], force, check=False)
"""
        silent = f"handler_before = lambda *_: None\n{ours}"
        for text, said in (
            (script(ENDLESS["run"], raising).replace("KeyboardInterrupt", "KeyError"), "interrupted"),
            # One that raises nothing has a stopped run.
            (script(ENDLESS["run"], silent), "ended over_budget"),
            (script(ENDLESS["callable"], within), "interrupted"),
        ):
            self.assertEqual(interrupted(text), (f"{said}\n", 0))


def in_threads(work, names):
    """Works in threads of these names at once, until all are done."""
    threads = [threading.Thread(target=work, name=name) for name in names]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


class Threads(unittest.TestCase):
    def test_two_solves_run_in_two_threads(self):
        # Each waits in its first force for the other's; one after the other they would never meet.
        meeting, met, ends = threading.Barrier(2, timeout=60), set(), []

        def force(q, f):
            if threading.get_ident() not in met:
                meeting.wait()
            met.add(threading.get_ident())
            f[:] = -q

        def work():
            system = qddot.System(np.ones(3), force, check=False)
            run = dict(step_size=0.01, until=10, q0=np.ones(3))
            ends.append(qddot.solve(system, "verlet", **run).end.q)

        in_threads(work, "ab")
        self.assertTrue(np.array_equal(*ends))

    def test_python_goes_on_beside_a_solve(self):
        solution = []
        cloth = qddot.scenes.cloth(nodes=10)
        run = dict(step_size=1e-8, until=1e3, seconds=3)
        work = lambda: solution.append(qddot.solve(cloth, "verlet", **run))
        thread = threading.Thread(target=work)
        thread.start()
        count = 0
        while thread.is_alive():
            time.sleep(1e-3)
            count += 1
        # It would be one or two if the GIL were held.
        self.assertGreater(count, 20)
        self.assertEqual(solution[0].outcome, "over_budget")

    def test_one_system_in_many_threads(self):
        chain = problems.Chain(4)
        q0, v0 = chain.start()
        system, ends = chain.system(), []

        def work():
            for _ in range(5):
                run = dict(step_size=2e-3, until=0.2, q0=q0, v0=v0)
                ends.append(qddot.solve(system, "implicit_midpoint", **run).end.q)

        in_threads(work, "abcd")
        self.assertEqual(len(ends), 20)
        for end in ends:
            self.assertTrue(np.array_equal(end, ends[0]))

    def test_what_a_thread_raises_stays_there(self):
        def force(q, f):
            if threading.current_thread().name == "bad":
                raise ZeroDivisionError
            f[:] = -q

        system, seen = qddot.System(np.ones(2), force), {}

        def work():
            try:
                run = dict(step_size=0.01, until=5, q0=[1.0, 0.0])
                seen[threading.current_thread().name] = qddot.solve(system, "verlet", **run).outcome
            except ZeroDivisionError:
                seen["bad"] = "raised"

        in_threads(work, ("good", "bad", "fine"))
        self.assertEqual(seen, {"good": "reached_end", "bad": "raised", "fine": "reached_end"})


def said_by(code):
    """The output of a process that runs the code after BEGIN and ends well."""
    # From 3.12 on, Python warns of a fork beside other threads.
    words = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", BEGIN + code]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return done.stdout


def end_of(scene, step_size=1e-3, until=0.1):
    return qddot.solve(scene, "verlet", step_size=step_size, until=until).or_raise()


class Processes(unittest.TestCase):
    def test_failures_come_from_other_processes(self):
        with get_context("fork").Pool(1) as pool:
            with self.assertRaises(qddot.RunFailed) as raised:
                pool.apply(end_of, (qddot.scenes.oscillator(), 1.0, 1e3))
        self.assertEqual(raised.exception.solution.outcome, "diverged")

    def test_control_c_in_a_process_that_was_forked_within_a_run(self):
        code = """
def force(q, f):
    f[:] = -q
    if os.fork() == 0:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(1000): pass
        except KeyboardInterrupt:
            os._exit(7)
        os._exit(8)
    _, status = os.wait()
    print(os.waitstatus_to_exitcode(status), flush=True)
qddot.solve(qddot.System([1.0], force, check=False), "verlet", step_size=1.0, until=1, q0=[1.0])
"""
        self.assertEqual(set(said_by(code).split()), {"7"})

    def test_the_interpreter_exits_while_threads_solve(self):
        for run in (
            ENDLESS["run"], ENDLESS["callable"],
            "[qddot.solve(cloth, 'verlet', step_size=1e-3, until=0.01) for _ in range(10**6)]",
        ):  # fmt: skip
            code = f"""
threading.Thread(target=lambda: {run}, daemon=True).start()
time.sleep(0.3)
print("exits")
"""
            with self.subTest(run):
                for _ in range(3):
                    self.assertEqual(said_by(code), "exits\n")

    def test_scenes_and_solutions_go_to_other_processes(self):
        scene = problems.random_scene(5)
        self.assertEqual(pickle.loads(pickle.dumps(scene)).content_hash(), scene.content_hash())
        here = end_of(scene)
        for way in ("fork", "spawn"):
            with self.subTest(way), get_context(way).Pool(2) as pool:
                for there in pool.map(end_of, [scene, scene]):
                    self.assertTrue(np.array_equal(there.end.q, here.end.q))
                    self.assertEqual((there.counts, there.diagnosis()), (here.counts, ""))
