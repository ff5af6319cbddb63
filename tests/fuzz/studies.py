"""Small command lines of every study, whose points do not depend on how fast the machine is."""

SCENES = {
    "steady.toml": b'until = 0.02\n[generator]\nkind = "chain"\nnodes = 6\n',
    "larger.toml": b'until = 0.02\n[generator]\nkind = "cloth"\nnodes = 7\n',
}

# Each takes "--out FOLDER" beside. No run comes near its limit of time.
# Parts of a second:
STUDIES = {
    "work_precision": "--scene steady.toml --methods verlet,rk4,ida --repeats 1 --point-limit 100"
    " --until 0.01",
    "convergence": "--scene steady.toml --methods verlet,rk4,implicit_midpoint --until 0.01",
    "reversal": "--scene steady.toml --methods verlet,rk4 --steps 1e-3,1e-4 --until 0.01",
    "stability_map": "--scene steady.toml --methods verlet,rk4 --columns 6 --amplitudes 0.03,0.3"
    " --cell-limit 100 --until 0.01",
    "energy_drift": "--scene steady.toml --methods verlet,rk4,dprkn6 --step-size 1e-4 --until 0.05"
    " --method-limit 100",
    "exchange": "--scene fpu --methods verlet,rk4 --until 1 --h-omega 0.1,1",
    "local_global": "--nodes 5 --iterations 20 --repeats 1 --stiffnesses 300,600 --resolutions 4,5"
    " --swing 0.02 --until 0.02",
    "scaling": "--scenes chain --methods verlet --least-nodes 20 --most-nodes 60 --sizes 1",
    "crossover": "--family chain --nodes 9 --until 0.01 --ratios 1,10 --methods verlet,rk4"
    " --repeats 1 --point-limit 100",
    "stock_sundials": "--scene steady.toml --methods ida,arkode_dirk4 --rtol 1e-3,1e-5 --repeats 1"
    " --until 0.01",
    "solvers": "--scene steady.toml --repeats 2",
    "modes": "--scene steady.toml",
    "symmetric_roots": "--samples 30",
    "verdicts": "--seeds 1 --cells 64",
    "advice": "--cases 2 --first 11000011 --repeats 1 --reference-seconds 0.3",
    "bench": "steady.toml@0.01 --methods verlet --repeats 1 --point-limit 100 --peers odeint",
}

# All programs that write files; the studies write into the folder "results".
COMMANDS = {name: f"{words} --out results" for name, words in STUDIES.items()} | {
    "simulate": "--scene steady.toml --method verlet --step-size 1e-4 --until 0.02"
    " --final results/final.csv --trajectory results/trajectory.csv --energy results/energy.csv"
    " --motion results/motion.vtkhdf --every 1e-4 --write-scene results/scene.toml",
    "equilibrium": "--scene steady.toml --final results/rest.csv --out results",
    "advise": "--scene steady.toml --accuracy 1e-3 --out results",
}

# A second or so:
LONG_STUDIES = {
    "work_precision": "--scene steady.toml --methods"
    " verlet,rk4,blanes_moan4,dprkn8,implicit_midpoint,ida,cvode_bdf,arkode_dirk4 --repeats 2"
    " --point-limit 1000 --until 0.02",
    "convergence": "--scene larger.toml --methods"
    " verlet,rk4,blanes_moan4,implicit_midpoint,trapezoidal,bdf2 --until 0.05",
    "reversal": "--scene larger.toml --methods verlet,rk4,blanes_moan4,implicit_midpoint --steps"
    " 1e-3,1e-4,5e-5 --until 0.5",
    "stability_map": "--scene larger.toml --methods verlet,rk4,implicit_euler,bdf2,hht --columns 12"
    " --amplitudes 0.03,0.1,0.3,1 --cell-limit 1000 --until 0.1",
    "energy_drift": "--scene larger.toml --methods verlet,rk4,dprkn6,implicit_midpoint,hht"
    " --step-size 2e-4 --until 0.2 --method-limit 1000",
    "exchange": "--scene fpu --methods verlet,rk4,blanes_moan4,implicit_midpoint --until 60"
    " --h-omega 0.1,1",
    "local_global": "--nodes 15 --iterations 100 --repeats 2 --stiffnesses 300,600 --resolutions"
    " 9,11 --swing 0.1 --until 0.1",
    "scaling": "--scenes chain,cloth --methods verlet --least-nodes 20 --most-nodes 200 --sizes 2"
    " --point-limit 1000",
    # crossover gives up slow methods by the clock, so only one takes part.
    "crossover": "--family whole --nodes 9 --until 0.5 --ratios 1,3,10,30,100 --methods verlet"
    " --repeats 2 --point-limit 1000",
    "stock_sundials": "--scene larger.toml --rtol 1e-3,1e-5,1e-7 --repeats 3 --until 0.05"
    " --point-limit 1000",
    "solvers": "--scene lattice --repeats 3",
    "verdicts": "--seeds 3 --cells 256",
    "advice": "--cases 6 --first 22000000 --repeats 2 --reference-seconds 1",
    "bench": "larger.toml@0.02 --methods verlet,dprkn6 --repeats 1 --point-limit 1000 --peers"
    " odeint",
}

# Studies that make their references by whatever is the fastest, and so not the same twice.
REFERENCES_BY_THE_CLOCK = {"crossover", "advice"}


def write_scenes(folder):
    """Writes the scene files that the studies read."""
    for name, data in SCENES.items():
        with open(f"{folder}/{name}", "wb") as file:
            file.write(data)
