"""Values of options by name that should be fine and make runs short."""

# Choices, (low, high) of a logarithmic range, or the name of a rule of `Commands.sensible`; all so
# that runs take milliseconds. Those of NEEDED make a run short, or possible at all, and are nearly
# always given.
# fmt: off
NEEDED = {
    "--scene": "scene", "--methods": "methods", "--out": "folder", "--until": (0.001, 0.02),
    "--swing": (0.001, 0.02), "--repeats": ["1", "2"], "--point-limit": (0.005, 0.03),
    "--cell-limit": (0.002, 0.01), "--method-limit": (0.005, 0.03), "--time-limit": (0.005, 0.5),
    "--nodes": ["3", "4", "5"], "--stiffnesses": ["300", "300,600"],
    "--resolutions": ["3", "4", "3,5"], "--least-nodes": ["20", "30"], "--most-nodes": ["30", "60"],
    "--sizes": ["1", "2"], "--ratios": ["1", "1,100"], "--seeds": ["1"], "--cells": ["64", "128"],
    "--columns": ["2", "3"], "--amplitudes": ["0.1", "0.03,0.3"], "scenes": "scenes",
    "--peers": ["odeint", "none"], "--cases": ["1", "2"], "--reference-seconds": ["0.2", "0.5"],
    "--samples": ["1", "5"], ("advise", "--accuracy"): (1e-6, 0.1),
}
SENSIBLE = NEEDED | {
    "--final": "file", "--trajectory": "file", "--energy": "file",
    "--write-scene": ["new.toml", "folder/new.toml"],
    "--motion": ["motion.vtkhdf", "motion.pc2", "folder/new.vtkhdf", "new.pc2"],
    "--motion-fields": ["none", "strain", "velocity,kinetic_energy", "velocity,strain"],
    "--every": (0.001, 0.01), "--step-size": (0.0001, 0.01), "--rtol": (1e-8, 0.01),
    "--atol": (1e-10, 0.01), "--progress": ["auto", "plain", "none"], "--memory-limit": (0.05, 2),
    "--stiffness": (10, 10000), "--iterations": ["1", "2", "5", "20"],
    "--family": ["chain", "whole", "frame"], "--kinds": ["one jump"], "--low": ["0.1", "1"],
    "--high": ["3", "10"], "--threads": ["1", "2"], "--vary": ["stiffness", "nodes", "mass"],
    "--tolerated": (0.01, 1), "--h-omega": ["1", "0.1,2"], "--count": ["1", "3"],
    "--at": ["drawn", "equilibrium"], "--max-order": ["2", "5"], "--solve-tolerance": (1e-9, 0.01),
    "--spectral-radius": ["0", "0.5", "1"], "--scenes": ["chain", "cloth", "chain,lattice"],
    "--solver": ["automatic", "multifrontal", "cholmod", "conjugate_gradients"],
    "--solvers": ["multifrontal", "cholmod", "multifrontal,conjugate_gradients"],
    "--accuracy": (1e-6, 0.1), "--accuracy-of": ["positions", "path", "energy"],
    "--first": ["22000000", "22000002"], "--steps": ["1e-4", "2e-4,1e-4"],
}
OF_A_PROGRAM = {
    ("symmetric_roots", "--at"): (0.1, 1), ("crossover", "--nodes"): ["9", "10"],
    ("exchange", "--until"): (0.1, 1), ("energy_drift", "--step-size"): (1e-6, 2e-5),
    ("exchange", "--scene"): ["fpu", "scene.toml"],
}
GENERATORS = ["oscillator", "orbit", "pair", "pendulum", "strut", "chain"]
