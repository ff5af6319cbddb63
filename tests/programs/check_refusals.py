"""Refusals: status 2, nothing on stdout, one sentence on stderr, and no file written."""

import itertools
import os
import re

from programs import BIN, Programs, node, pin, rows_of, run, scene, spring, write
from random_commands import options_of

ONE_NODE = "nodes = [{position = [0], mass = 1}]\n"
SCENES = {
    "flying.toml": "dimension = 1\n" + ONE_NODE,
    "falling.toml": "dimension = 1\ngravity = [-1]\n" + ONE_NODE,
    "massless.toml": scene([pin(0), node(1, mass=0)], [spring(0, 1, 1)], until=1),
    "huge.toml": scene([pin(0), node(1e60, mass=1)], [spring(0, 1, 100)]),
    # Malformed ones.
    "empty.toml": "",
    "syntax.toml": "dimension = = 1\n",
    "dimension.toml": "dimension = 4\n" + ONE_NODE,
    "foo.toml": "dimension = 1\nfoo = 1\n" + ONE_NODE,
}

SIMULATE = "simulate --scene oscillator --final f.csv --method"
STUDIES = "work_precision,convergence,stability_map,energy_drift,exchange,stock_sundials,reversal"
# A command line a line, and what its sentence has to hold. For {a,b} each of these stands, and {} (or
# {0}, {1} for several) for the last word of the same one on the right. "OUT" is short for "--out
# out", SIMULATE for a run that writes its end. STUDIES are those of a scene by several methods.
TABLE = """
{STUDIES,modes,motions,solvers,advise --accuracy 1e-3} OUT | --scene is missing
{simulate,simulate --write-scene s.toml,equilibrium} | --scene is missing
{STUDIES,modes,motions,solvers} --scene fpu | --out is missing
{crossover,local_global,scaling,symmetric_roots,verdicts,advice} | --out is missing
{STUDIES,modes,solvers} --scene carpet OUT | carpet | allowed
{simulate --write-scene s.toml,equilibrium} --scene carpet | carpet | allowed
{STUDIES} --scene fpu --methods leapfrog OUT | --methods: leapfrog is not a method | allowed
{STUDIES} --scene fpu --methods verlett OUT | --methods: verlett is not a method, the nearest is verlet | allowed
{crossover,scaling} --methods leapfrog OUT | --methods: leapfrog is not a method | allowed
{work_precision,energy_drift,stock_sundials,exchange,reversal,stability_map} --scene fpu --methods ida,ida OUT | --methods: ida is named twice
solvers --scene cloth --solvers klu,klu OUT | --solvers: klu is named twice; allowed is once
{work_precision,convergence,exchange} --scene fpu --no-reduce gravity OUT | --no-reduce | gravity | allowed are pins, duplicates, massless
{scaling --no-reduce gravity OUT,simulate --scene chain --explain --no-reduce gravity} | --no-reduce | gravity is not a reduction
{crossover --ratios 1,local_global,symmetric_roots} --scene cloth OUT | --scene
{work_precision,stock_sundials} --scene orbit --step-size 1 OUT | --step-size
work_precision --scene orbit {--point-limit,--until} 0 OUT | {} 0 is not allowed | greater than 0
energy_drift --scene orbit {--step-size,--until,--rtol,--method-limit} 0 OUT | {} 0 is not allowed | greater than 0
exchange --scene fpu {--h-omega,--until,--every} 0 OUT | {} 0 is not allowed | greater than 0
stability_map --scene orbit {--until,--cell-limit,--tolerated,--amplitudes} 0 OUT | {} 0 is not allowed | greater than 0
stock_sundials --scene orbit {--rtol,--point-limit} 0 OUT | {} 0 is not allowed | greater than 0
crossover --ratios 1 {--until,--point-limit} 0 OUT | {} 0 is not allowed | greater than 0
local_global {--stiffness,--step-size,--until,--stiffnesses} 0 OUT | {} 0 is not allowed | greater than 0
scaling {--step-size,--point-limit,--memory-limit,--least-nodes,--most-nodes} 0 OUT | {} 0 is not allowed
simulate --scene cloth --time-limit 0 | --time-limit 0 is not allowed | greater
{work_precision --scene orbit,stock_sundials --scene orbit,crossover --ratios 1,local_global} --repeats {0,1001} OUT | --repeats {1} | from 1 to 1000
advise --scene orbit --until 1 OUT | --accuracy is missing
advice {--rules,--samples} OUT | {} is given without --hard
advice --hard --rules --samples OUT | --rules | --samples
{advise OUT,simulate --final f.csv} --scene orbit --until 1 --accuracy {0,nan,1e-40,10} | --accuracy | from 1e-14 | below 1
simulate --scene orbit --until 1 --accuracy 1e-3 --method verlet --final f.csv | --method | --accuracy
simulate --scene orbit --until 1 --accuracy 1e-3 --rtol 1e-3 --final f.csv | --rtol
simulate --scene orbit --until 1 --accuracy 1e-3 --accuracy-of speed | --accuracy-of speed | positions, path and energy
simulate --scene orbit --until 1 --accuracy-of path --method verlet --step-size 0.1 | --accuracy-of
simulate --scene oscillator --method {ida,arkode_dirk2,dprkn8} --rtol 1e-30 --final f.csv | --rtol 1e-30 | 1e-15
simulate --scene flying.toml --method verlet --step-size 0.1 --final f.csv | --until | missing | greater than 0
simulate --scene empty.toml --method verlet --step-size 0.1 --final f.csv | empty.toml | nodes
simulate --scene syntax.toml --method verlet --step-size 0.1 --final f.csv | syntax.toml | :1: | TOML
simulate --scene dimension.toml --method verlet --step-size 0.1 --final f.csv | dimension | 4 | allowed
simulate --scene foo.toml --method verlet --step-size 0.1 --final f.csv | foo.toml | foo | allowed
simulate --scene . --method verlet --step-size 0.1 --final f.csv | .:
simulate --scene oscillator --method verlet --step-size 0.1 --final f.csv --energy {f.csv,./f.csv,f.json,f} --every 1 | {}
simulate --scene orbit --method verlet --step-size 0.01 --every 0.1 --trajectory g.csv --energy e.csv --every 0.2 | --every | 0.1 | --trajectory
simulate --scene orbit --method verlet --step-size 0.01 --every 0.1 | --every | --trajectory | --energy | --motion
SIMULATE {verlet --until 1 --step-size,verlet --step-size 0.1 --until,ida --until 1 --rtol,ida --until 1 --rtol 1e-3 --atol} {nan,inf,0,-0.0025} | {0} | {1} | not allowed | greater than 0
SIMULATE verlet --step-size 0.1 --until 1 --energy e.csv --every {nan,inf,0,-0.0025} | --every | {} | not allowed | greater than 0
SIMULATE verlet --until 1 --step-size 1e999 | --step-size inf is not allowed
SIMULATE verlet --until 1 --step-size -2.5e-3 | --step-size -0.0025 is not allowed
SIMULATE verlet --until 1 --step-size {text,1e-3x,--final} | --step-size | {} | allowed
SIMULATE ida --until 1 --rtol {1,1e300,1e-16} | --rtol | from 1e-15 | below 1
# The oscillator measures 1 m, and goes at up to 10 m/s; a second holds 1e15 steps.
SIMULATE ida --until 1 --rtol 1e-3 --atol {10,1e-31} | --atol | below 10
SIMULATE verlet --until 1 --step-size {9e-16,1e-20} | --step-size | at least 1e-15
SIMULATE verlet --until 1 --step-size 1e200 | --step-size | 1e+150
SIMULATE verlet --step-size 0.1 --until 1 --energy e.csv --every 1e-12 | --every | 1e-12 | allowed
simulate --scene oscillator --step-size 0.1 --until 1 --final f.csv | --method | missing
SIMULATE verlet --until 1 | --step-size | missing
SIMULATE verlet --step-size 0.1 --until 1 --energy e.csv | --every | missing
SIMULATE arkode_dirk4 --until 1 | --rtol | missing | arkode_dirk4
simulate --until 1 {--scene,--method,--step-size,--until,--final,--trajectory,--energy,--motion,--every} | {}
SIMULATE verlet --step-size 0.1 --until 1 {--stepsize,--Scene,-s,stray} | {}
SIMULATE verlet --step-size 0.1 --until 1 --integrator=verlet | --integrator
SIMULATE verlet --step-size 0.1 --until 1 {--step-size,--until,--method,--scene,--final} 0.5 | {}
SIMULATE {verlet,implicit_euler,arkode_trbdf2} --step-size 0.1 --until 1 {--rtol,--atol} 1e-3 | {1} | {0} | --step-size
SIMULATE {ida,dprkn8,arkode_erk4} --rtol 1e-3 --until 1 --step-size 1e-3 | --step-size | {} | --rtol
simulate --scene oscillator --method verlet --step-size 0.1 --until 1 --motion m.pc2 --every 0.1 {--final,--trajectory,--energy} {none/o.csv,/proc/o.csv,/etc/passwd/o.csv} | {1} | cannot be written | allowed
simulate --scene oscillator --method verlet --step-size 0.1 --until 1 --motion m.pc2 --every 0.1 {--final,--trajectory,--energy} / | /: is a folder | allowed
simulate --scene oscillator --method verlet --step-size 0.1 --until 1 --motion m.pc2 --every 0.1 {--final,--trajectory,--energy} '' | {}
simulate --scene orbit --write-scene s.toml {--final f.csv,--energy e.csv --every 1,--step-size 0.1,--until 0.1} | --method | missing
simulate --scene orbit --method verlet --step-size 0.1 --final f.csv --energy e.csv --every 1 --write-scene {f.csv,./f.csv,f.json,e.csv,e.json} | --write-scene | {} | another output | allowed
simulate --scene dimension.toml --write-scene s.toml | dimension.toml:1 | dimension
simulate --scene orbit --write-scene '' | --write-scene
simulate --scene orbit --write-scene none/s.toml | none/s.toml | cannot be written | allowed
simulate --scene orbit --method verlet --step-size 0.1 --write-scene s.toml --final none/f.csv | none/f.csv | cannot be written
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion {m.vtk,m} | --motion {} | .vtkhdf and .pc2
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion= | --motion
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --motion m.pc2 | --every is missing | --motion
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --motion-fields strain | --motion-fields | --motion,
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion m.vtkhdf --motion-fields speed | --motion-fields | speed | strain
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion m.vtkhdf --motion-fields none,strain | none alone
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion m.pc2 --motion-fields strain | --motion-fields | .pc2
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 {--trajectory m.vtkhdf,--final m.vtkhdf.json,--energy m.xdmf} --motion m.vtkhdf | another output | --motion
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --energy m.obj --motion m.pc2 | another output | m.obj
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion m.vtkhdf --write-scene m.xdmf | another output | --write-scene
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion none/m.vtkhdf | none/m.vtkhdf | folder
simulate --scene orbit --method verlet --step-size 1e-3 --until 0.05 --every 0.01 --motion a:b.vtkhdf | a:b.vtkhdf | colons
simulate --scene huge.toml --method verlet --step-size 1e-4 --until 0.05 --every 0.01 --motion {m.vtkhdf,m.pc2} | 32-bit
crossover --ratios {0,0.5,1e10} OUT | --ratios | from 1 to 1e+09
crossover --ratios 10,1,10 OUT | --ratios: 10 | twice
crossover --nodes {3,1001} --ratios 1 OUT | --nodes | {} | from 4 to 1000
crossover --nodes 5 --ratios 1 --family carpet OUT | --family | carpet | allowed | whole
crossover --nodes 5 --ratios 1 --methods exact OUT | exact | allowed
crossover --nodes 5 --ratios 1 --until 0.01 --methods arkode_imex3 OUT | arkode_imex3 | stiff
energy_drift --scene orbit --step-size 1 --until 0.5 OUT | --until 0.5 | 0.5 steps
energy_drift --scene orbit --step-size 1e-9 --until 1e9 OUT | 1e+18 steps
energy_drift --scene flying.toml OUT | --step-size is missing | flying.toml
equilibrium --scene cloth --final '' | --final is missing
equilibrium --scene cloth --final none/e.csv | none/e.csv
equilibrium --scene cloth --finall x | --finall
exchange --scene cloth OUT | cloth: stiff_above: it is missing
exchange --scene framed_cloth OUT | framed_cloth | without energy
exchange --scene fpu --h-omega 1,0.1,1 OUT | --h-omega: 1 is named twice
exchange --scene fpu --h-omega 5e-324 OUT | --h-omega | h = 0 | greater than 0
exchange --scene fpu --h-omega 1e-18 OUT | --h-omega 1e-18 | at least
exchange --scene fpu --until 0.9 OUT | --until 0.9 | ten steps | 1 s
exchange --scene fpu --every 21 OUT | --every 21 | tenth
exchange --scene fpu --methods rodas4,cvode_bdf OUT | rodas4, cvode_bdf | fixed step
exchange --scene fpu --methods exact OUT | exact needs a K
local_global --step-size 1e-300 OUT | --step-size | at least
local_global --step-size 1e300 OUT | --step-size | not allowed
local_global --step-size 1e6 OUT | --step-size | at most | 1e+07 steps
local_global --step-size 1e-8 OUT | --step-size | 5e+07 steps
local_global --until 1e300 OUT | --step-size 0.01 | at least
local_global --until 1e4 --step-size 1 OUT | --until | at most
local_global --swing 1e6 OUT | --swing | at most
local_global --iterations 1000000000 OUT | --iterations | 100000
local_global --nodes {2,401} OUT | --nodes | {} | from 3 to 400
local_global --resolutions 4,2 OUT | --resolutions 2 | from 3 to 400
local_global --iterations 0 OUT | --iterations 0 | from 1 to
local_global --swing -1 OUT | --swing -1 | at least 0
simulate --scene orbit --method ida --rtol 1e-3 --max-order {0,-1,6,100} | --max-order {} is not allowed | from 1 to 5
simulate --scene orbit --method ida --rtol 1e-3 --max-order {text,1.5,nan,99999999999999999999} | --max-order | {} | allowed is a number
simulate --scene orbit --method ida --rtol 1e-3 --max-order | --max-order
simulate --scene orbit --method ida --rtol 1e-3 --max-order 2 --max-order 0 | --max-order 0 | from 1 to
simulate --scene orbit --method verlet --step-size 1e-3 --max-order 2 | --max-order is not for verlet; it is for ida, ida_klu, ida_rods, cvode_bdf, cvode_bdf_klu, cvode_adams
simulate --scene orbit --method arkode_dirk4 --rtol 1e-3 --max-order 2 | --max-order is not for arkode_dirk4
simulate --scene orbit --method {arkode_dirk4,cvode_adams,ida} --rtol 1e-3 --stability-detection | --stability-detection is not for {}; it is for cvode_bdf, cvode_bdf_klu
simulate --scene orbit --method local_global --step-size 1e-3 --iterations {0,1000000000} | --iterations {} | a whole number from 1 to 100000
simulate --scene orbit --method implicit_euler --step-size 1e-3 --iterations 3 | --iterations is not for implicit_euler | local_global_lbfgs
simulate --scene orbit --method implicit_euler --step-size 1e-3 --solve-tolerance {0,1} | --solve-tolerance {} | between 0 and 1
simulate --scene orbit --method {local_global,verlet} --step-size 1e-3 --solve-tolerance 0.1 | --solve-tolerance is not for {} | bdf2
simulate --scene orbit --method hht --step-size 1e-3 --spectral-radius {-1,1.5} | --spectral-radius {} | from 0 to 1
simulate --scene orbit --method trapezoidal --step-size 1e-3 --spectral-radius 0.5 | --spectral-radius is not for trapezoidal | generalized_alpha
simulate --scene orbit --method implicit_euler --step-size 1e-3 --solver {lu,klu} | --solver {} | one of automatic, multifrontal
simulate --scene orbit --method ida_klu --rtol 1e-3 --solver cholmod | --solver is not for ida_klu | implicit_euler
work_precision --scene orbit --methods {ida,cvode_adams} --max-order 13 OUT | --max-order 13 | from 1 to
work_precision --scene orbit --methods hht --spectral-radius 1.5 OUT | --spectral-radius 1.5 | from 0 to 1
simulate --scene orbit --method exact --step-size 1 | orbit: exact | same everywhere | verlet
simulate --scene orbit --method arkode_imex3 --rtol 1e-3 | orbit: stiff_above: | arkode_imex3 | above 0 | verlet | implicit_euler
work_precision --scene orbit --progress loud OUT | --progress loud | auto, plain, none
work_precision --scene orbit --methods exact OUT | orbit | exact
modes --scene cloth --count {0,1001} OUT | --count {} | from 1 to 1000
modes --scene cloth --at rest OUT | --at: rest | drawn or equilibrium
modes --scene falling.toml --at equilibrium OUT | falling.toml | falls for ever
reversal --scene pendulum --steps 0 OUT | --steps 0 is not allowed
reversal --scene pendulum --methods ida OUT | ida chooses its steps by itself
scaling --scenes chain,rope OUT | rope | chain, cloth, lattice
scaling --scenes chain,chain OUT | chain | twice
scaling --solvers lu OUT | --solvers: lu | conjugate_gradients
scaling --solvers cholmod,cholmod OUT | cholmod | twice
scaling --methods dprkn8 OUT | dprkn8 | fixed step
scaling --most-nodes 1e8 OUT | --most-nodes | 1e+07
scaling --least-nodes 2000 --most-nodes 1000 OUT | --least-nodes 2000 | --most-nodes 1000
scaling --sizes 0 OUT | --sizes 0 | from 1 to
solvers --scene cloth --solvers multifrontal,lu OUT | --solvers: lu is not a solver; allowed are multifrontal, cholmod, eigen, klu
stability_map --scene pendulum --columns 0 OUT | --columns | 0 | 1 to
stability_map --scene pendulum --low -1 OUT | --low | -1
stability_map --scene pendulum --low 3 --high 2 OUT | --high | 2 | 3
stability_map --scene pendulum --vary colour OUT | colour | mass
stability_map --scene strut --vary compression --amplitudes 1e9,2 OUT | compression = 1000000000 | not allowed
stock_sundials --scene pendulum --methods {verlet,arkode_erk4,arkode_trbdf2,cvode_adams,ida_klu} OUT | --methods | {} | stock | allowed
stock_sundials --scene pendulum --methods ida,verlet OUT | --methods | verlet
stock_sundials --scene pendulum --rtol 1e-3,1e300 OUT | --rtol 1e+300 | below 1
symmetric_roots --samples {0,100001} OUT | --samples {} | from 1 to 100000
symmetric_roots --at {0,2.1} OUT | --at | {} | from 0.01 to 2
verdicts --seeds 0 OUT | --seeds 0
verdicts --cells 1 OUT | --cells 1
verdicts --kinds nothing OUT | no kind "nothing" | random walk
work_precision --scene orbit --out /proc/none | --out | /proc/none | allowed
work_precision --scene orbit --out /etc/passwd | /etc/passwd | allowed
work_precision --scene orbit OUT {--point-limit,--until} | {}
work_precision --scene orbit --repeats {1.5,99999999999999999999} OUT | --repeats | {}
# Folders in the places of tables are found before anything is measured.
work_precision --scene orbit --until 0.1 --out {points.csv,front.csv,reference.json}.is_taken | .is_taken/{}
crossover --ratios 1 --out {points.csv,crossover.csv,kinds.csv,points.json}.is_taken | .is_taken/{}
convergence --scene orbit --until 0.1 --out {order.csv,order.json}.is_taken | .is_taken/{}
energy_drift --scene orbit --until 10 --out {drift.csv,summary.csv}.is_taken | .is_taken/{}
stability_map --scene orbit --until 1 --out {map.csv,limits.csv}.is_taken | .is_taken/{}
simulate --scene oscillator --method verlet --step-size 0.1 --until 1 --final f.json.is_taken/f.csv | f.json.is_taken/f.json
sweep | the action is missing
sweep sweep S | sweep is no action of sweep
sweep run | the sweep's folder is missing
sweep run S | --stage is missing
sweep run S --stage point | --stage point is not one
sweep run S --stage points --task 0 | 0 is no task of points
sweep run S --stage points --go | --go is for sweep submit
sweep run . --stage points | tasks.jsonl: it is missing
sweep run S --stage points --shard={5/4,0/4,1,1/,/2,a/b,1/2/3,-1/4,1/-4,1.5/2} | {} | 1/N to N/N
sweep merge S --by time | --by time is not allowed
sweep submit S | --slurm or --parallel
sweep submit S --slurm --shards 0 | --shards 0
sweep status nothing | tasks.jsonl: it is missing
sweep plan study.toml | --out is missing
work_precision --scene massless.toml --methods verlet OUT | massless.toml | nodes[1].mass | allowed
work_precision --scene flying.toml --methods verlet OUT | --until | missing
"""
# Command lines to which each option that takes a number can be added. simulate's take other methods.
GOOD = """
simulate
equilibrium --scene orbit
{STUDIES,modes,motions,solvers} --scene fpu OUT
{crossover,local_global,scaling,symmetric_roots,verdicts,advice,bench orbit} OUT
advise --scene orbit --accuracy 1e-3
sweep submit S --parallel
"""

# Studies of a sweep, and what the sentence holds beside the file's name.
SWEEPS = """
scenes = ["cloth"]; method = ["verlet"] | study.toml:2: method: it is an unknown key; allowed are
scenes = [] | :1: scenes: [] is not allowed
until = 1 | scenes: it is missing
scenes = ["cloth"]; until = 0 | :2: until: 0 is not allowed
scenes = ["cloth"]; until = [1, 1] | :2: until: [1, 1] | each once
scenes = ["cloth"]; methods = [] | :2: methods: []
scenes = ["cloth"]; methods = ["verlt"] | :2: methods: [ | verlt
scenes = ["cloth"]; methods = ["ida", "ida"] | ida is named twice
scenes = ["cloth"]; accuracies = [2] | :2: accuracies: [2 | 1e-14
program = "modes"; scenes = ["cloth"] | :1: program:  | modes
program = "advice"; scenes = ["cloth"] | scenes: advice draws
program = "advice"; methods = ["ida"] | methods: advice takes none
program = "energy_drift"; scenes = ["orbit"]; accuracies = [1e-3] | accuracies: only work_precision
scenes = [{ generator = "chain", nodes = [] }] | scenes[0].nodes: [] is not allowed
scenes = [{ generator = "chain", node = 3 }] | scenes[0].node: it is no parameter of chain
scenes = [{ generator = "chains" }] | scenes[0].generator
scenes = [{ generator = "chain", file = "a" }] | exactly one
scenes = [{ generator = "chain", nodes = { from = 1, to = 9 } }] | scenes[0].nodes.count: it is missing
scenes = [{ generator = "chain", seed = 1 }] | draws: it is missing
scenes = [{ generator = "chain", draws = 3 }] | scenes[0].draws
scenes = [{ generator = "chain", nodes = 1e9 }] | chain | nodes
scenes = ["nowhere.toml"] | nowhere
scenes = ["pendulum"]; methods = ["exact"] | pendulum | exact needs a K
scenes = [3] | :1: scenes: [3] is not allowed
scenes = ["pendulum"]; [options]; out = "x" | :3: options.out
scenes = ["pendulum"]; [options]; point-limt = 3 | --point-limt
scenes = ["pendulum"]; [options]; repeats = 0 | --repeats 0
scenes = [ | this is not TOML
scenes = [{ generator = "chain", length = MANY, mass = MANY, stiffness = MANY, gravity = MANY }] | multiply to 1e+08 scenes | 100000
"""
MANY = "{ from = 1, to = 1e6, count = 100 }"


def lines_of(text):
    """The lines of a table, each as its first part and the fragments behind it."""
    for line in filter(None, re.sub("(?m)^#.*", "", text).split("\n")):
        first, *fragments = line.split(" | ")
        yield first, fragments


def expanded(command, fragments):
    """The command lines of a line of the table, each with its fragments."""
    command = re.sub(r"\bOUT\b", "--out out", command).replace("STUDIES", STUDIES)
    command = command.replace("SIMULATE", SIMULATE)
    choices = [choice.split(",") for choice in re.findall(r"\{(.*?)\}", command)]
    for values in itertools.product(*choices):
        rest = iter(values)
        words = re.sub(r"\{.*?\}", lambda _: next(rest), command)
        named = [value.split(" ")[-1] for value in values]
        yield words, [fragment.format(*named) for fragment in fragments]


class Refusals(Programs):
    def setUp(self):
        super().setUp()
        for name, text in SCENES.items():
            write(name, text)
        for names in re.findall(r"(?:\{(\S+?)\}|(\bf\.json))\.is_taken", TABLE):
            for name in "".join(names).split(","):
                os.makedirs(f"{name}.is_taken/{name}", exist_ok=True)
        write("study.toml", 'scenes = ["pendulum"]\nuntil = 0.05\nmethods = ["verlet"]\n')
        self.done("sweep plan study.toml --out S")

    def test_each_line_of_the_table(self):
        for line in lines_of(TABLE):
            for command, fragments in expanded(*line):
                self.refused(command, *fragments)

    def test_odd_numbers_in_every_option(self):
        for line, _ in lines_of(GOOD):
            for command, _ in expanded(line, []):
                program = command.split()[0]
                for option in options_of(f"{BIN}/{program}"):
                    is_list = (option.default or option.words).startswith(("[", "a,b"))
                    values = ["1,x" if is_list else "1,5"]
                    if program != "simulate":
                        values += ["-1", "nan", "inf"][: 3 if option.kind == "FLOAT" else 1]
                    for value in values if option.kind in ("INT", "FLOAT") else ():
                        self.refused(f"{command} {option.name} {value}", option.name, value, "allowed")

    def test_studies_of_a_sweep(self):
        for text, fragments in lines_of(SWEEPS):
            write("study.toml", text.replace("; ", "\n").replace("MANY", MANY) + "\n")
            with self.subTest(text):
                self.refused("sweep plan study.toml --out T", "study.toml", *fragments)

    def test_names_are_answered_with_those_that_there_are(self):
        methods, scenes = (
            {row[name] for row in rows_of(run(f"simulate --list-{kinds} --csv").stdout)}
            for kinds, name in (("methods", "name"), ("scenes", "scene"))
        )
        self.refused(f"{SIMULATE} leapfrog", "--method", "leapfrog", *methods)
        measured = "work_precision --scene orbit --methods verlet,leapfrog --out out"
        self.refused(measured, "--methods", "leapfrog", *methods)
        step = "--step-size 0.1 --until 1"
        self.refused(f"simulate --scene carpet --method verlet {step}", "carpet", *scenes)
        for words in "--scene 'two\nlines' --method verlet", "--scene orbit --method 'two\nlines'":
            self.refused(f"simulate {words} {step}", "two", "lines", "allowed")

    def test_an_unknown_option_gets_the_nearest(self):
        for given, nearest in (
            ("--dt 0.1", "--step-size"), ("--h=0.1", "--step-size"), ("--time-step 1", "--step-size"),
            ("--stepsize 0.1", "--step-size"), ("--utnil 1", "--until"),
        ):  # fmt: skip
            option = re.split("[ =]", given)[0]
            said = f"{option} is not an option of simulate, the nearest is {nearest}"
            self.refused(f"simulate --scene orbit --method verlet {given}", said)
        ended = run("energy_drift --scene orbit --leapfrog 1 --out out")
        self.complains(ended, 2, "--leapfrog is not an option of energy_drift; --help")
        # A program without that option has no word for it.
        ended = run("equilibrium --scene orbit --dt 1")
        self.complains(ended, 2, "--dt is not an option of equilibrium; --help")

    def test_kernels_that_are_not_there(self):
        line = "simulate --scene cloth --method verlet --step-size 1e-4"
        for variable in ("QDDOT_ROOTS", "QDDOT_KERNELS"):
            ended = run(line, env=os.environ | {variable: "square"})
            self.complains(ended, 2, f"simulate: {variable}=square: ", "allowed are ")
            self.assertEqual(ended.stdout, "")

    def test_help_names_the_options(self):
        options = "--scene --method --step-size --rtol --atol --until --final --trajectory --energy"
        options += " --every --write-scene --list-methods --list-scenes --csv"
        for program, named in (("simulate", options), ("modes", "--scene --out --count --at growth")):
            for word in ("--help", "-h"):
                helped = self.done([program, word])
                self.assertEqual(helped.stderr, "")
                self.holds(helped.stdout, *named.split())
