"""The smoothness of a movement once more, as its definition reads: with numpy, a transform by the sum itself.

Reads positions, one `x y z` a line, behind a first line with the samples a second; prints SPARC and LDLJ.
"""
import sys

import numpy as np

hz = float(sys.stdin.readline())
positions = np.loadtxt(sys.stdin)
speed = np.linalg.norm(np.diff(positions, axis=0), axis=1) * hz

size = 2 ** (int(np.ceil(np.log2(len(speed)))) + 4)
frequencies = np.arange(size // 2 + 1) * hz / size
frequencies = frequencies[frequencies <= 10]
times = np.arange(len(speed)) / hz
magnitude = np.array([abs(np.sum(speed * np.exp(-2j * np.pi * f * times))) for f in frequencies])
magnitude = magnitude / magnitude[0]
last = max(np.nonzero(magnitude >= 0.05)[0][-1], 1)
frequencies, magnitude = frequencies[: last + 1], magnitude[: last + 1]
across = np.diff(frequencies) / (frequencies[-1] - frequencies[0])
sparc = -np.sum(np.sqrt(across**2 + np.diff(magnitude) ** 2))

jerk = np.diff(speed, 2) * hz**2
ldlj = -np.log((len(speed) / hz) ** 3 / speed.max() ** 2 * np.sum(jerk**2) / hz)
print(repr(float(sparc)), repr(float(ldlj)))
