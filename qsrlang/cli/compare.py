"""`qsr compare SCENARIO`: arms times trials over processes, with a table of intervals and a CSV of every trial."""

from __future__ import annotations

import json
import os
import sys
from contextlib import contextmanager
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from qsrlang.cli.options import TableFormat, TableOutput
from qsrlang.experiments.comparing import Watch, compare as compare_arms
from qsrlang.experiments.scenarios import load_scenario
from qsrlang.experiments.tables import comparison_json, comparison_table
