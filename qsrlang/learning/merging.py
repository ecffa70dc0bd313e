"""Learned text in a file among what people wrote: only what stands between two marks is ever changed."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from qsrlang.errors import FileError
from qsrlang.files import write_whole
from qsrlang.language.diagnostics import raise_errors
from qsrlang.language.parser import parse_source
from qsrlang.language.source import Source
from qsrlang.language.statements import Declaration, Document
from qsrlang.learning.experience import (
    Experience,
    experience_bytes,
    no_experience,
    read_experience,
)
from qsrlang.learning.writing import GENERAL, Contexts, learned_text
from qsrlang.relations.checking import check_text
from qsrlang.relations.imports import read_library, read_source

BEGIN = "# Learned: qsr learn writes everything anew from here to the line that ends it."
END = "# End of what was learned."
_BLOCK = re.compile(rf"^{re.escape(BEGIN)}$\n(.*?)^{re.escape(END)}$\n?", re.MULTILINE | re.DOTALL)
_SUMS = re.compile(r"^# Sums: (\S+)\.$", re.MULTILINE)
_HEAD = "language 1.\n"


@dataclass(frozen=True, slots=True)
class Lesson:
    """What learning into a file came to: its new text, and the statements and sources in it."""

    path: Path
    text: str
    experience: Experience


def learn_into(file: Path | str, new: Experience, by: Contexts = GENERAL, keep_sums: bool = True) -> Lesson:
    """Add an experience to what a file was learned from before, and write what all of it teaches into the file.

    The sums lie beside the file, under a name that the file gives; learning from them and new observations is
    learning from all observations. Without `keep_sums` none are kept, for knowledge that is handed on. What people
    wrote stays as it is, byte for byte. Raises FileError, or LanguageError where the file is wrong.
    """
    path = Path(file)
    return _written(path, _text_of(path), learned_before(path) + new, by, keep_sums)


def learn_anew(
    file: Path | str, experience: Experience, by: Contexts = GENERAL, keep_sums: bool = True
) -> Lesson:
    """Write what an experience teaches into a file, in place of all that the file was learned from before.

    Otherwise as `learn_into`.
    """
    path = Path(file)
    return _written(path, _text_of(path), experience, by, keep_sums)


def learned_before(file: Path | str) -> Experience:
    """Return what a file was learned from, nothing where there is none; FileError where its sums are not kept."""
    path = Path(file)
    sums = _sums_of(path, _text_of(path).text)
    return no_experience() if sums is None else read_experience(sums)


def _text_of(path: Path) -> Source:
    before = read_source(path) if path.exists() else Source(path.name, _HEAD, path)
    raise_errors(parse_source(before).diagnostics)
    return before


def _written(path: Path, before: Source, experience: Experience, by: Contexts, keep_sums: bool) -> Lesson:
    kept = experience_bytes(experience) if keep_sums else None
    name = None if kept is None else f"{path.stem}.{hashlib.sha256(kept).hexdigest()[:12]}.sums"
    body = learned_text(experience, _declared(before), by)
    text = merged(before.text, "\n".join([*_provenance(experience, name), *(["", body] if body else [])]))
    raise_errors(check_text(text, str(path)))
    if kept is not None and name is not None:
        write_whole(path.with_name(name), kept)
    write_whole(path, text)
    old = _named_sums(path, before.text)
    if old is not None and old.name != name:
        old.unlink(missing_ok=True)
    return Lesson(path, text, experience)


def merged(text: str, learned: str) -> str:
    """Return a text with what was learned in the place of what was learned before, or at its end."""
    block = f"{BEGIN}\n{learned}\n{END}\n"
    if _BLOCK.search(text):
        return _BLOCK.sub(lambda _: block, text, count=1)
    gap = "" if not text else "\n" if text.endswith("\n") else "\n\n"
    return f"{text}{gap}{block}"


def without_learned(text: str) -> str:
    """Return what people wrote."""
    return _BLOCK.sub("", text)


def _sums_of(path: Path, text: str) -> Path | None:
    """Return the file of sums that a text was learned from; None where nothing was learned yet."""
    if _BLOCK.search(text) is None:
        return None
    sums = _named_sums(path, text)
    remedy = "learn from all observations into a new file, and import this one there"
    if sums is None:
        raise FileError(path, "was learned without keeping its sums", remedy)
    if not sums.is_file():
        raise FileError(path, f"was learned from the sums in {sums.name}, which is gone", remedy)
    return sums


def _named_sums(path: Path, text: str) -> Path | None:
    """Return the file of sums that the learned part of a text names, whether it is there or not."""
    block = _BLOCK.search(text)
    named = None if block is None else _SUMS.search(block[1])
    return None if named is None else path.with_name(Path(named[1]).name)


def _provenance(experience: Experience, sums: str | None) -> list[str]:
    total = sum(experience.sources.values())
    sources = ", ".join(f"{name or 'unnamed'} ({count})" for name, count in experience.sources.items())
    lines = [f"# {total} sightings at {len(experience.placements.places())} places; sources: {sources}."]
    return [*lines, f"# Sums: {sums}."] if sums else lines


def _declared(source: Source) -> Collection[str]:
    """Return the classes that the file declares outside of what was learned, or imports."""
    written = Source(source.name, without_learned(source.text), source.path)
    documents: tuple[Document, ...] = read_library(written).documents
    statements = [one for document in documents for one in document.statements]
    return {c.name.text for one in statements if isinstance(one, Declaration) for c in one.classes}
