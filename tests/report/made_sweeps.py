"""Points of a work-precision chart made up by formula: errors c h^p and times that go with 1/h."""

import json
from dataclasses import dataclass

from study_tables import judge, write_table

CERTIFIED = 4e-13
UNTIL = 0.5

COLUMNS = (
    "scene,method,knob,value,outcome,t_reached,error_position,error_velocity,error_energy,time_s,"
    "time_min_s,setup_s,steps,rejected,force_evaluations,factorizations,timed_runs,family,order,"
    "error_energy_max,error_momentum_max,error_modal_shares,error_position_at_least,"
    "error_position_at_most,energy_growth,stock_of"
).split(",")


@dataclass(frozen=True)
class Method:
    """A method of the made chart: its error is `constant` times its knob to the power `order`, and
    a step takes `cost` seconds; steps above `limit` diverge."""

    name: str
    family: str
    order: int
    knob: str
    constant: float
    cost: float
    limit: float
    summary: str
    stock_of: str = ""

    def point(self, scene, value):
        """One row of points.csv."""
        adaptive = self.knob == "rtol"
        steps = round(UNTIL * 300 * value ** (-1 / self.order)) if adaptive else round(UNTIL / value)
        error = self.constant * value ** (1 if adaptive else self.order) + 3e-15 * steps**0.5
        row = dict.fromkeys(COLUMNS, "")
        row |= {"scene": scene, "method": self.name, "knob": self.knob, "value": value}
        row |= {"family": self.family, "order": self.order, "stock_of": self.stock_of}
        row |= {"steps": steps, "rejected": steps // 9 if adaptive else 0}
        row |= {"force_evaluations": max(1, self.order // 2) * steps, "factorizations": 0}
        if value > self.limit:
            share = 0.05 + 0.4 * self.limit / value
            failed = {"outcome": "diverged", "t_reached": share * UNTIL, "energy_growth": 1e300}
            return row | failed | {"timed_runs": 0}
        if steps * self.cost > 0.05:
            return row | {"outcome": "over_budget", "t_reached": 0.6 * UNTIL, "timed_runs": 0}
        time = steps * self.cost
        row |= {"energy_growth": 1, "timed_runs": 5, "outcome": "reached_end", "t_reached": UNTIL}
        row |= {"error_position": error, "error_velocity": 2 * error, "error_energy": error / 3}
        row |= {"error_energy_max": error / 2, "error_momentum_max": 1e-14 + error / 100}
        row |= {"error_position_at_least": max(error - CERTIFIED, 0.0)}
        row |= {"error_position_at_most": error + CERTIFIED}
        return row | {"time_s": time, "time_min_s": 0.97 * time, "setup_s": 1e-5}


METHODS = (
    Method("explicit_euler", "hand-written", 1, "step_size", 90.0, 1.0e-6, 1e-3, "forward Euler"),
    Method("verlet", "hand-written", 2, "step_size", 2e3, 1.0e-6, 1e-2, "velocity Verlet"),
    Method("rk4", "hand-written", 4, "step_size", 8e4, 4.2e-6, 2e-2, "classical Runge-Kutta"),
    Method("symmetric4", "hand-written", 4, "step_size", 5e5, 1.1e-6, 9e-3, "symmetric multistep"),
    Method("symmetric8", "hand-written", 8, "step_size", 6e13, 1.3e-6, 5e-3, "eight, <b>bold</b>"),
    Method("kahan_li8", "hand-written", 8, "step_size", 2e9, 1.7e-5, 2e-2, "composed to order 8"),
    Method("implicit_euler", "hand-written", 1, "step_size", 40.0, 3e-5, 1.0, "backward Euler"),
    Method("ida", "sundials", 5, "rtol", 30.0, 4e-5, 1.0, "SUNDIALS IDA, BDF of order 1 to 5"),
    Method("ida_klu", "sundials", 5, "rtol", 30.0, 7e-5, 1.0, "IDA, stock KLU", "ida"),
    Method("arkode_erk8", "sundials", 8, "rtol", 2.0, 2.2e-5, 1.0, "ARKODE, explicit of order 8"),
)
STEP_SIZES = [2e-2 / 2**k for k in range(12)]
TOLERANCES = [10.0**-k for k in range(1, 12)]


def front(scene):
    """The rows of front.csv, of which the record takes the accuracies and how much a step of verlet
    leaves to its limit of stability: 4 %."""
    rows = [{"scene": scene, "accuracy": 10.0**-digit} for digit in range(1, 10)]
    rows[0] |= {"method": "verlet", "value": STEP_SIZES[1], "stability_margin": 0.04}
    return rows


def sidecar(scene, dimension, nodes, springs):
    """The content of points.json."""
    command = ["build/bin/work_precision", "--scene", scene, "--out", f"results/{scene}"]
    outcomes = {"diverged": "the motion grew without bound: take a smaller step"}
    return {
        "command_line": [*command, "--point-limit", "0.5"],
        "cpu": "a processor",
        "interrupted": None,
        "libraries": {"eigen": "3.4.0", "sundials": "6.4.1"},
        "methods": [{"name": m.name, "summary": m.summary, "takes": []} for m in METHODS],
        "outcomes": outcomes | {"over_budget": "the run was stopped because its time was up"},
        "reduced": {
            "omega_max": 3281.4, "largest_stable_step": 6.1e-4, "parts": 1,
            "reductions": [{"name": "pins", "what": "2 pinned nodes stay where drawn"}],
            "stiffness_is_constant": False, "unknowns": max(1, dimension * (nodes - 2)),
            "unknowns_drawn": dimension * nodes, "unstable_directions": 0,
        },  # fmt: skip
        "scene": {
            "dimension": dimension, "hash": "0123456789abcdef", "name": scene, "nodes": nodes,
            "springs": springs,
        },  # fmt: skip
        "study": {"options": {"--point-limit": ["0.5"]}, "program": "work_precision"},
        "until": UNTIL,
        "version": "0.1.0",
    }


def reference(scene, displacement):
    """The content of reference.json."""
    return {
        "beyond_horizon": False, "certified_position": CERTIFIED, "certified_velocity": 3e-12,
        "certified_energy": 2e-13, "chaotic": False, "horizon": None, "lyapunov": 0.0,
        "made_by": "kahan_li8 at h = 0.0001 s; Boost.odeint Fehlberg 7(8) at tolerance 1e-13",
        "modal_shares_floor": 0.0, "only_symmetric": False, "rounding_effect": 3e-15,
        "scales": {"displacement": displacement, "kinetic": 0.2, "parts": [], "speed": 1.1},
        "scene": scene, "until": UNTIL,
    }  # fmt: skip


def write_study(folder, scene, dimension, nodes, springs, displacement):
    """Writes points.csv, front.csv, their sidecar, reference.json and chart.json; returns the rows of the
    points."""
    rows = [
        method.point(scene, value)
        for method in METHODS
        for value in (TOLERANCES if method.knob == "rtol" else STEP_SIZES)
    ]
    write_table(folder / "points.csv", rows)
    write_table(folder / "front.csv", front(scene))
    about = json.dumps(sidecar(scene, dimension, nodes, springs))
    (folder / "points.json").write_text(about)
    (folder / "front.json").write_text(about)
    (folder / "reference.json").write_text(json.dumps(reference(scene, displacement)))
    judge(folder)
    return rows
