# SPDX-License-Identifier: Apache-2.0
"""Pictures as other programs write them, read with nothing but Python: 8-bit PNG, PGM and PPM, and id maps."""
import struct
import zlib


class Raster:
    """8 bits a channel; rows of bytes, channels interleaved."""

    def __init__(self, width, height, channels, rows):
        self.width, self.height, self.channels, self.rows = width, height, channels, rows

    def channel(self, number):
        return [row[number :: self.channels] for row in self.rows]


def unfiltered(kind, row, above, channels):
    """A row of a PNG, in place."""
    for i in range(len(row) if kind else 0):
        left = row[i - channels] if i >= channels else 0
        if kind == 1:
            row[i] = (row[i] + left) & 255
        elif kind == 2:
            row[i] = (row[i] + above[i]) & 255
        elif kind == 3:
            row[i] = (row[i] + (left + above[i]) // 2) & 255
        elif kind == 4:
            corner = above[i - channels] if i >= channels else 0
            guess = left + above[i] - corner
            near = min((abs(guess - left), 0, left), (abs(guess - above[i]), 1, above[i]),
                       (abs(guess - corner), 2, corner))
            row[i] = (row[i] + near[2]) & 255


def read_png(path):
    data, at, packed = path.read_bytes(), 8, b""
    width = height = channels = 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", data[at + 8 : at + 18])
            assert bits == 8
            channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += size + 12
    raw, rows, above = zlib.decompress(packed), [], bytearray(width * channels)
    for y in range(height):
        start = y * (width * channels + 1)
        row = bytearray(raw[start + 1 : start + 1 + width * channels])
        unfiltered(raw[start], row, above, channels)
        rows.append(bytes(row))
        above = row
    return Raster(width, height, channels, rows)


def read_pnm(path):
    """Binary PGM or PPM."""
    data = path.read_bytes()
    fields, at = [], 0
    while len(fields) < 4:
        end = at
        while data[end : end + 1] not in (b" ", b"\n", b"\t"):
            end += 1
        fields.append(data[at:end])
        at = end + 1
    width, height, channels = int(fields[1]), int(fields[2]), {b"P5": 1, b"P6": 3}[fields[0]]
    row = width * channels
    return Raster(width, height, channels, [data[at + y * row : at + (y + 1) * row] for y in range(height)])


def read_ids(path, width, height):
    """Rows of an id map that frontmost wrote as .npy."""
    data = path.read_bytes()
    at = 10 + struct.unpack("<H", data[8:10])[0]
    values = struct.unpack(f"<{width * height}I", data[at:])
    return [values[y * width : (y + 1) * width] for y in range(height)]
