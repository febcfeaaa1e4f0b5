"""Digests of files and texts. Pictures have a second one, of their pixels alone, so that other metadata can be told from other light."""

import hashlib
import json
import struct

DIGITS = 24
"""Hexadecimal digits that are stored of a SHA-256: 96 bits."""

PNG = b"\x89PNG\r\n\x1a\n"
EXR = b"\x76\x2f\x31\x01"
EXR_MULTIPART = 0x1000


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:DIGITS]


def canonical(value) -> bytes:
    """JSON with sorted keys and without blanks."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode()


def pixels(data: bytes) -> bytes | None:
    """The compressed pixels of a PNG or OpenEXR file without names, texts and other metadata; `None` of other files."""
    if data.startswith(PNG):
        return b"".join(body for kind, body in png_chunks(data) if kind in (b"IHDR", b"PLTE", b"IDAT"))
    if data.startswith(EXR) and not struct.unpack_from("<I", data, 4)[0] & EXR_MULTIPART:
        return exr_chunks(data)
    return None


def png_chunks(data: bytes):
    at = len(PNG)
    while at + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        yield kind, data[at + 8 : at + 8 + length]
        at += 12 + length


def exr_chunks(data: bytes) -> bytes:
    """What follows the header and the table of offsets of a file of one part."""
    at = 8
    while data[at] != 0:
        at = data.index(0, at) + 1  # name
        at = data.index(0, at) + 1  # type
        at += 4 + struct.unpack_from("<I", data, at)[0]
    first_chunk = struct.unpack_from("<Q", data, at + 1)[0]
    return data[first_chunk:]
