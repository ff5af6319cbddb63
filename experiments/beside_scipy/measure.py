#!/usr/bin/env python3
"""Times of a Python user's solvers to the same error: solve_ivp and a Verlet loop in NumPy beside
this project's module. The module runs on the user's f and on its own.

    ./run beside_scipy
    PYTHONPATH=build/python /usr/bin/python3 experiments/beside_scipy/measure.py --out DIR

 1. Problems: a planet (n = 2) and a cloth (n = 2694), each with f, V and K in NumPy as one writes
    them; the cloth is a scene as well.
 2. The reference is the module's, certified; errors are the largest of any node's position at the
    end over the largest displacement.
 3. Each way runs over its knob, from coarse to fine, until a run takes longer than --point-limit
    seconds. runs.csv has all of them: the shortest of --repeats times, one thread.
 4. times.csv has, for each accuracy, the time of each way at that error, between its runs by
    logarithms; the ratio to the fastest way on the same f; and the lines that a user writes.
 5. callbacks.csv has what a step costs by whose f it calls.
"""

import argparse
import csv
import json
import math
import os
import platform
import sys
import time
from types import SimpleNamespace

import numpy as np
import scipy

import own_forces
import solvers
import qddot

ACCURACIES = (1e-2, 1e-4, 1e-6, 1e-8)
# Explicit methods of fixed steps, of order 2 to 8, and adaptive ones.
OWN = {
    "verlet": (2, "step_size"), "blanes_moan4": (4, "step_size"), "symmetric6": (6, "step_size"),
    "symmetric8": (8, "step_size"), "dprkn8": (8, "rtol"), "dprkn12": (12, "rtol"),
}  # fmt: skip


def written(force):
    """A user's f as a System takes it."""
    return lambda q, f: np.copyto(f, force(q))


def step_sizes(p, order, longest):
    """Step sizes from the longest that may be stable, each for a fourth of the error."""
    for k in range(40):
        yield p.until / math.ceil(p.until / longest * 4 ** (k / order))


def ways(p, scene, scales, longest):
    """(whose f, way, method, knob, values, function of a value, key of LINES)."""
    own = written(p.force)
    for method in ("DOP853", "LSODA", "Radau", "BDF"):
        key = "solve_ivp, with K" if method in ("Radau", "BDF") else "solve_ivp"
        # LSODA prints of tolerances that are too coarse for it.
        rtols = solvers.RTOLS[2:] if method == "LSODA" else solvers.RTOLS
        run = lambda rtol, m=method: solvers.scipy_ivp(p, p.force, m, rtol, scales)  # noqa: E731
        yield "own f", "solve_ivp", method, "rtol", rtols, run, key
    run = lambda h: solvers.numpy_verlet(p, p.force, h)  # noqa: E731
    yield "own f", "NumPy", "Verlet", "step_size", step_sizes(p, 2, longest), run, "NumPy Verlet"
    numba = own_forces.numba_planet() if scene is None else own_forces.numba_cloth(p)
    for name, f in (("own f", own), ("own f, Numba", numba)):
        if f is None:
            continue
        for method, (order, knob) in OWN.items():
            values = solvers.RTOLS if knob == "rtol" else step_sizes(p, order, longest)
            run = lambda x, m=method, k=knob, f=f: solvers.own_system(p, f, m, {k: x})  # noqa: E731
            yield name, "qddot", method, knob, values, run, "qddot, own f"
    for method in ("arkode_dirk4", "cvode_bdf"):
        run = lambda x, m=method: solvers.own_system_with_k(p, own, m, {"rtol": x})  # noqa: E731
        yield "own f", "qddot", method, "rtol", solvers.RTOLS, run, "qddot, own f and K"
    if scene is None:
        return
    model = scene.model(keep=["dimension", "mirror"])
    scenes_f = lambda q: model.force(q.reshape(-1)).reshape(q.shape)  # noqa: E731
    for method in ("DOP853", "LSODA"):
        run = lambda rtol, m=method: solvers.scipy_ivp(p, scenes_f, m, rtol, scales)  # noqa: E731
        yield "the scene's f", "solve_ivp", method, "rtol", solvers.RTOLS[2:], run, "solve_ivp"
    for method, (order, knob) in OWN.items():
        values = solvers.RTOLS if knob == "rtol" else step_sizes(p, order, longest)
        run = lambda x, m=method, k=knob: solvers.scene_by_method(scene, m, {k: x})  # noqa: E731
        yield "the scene's f", "qddot", method, knob, values, run, "qddot, a scene"
    run = lambda a: solvers.scene_by_accuracy(scene, a)  # noqa: E731
    accuracies = 10.0 ** -np.arange(2, 11)
    yield "the scene's f", "qddot", "accuracy=", "accuracy", accuracies, run, "qddot, an accuracy"


def sweep(p, exact, way, options):
    """The runs of one way, from coarse to fine."""
    whose, who, method, knob, values, run, key = way
    for value in values:
        times = []
        try:
            while len(times) < options.repeats and (
                len(times) < 1 or sum(times) < options.point_limit
            ):
                begin = time.perf_counter()
                q, v, forces = run(value)
                times.append(time.perf_counter() - begin)
        except (qddot.RunFailed, RuntimeError, FloatingPointError, ValueError):
            continue
        error = exact.errors(q, v, t=exact.until).position
        if not math.isfinite(error) or error > 3:
            continue
        yield {
            "problem": p.name, "unknowns": p.q0.size, "force": whose, "way": who, "method": method,
            "knob": knob, "value": value, "error_position": error, "time_s": min(times),
            "force_evaluations": forces, "lines": solvers.LINES[key],
        }  # fmt: skip
        if min(times) > options.point_limit or error < 10 * exact.certified.position:
            return


def time_at(runs, accuracy):
    """The time of a solver at an error, interpolated between its runs; None if it reached no such
    error."""
    reached = [run["time_s"] for run in runs if run["error_position"] <= accuracy]
    if not reached:
        return None
    best = min(reached)
    for one, other in zip(runs, runs[1:]):
        a, b = one["error_position"], other["error_position"]
        if a > accuracy >= b:
            share = math.log(a / accuracy) / math.log(a / b)
            best = min(best, one["time_s"] ** (1 - share) * other["time_s"] ** share)
    return best


def table(runs):
    """Each way's time at each accuracy, the best of its methods where it has several."""
    rows = []
    for problem in dict.fromkeys(run["problem"] for run in runs):
        for accuracy in ACCURACIES:
            for whose in ("own f", "own f, Numba", "the scene's f"):
                best = {}
                for run in runs:
                    if run["problem"] != problem or run["force"] != whose:
                        continue
                    # The module's best method counts; solve_ivp's methods stand by themselves.
                    is_choice = run["method"] == "accuracy="
                    by = run["way"] == "qddot" and not is_choice
                    key = (run["way"], "best method" if by else run["method"])
                    best.setdefault(key, {}).setdefault(run["method"], []).append(run)
                for (way, name), methods in best.items():
                    found = [
                        (at, method, own[0]["lines"])
                        for method, own in methods.items()
                        if (at := time_at(own, accuracy)) is not None
                    ]
                    if found:
                        at, method, lines = min(found)
                        rows.append([problem, accuracy, whose, way, method, at, lines,
                                     "chosen by itself" if name == "accuracy=" else ""])  # fmt: skip
    fastest = {}
    for row in rows:
        key = (row[0], row[1])
        if row[3] == "qddot" and row[2] == "own f":
            fastest[key] = min(row[5], fastest.get(key, math.inf))
    return [[*row[:6], row[5] / fastest.get((row[0], row[1]), math.nan), *row[6:]] for row in rows]


def callbacks(options):
    """What a step of Verlet's method costs by whose f it calls."""
    rows, h = [], 1e-6
    keep = ["dimension", "mirror", "constant_stiffness"]
    for nodes, steps in ((2, 20000), (30, 1000), (100, 100)):
        # Three unknowns; and cloths of 2694 and 29994.
        scene = qddot.scenes.chain(nodes=2) if nodes == 2 else qddot.scenes.cloth(nodes=nodes)
        p = own_forces.Cloth(scene, scene.name)
        size = scene.model(keep=keep).size

        def add(whose, run):
            rows.append([size, whose, min(run() for _ in range(options.repeats)) / steps])

        def by_module(problem, **more):
            return qddot.solve(problem, "verlet", step_size=h, until=steps * h, **more).seconds

        def by(force):
            system = qddot.System(p.mass, force, dimension=3, check=False)
            return lambda: by_module(system, q0=p.q0)

        def by_loop():
            short = SimpleNamespace(until=steps * h, q0=p.q0, v0=p.v0, mass=p.mass)
            begin = time.perf_counter()
            solvers.numpy_verlet(short, p.force, h)
            return time.perf_counter() - begin

        add("f.fill(0), called by the module", by(lambda q, f: f.fill(0)))
        add("NumPy's f, called by the module", by(written(p.force)))
        add("NumPy's f, in a loop of NumPy", by_loop)
        numba = own_forces.numba_cloth(p)
        if numba is not None:
            add("Numba's f", by(numba))
        add("the scene's f", lambda: by_module(scene, keep=keep))
    return rows


def write(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def processor():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else platform.machine()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--out", required=True, help="the folder for the results")
    parser.add_argument("--point-limit", type=float, default=3, help="seconds that a run may take")
    parser.add_argument("--repeats", type=int, default=3, help="how often a run is timed at most")
    parser.add_argument("--reference-seconds", type=float, default=60, help="of each reference")
    parser.add_argument("--problems", default="planet,cloth", help="which of planet and cloth")
    options = parser.parse_args()
    chosen = options.problems.split(",")
    if not set(chosen) <= {"planet", "cloth"}:
        parser.error(f"--problems {options.problems}: allowed are planet and cloth")
    if options.repeats < 1 or not min(options.point_limit, options.reference_seconds) > 0:
        parser.error("--repeats is 1 or more, and --point-limit and --reference-seconds above 0")
    os.makedirs(options.out, exist_ok=True)
    np.seterr(all="ignore")  # runs that grow without bound are part of a sweep
    planet, scene = own_forces.Planet(), qddot.scenes.cloth(nodes=30)
    cloth = own_forces.Cloth(scene, "cloth")
    runs = []
    for p, of, longest in ((planet, None, 0.05), (cloth, scene, 2.1 / scene.explain().omega_max)):
        if p.name not in chosen:
            continue
        system = qddot.System(
            p.mass, written(p.force), p.potential, p.stiffness, dimension=p.dimension
        )
        seconds = options.reference_seconds
        exact = qddot.reference(system, p.until, q0=p.q0, v0=p.v0, seconds=seconds)
        print(f"{p.name}: reference certified to {exact.certified.position:.1e}", flush=True)
        scales = (np.max(np.abs(p.q0)), max(np.max(np.abs(exact.v)), 1e-3))
        for way in ways(p, of, scales, longest):
            mine = list(sweep(p, exact, way, options))
            runs += mine
            if mine:
                last = mine[-1]
                print(f"  {way[0]:<14} {way[1]:<10} {way[2]:<14} {len(mine):>2} runs, to "
                      f"{last['error_position']:.1e} in {last['time_s']:.3g} s", flush=True)  # fmt: skip
    write(
        os.path.join(options.out, "runs.csv"), list(runs[0]), [list(run.values()) for run in runs]
    )
    rows = table(runs)
    header = ["problem", "accuracy", "force", "way", "method", "time_s", "ratio", "lines", "remark"]
    write(os.path.join(options.out, "times.csv"), header, rows)
    for problem, accuracy, whose, way, method, at, ratio, lines, _ in rows:
        print(f"{problem:<7} {accuracy:7.0e}  {whose:<14} {way:<10} {method:<14} {at:10.3g} s "
              f"{ratio:9.3g} x  {lines} lines")  # fmt: skip
    costs = callbacks(options) if "cloth" in chosen else []
    write(os.path.join(options.out, "callbacks.csv"), ["unknowns", "force", "step_s"], costs)
    for unknowns, whose, seconds in costs:
        print(f"{unknowns:>6} unknowns, {whose:<40} {seconds * 1e6:10.3g} us a step")
    about = {
        "command_line": sys.argv, "processor": processor(), "python": platform.python_version(),
        "numpy": np.__version__, "scipy": scipy.__version__, "qddot": qddot.__version__,
    }  # fmt: skip
    for name in ("runs", "times", "callbacks"):
        with open(os.path.join(options.out, f"{name}.json"), "w", encoding="utf-8") as file:
            json.dump(about, file, indent=1)
    return 0


if __name__ == "__main__":
    sys.exit(main())
