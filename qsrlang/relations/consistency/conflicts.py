"""What does not hold together, as values that show themselves."""

from __future__ import annotations

from dataclasses import dataclass

from qsrlang.language.diagnostics import Edit
from qsrlang.language.source import Span
from qsrlang.language.syntax import Atom


@dataclass(frozen=True, slots=True)
class Relaxation:
    """A change after which a conflict is gone: how many steps between conceptual neighbours it takes, and its edits.

    `steps` is None where an atom is to be left out instead; its edits are empty where more than that has to go.
    `short` is the text without places.
    """

    steps: int | None
    text: str
    short: str = ""
    edits: tuple[Edit, ...] = ()

    def to_json(self) -> dict[str, object]:
        """Return the change as plain data."""
        edits = [{**_place(edit.span), "text": edit.text} for edit in self.edits]
        return {"steps": self.steps, "text": self.text, "edits": edits}


@dataclass(frozen=True, slots=True)
class Conflict:
    """Atoms that cannot all hold, while they can without any one of them; `poses` are the landmarks it rests on.

    The relaxations are the smallest changes that were found to end it, the best first.
    """

    atoms: tuple[Atom, ...]
    poses: tuple[str, ...] = ()
    relaxations: tuple[Relaxation, ...] = ()

    def to_json(self) -> dict[str, object]:
        """Return the conflict as plain data."""
        return {
            "atoms": [{**_place(atom.span), "text": one_line(atom)} for atom in self.atoms],
            "poses": list(self.poses),
            "relaxations": [one.to_json() for one in self.relaxations],
        }

    def __str__(self) -> str:
        places = [f"  {atom.span}: {one_line(atom)}" for atom in self.atoms]
        changes = [f"  or: {one.text}" for one in self.relaxations]
        if changes:
            changes[0] = f"  the least change: {self.relaxations[0].text}"
        return "\n".join([f"{self.title}:", *places, *changes])

    @property
    def title(self) -> str:
        """What is wrong, on one line."""
        given = f", given where {' and '.join(self.poses)} stand" if self.poses else ""
        count = len(self.atoms)
        return f"{count} atoms contradict each other{given}" if count > 1 else f"this cannot hold{given}"


@dataclass(frozen=True, slots=True)
class Impossible:
    """An alternative with a share that holds in no world, for the atoms of `conflict`, some its own, cannot hold."""

    atoms: tuple[Atom, ...]
    share: float
    conflict: Conflict

    def to_json(self) -> dict[str, object]:
        """Return the alternative as plain data."""
        atoms = [{**_place(atom.span), "text": one_line(atom)} for atom in self.atoms]
        return {"atoms": atoms, "share": self.share, "conflict": self.conflict.to_json()}

    def __str__(self) -> str:
        alternative = " ∧ ".join(one_line(atom) for atom in self.atoms)
        return f"an alternative of share {self.share:.3g} is never true: {alternative}\n{self.conflict}"


@dataclass(frozen=True, slots=True)
class Consistency:
    """Whether all that is known can be true at once: conflicts that share no atom, and alternatives that never hold.

    `is_decided` is False where the search was given up at its limits: what was found is right, but there may be more.
    """

    conflicts: tuple[Conflict, ...] = ()
    impossible: tuple[Impossible, ...] = ()
    is_decided: bool = True

    @property
    def is_consistent(self) -> bool:
        """Whether no conflict was found."""
        return not self.conflicts

    def to_json(self) -> dict[str, object]:
        """Return the answer as plain data."""
        return {
            "is_consistent": self.is_consistent,
            "is_decided": self.is_decided,
            "conflicts": [one.to_json() for one in self.conflicts],
            "impossible": [one.to_json() for one in self.impossible],
        }

    def __str__(self) -> str:
        head = [] if self.conflicts else ["consistent: everything that is stated can be true at once"]
        rest = [] if self.is_decided else ["(there are more alternatives than were tried)"]
        return "\n\n".join([*head, *map(str, self.conflicts), *map(str, self.impossible), *rest])


def one_line(atom: Atom) -> str:
    """Return an atom as it is written; one that follows from a negation with what was negated."""
    written = " ".join(atom.span.text.split())
    return written if is_plain(atom) else f"¬{written}"


def is_plain(atom: Atom) -> bool:
    """Return whether an atom is what stands at its place, and not what follows from the negation of that."""
    return atom.relation.text.endswith(atom.relation.span.text)


def _place(span: Span) -> dict[str, object]:
    place = {"line": span.line, "column": span.column, "length": span.end - span.start}
    return {"file": span.source.name, **place}
