"""Reads the VTU files that `kropla run` writes, by the rules of VTK's file format, with the standard library alone:
an XML head, and arrays appended to it, raw, in blocks packed by zlib."""

import array
import re
import struct
import xml.etree.ElementTree as ElementTree
import zlib

CODES = {"Float64": "d", "Float32": "f", "Int64": "q", "Int32": "i", "UInt8": "B", "UInt32": "I", "UInt64": "Q"}
TETRA, WEDGE = 10, 13


class Damaged(Exception):
    """The file does not hold what it says."""


def decompressed(data, offset, head):
    """The array that begins at `offset`: number of blocks, their size, the last one's, then each one's when packed."""
    size = struct.calcsize(head)
    blocks, block, last = struct.unpack_from(f"<3{head}", data, offset)
    packed = struct.unpack_from(f"<{blocks}{head}", data, offset + 3 * size)
    at, parts = offset + (3 + blocks) * size, []
    for length in packed:
        parts.append(zlib.decompress(data[at : at + length]))
        at += length
    whole = b"".join(parts)
    if blocks and len(whole) != block * (blocks - (last > 0)) + last:
        raise Damaged(f"an array has {len(whole)} bytes, not what its head says")
    return whole


def read_arrays(path):
    """{name: array} of all arrays in the file, and (points, cells) as its head says."""
    data = path.read_bytes()
    start = re.search(rb"<AppendedData encoding=\"raw\">\s*_", data)
    if not start:
        raise Damaged("has no data that are appended raw")
    head = ElementTree.fromstring(data[: start.start()] + b"</VTKFile>")
    if head.get("byte_order") != "LittleEndian" or head.get("compressor") != "vtkZLibDataCompressor":
        raise Damaged("is not little-endian and packed by zlib")
    length = {"UInt32": "I", "UInt64": "Q"}[head.get("header_type", "UInt32")]
    piece = head.find("UnstructuredGrid/Piece")
    arrays = {}
    for item in piece.iter("DataArray"):
        if item.get("format") != "appended":
            raise Damaged(f"the array {item.get('Name')} is not appended")
        values = array.array(CODES[item.get("type")])
        values.frombytes(decompressed(data, start.end() + int(item.get("offset")), length))
        arrays[item.get("Name")] = values
    return arrays, int(piece.get("NumberOfPoints")), int(piece.get("NumberOfCells"))


class Frame:
    """points: list of (x, y, z); tets, prisms: lists of vertex tuples, prisms as VTK numbers a wedge; per cell, tets
    before prisms as they stand in the file: region, layer, aspect_ratio; temperature per point, or None."""

    def __init__(self, path):
        try:
            arrays, points, cells = read_arrays(path)
        except (KeyError, ElementTree.ParseError, struct.error, zlib.error) as error:
            raise Damaged(f"cannot be read: {error}") from error
        x = arrays["Points"]
        self.points = list(zip(x[0::3], x[1::3], x[2::3]))
        self.temperature = arrays.get("temperature")
        if len(self.points) != points or len(arrays["types"]) != cells:
            raise Damaged("has another number of points or cells than its head says")
        self.region, self.layer, self.aspect_ratio = arrays["region"], arrays["layer"], arrays["aspect_ratio"]
        self.tets, self.prisms, self.tet_cells, self.prism_cells = [], [], [], []
        corners, begin = arrays["connectivity"].tolist(), 0
        for cell, (kind, end) in enumerate(zip(arrays["types"], arrays["offsets"])):
            vertices, begin = tuple(corners[begin:end]), end
            if (kind, len(vertices)) not in ((TETRA, 4), (WEDGE, 6)):
                raise Damaged(f"cell {cell} is of VTK's type {kind} with {len(vertices)} vertices")
            if not all(0 <= v < points for v in vertices):
                raise Damaged(f"cell {cell} has a vertex that is not there")
            (self.tets if kind == TETRA else self.prisms).append(vertices)
            (self.tet_cells if kind == TETRA else self.prism_cells).append(cell)
