"""What Python costs, beside the program: observations a second of make_vec against `vlaprobe run` with as many threads, a
control step without pictures against the C++ one, and a reset up to its first picture.

    cmake --build build --target vlaprobe vlaprobe_python_package bench
    PYTHONPATH=build/python /usr/bin/python3 tests/bench/python_bench.py build
"""

import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import vlaprobe

HERE = os.path.dirname(os.path.abspath(__file__))
BUILD = sys.argv[1] if len(sys.argv) > 1 else "build"
THREADS = 2
EPISODES = 24


def random_actions(draw: np.random.Generator, worlds: int) -> np.ndarray:
    """As the program's `random` policy draws them."""
    actions = draw.uniform(-1, 1, (worlds, 7)) * np.array([0.02] * 3 + [0.1] * 3 + [1])
    actions[:, 6] = np.where(actions[:, 6] < 0, -1, 1)
    return actions


def of_run(plan: vlaprobe.Plan) -> float:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "worlds.plan")
        plan.save(path)
        words = ["run", path, "--policy", "random", "--jobs", str(THREADS), "-o", os.path.join(folder, "run")]
        told = subprocess.run([os.path.join(BUILD, "vlaprobe"), *words], capture_output=True, text=True, check=True)
        (line,) = [line for line in told.stderr.splitlines() if "observations/s" in line]
        return float(line.split(" observations/s")[0].split()[-1])


def of_make_vec(plan: vlaprobe.Plan, copy: bool, steps: int = 120) -> float:
    env = vlaprobe.make_vec(plan, "carrot_small", num_envs=16, threads=THREADS, autoreset="same_step", copy=copy)
    env.reset(seed=0)
    draw = np.random.default_rng(0)
    begin = time.perf_counter()
    for _ in range(steps):
        env.step(random_actions(draw, 16))
    rate = 16 * steps / (time.perf_counter() - begin)
    env.close()
    return rate


def of_step(plan: vlaprobe.Plan) -> float:
    """Seconds of the median control step without pictures, all of it in Python."""
    env = vlaprobe.make(plan, "carrot_on_plate", episode=0, cameras=False)
    times = []
    for _ in range(10):
        env.reset()
        for step in range(60):
            action = [0.005 if step % 20 < 10 else -0.005, 0, 0.001, 0, 0, 0, 1]  # to and fro over the table
            begin = time.perf_counter()
            env.step(action)
            times.append(time.perf_counter() - begin)
    env.close()
    return float(np.median(times))


def of_step_in_cpp() -> float:
    words = [os.path.join(BUILD, "tests", "bench", "bench"), "--benchmark_filter=stage/step/", "--benchmark_format=json"]
    told = subprocess.run(words, capture_output=True, text=True, check=True)
    (row,) = json.loads(told.stdout)["benchmarks"]
    return row["median_us"] * 1e-6


def of_reset(plan: vlaprobe.Plan) -> float:
    """Seconds of the median reset with its first picture, of a task that was loaded before."""
    env = vlaprobe.make(plan, "carrot_small")
    env.reset(seed=0)
    times = []
    for episode in range(24):
        begin = time.perf_counter()
        env.reset(options={"episode": episode})
        times.append(time.perf_counter() - begin)
    env.close()
    return float(np.median(times))


def main() -> None:
    plan = vlaprobe.compile(os.path.join(HERE, "worlds.probe"))
    suite = vlaprobe.compile(os.path.join(HERE, "..", "..", "suite", "intact.probe"))
    # By turns, so that what else the machine does meets all of them.
    runs, worlds, views = [], [], []
    for _ in range(3):
        runs.append(of_run(plan))
        worlds.append(of_make_vec(plan, copy=True))
        views.append(of_make_vec(plan, copy=False))
    run = np.median(runs)
    print(f"run --jobs {THREADS}, 224 x 224: {run:.0f} observations/s of {[round(rate) for rate in runs]}")
    for name, rates in (("make_vec, 16 worlds", worlds), ("make_vec, copy=False", views)):
        rate = np.median(rates)
        print(f"{name}: {rate:.0f} observations/s, {rate / run:.0%} of run, of {[round(r) for r in rates]}")
    in_cpp, in_python = of_step_in_cpp(), of_step(suite)
    print(f"step without pictures: {in_python * 1e6:.0f} us, in C++ {in_cpp * 1e6:.0f} us: {in_python / in_cpp:.2f} x")
    print(f"reset to a first picture: {of_reset(plan) * 1e3:.1f} ms")


if __name__ == "__main__":
    main()
