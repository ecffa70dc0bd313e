"""Files are written whole or not at all."""

from __future__ import annotations

import tempfile
from pathlib import Path

from qsrlang.errors import FileError


def write_whole(path: Path, content: bytes | str) -> None:
    """Put a file with this content in the place of the path's; text is UTF-8. An interruption leaves the old one.

    Raises FileError where the place cannot be written.
    """
    written = content.encode("utf-8") if isinstance(content, str) else content
    try:
        with tempfile.TemporaryDirectory(prefix=f".{path.name[:32]}-", dir=path.parent) as folder:
            whole = Path(folder) / path.name
            whole.write_bytes(written)
            if path.exists():
                whole.chmod(path.stat().st_mode & 0o777)
            whole.replace(path.resolve() if path.is_symlink() else path)
    except (OSError, ValueError) as error:
        problem = f"cannot be written ({getattr(error, 'strerror', None) or error})"
        raise FileError(path, problem, "name a file in a folder that exists and may be written") from error
