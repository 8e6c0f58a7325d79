"""Is a frame the mesh it should be? Figures of cells by textbook formulas, faults by counting facets: cells of
positive volume whose facets are shared by two or lie on a face of the box, that fill each face and the box, tile it.
"""

import math
from dataclasses import dataclass, field

EPSILON = 2.2e-16
WEDGE_TRIANGLES = ((0, 1, 2), (3, 4, 5))
WEDGE_QUADS = ((0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))
GAUSS = ((0.5 - math.sqrt(3) / 6, 0.5), (0.5 + math.sqrt(3) / 6, 0.5))  # place, weight; exact for cubics


@dataclass
class Figures:
    """Of one frame."""

    faults: list = field(default_factory=list)
    volumes: dict = field(default_factory=dict)  # per region [m^3]
    worst_ratio: float = 0.0  # R/r of the tets
    least_dihedral: float = math.pi
    least_jacobian: float = 1.0  # scaled, of the prisms' corners
    integrals: dict = field(default_factory=dict)  # per region: of the temperature [K m^3]
    surfaces: dict = field(default_factory=dict)  # per body: its surface's vertices


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def tet_figures(p, q, r, s):
    """(volume, R/r, cosine of the least dihedral angle); in units of an edge, so that nothing overflows."""
    a, b, c = sub(q, p), sub(r, p), sub(s, p)
    unit = max(map(abs, a + b + c)) or 1.0
    a, b, c = (tuple(x / unit for x in e) for e in (a, b, c))
    n1, n2, n3 = cross(b, c), cross(c, a), cross(a, b)
    six = dot(a, n1)
    n0 = (-n1[0] - n2[0] - n3[0], -n1[1] - n2[1] - n3[1], -n1[2] - n2[2] - n3[2])
    normals = (n0, n1, n2, n3)
    sizes = [math.sqrt(dot(n, n)) for n in normals]
    if six <= 0 or min(sizes) == 0:
        return six / 6 * unit**3, math.inf, 1.0
    aa, bb, cc = dot(a, a), dot(b, b), dot(c, c)
    towards = [aa * n1[i] + bb * n2[i] + cc * n3[i] for i in range(3)]
    ratio = math.sqrt(dot(towards, towards)) / (2 * six) * sum(sizes) / six
    cosine = max(-dot(normals[i], normals[j]) / (sizes[i] * sizes[j]) for i in range(4) for j in range(i))
    return six / 6 * unit**3, ratio, cosine


def wedge_figures(x, temperature):
    """(volume, least scaled Jacobian of a corner, integral of the temperature) of a wedge in VTK's numbers."""
    x = [x[i] for i in (0, 2, 1, 3, 5, 4)]  # the first triangle seen from inside
    unit = max(abs(e) for corner in x for e in sub(corner, x[0])) or 1.0
    x = [tuple(e / unit for e in sub(corner, x[0])) for corner in x]
    least = math.inf
    for i in range(6):
        base, k = (0, i) if i < 3 else (3, i - 3)
        edges = (sub(x[base + (k + 1) % 3], x[i]), sub(x[base + (k + 2) % 3], x[i]), sub(x[k + 3], x[k]))
        size = math.prod(math.sqrt(dot(e, e)) for e in edges)
        least = min(least, dot(edges[0], cross(edges[1], edges[2])) / size if size else 0.0)
    temperature = [temperature[i] for i in (0, 2, 1, 3, 5, 4)] if temperature else [0.0] * 6
    volume = integral = 0.0
    for z, weight in GAUSS:
        for shares in ((0.5, 0.5, 0.0), (0.0, 0.5, 0.5), (0.5, 0.0, 0.5)):  # exact for squares on the triangle
            along = [tuple((1 - z) * e + z * f for e, f in zip(sub(x[k], x[0]), sub(x[k + 3], x[3]))) for k in (1, 2)]
            up = tuple(sum(shares[k] * (x[k + 3][i] - x[k][i]) for k in range(3)) for i in range(3))
            part = weight / 6 * dot(along[0], cross(along[1], up))
            volume += part
            integral += part * sum(shares[k] * ((1 - z) * temperature[k] + z * temperature[k + 3]) for k in range(3))
    return volume * unit**3, least / (math.sqrt(3) / 2), integral * unit**3


class Parts:
    """Sets that are united: which cells are connected."""

    def __init__(self, count):
        self.parent = list(range(count))

    def find(self, i):
        while self.parent[i] != i:
            self.parent[i] = i = self.parent[self.parent[i]]
        return i

    def unite(self, i, j):
        self.parent[self.find(i)] = self.find(j)


def measure_cells(frame, figures):
    parts, heat = {}, {}
    temperature = frame.temperature
    for vertices, cell in zip(frame.tets, frame.tet_cells):
        volume, ratio, cosine = tet_figures(*(frame.points[v] for v in vertices))
        if not volume > 0:
            figures.faults.append(f"cell {cell} is not positive")
        elif abs(ratio - frame.aspect_ratio[cell]) > 1e-6 * ratio:
            figures.faults.append(f"cell {cell} has R/r {ratio}, the frame says {frame.aspect_ratio[cell]}")
        figures.worst_ratio = max(figures.worst_ratio, ratio)
        figures.least_dihedral = min(figures.least_dihedral, math.acos(min(1.0, max(-1.0, cosine))))
        parts.setdefault(frame.region[cell], []).append(volume)
        if temperature:
            heat.setdefault(frame.region[cell], []).append(volume * sum(temperature[v] for v in vertices) / 4)
    for vertices, cell in zip(frame.prisms, frame.prism_cells):
        volume, jacobian, integral = wedge_figures(
            [frame.points[v] for v in vertices], temperature and [temperature[v] for v in vertices])
        if not (volume > 0 and jacobian > 0):
            figures.faults.append(f"cell {cell}, a prism, is not positive")
        figures.least_jacobian = min(figures.least_jacobian, jacobian)
        parts.setdefault(frame.region[cell], []).append(volume)
        heat.setdefault(frame.region[cell], []).append(integral)
    figures.volumes = {region: math.fsum(all_of) for region, all_of in parts.items()}
    figures.integrals = {region: math.fsum(all_of) for region, all_of in heat.items()}


def facets_of(frame):
    """{sorted vertices: [cells that have it]}"""
    shared = {}
    for (a, b, c, d), cell in zip(frame.tets, frame.tet_cells):
        for facet in ((b, c, d), (a, c, d), (a, b, d), (a, b, c)):
            shared.setdefault(tuple(sorted(facet)), []).append(cell)
    for vertices, cell in zip(frame.prisms, frame.prism_cells):
        for corners in WEDGE_TRIANGLES + WEDGE_QUADS:
            shared.setdefault(tuple(sorted(vertices[i] for i in corners)), []).append(cell)
    return shared


def face_of(frame, facet, scene):
    """(axis, 0 or 1) of the face of the box on which all its vertices lie, to the bit; None: on none."""
    for axis in range(3):
        for side, place in enumerate((scene.low[axis], scene.high[axis])):
            if all(frame.points[v][axis] == place for v in facet):
                return axis, side
    return None


def check_faces(frame, outer, scene, tolerance, figures):
    """The facets that one cell has fill the faces of the box."""
    areas = {}
    for facet in outer:
        face = face_of(frame, facet, scene) if len(facet) == 3 else None
        if face is None:
            figures.faults.append(f"the facet {facet} has one cell, but is not on the box")
            continue
        p, q, r = (frame.points[v] for v in facet)
        normal = cross(sub(q, p), sub(r, p))
        areas.setdefault(face, []).append(abs(normal[face[0]]) / 2)
    span = sub(scene.high, scene.low)
    for axis in range(3):
        wanted = span[axis - 1] * span[axis - 2]
        for side in (0, 1):
            found = math.fsum(areas.get((axis, side), []))
            if abs(found - wanted) > tolerance * wanted:
                figures.faults.append(f"the facets on face {'xyz'[axis]} {side} fill {found / wanted} of it")


def check_facets(frame, scene, tolerance, figures):
    outer, walls = [], {}
    parts = Parts(len(frame.region))
    for facet, cells in facets_of(frame).items():
        if len(cells) == 1:
            outer.append(facet)
        elif len(cells) > 2:
            figures.faults.append(f"the facet {facet} is shared by the cells {cells}")
        elif frame.region[cells[0]] == frame.region[cells[1]]:
            parts.unite(*cells)
        else:
            between = sorted(frame.region[cell] for cell in cells)
            if between[0] != 0 or len(facet) != 3:
                figures.faults.append(f"the facet {facet} lies between the regions {between}")
            walls.setdefault(between[1], []).append(facet)
    check_faces(frame, outer, scene, tolerance, figures)
    pieces = {}
    for cell, region in enumerate(frame.region):
        pieces.setdefault(region, set()).add(parts.find(cell))
    for region, found in pieces.items():
        if len(found) != 1:
            figures.faults.append(f"region {region} is in {len(found)} pieces")
    for body, facets in walls.items():
        figures.surfaces[body] = {v for facet in facets for v in facet}
        edges = {tuple(sorted(e)) for a, b, c in facets for e in ((a, b), (b, c), (c, a))}
        if len(figures.surfaces[body]) - len(edges) + len(facets) != 2:
            figures.faults.append(f"the surface of body {body} is not that of a ball")


def rounding(scene):
    """How far volumes may be off, relative: coordinates are rounded, which far from the origin is much of a cell."""
    span = [h - l for h, l in zip(scene.high, scene.low)]
    least = min([*span, *(min(body.shape.axes) for body in scene.bodies)])
    return 1e-12 + 30 * EPSILON * max(map(abs, scene.low + scene.high)) / least


def look_at(frame, scene, t):
    """The figures of a frame at time `t`, with the faults found first."""
    figures = look_at_cells(frame, scene)
    check_surfaces(frame, scene, t, figures)
    return figures


def look_at_cells(frame, scene):
    """The same but for where the bodies are."""
    figures = Figures()
    tolerance = rounding(scene)
    measure_cells(frame, figures)
    check_facets(frame, scene, tolerance, figures)
    box = math.prod(h - l for h, l in zip(scene.high, scene.low))
    filled = math.fsum(figures.volumes.values())
    if abs(filled - box) > tolerance * box:
        figures.faults.append(f"the cells fill {filled / box} of the box")
    if sorted(figures.volumes) != list(range(len(scene.bodies) + 1)):
        figures.faults.append(f"the regions are {sorted(figures.volumes)}")
    if len({v for cell in frame.tets + frame.prisms for v in cell}) != len(frame.points):
        figures.faults.append("there are vertices without a cell")
    if frame.temperature and not all(map(math.isfinite, frame.temperature)):
        figures.faults.append("a temperature is not finite")
    return figures


def check_surfaces(frame, scene, t, figures):
    """The vertices of each body's surface stand where its motion takes it, so that it has its volume."""
    for number, body in enumerate(scene.bodies, 1):
        shape = body.at(t)
        part = figures.volumes.get(number, math.nan) / shape.volume()
        if not abs(part - 1) <= rounding(scene):
            figures.faults.append(f"body {number} has {part} of its volume")
        allowed = 0.5 * scene.surface_size(body)  # the rise of a facet of that size is below a quarter of it
        for v in figures.surfaces.get(number, ()):
            off = shape.distance(frame.points[v])
            if off > allowed:
                figures.faults.append(f"vertex {v} is {off} m off the surface of body {number}")
                break
