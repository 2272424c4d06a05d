"""Pages of reports, read by other ways than the page reads itself, and the study that most of them show."""

import base64
import gzip
from html.parser import HTMLParser

import numpy as np

import rinow
import shapes
from rinow.study.surface import study_surface

VOID = {"meta", "link", "img", "input", "br"}


class Reader(HTMLParser):
    """Elements with their attributes and the text in them; complains about tags that do not match."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.elements = [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.elements.append([tag, dict(attrs), ""])
        if tag not in VOID:
            self.open.append(self.elements[-1])

    def handle_endtag(self, tag):
        assert self.open.pop()[0] == tag

    def handle_data(self, data):
        if self.open:
            self.open[-1][2] += data

    def texts(self, tag):
        return [text for name, _, text in self.elements if name == tag]

    def by_id(self, name):
        return next(e for e in self.elements if e[1].get("id") == name)


def faulty_mesh():
    """A torus with an unused vertex, a vertex without position, and a face at it."""
    torus = shapes.irregular_torus(300)
    vertices = np.vstack([torus.vertices, [[np.nan, 0, 0], [9.0, 9, 9]]])
    n = len(torus.vertices)
    return rinow.TriangleMesh(vertices, np.vstack([torus.faces, [[0, 1, n]]]))


def study_of(mesh, **options):
    return study_surface(mesh, method="sectional", quality="fast", **options)


def decoded(header, data):
    """The arrays of a scene by another way than the page's: from the description in `report/scene.py`."""
    raw, arrays, start = gzip.decompress(base64.b64decode(data)), {}, 0
    for entry in header["arrays"]:
        dtype = np.dtype(entry["type"])
        count = entry["rows"] * entry["columns"]
        planes = [raw[start + b * count : start + (b + 1) * count] for b in range(dtype.itemsize)]
        numbers = bytes(byte for number in zip(*planes, strict=True) for byte in number)
        values = np.frombuffer(numbers, dtype.newbyteorder("<")).reshape(entry["rows"], entry["columns"])
        if entry["differences"]:
            steps = np.array([[z // 2 if z % 2 == 0 else -(z + 1) // 2 for z in row] for row in values.tolist()])
            values = np.cumsum(steps.reshape(values.shape), axis=0) % 2**32
        arrays[entry["name"]] = values.reshape(-1) if entry["columns"] == 1 else values
        start += count * dtype.itemsize
    assert start == len(raw)
    return arrays
