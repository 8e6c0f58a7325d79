"""Random legal cases of a flow. All is drawn in radii, then scaled by a length, a density and a time:

bodies   one to three in a row, spheres and ellipsoids: at rest, on a path, free, liquid with surface tension, or in a velocity
         field that takes them along, turns and strains them
liquids  densities to 1e5 and viscosities to 1e3 times those around; Ohnesorge numbers from 0.01 to 1
flow     Reynolds numbers from 0.01 to 200, Courant numbers about 1; walls, slip, openings, velocities; gravity
layers   on one body in three: outside, inside, both
besides  heat in three of five: sources, latent heat, exchange and radiation; a species in one of three

Bodies stand so far apart that none comes near another or a wall.
"""

import math
import random

from case_maker import direction, log_uniform, numbers

KINDS = ("rest", "path", "free", "liquid", "field")


class Scales:
    """Of a case: length [m], density [kg/m^3] and viscosity of the surroundings and of liquids, tension, speed, times."""

    def __init__(self, rng, kinds, size, steps):
        self.length, self.liquid = 10 ** rng.uniform(-5, 1), 10 ** rng.uniform(-1, 4)
        ohnesorge, reynolds = log_uniform(rng, 0.01, 1), log_uniform(rng, 0.01, 200)
        self.tension = self.liquid * self.length**3 * 10 ** rng.uniform(-2, 5)
        ringing = 2 * math.pi / math.sqrt(8 * self.tension / (self.liquid * self.length**3))  # [s] a period
        if "liquid" in kinds:
            step = ringing * log_uniform(rng, 0.02, 0.3)
            self.speed = min(rng.uniform(0.1, 0.8) * size / step, 5 / ringing) * self.length
            self.density = self.liquid * log_uniform(rng, 1e-5, 2)
            self.liquid_viscosity = ohnesorge * math.sqrt(self.liquid * self.tension * self.length)
            self.viscosity = self.liquid_viscosity * log_uniform(rng, 1e-3, 3)
        else:
            self.speed = 10 ** rng.uniform(-2, 1) * self.length
            step = rng.uniform(0.2, 1.3) * size * self.length / self.speed
            self.density = self.liquid
            self.viscosity = self.density * self.speed * 2 * self.length / reynolds
        self.end = step * steps
        self.way = self.speed * self.end / self.length  # in radii


def shape_lines(rng, radius, centre):
    lines = [f"centre = {numbers(centre)}"]
    if rng.random() < 0.6:
        return lines + ['shape = "sphere"', f"radius = {radius!r}"]
    axes = (radius * rng.uniform(0.85, 1), radius, radius * rng.uniform(0.85, 1))
    return lines + ['shape = "ellipsoid"', f"axes = {numbers(axes)}",
                    f"rotation = {numbers((*direction(rng), rng.uniform(0, 180)))}"]


def strain(rng, centre, scales):
    """Of the velocity at x, y, z: no divergence, a tenth of a radius or so in the run."""
    rate = [rng.uniform(-0.2, 0.2) / scales.end for _ in range(5)]
    x, y, z = (f"({axis} - {at!r})" for axis, at in zip("xyz", centre))
    return (f"{rate[0]!r}*{x} + {rate[2]!r}*{y}", f"{rate[1]!r}*{y} + {rate[3]!r}*{x}",
            f"{-rate[0] - rate[1]!r}*{z} + {rate[4]!r}*{y}")


def motion_lines(rng, kind, centre, scales):
    way = direction(rng)
    if kind == "field":
        parts = (f'"{0.5 * scales.speed * u!r} + {part}"' for u, part in zip(way, strain(rng, centre, scales)))
        return ["[body.motion]", 'kind = "field"', f"velocity = [{', '.join(parts)}]"]
    if kind == "path":
        swing = 0.1 * scales.speed * scales.end
        return ["[body.motion]"] + [f'{axis} = "{scales.speed * u!r}*t + {swing!r}*sin(6*t/{scales.end!r})"'
                                    for axis, u in zip("xyz", way)]
    if kind == "free":
        return (["[body.motion]", 'kind = "free"', f"density = {scales.density * log_uniform(rng, 0.2, 1e3)!r}",
                 f"velocity = {numbers(scales.speed * u for u in way)}"]
                + (['hold = ["turn"]'] if rng.random() < 0.3 else []))
    return ["[body.motion]", 'kind = "flow"'] if kind == "liquid" else []


def layer_lines(rng, size):
    return ["[body.layer]", f"count = {rng.randint(1, 4)}", f"first_height = {size * rng.uniform(0.08, 0.15)!r}",
            f"growth = {rng.uniform(1, 1.4)!r}", f'side = "{rng.choice(("outside", "both", "inside"))}"']


def flow_lines(rng, names, scales):
    lines = ["[flow]"]
    if rng.random() < 0.4:
        lines.append(f"gravity = {numbers((0, 0, -0.3 * scales.speed / scales.end))}")
    lines += ["[flow.region.surroundings]", f"density = {scales.density!r}", f"viscosity = {scales.viscosity!r}"]
    for name, kind in names.items():
        if kind == "liquid":
            velocity = numbers(0.5 * scales.speed * u for u in direction(rng))
            lines += [f"[flow.region.{name}]", f"density = {scales.liquid!r}", f"viscosity = {scales.liquid_viscosity!r}",
                      f"initial = {velocity}", f"[flow.surface.{name}]", f"tension = {scales.tension!r}"]
    faces = {}
    if rng.random() < 0.5:
        faces[rng.choice(("z_min", "x_max", "y_max"))] = "{ pressure = 0 }"
        if rng.random() < 0.5:
            faces["x_min"] = f'{{ velocity = ["{0.3 * scales.speed!r}*(1 + 0.2*sin(9*t/{scales.end!r}))", 0, 0] }}'
    if rng.random() < 0.4:
        faces["y_min"] = '"slip"'
    return lines + (["[flow.face]"] + [f"{face} = {what}" for face, what in faces.items()] if faces else [])


def heat_lines(rng, names, scales):
    spread = scales.length**2 / scales.end  # [m^2/s] what spreads over a radius in the run
    lines = []
    for name in ("surroundings", *names):
        density = scales.density if name == "surroundings" else scales.liquid
        lines += [f"[heat.region.{name}]", f"conductivity = {1000 * density * spread * log_uniform(rng, 1e-4, 1)!r}",
                  f"density = {density!r}", "specific_heat = 1000", f"initial = {rng.choice((300, 1000, 2000.5))}"]
        if name in names and rng.random() < 0.2:
            lines += ["solidus = 900", "liquidus = 1200", "latent_heat = 2e5"]
        if rng.random() < 0.2:
            lines.append(f"source = {1000 * density * rng.uniform(-50, 300) / scales.end!r}")
    for name in names:
        if rng.random() < 0.3:
            exchange = 1000 * scales.density * scales.length / scales.end * rng.random()
            lines += [f"[heat.surface.{name}]", f"emissivity = {rng.random()!r}", "ambient = 400", f"coefficient = {exchange!r}"]
    if rng.random() < 0.5:
        lines += ["[heat.face]", "x_min = { value = 500 }", "z_max = { coefficient = 20, ambient = 300 }"]
    return lines


def species_lines(rng, names, scales):
    spread = scales.length**2 / scales.end
    lines = ["[[species]]", 'name = "solute"']
    for name in ("surroundings", *names):
        if name == "surroundings" or rng.random() < 0.6:
            lines += [f"[species.region.{name}]", f"diffusivity = {spread * log_uniform(rng, 1e-4, 0.1)!r}",
                      f"initial = {rng.choice((0, 1, 0.3))}"]
    return lines


def make_case(seed, number, most_steps):
    """The text of case `number` of the flood `seed`."""
    rng = random.Random(f"flow {seed}/{number}")
    kinds = [rng.choice(KINDS) for _ in range(rng.choice((1, 2, 2, 3)))]
    names = {f"b{i}": kind for i, kind in enumerate(kinds)}
    size, steps = rng.uniform(0.3, 0.45), rng.randint(3, most_steps)
    scales = Scales(rng, kinds, size, steps)
    radii = [rng.uniform(0.6, 1.1) for _ in kinds]
    lines, along = [], 0.0
    for i, (name, kind) in enumerate(names.items()):
        if i > 0:
            along += radii[i - 1] + radii[i] + rng.uniform(0.8, 2) + 2 * scales.way
        centre = (along * scales.length, 0, 0)
        lines += ["", "[[body]]", f'name = "{name}"', *shape_lines(rng, radii[i] * scales.length, centre),
                  *motion_lines(rng, kind, centre, scales)]
        if rng.random() < 0.33:
            lines += layer_lines(rng, size * scales.length)
    room = [1.1 + 1.2 * scales.way + rng.uniform(0.8, 2) for _ in range(6)]
    low, high = [-x for x in room[:3]], [along + room[3], *room[4:]]
    head = ["[domain]", f"min = {numbers(x * scales.length for x in low)}",
            f"max = {numbers(x * scales.length for x in high)}"]
    lines += ["", "[size]", f"surface = {size * scales.length!r}", f"growth = {rng.uniform(0.2, 0.5)!r}",
              f"far = {rng.uniform(1, 2) * scales.length!r}", "", "[time]", f"end = {scales.end!r}", f"steps = {steps}", ""]
    if "free" in kinds and rng.random() < 0.5:
        lines += ["[contact]", f"restitution = {rng.choice((0, 0.5, 0.9))}", ""]
    lines += flow_lines(rng, names, scales)
    if rng.random() < 0.6:
        lines += heat_lines(rng, names, scales)
    if rng.random() < 0.33:
        lines += species_lines(rng, names, scales)
    lines += ["", "[output]", "every = 2", "", "[random]", f"seed = {rng.randint(0, 10**6)}"]
    return "\n".join(head + lines) + "\n"
