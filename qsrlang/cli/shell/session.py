"""A session as a value: what is known as text, how it became so, and under which circumstances it is asked."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import qsrlang as qsr
from qsrlang.errors import ValueRangeError
from qsrlang.geometry.pose import Pose2
from qsrlang.language.diagnostics import Diagnostic, raise_errors
from qsrlang.language.source import MAX_SOURCE_BYTES, Source
from qsrlang.relations.build import ANYWHERE, Built, build_graph
from qsrlang.relations.contexts import Circumstances

MAX_STEPS_BACK = 10_000
NAME = "session"


@dataclass(frozen=True, slots=True)
class Stated:
    """The statements of one input, and which input of the session it was."""

    number: int
    text: str


@dataclass(frozen=True, slots=True)
class Knowledge:
    """What is known as text: the file it opens with (imported where it is shipped), and what was stated since."""

    opening: Source = field(default_factory=lambda: Source(NAME, ""))
    is_shipped: bool = False
    stated: tuple[Stated, ...] = ()

    @property
    def name(self) -> str:
        """The name of the file, or "session"."""
        return self.opening.name.removesuffix(".qsr") if self.is_shipped else self.opening.name

    @property
    def source(self) -> Source:
        """The whole as one text, as a file that holds it would read."""
        if not self.stated:
            return self.opening
        name = NAME if self.is_shipped else self.opening.name
        text = self.heading + "".join(f"{one.text}\n" for one in self.stated)
        return Source(name, text, None if self.is_shipped else self.opening.path)

    @property
    def heading(self) -> str:
        """The text before what was stated."""
        if self.is_shipped:
            return f'import "{self.name}".\n'
        text = self.opening.text
        return f"{text}\n" if text and not text.endswith("\n") else text

    def numbered(self) -> Iterator[tuple[int, Stated]]:
        """Yield what was stated, each with the number of its first line in the source."""
        line = self.heading.count("\n") + 1
        for one in self.stated:
            yield line, one
            line += one.text.count("\n") + 1


@dataclass(frozen=True, slots=True)
class Session:
    """What is known and what it was before, who asks, and which inputs are saved in a file.

    Every change returns a new session; it raises LanguageError, and changes nothing, where the text that it makes
    has errors.
    """

    knowledge: Knowledge
    built: Built
    past: tuple[Knowledge, ...] = ()
    future: tuple[Knowledge, ...] = ()
    saved: frozenset[int] = frozenset()
    inputs: int = 0
    circumstances: Circumstances = ANYWHERE
    viewer: Pose2 | None = None
    scenario: str | None = None

    @classmethod
    def begin(cls, knowledge: Knowledge | None = None) -> Session:
        """Return a session that knows this, or nothing but the built-in relations."""
        first = knowledge or Knowledge()
        return cls(first, _build(first))

    @property
    def unsaved(self) -> tuple[Stated, ...]:
        """What was stated and is in no file."""
        return tuple(one for one in self.knowledge.stated if one.number not in self.saved)

    @property
    def known(self) -> qsr.KnowledgeBase:
        """The knowledge, ready to be asked under the circumstances of the session."""
        known = qsr.KnowledgeBase(self.built.graph, self.built.diagnostics, self.built)
        return known.under(self.circumstances)

    def source(self) -> Source:
        """Return what is known as one text, the very one it was built from."""
        sources = self.built.library.sources
        return sources[min(1, len(sources) - 1)]

    def state(self, text: str) -> Session:
        """Return the session with the statements of one more input."""
        stated = (*self.knowledge.stated, Stated(self.inputs + 1, text.strip()))
        changed = self.become(replace(self.knowledge, stated=stated))
        return replace(changed, inputs=self.inputs + 1)

    def become(self, knowledge: Knowledge) -> Session:
        """Return the session with other knowledge; `undo` leads back."""
        built = _build(knowledge)
        past = (*self.past, self.knowledge)[-MAX_STEPS_BACK:]
        return replace(self, knowledge=knowledge, built=built, past=past, future=())

    def ask(self, query: str) -> qsr.Answer | qsr.RankedViews:
        """Answer a query, about views on the map of the session's scenario; raises QSRError."""
        if self.scenario is not None and query.lstrip().startswith("views"):
            return qsr.ask_views(self.known, query, self.scenario, viewer=self.viewer)
        return self.known.ask(query, viewer=self.viewer)

    def undo(self, count: int = 1) -> Session:
        """Return the session as it was before the last `count` changes, or as far back as is remembered."""
        return self._move(-min(count, len(self.past)))

    def redo(self, count: int = 1) -> Session:
        """Return the session with the last `count` changes made again that were undone."""
        return self._move(min(count, len(self.future)))

    def as_one_step_from(self, before: Session) -> Session:
        """Return this session with all changes since `before` as a single one."""
        if self.knowledge == before.knowledge:
            return self
        return replace(self, past=(*before.past, before.knowledge)[-MAX_STEPS_BACK:])

    def saved_as(self, knowledge: Knowledge) -> Session:
        """Return the session after what is known was written to the file that `knowledge` opens with."""
        numbers = frozenset(one.number for one in knowledge.stated)
        return replace(self, knowledge=knowledge, built=_build(knowledge), saved=self.saved | numbers)

    def findings_since(self, before: Session) -> tuple[Diagnostic, ...]:
        """Return the findings that the session before did not have."""
        known = {_identity(one) for one in before.built.diagnostics}
        return tuple(one for one in self.built.diagnostics if _identity(one) not in known)

    def _move(self, steps: int) -> Session:
        if steps == 0:
            return self
        timeline = (*self.past, self.knowledge, *self.future)
        now = len(self.past) + steps
        knowledge = timeline[now]
        return replace(
            self,
            knowledge=knowledge,
            built=_build(knowledge),
            past=timeline[:now],
            future=timeline[now + 1 :],
        )


def _build(knowledge: Knowledge) -> Built:
    source = knowledge.source
    if len(source.text) > MAX_SOURCE_BYTES:
        raise ValueRangeError(
            "the length of a session", len(source.text), f"at most {MAX_SOURCE_BYTES} characters"
        )
    built = build_graph(source)
    raise_errors(built.diagnostics)
    return built


def _identity(finding: Diagnostic) -> tuple[str, str, str, int]:
    return finding.code, finding.message, finding.span.source.name, finding.span.start
