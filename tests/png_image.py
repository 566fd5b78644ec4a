"""Reads and writes PNG files of 8 bits a channel without any library, for tests that look at pixels."""

import struct
import zlib


def _chunks(data):
    at = 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        yield kind, data[at + 8:at + 8 + size]
        at += 12 + size


def _paeth(a, b, c):
    p = a + b - c
    distances = abs(p - a), abs(p - b), abs(p - c)
    return (a, b, c)[distances.index(min(distances))]


def _unfilter(kind, row, above, step):
    for i, value in enumerate(row):
        left = row[i - step] if i >= step else 0
        corner = above[i - step] if i >= step else 0
        guess = (0, left, above[i], (left + above[i]) // 2, _paeth(left, above[i], corner) if kind == 4 else 0)[kind]
        row[i] = (value + guess) & 255
    return row


def read(path):
    """(width, height, channels, rows of bytes)"""
    data = open(path, "rb").read()
    parts = list(_chunks(data))
    width, height, bits, color = struct.unpack(">IIBB", parts[0][1][:10])
    channels = {0: 1, 2: 3, 6: 4}[color]
    assert bits == 8, path
    raw = zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT"))
    size, rows = width * channels, [bytearray(width * channels)]
    for y in range(height):
        line = raw[y * (size + 1):(y + 1) * (size + 1)]
        rows.append(_unfilter(line[0], bytearray(line[1:]), rows[-1], channels))
    return width, height, channels, rows[1:]


def write(path, width, channels, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    header = struct.pack(">IIBBBBB", width, len(rows), 8, {1: 0, 3: 2}[channels], 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 1)
    open(path, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b""))
