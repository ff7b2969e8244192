"""Searches in Python on the paper's step: CPU seconds until the cost is within 1 % of the truth's.

The step response of the paper's motor (1 V, 1 ms, 10 s) is read in whole degrees. The six parameters are searched for in
the paper's box; the cost is the integral of the absolute error of an explicit Euler model, compiled by numba, so that
what differs is the search and its overhead. Seeds that do not get there within 20,000 evaluations are counted.
"""

import importlib
import statistics
import sys
import time

import numpy

SAMPLES, INTERVAL_S, VOLTS = 10_000, 1e-3, 1.0
BOX = (1e-4, 1.5)
# Inductance, resistance, kt, inertia, viscous friction, kb; SI.
TRUTH = numpy.array([0.02, 1.2, 0.06, 6.2e-4, 1e-4, 0.06])
BUDGET, PARTICLES, WITHIN = 20_000, 50, 1.01
COUNTS_PER_RAD = 180 / numpy.pi

try:
    from numba import njit
except ImportError:
    print("numba: not there; costs run in plain Python and say nothing about speed")

    def njit(function):
        return function


@njit
def angles(x, substeps, out):
    """The motor's angle in degrees at each sample."""
    inductance, resistance, kt, inertia, viscous, kb = x
    step = INTERVAL_S / substeps
    current = speed = angle = 0.0
    for k in range(SAMPLES):
        out[k] = angle * COUNTS_PER_RAD
        for _ in range(substeps):
            rise = (VOLTS - resistance * current - kb * speed) / inductance
            gain = (kt * current - viscous * speed) / inertia
            angle += step * speed
            current += step * rise
            speed += step * gain


@njit
def cost(x, readings):
    """Integral of the absolute error, degree seconds."""
    inductance, resistance, kt, inertia, viscous, kb = x
    current = speed = angle = total = 0.0
    for k in range(SAMPLES):
        total += abs(angle * COUNTS_PER_RAD - readings[k])
        rise = (VOLTS - resistance * current - kb * speed) / inductance
        gain = (kt * current - viscous * speed) / inertia
        angle += INTERVAL_S * speed
        current += INTERVAL_S * rise
        speed += INTERVAL_S * gain
    total *= INTERVAL_S
    return total if total == total else numpy.inf


class Reached(Exception):
    """The target, or the end of the budget."""


class Problem:
    """Counts evaluations and ends the search at the target."""

    def __init__(self, readings, target):
        self.readings, self.target = readings, target
        self.evaluations, self.best = 0, numpy.inf

    def __call__(self, x):
        x = numpy.clip(numpy.asarray(x, dtype=float), *BOX)
        value = min(cost(x, self.readings), 1e30)
        self.evaluations += 1
        self.best = min(self.best, value)
        if self.best <= self.target or self.evaluations >= BUDGET:
            raise Reached
        return value


LOW, HIGH = numpy.full(6, BOX[0]), numpy.full(6, BOX[1])
ROUNDS = BUDGET // PARTICLES + 1


def scipy_de(problem, seed):
    from scipy.optimize import differential_evolution

    differential_evolution(problem, list(zip(LOW, HIGH)), seed=seed, maxiter=10**6, tol=0, polish=False)


def pygmo(name):
    def search(problem, seed):
        import pygmo

        class Wrapped:
            def fitness(self, x):
                return [problem(x)]

            def get_bounds(self):
                return (LOW, HIGH)

        how = {
            "pso": lambda: pygmo.pso(gen=ROUNDS, seed=seed),
            "cmaes": lambda: pygmo.cmaes(gen=10**4, seed=seed, force_bounds=True, ftol=0, xtol=0),
        }[name]()
        population = pygmo.population(pygmo.problem(Wrapped()), PARTICLES if name == "pso" else 12, seed=seed)
        pygmo.algorithm(how).evolve(population)

    return search


def cma_es(problem, seed):
    import cma

    middle = numpy.random.default_rng(seed).uniform(LOW, HIGH)
    cma.fmin2(problem, middle, 0.3, {"bounds": [BOX[0], BOX[1]], "seed": seed, "verbose": -9}, restarts=9)


def mealpy_pso(problem, seed):
    from mealpy import FloatVar, PSO

    PSO.OriginalPSO(epoch=ROUNDS, pop_size=PARTICLES).solve(
        {"obj_func": problem, "bounds": FloatVar(lb=LOW, ub=HIGH), "minmax": "min", "log_to": None}, seed=seed
    )


def pyswarms_pso(problem, seed):
    import logging

    logging.disable(logging.CRITICAL)
    import pyswarms

    numpy.random.seed(seed)
    swarm = pyswarms.single.GlobalBestPSO(PARTICLES, 6, {"c1": 1.2, "c2": 1.8, "w": 0.7}, bounds=(LOW, HIGH))
    swarm.optimize(lambda points: numpy.array([problem(x) for x in points]), ROUNDS, verbose=False)


def pymoo_pso(problem, seed):
    from pymoo.algorithms.soo.nonconvex.pso import PSO
    from pymoo.core.problem import ElementwiseProblem
    from pymoo.optimize import minimize

    class Wrapped(ElementwiseProblem):
        def __init__(self):
            super().__init__(n_var=6, n_obj=1, xl=LOW, xu=HIGH)

        def _evaluate(self, x, out):
            out["F"] = problem(x)

    minimize(Wrapped(), PSO(pop_size=PARTICLES), ("n_gen", ROUNDS), seed=seed, verbose=False)


SEARCHES = [
    ("pygmo", "PSO", pygmo("pso")),
    ("pygmo", "CMA-ES", pygmo("cmaes")),
    ("cma", "CMA-ES", cma_es),
    ("mealpy", "PSO", mealpy_pso),
    ("pyswarms", "PSO", pyswarms_pso),
    ("pymoo", "PSO", pymoo_pso),
    ("scipy", "DE", scipy_de),
]


def measure(search, readings, target, seed):
    """CPU seconds, evaluations, and whether the target was reached."""
    problem = Problem(readings, target)
    began = time.process_time()
    try:
        search(problem, seed)
    except Reached:
        pass
    return time.process_time() - began, problem.evaluations, problem.best <= target


def row(label, runs):
    """Medians of all runs and of those that reached the target, and what all took for each that did (the expected
    running time of N. Hansen et al., COCO: it charges a search for the seeds at which it fails)."""
    there = [run[0] for run in runs if run[2]]
    seconds = statistics.median(run[0] for run in runs)
    of_those = statistics.median(there) if there else numpy.nan
    a_success = sum(run[0] for run in runs) / len(there) if there else numpy.inf
    evaluations = statistics.median(run[1] for run in runs)
    reached = f"{len(there)}/{len(runs)}"
    return f"{label:22} {seconds:14.4f} {of_those:11.4f} {a_success:11.4f} {evaluations:12.0f} {reached:>8}"


def main():
    file, seeds = sys.argv[1], int(sys.argv[2])
    fine = numpy.empty(SAMPLES)
    angles(TRUTH, 200, fine)
    readings = numpy.floor(fine)
    numpy.savetxt(file, readings, fmt="%d")
    target = WITHIN * cost(TRUTH, readings)
    print(f"{'search':22} {'CPU s: median':>14} {'of reached':>11} {'a success':>11} {'evaluations':>12} {'reached':>8}")
    for package, name, search in SEARCHES:
        label = f"{package} {name}"
        try:
            importlib.import_module(package)
        except ImportError:
            print(f"{label:22} not there")
            continue
        try:
            measure(search, readings, target, 1)  # What is compiled at first use is not counted.
            runs = [measure(search, readings, target, 1 + seed) for seed in range(seeds)]
        except Exception as error:
            print(f"{label:22} failed: {type(error).__name__}: {error}")
            continue
        print(row(label, runs))


main()
