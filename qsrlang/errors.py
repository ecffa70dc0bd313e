"""The error tree: every error takes data and writes its own sentence.

* QSRError                    (a user's mistake or a damaged input; exit code 2, never a traceback)
  + LanguageError             text that is not a .qsr document; carries its diagnostics (raised in `language`)
  + FileError                 a file that is missing, damaged or of the wrong kind
  + UnknownNameError          a name that nothing of its kind bears
  + ValueRangeError           a value outside the range that makes sense
  + OutsideMapError           a place the map does not cover
  + BlockedPoseError          a place where the robot would stand in something
  + NoNavigablePoseError      a map in which the robot can stand nowhere
  + UnreachedTargetError      a target that no chain of relations ties to a landmark
  + MissingFacingError        a landmark without a heading where a frame of reference needs one
  + NoRoomError               relations that leave no room on their support
  + ImpossibleConditionError  an assumption or requirement that no possible scene meets
  + UnansweredQueryError      a query about a map, which knowledge alone does not have
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from pathlib import Path


class QSRError(Exception):
    """Root of every error that a user can cause and mend."""


class FileError(QSRError):
    """A file that cannot be used: which one, what is wrong with it, and the remedy."""

    def __init__(self, path: Path | str, problem: str, remedy: str) -> None:
        self.path, self.problem, self.remedy = str(path), problem, remedy
        super().__init__(f"{self.path}: {problem}; {remedy}")


class UnknownNameError(QSRError):
    """A name that nothing of its kind bears; lists the valid names, the nearest first."""

    def __init__(self, kind: str, name: str, known: Iterable[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(sorted(known))
        nearest = difflib.get_close_matches(name, self.known, n=1)
        hint = f"did you mean '{nearest[0]}'? " if nearest else ""
        names = ", ".join(self.known) or "none"
        super().__init__(f"unknown {kind} '{name}'; {hint}known: {names}")


class ValueRangeError(QSRError):
    """A value outside the range that makes sense."""

    def __init__(self, what: str, value: object, expected: str) -> None:
        self.what, self.value, self.expected = what, value, expected
        super().__init__(f"{what} is {value}; expected {expected}")


class OutsideMapError(QSRError):
    """A place the map does not cover; bounds are (x_min, y_min, x_max, y_max) in metres, map frame."""

    def __init__(self, what: str, point: Sequence[float], bounds: Sequence[float], source: str) -> None:
        self.what, self.point, self.bounds, self.source = what, tuple(point), tuple(bounds), source
        x0, y0, x1, y1 = bounds
        super().__init__(
            f"{source}: {what} at ({point[0]:.2f} m, {point[1]:.2f} m) lies outside the map; "
            f"the map covers x {x0:.2f} to {x1:.2f} m, y {y0:.2f} to {y1:.2f} m: move it or load another map"
        )


class BlockedPoseError(QSRError):
    """A place where the robot would stand in something."""

    def __init__(
        self, what: str, point: Sequence[float], radius: float, source: str, nearest: Sequence[float]
    ) -> None:
        self.what, self.point, self.radius, self.source = what, tuple(point), radius, source
        self.nearest = tuple(nearest)
        super().__init__(
            f"{source}: {what} at ({point[0]:.2f} m, {point[1]:.2f} m) is within {radius:.2f} m of an obstacle "
            f"or of unknown space; the nearest free place is ({nearest[0]:.2f} m, {nearest[1]:.2f} m)"
        )


class NoNavigablePoseError(QSRError):
    """A map in which the robot can stand nowhere it can reach."""

    def __init__(self, source: str, radius: float) -> None:
        self.source, self.radius = source, radius
        super().__init__(
            f"{source}: no navigable pose is left after inflation by {radius:.2f} m; "
            "lower the inflation radius of the robot or check the map's thresholds"
        )


class UnplaceableError(QSRError):
    """Knowledge that does not tell where something is."""


class UnreachedTargetError(UnplaceableError):
    """A target that no chain of relations ties to a landmark; lists the chains that were tried."""

    def __init__(self, target: str, chains: Iterable[str]) -> None:
        self.target, self.chains = target, tuple(chains)
        tried = "; ".join(self.chains) or f"no statement places {target}"
        super().__init__(
            f"no chain of relations ties '{target}' to a landmark ({tried}); "
            "add a relation to a class that has a landmark, or add a landmark"
        )


class MissingFacingError(UnplaceableError):
    """A landmark without a heading where a frame of reference or a support's outline needs one."""

    def __init__(self, landmark: str, need: str) -> None:
        self.landmark, self.need = landmark, need
        super().__init__(
            f"landmark '{landmark}' has no heading, which {need} needs; add 'facing … deg' to it"
        )


class NoRoomError(UnplaceableError):
    """Relations that leave no room on their support."""

    def __init__(self, what: str, support: str) -> None:
        self.what, self.support = what, support
        super().__init__(
            f"{what}: no room is left on {support}; check the poses and sizes or use another relation"
        )


class ImpossibleConditionError(UnplaceableError):
    """What is given or required, and how many draws did not meet it."""

    def __init__(self, conditions: Sequence[str], draws: int) -> None:
        self.conditions, self.draws = tuple(conditions), draws
        what = " and ".join(self.conditions) or "what is known"
        found = f"this held in none of {draws} draws; assume less, or draw more"
        super().__init__(f"{what}: {found if draws else 'this cannot hold; assume less'}")


class UnansweredQueryError(QSRError):
    """A query about what knowledge alone does not have, a map, by its verb."""

    def __init__(self, verb: str) -> None:
        self.verb = verb
        super().__init__(
            f"'{verb}' is about views on a map, and knowledge alone has none; "
            "name a scenario, as in 'qsr ask kitchen/cups \"views Cup?\" --scenario kitchen', or ':map kitchen'"
        )
