"""Draw scenes of a Scenic program for some seconds for every line read; runs where scenic is installed.

python rounds_scenic.py PROGRAM; each line read is a number of seconds, each line written JSON.
"""

import json
import random
import sys
import time

import numpy
import scenic


def drawn(scenario, seconds):
    scenes, tries, start = 0, 0, time.perf_counter()
    while scenes == 0 or time.perf_counter() - start < seconds:
        _, iterations = scenario.generate(maxIterations=10**7)
        scenes, tries = scenes + 1, tries + iterations
    return {"rate": scenes / (time.perf_counter() - start), "tries": tries / scenes}


if __name__ == "__main__":
    random.seed(0)
    numpy.random.seed(0)  # noqa: NPY002 (the generator that Scenic draws from)
    program = scenic.scenarioFromFile(sys.argv[1], mode2D=True)
    for line in sys.stdin:
        print(json.dumps(drawn(program, float(line))), flush=True)
