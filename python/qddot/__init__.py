"""Time integration of deformable objects: mass-spring networks, or your own M q'' = f(q). It offers
all of qddot's methods and SUNDIALS', references, charts, advice, and answers with an error bar.

    import qddot
    cloth = qddot.scenes.cloth(nodes=30)
    solution = qddot.solve(cloth, "blanes_moan4", step_size=1e-3, until=0.5)
    sure = qddot.solve(cloth, accuracy=1e-4, until=0.5)

What is called:

    scenes, Scene, System    a motion: of a generator, of a file, or of your own forces
    solve                    the motion by a method, or by the fastest one for an accuracy
    advise                   the method to take for an accuracy
    work_precision           the chart of speed against accuracy
    reference                a certified end, and errors against it
    convergence, energy_trend, exchange    order, drift, and energies of modes
    modes, equilibrium, stability_limit, linear_step    what theory says
    methods, method          all methods, and one by name

Arrays are float64 in C order, (nodes, dimension) or, over time, (times, nodes, dimension). Units
are SI. A run that fails returns a Solution with an outcome; its `or_raise()` raises an exception
instead. Wrong arguments raise a ValueError with one sentence, and misspelt ones a TypeError with the
nearest name.
"""

from qddot import scenes
from qddot._advice import Advice, Advices, Candidate, advise
from qddot._analysis import (
    Equilibrium,
    LinearStep,
    Modes,
    StabilityLimit,
    equilibrium,
    linear_step,
    modes,
    stability_limit,
)
from qddot._curve import Curve
from qddot._methods import Method, method, methods
from qddot._qddot import InvalidInput, NoReference, __version__
from qddot._reference import Errors, ErrorsAlong, Reference, reference
from qddot._scene import Explanation, Scene
from qddot._solve import Break, Counts, Energy, RunFailed, Solution, State, solve
from qddot._studies import (
    Convergence,
    EnergyTrend,
    Exchange,
    ExchangeRun,
    convergence,
    energy_trend,
    exchange,
)
from qddot._system import System
from qddot._work_precision import Point, WorkPrecision, work_precision

__all__ = [
    "Advice",
    "Advices",
    "Break",
    "Candidate",
    "Convergence",
    "Counts",
    "Curve",
    "Energy",
    "EnergyTrend",
    "Equilibrium",
    "Errors",
    "ErrorsAlong",
    "Exchange",
    "ExchangeRun",
    "Explanation",
    "InvalidInput",
    "LinearStep",
    "Method",
    "Modes",
    "NoReference",
    "Point",
    "Reference",
    "RunFailed",
    "Scene",
    "Solution",
    "StabilityLimit",
    "State",
    "System",
    "WorkPrecision",
    "__version__",
    "advise",
    "convergence",
    "energy_trend",
    "equilibrium",
    "exchange",
    "linear_step",
    "method",
    "methods",
    "modes",
    "reference",
    "scenes",
    "solve",
    "stability_limit",
    "work_precision",
]
