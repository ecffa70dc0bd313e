"""Answer a ProbLog program once for every line read, and write what it took as JSON; runs where problog is installed.

python rounds_problog.py PROGRAM
"""

import json
import sys
import time
from pathlib import Path

from problog import get_evaluatable
from problog.program import PrologString


def answered(text):
    start = time.perf_counter()
    list(PrologString(text))
    parsed = time.perf_counter()
    found = get_evaluatable().create_from(PrologString(text)).evaluate()
    whole = time.perf_counter() - parsed
    return {
        "parse": parsed - start,
        "text to answer": whole,
        "answers": {str(query): value for query, value in found.items()},
    }


if __name__ == "__main__":
    program = Path(sys.argv[1]).read_text(encoding="utf-8")
    for _ in sys.stdin:
        print(json.dumps(answered(program)), flush=True)
