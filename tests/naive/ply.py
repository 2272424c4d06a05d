"""PLY files written number by number, and polygons cut into triangles one by one."""

import struct

CODES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}
ORDERS = {"binary_little_endian": "<", "binary_big_endian": ">"}


def encode(form, elements, newline="\n"):
    """A PLY file.

    `elements` lists (name, properties, rows); a property is (name, type) or, for a list, (name, length type, type);
    a row has one number or one list for each property.
    """
    lines = ["ply", f"format {form} 1.0"]
    for name, properties, rows in elements:
        lines.append(f"element {name} {len(rows)}")
        for label, *types in properties:
            lines.append(f"property {'list ' if len(types) == 2 else ''}{' '.join(types)} {label}")
    lines.append("end_header")
    header = "".join(line + newline for line in lines).encode()
    one = text_record if form == "ascii" else lambda p, row: binary_record(p, row, ORDERS[form])
    return header + b"".join(one(properties, row) for _, properties, rows in elements for row in rows)


def text_record(properties, row):
    words = []
    for (_, *types), value in zip(properties, row, strict=True):
        words += [len(value), *value] if len(types) == 2 else [value]
    return (" ".join(map(repr, words)) + "\n").encode()


def binary_record(properties, row, order):
    data = b""
    for (_, *types), value in zip(properties, row, strict=True):
        if len(types) == 2:
            data += struct.pack(order + CODES[types[0]], len(value))
        for item in value if len(types) == 2 else [value]:
            data += struct.pack(order + CODES[types[-1]], item)
    return data


def fans(polygons):
    """Triangles of polygons, each cut from its first corner."""
    triangles = []
    for corners in polygons:
        for j in range(1, len(corners) - 1):
            triangles.append([corners[0], corners[j], corners[j + 1]])
    return triangles


def strip(corners):
    """Triangles of a strip in which -1 starts anew; every second one is turned."""
    triangles, start = [], 0
    for i in range(len(corners)):
        if corners[i] == -1:
            start = i + 1
        elif i - start >= 2:
            a, b, c = corners[i - 2], corners[i - 1], corners[i]
            triangles.append([a, b, c] if (i - start) % 2 == 0 else [b, a, c])
    return triangles
