"""MTConnectStreams documents of a log, one after another, read as a stream: observations as they stand.

Between documents there may be anything (an HTTP boundary, a cut document); what of it looks like XML is a loss.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from xml.parsers import expat

from thermodata.plugin import Loss
from thermodata_reader_cnc.mtconnect.document import Document, EndError, Names, NextError, Parser, UntrustedError

ROOT = re.compile(rb"<(?:[\w.-]+:)?MTConnectStreams[\s>/]")
_ENCODING = re.compile(rb"<\?xml[^>]{0,200}encoding=[\"']([\w.-]+)")
_PART = 1 << 18
_TAIL = 512  # bytes kept of what is no document: a root or its XML declaration may begin there
_MOST = 200_000  # observations of a document that wait to be put in order


def documents(path: Path, names: Names, start: int = 0, stop: int | None = None) -> Iterator[Document | Loss]:
    """The documents that begin between two bytes of a file, in order, those of very many observations in parts; and a
    loss for what is between them, cut or refused."""
    size, counted = max(1, path.stat().st_size), 0
    with path.open("rb") as file:
        file.seek(start)
        data, offset, ended, lost = b"", start, False, 0
        while not (ended and not data):
            root = ROOT.search(data)
            if root is None:
                keep = 0 if ended else _TAIL
                lost += data[: len(data) - keep].count(b"<") if len(data) > keep else 0
                offset, data = offset + max(0, len(data) - keep), data[max(0, len(data) - keep) :] if keep else b""
                if (stop is not None and offset > stop) or ended:
                    break
                part = file.read(_PART)
                data, ended = data + part, len(part) < _PART
                continue
            before = data[: root.start()]
            lost += _fragments(before)
            if lost and start == 0:
                yield Loss(f"{path.name} before byte {offset + root.start()}", reason="a part of a document; not read")
            lost = 0
            offset, data = offset + root.start(), data[root.start() :]
            if stop is not None and offset > stop:
                return
            counted += 1
            encoding = _ENCODING.search(before[-_TAIL:])
            place = f"{path.name} document {counted} (byte {offset})"
            parser = Parser(Document(place), names, encoding[1].decode() if encoding else None)
            wrong, begin = "", offset
            while True:
                wrong, used = _feed(parser, data, offset - begin)
                if wrong or parser.document.whole:
                    offset, data = offset + used, data[used:]
                    break
                offset += len(data)
                if len(parser.document.observations) > _MOST:
                    yield parser.document
                    parser.document = Document(place, parser.document.instance, None, None)
                data = file.read(_PART)
                ended = len(data) < _PART
                if not data:
                    wrong = "it ends"
                    break
            if wrong != "refused":
                yield parser.document
            if wrong:
                said = (
                    "a document type, entities, or a value too long: not read"
                    if wrong == "refused"
                    else f"the document is cut or damaged ({wrong}); the observations before are kept"
                )
                yield Loss(place, fraction=min(1.0, (offset - begin) / size), reason=said)
        if lost and start == 0:
            yield Loss(f"{path.name} after byte {offset}", reason="a part of a document; not read")


def _fragments(between: bytes) -> int:
    """How many tags stand between two documents, but for declarations, comments and processing instructions."""
    return len(re.findall(rb"<(?![?!])", between)) + between.count(b"<!DOCTYPE") + between.count(b"<!ENTITY")


def _feed(parser: Parser, data: bytes, fed: int) -> tuple[str, int]:
    """(what is wrong, bytes of data that belong to the document) of a part. fed: bytes fed before."""
    try:
        parser.parser.Parse(data, False)
    except EndError:
        return "", data.find(b">", max(0, parser.stop - fed)) + 1 or len(data)
    except NextError:
        return "another one begins in it", max(1, parser.stop - fed)
    except UntrustedError:
        return "refused", len(data) if parser.depth > 1 else 1
    except expat.ExpatError as error:
        return expat.ErrorString(error.code), max(1, parser.parser.ErrorByteIndex - fed)
    except (LookupError, ValueError) as error:
        return str(error), 1
    return "", len(data)
