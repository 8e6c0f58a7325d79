"""Boxes and moving ellipsoids, by code of the flood's own: where a body is, and how near it comes to what.

Vectors are tuples of three floats [m]; a rotation is the tuple of its three columns. The distance of two ellipsoids is
that of their Minkowski difference from the origin, by Gilbert's algorithm [Gilbert 1966, "An iterative procedure for
computing the minimum of a quadratic form on a convex set"].
"""

import math
from dataclasses import dataclass, field
from typing import Callable

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def add(a, b, factor=1.0):
    return (a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2])


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def norm(a):
    return math.hypot(a[0], a[1], a[2])


def turned(rotation, a):
    return tuple(sum(rotation[j][i] * a[j] for j in range(3)) for i in range(3))


def turned_back(rotation, a):
    return (dot(rotation[0], a), dot(rotation[1], a), dot(rotation[2], a))


def rotation_about(axis, angle):
    """By Rodrigues' formula; `angle` in radians."""
    k = tuple(x / norm(axis) for x in axis)
    c, s = math.cos(angle), math.sin(angle)

    def column(a):
        across = (k[1] * a[2] - k[2] * a[1], k[2] * a[0] - k[0] * a[2], k[0] * a[1] - k[1] * a[0])
        along = dot(k, a) * (1 - c)
        return tuple(c * a[i] + s * across[i] + along * k[i] for i in range(3))

    return tuple(column(a) for a in IDENTITY)


def product(second, first):
    return tuple(turned(second, column) for column in first)


@dataclass
class Ellipsoid:
    centre: tuple
    axes: tuple  # semi-axes [m]
    rotation: tuple = IDENTITY

    def support(self, direction):
        """The point farthest along `direction`."""
        d = turned_back(self.rotation, direction)
        scaled = tuple(d[i] * self.axes[i] for i in range(3))
        length = norm(scaled) or 1.0
        return add(self.centre, turned(self.rotation, tuple(scaled[i] * self.axes[i] / length for i in range(3))))

    def half_extent(self, axis):
        return norm(tuple(self.axes[j] * self.rotation[j][axis] for j in range(3)))

    def level(self, x):
        """1 on the surface, less inside: the distance from the centre in semi-axes."""
        p = turned_back(self.rotation, minus(x, self.centre))
        return norm(tuple(p[i] / self.axes[i] for i in range(3)))

    def distance(self, x):
        """About the distance from the surface, either side: the level by the length of its gradient."""
        p = turned_back(self.rotation, minus(x, self.centre))
        level = norm(tuple(p[i] / self.axes[i] for i in range(3)))
        slope = norm(tuple(p[i] / self.axes[i] ** 2 for i in range(3)))
        return abs(level * (level - 1) / slope) if slope > 0 else min(self.axes)

    def curvature_radius(self):
        return min(self.axes) ** 2 / max(self.axes)

    def volume(self):
        return 4 / 3 * math.pi * self.axes[0] * self.axes[1] * self.axes[2]


def gap(a, b, accuracy=1e-4):
    """Between two ellipsoids [m], to `accuracy` of the shortest semi-axis; 0 if they overlap."""
    accuracy *= min(min(a.axes), min(b.axes))
    if len({*a.axes}) == len({*b.axes}) == 1:
        return max(0.0, norm(minus(a.centre, b.centre)) - a.axes[0] - b.axes[0])
    near = minus(a.centre, b.centre)
    for _ in range(2000):
        far = norm(near)
        if far < accuracy:
            return 0.0
        towards = tuple(-x / far for x in near)
        point = minus(a.support(towards), b.support(tuple(-x for x in towards)))
        bound = -dot(point, towards)  # planes across `near` confirm this
        if far - bound < accuracy:
            return max(0.0, bound)
        way = minus(point, near)
        near = add(near, way, min(1.0, -dot(near, way) / dot(way, way)))
    return max(0.0, bound)


@dataclass
class Layer:
    count: int = 4
    first_height: float = 2e-5
    growth: float = 1.3
    side: str = "outside"
    min_gap: float | None = None

    def thickness(self):
        return sum(self.first_height * self.growth**k for k in range(self.count))

    def least_gap(self):
        return self.first_height if self.min_gap is None else self.min_gap


@dataclass
class Body:
    name: str
    shape: Ellipsoid
    displacement: Callable = lambda t: (0.0, 0.0, 0.0)
    turn: Callable | None = None  # t -> rotation
    layer: Layer | None = None

    def at(self, t):
        rotation = self.shape.rotation if self.turn is None else product(self.turn(t), self.shape.rotation)
        return Ellipsoid(add(self.shape.centre, self.displacement(t)), self.shape.axes, rotation)


@dataclass
class Scene:
    """What of a case the geometry is."""

    low: tuple
    high: tuple
    surface: float
    growth: float
    far: float
    end: float
    steps: int
    bodies: list = field(default_factory=list)

    def surface_size(self, body):
        """At a body whose layer ends in thin prisms, the first tets are as small as they."""
        if body.layer is None:
            return self.surface
        layer = body.layer
        return min(self.surface, 15 * layer.first_height * layer.growth ** (layer.count - 1))

    def stands_out(self, body):
        """How far at most the triangulated surface stands out of the shape, which gives it the body's volume [m]."""
        return 0.15 * self.surface**2 / body.shape.curvature_radius()

    def needed_gaps(self, least_gap):
        """Those to a wall and between two bodies that surely do, `least_gap` sizes between surfaces [m]."""
        out = sorted((self.stands_out(body) for body in self.bodies), reverse=True) + [0.0, 0.0]
        return least_gap * self.surface + out[0], least_gap * self.surface + out[0] + out[1]

    def wall_gap(self, shape):
        """The least one; negative outside of the box."""
        gaps = []
        for axis in range(3):
            half = shape.half_extent(axis)
            gaps += [shape.centre[axis] - half - self.low[axis], self.high[axis] - shape.centre[axis] - half]
        return min(gaps)


def least_gaps(scene, looks_per_step=8, times=None):
    """(least gap of a body to a wall, least gap of two bodies) over the whole way [m], and when each is."""
    if times is None:
        looks = looks_per_step * scene.steps
        times = [scene.end * k / looks for k in range(looks + 1)]
    wall, pair = (math.inf, 0.0), (math.inf, 0.0)
    for t in times:
        shapes = [body.at(t) for body in scene.bodies]
        for i, shape in enumerate(shapes):
            wall = min(wall, (scene.wall_gap(shape), t))
            for other in shapes[:i]:
                apart = norm(minus(shape.centre, other.centre)) - max(shape.axes) - max(other.axes)
                if apart < pair[0]:  # a lower bound of the gap
                    pair = min(pair, (gap(shape, other), t))
    return wall, pair
