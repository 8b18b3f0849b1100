"""Lines of a text file as instruments write them: compressed or not, in the usual encodings."""

import gzip
import re
import zlib
from pathlib import Path

from dalembert.data.opening import absent
from dalembert.errors import DataError

_GZIP = b"\x1f\x8b"
_BLOCK = 1_000_000  # characters that are looked at once; other threads have their turn between
_BINARY = re.compile("[\x00-\x08\x0e-\x1f]")  # control characters that no text has


def text_lines(path: Path) -> list[tuple[int, str]]:
    """The lines that are not blank, with their numbers in the file.

    UTF-8, UTF-16 with a byte order mark, or else Windows-1252, in which older instruments write a degree sign.
    """
    text = _decoded(path, file_bytes(path))
    return [(number, line) for number, line in enumerate(text.splitlines(), start=1) if line.strip()]


def file_bytes(path: Path) -> bytes:
    """Bytes of a file, decompressed if it is a gzip file."""
    try:
        content = path.read_bytes()
        return gzip.decompress(content) if content.startswith(_GZIP) else content
    except FileNotFoundError:
        raise absent(path) from None
    except (OSError, EOFError, zlib.error) as error:
        raise DataError(f"{path}: cannot be read as text with columns ({error})") from error


def _decoded(path: Path, content: bytes) -> str:
    utf16 = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    for encoding in ("utf-16",) if utf16 else ("utf-8-sig", "cp1252"):
        try:
            text = content.decode(encoding)
        except UnicodeDecodeError:
            continue
        if not any(_BINARY.search(text, begin, begin + _BLOCK) for begin in range(0, len(text), _BLOCK)):
            return text
    raise DataError(f"{path}: the file is not text; give its format, or save it as UTF-8 text")
