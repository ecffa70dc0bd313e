"""Whether the words of a question stand for something that is known."""

from __future__ import annotations

from collections.abc import Iterator

from qsrlang.errors import UnknownNameError, ValueRangeError
from qsrlang.language.questions import Check, Explain, Landmarks, Prob, Query, Sample, Views, Where
from qsrlang.language.syntax import Argument, Atom, atoms_of
from qsrlang.mixtures.worlds.chains import sources_of
from qsrlang.relations.graph import RelationGraph


def check_question(question: Query, graph: RelationGraph) -> None:
    """Raise UnknownNameError for a name nothing bears, ValueRangeError for an atom with too many or few arguments, and
    for something given where nothing can be.
    """
    if isinstance(question, Landmarks | Check) and question.given is not None:
        verb, given = type(question).__name__.lower(), question.given.span.text
        allowed = "nothing; 'where', 'prob', 'explain' and 'sample' may assume something"
        raise ValueRangeError(f"what is given to '{verb}'", given, allowed)
    if isinstance(question, Sample) and question.subject is not None:
        _check_subject(question.subject.text, graph)
    for part in _parts(question):
        if isinstance(part, Atom):
            check_atom(part, graph)
        else:
            check_object(part.text, graph)


def check_object(name: str, graph: RelationGraph) -> None:
    """Raise UnknownNameError unless a name is that of a class, a landmark or a role."""
    known = _objects(graph)
    if name not in known:
        raise UnknownNameError("role" if ":" in name else "class", name, known)


def drawn_names(graph: RelationGraph, subject: str | None) -> tuple[str, ...]:
    """Return the things that scenes of a subject are drawn of: a scene's members, or a class with all it is placed by.

    Without a subject, all that statements relate. Raises UnknownNameError.
    """
    if subject is None:
        constraints = (
            one for choice in graph.choices for each in choice.alternatives for one in each.constraints
        )
        related = {graph.node_of(name) for one in constraints for name in (one.referent, *one.relata)}
        return tuple(sorted(related))
    _check_subject(subject, graph)
    return graph.scenes.get(subject) or (subject, *sorted(sources_of(graph, subject)))


def _check_subject(name: str, graph: RelationGraph) -> None:
    """Scenes may be drawn of a named scene too."""
    known = [*graph.scenes, *_objects(graph)]
    if name not in known:
        raise UnknownNameError("scene or class", name, known)


def _objects(graph: RelationGraph) -> list[str]:
    return [*graph.classes, *(landmark.name for landmark in graph.landmarks), *graph.roles]


def _parts(question: Query) -> Iterator[Argument | Atom]:
    match question:
        case Where(target=subject, relatum=relatum) | Explain(subject=subject, relatum=relatum):
            yield subject
            if relatum is not None:
                yield relatum
        case Views(target=target) | Landmarks(target=target):
            yield target
        case Prob(formula=formula):
            yield from atoms_of(formula)
        case _:
            pass
    if question.given is not None:
        yield from atoms_of(question.given)


def check_atom(atom: Atom, graph: RelationGraph) -> None:
    """Raise UnknownNameError for a name nothing bears, ValueRangeError for too many or few arguments."""
    relation = graph.relations.get(atom.relation.text)
    if relation is None:
        raise UnknownNameError("relation", atom.relation.text, graph.relations)
    if len(atom.arguments) != relation.arity:
        raise ValueRangeError(
            f"the number of arguments of '{relation.name}'", len(atom.arguments), str(relation.arity)
        )
    for argument in atom.arguments:
        check_object(argument.text, graph)
