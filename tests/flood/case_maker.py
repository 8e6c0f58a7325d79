"""Random legal cases. All is drawn in surface sizes first, then scaled by a length and moved away from the origin:

bodies   one to five: spheres and ellipsoids of aspect up to 4, randomly turned; at rest, going straight,
         swinging, turning about random axes; 0.4 to 2 sizes per step; many pass another at 0.3 to 1 sizes
layers   on one body in three: outside, inside, both; 1 to 8 prisms; growth 1 to 2
box      as the bodies need, one in three flat: one side down to a twentieth of the others
sizes    far 1 to 10 surface sizes; growth 0 to 1
heat     in two of three: materials over eight decades, sources, faces of all kinds

What a case needs is kept in mind while it is drawn: a legal one comes out, or nothing, and it is drawn anew.
"""

import math
import random

from geometry import Body, Ellipsoid, Layer, Scene, add, gap, least_gaps, minus, norm, rotation_about

LEAST_GAP = 0.3  # [surface sizes] to walls and between bodies, all the time
LOOKS = 4  # at a path, per step


def direction(rng):
    while True:
        x = tuple(rng.uniform(-1, 1) for _ in range(3))
        if 0.1 < norm(x) <= 1:
            return tuple(e / norm(x) for e in x)


def log_uniform(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


class Path:
    """A motion in sizes over the time 0 ... 1: straight, plus a swing, plus a turn."""

    def __init__(self, rng, steps, reach):
        share = rng.uniform(0.4, 2.0)  # [sizes] that the fastest point of the surface goes in a step
        kinds = rng.choice(((), ("straight",), ("swing",), ("turn",), ("straight", "swing"), ("straight", "turn")))
        part = share / max(1, len(kinds))
        self.way = tuple(part * steps * x for x in direction(rng)) if "straight" in kinds else (0.0, 0.0, 0.0)
        self.frequency, self.phase = rng.uniform(1, 9), rng.uniform(0, 6)
        amplitude = part * steps / self.frequency
        self.swing = tuple(amplitude * x for x in direction(rng)) if "swing" in kinds else None
        self.axis = direction(rng) if "turn" in kinds else None
        self.degrees = math.degrees(part * steps / reach)
        self.swings_round = rng.random() < 0.3  # the turn goes to and fro

    def displacement(self, t):
        at = tuple(t * x for x in self.way)
        return add(at, self.swing, math.sin(self.frequency * t + self.phase)) if self.swing else at

    def angle(self, t):
        return self.degrees * (math.sin(3 * t) / 3 if self.swings_round else t)

    def turn(self, t):
        return rotation_about(self.axis, math.radians(self.angle(t)))

    def written(self, length, end):
        """As the formulas of a case file."""
        lines = []
        for i, name in enumerate("xyz"):
            text = f"{self.way[i] * length!r}*(t/{end!r})"
            if self.swing:
                text += f" + {self.swing[i] * length!r}*sin({self.frequency!r}*t/{end!r} + {self.phase!r})"
            if self.swing or self.way[i]:
                lines.append(f'{name} = "{text}"')
        if self.axis:
            turn = f"sin(3*t/{end!r})/3" if self.swings_round else f"t/{end!r}"
            lines += [f'angle = "{self.degrees!r}*{turn}"', f"axis = [{', '.join(map(repr, self.axis))}]"]
        return lines


def draw_shape(rng):
    """Curved no more sharply than a size."""
    least = log_uniform(rng, 1.05, 3.5)  # radius of curvature
    if rng.random() < 0.5:
        return Ellipsoid((0.0, 0.0, 0.0), (least,) * 3)
    aspect = rng.uniform(1.1, 4)
    longest = least * aspect**2  # the sharpest end has the radius shortest^2 / longest
    axes = [longest, longest / aspect, longest / rng.uniform(1, aspect)]
    rng.shuffle(axes)
    return Ellipsoid((0.0, 0.0, 0.0), tuple(axes), rotation_about(direction(rng), rng.uniform(0, math.pi)))


def draw_body(rng, number, steps):
    shape = draw_shape(rng)
    path = Path(rng, steps, max(shape.axes))
    body = Body(f"body {number}", shape, path.displacement, path.turn if path.axis else None)
    body.path = path
    return body


def comes_within(scene, body, times, wanted):
    """Whether the body comes nearer than `wanted` to another on its way."""
    for k, t in enumerate(times):
        shape = body.at(t)
        for other in (paths[k] for paths in scene.places):
            if norm(minus(shape.centre, other.centre)) - max(shape.axes) - max(other.axes) < wanted:
                if gap(shape, other, 1e-2) < wanted:
                    return True
    return False


def place(rng, scene, body, times):
    """Puts the body somewhere beside the others; half of them so that it passes one at a distance drawn."""
    target = rng.choice(scene.bodies)
    least = LEAST_GAP + scene.stands_out(target) + scene.stands_out(body) + 0.03
    wanted = log_uniform(rng, least, 1.0) if rng.random() < 0.6 else rng.uniform(1, 6)
    t, way = rng.random(), direction(rng)
    meet = minus(target.at(t).centre, body.displacement(t))
    reach = max(target.shape.axes) + max(body.shape.axes)
    near, far = 0.0, 3 * reach + wanted + 40
    for _ in range(11):
        middle = (near + far) / 2
        body.shape.centre = add(meet, way, middle)
        if comes_within(scene, body, times, wanted):
            near = middle
        else:
            far = middle
    body.shape.centre = add(meet, way, far)


def draw_layer(rng, scene, body):
    """Thinner than the room there is on the way, and than a size and a half."""
    wall, pair = least_gaps(scene, looks_per_step=LOOKS)
    room = min(1.5, 0.9 * wall[0], 0.45 * pair[0], 0.9 * body.shape.curvature_radius())
    layer = Layer(rng.randint(1, 8), 1.0, rng.uniform(1, 2), rng.choice(("outside", "inside", "both")))
    layer.first_height = room * rng.uniform(0.2, 1) / layer.thickness()
    body.layer = layer


def draw_box(rng, scene, times):
    """Around all that the bodies pass, with at least the least gap, and more at random; flat, or not."""
    low, high = [math.inf] * 3, [-math.inf] * 3
    for t in times:
        for shape in (body.at(t) for body in scene.bodies):
            for axis in range(3):
                half = shape.half_extent(axis)
                low[axis] = min(low[axis], shape.centre[axis] - half)
                high[axis] = max(high[axis], shape.centre[axis] + half)
    least = scene.needed_gaps(LEAST_GAP)[0] + 0.05
    room = [rng.choice((log_uniform(rng, least, 3), rng.uniform(1, 12))) for _ in range(6)]
    low = [low[axis] - room[axis] for axis in range(3)]
    high = [high[axis] + room[axis + 3] for axis in range(3)]
    if rng.random() < 0.33:
        flat = min(range(3), key=lambda axis: high[axis] - low[axis])
        wide = (high[flat] - low[flat]) * log_uniform(rng, 3, 20)
        for axis in {0, 1, 2} - {flat}:
            more = max(0.0, wide - (high[axis] - low[axis])) * rng.uniform(0.3, 1)
            low[axis], high[axis] = low[axis] - more / 2, high[axis] + more / 2
    scene.low, scene.high = tuple(low), tuple(high)


def estimated_cells(rng, scene):
    """Tets by the integral of the inverse volume of one of the target size, by chance; prisms by the surfaces."""
    span = minus(scene.high, scene.low)
    samples, total = 400, 0.0
    for _ in range(samples):
        x = tuple(low + rng.random() * s for low, s in zip(scene.low, span))
        size = min([scene.far] + [scene.surface_size(b) + scene.growth * b.at(0).distance(x) for b in scene.bodies])
        total += 6 * math.sqrt(2) / size**3
    cells = total / samples * math.prod(span)
    for body in scene.bodies:
        if body.layer:
            radius = body.shape.volume() ** (1 / 3)
            sides = 2 if body.layer.side == "both" else 1
            size = scene.surface_size(body)  # zero where there is no room for a layer: not legal
            cells += sides * body.layer.count * 4.8 * radius**2 / (0.433 * size**2) if size > 0 else math.inf
    return cells


def draw_scene(rng, steps):
    """In sizes, over the time 0 ... 1."""
    scene = Scene((0.0,) * 3, (0.0,) * 3, 1.0, rng.choice((0.0, 1.0, *(rng.random() for _ in range(8)))),
                  log_uniform(rng, 1, 10), 1.0, steps)
    scene.places = []  # of each body, at the times that are looked at
    times = [k / (LOOKS * steps) for k in range(LOOKS * steps + 1)]
    for number in range(1, rng.choice((1, 1, 2, 2, 3, 4, 5)) + 1):
        body = draw_body(rng, number, steps)
        if scene.bodies:
            place(rng, scene, body, times)
        scene.bodies.append(body)
        scene.places.append([body.at(t) for t in times])
    draw_box(rng, scene, times)
    for body in scene.bodies:
        if rng.random() < 0.33:
            draw_layer(rng, scene, body)
    return scene


def is_legal(scene):
    wall, pair = least_gaps(scene, looks_per_step=2 * LOOKS)
    to_wall, between = scene.needed_gaps(LEAST_GAP)
    return wall[0] >= to_wall and pair[0] >= between


def numbers(values):
    return "[" + ", ".join(repr(float(x)) for x in values) + "]"


def written_body(body, length, offset, end):
    shape = body.shape
    lines = ["", "[[body]]", f'name = "{body.name}"',
             f"centre = {numbers(x * length + o for x, o in zip(shape.centre, offset))}"]
    if len(set(shape.axes)) == 1:
        lines += ['shape = "sphere"', f"radius = {shape.axes[0] * length!r}"]
    else:
        axis, degrees = axis_and_degrees(shape.rotation)
        lines += ['shape = "ellipsoid"', f"axes = {numbers(x * length for x in shape.axes)}",
                  f"rotation = {numbers((*axis, degrees))}"]
    motion = body.path.written(length, end)
    if motion:
        lines += ["[body.motion]", *motion]
    if body.layer:
        layer = body.layer
        lines += ["[body.layer]", f"count = {layer.count}", f"first_height = {layer.first_height * length!r}",
                  f"growth = {layer.growth!r}", f'side = "{layer.side}"']
    return lines


def axis_and_degrees(r):
    """Of a rotation by less than half a turn."""
    axis = (r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0])
    return axis, math.degrees(math.atan2(norm(axis), r[0][0] + r[1][1] + r[2][2] - 1))


def written_heat(rng, scene, length, end):
    """Materials over eight decades; what comes in warms by about 100 K over the run, or less."""
    lines, least_capacity = [], math.inf
    for name in ["surroundings"] + [body.name for body in scene.bodies]:
        density, specific, conductivity = 10 ** rng.uniform(-4, 4), rng.uniform(200, 4000), 10 ** rng.uniform(-4, 4)
        least_capacity = min(least_capacity, density * specific)
        lines += ["", f'[heat.region."{name}"]', f"conductivity = {conductivity!r}", f"density = {density!r}",
                  f"specific_heat = {specific!r}", f"initial = {rng.uniform(250, 3000)!r}"]
        if rng.random() < 0.3:
            strength = density * specific * rng.uniform(-10, 100) / end
            lines.append(rng.choice((f"source = {strength!r}", f'source = "{strength!r}*sin(5*t/{end!r})"')))
    faces = []
    for face in ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max"):
        flux = least_capacity * length * rng.uniform(-10, 50) / end
        faces.append(rng.choice((
            f'{face} = "insulated"', f"{face} = {{ value = {rng.uniform(200, 2000)!r} }}",
            f"{face} = {{ flux = {flux!r} }}", f'{face} = {{ value = "300 + 50*sin(4*t/{end!r})" }}',
            f'{face} = {{ flux = "{flux!r}*exp(-(x/{length!r})^2)" }}')))
    return lines + (["", "[heat.face]", *faces] if rng.random() < 0.5 else [])


def written_case(rng, scene):
    """The case file of a scene in sizes, taken to a length and a time."""
    longest = max(minus(scene.high, scene.low))
    length = log_uniform(rng, 1e-12, 1e9) / longest
    away = longest * length * (log_uniform(rng, 0.01, 1e3) if rng.random() < 0.5 else 0.0)
    offset = tuple(away * x for x in direction(rng))
    end = 10 ** rng.uniform(-9, 6)
    lines = ["[domain]", f"min = {numbers(x * length + o for x, o in zip(scene.low, offset))}",
             f"max = {numbers(x * length + o for x, o in zip(scene.high, offset))}"]
    for body in scene.bodies:
        lines += written_body(body, length, offset, end)
    lines += ["", "[size]", f"surface = {length!r}", f"growth = {scene.growth!r}", f"far = {scene.far * length!r}",
              "", "[time]", f"end = {end!r}", f"steps = {scene.steps}", "", "[output]",
              f"every = {rng.choice((1, 1, 2, 3))}", "", "[random]", f"seed = {rng.randint(0, 10**6)}"]
    if rng.random() < 0.67:
        lines += written_heat(rng, scene, length, end)
    return "\n".join(lines) + "\n"


def make_case(seed, number, least_cells, most_cells, most_steps):
    """The text of case `number` of the flood `seed`."""
    rng = random.Random(f"{seed}/{number}")
    while True:
        scene = draw_scene(rng, rng.randint(3, most_steps))
        if least_cells <= estimated_cells(rng, scene) <= most_cells and is_legal(scene):
            return written_case(rng, scene)
