"""The texts that are open in an editor, which stand for their files, and what they say with all they import."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from pygls.uris import from_fs_path, to_fs_path

from qsrlang.language.source import Source
from qsrlang.relations.build import Built, build_graph
from qsrlang.relations.occurrences import Occurrence, occurrences
from qsrlang.resources import resource_root

_FAILED_IMPORT = "Q209"


@dataclass(frozen=True, slots=True)
class Reading:
    """What an open text says with all it imports, and every name in it."""

    built: Built
    names: tuple[Occurrence, ...]


class Workbench:
    """The open texts by their addresses (URIs); what they say is found when it is first asked for."""

    def __init__(self) -> None:
        self._sources: dict[str, Source] = {}
        self._readings: dict[str, Reading] = {}

    @property
    def open(self) -> tuple[str, ...]:
        """The addresses of the open texts."""
        return tuple(self._sources)

    def put(self, address: str, text: str) -> None:
        """Open a text, or give it another content."""
        path = to_fs_path(address)
        self._forget(path)
        source = Source(Path(path).name, text, Path(path)) if path else Source(address, text)
        self._sources[address] = source
        self._readings.pop(address, None)

    def drop(self, address: str) -> None:
        """Close a text: its file counts again."""
        self._sources.pop(address, None)
        self._readings.pop(address, None)
        self._forget(to_fs_path(address))

    def reread(self) -> None:
        """Take into account that files have changed."""
        self._readings.clear()

    def source(self, address: str) -> Source | None:
        """Return an open text."""
        return self._sources.get(address)

    def reading(self, address: str) -> Reading:
        """Return what an open text says; raises QSRError where that cannot be told."""
        if address not in self._readings:
            built = build_graph(self._sources[address], opened=self._opened())
            self._readings[address] = Reading(built, occurrences(built.library))
        return self._readings[address]

    def built(self, address: str) -> Built:
        """Return the relation graph of an open text, with what was found wrong."""
        return self.reading(address).built

    def readings(self) -> tuple[Reading, ...]:
        """Return what each open text says."""
        return tuple(self.reading(address) for address in self._sources)

    def address_of(self, source: Source) -> str:
        """Return the address of a source: the editor's own where it is open there."""
        if source.path is None:
            return source.name
        where = source.path.resolve()
        return self._addresses().get(where) or from_fs_path(str(where)) or source.name

    def _forget(self, path: str | None) -> None:
        """Forget what was built with a file, or without one that could not be found."""
        where = Path(path).resolve() if path else None
        for address, reading in tuple(self._readings.items()):
            missing = any(finding.code == _FAILED_IMPORT for finding in reading.built.diagnostics)
            if missing or where in {file.resolve() for file in reading.built.library.files}:
                del self._readings[address]

    def _opened(self) -> Mapping[Path, Source]:
        return {source.path.resolve(): source for source in self._sources.values() if source.path}

    def _addresses(self) -> Mapping[Path, str]:
        return {source.path.resolve(): address for address, source in self._sources.items() if source.path}


def is_shipped(source: Source) -> bool:
    """Return whether a source came with the package, so that it is not the user's to change."""
    return source.path is not None and source.path.resolve().is_relative_to(
        resource_root("knowledge").resolve()
    )
