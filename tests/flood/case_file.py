"""Reads a case file: its geometry as a Scene, and what of its heat the balances need. Formulas are evaluated
as Python's after `^` is made `**`; those that are more (`a ? b : c`) are beyond the flood."""

import math
import tomllib

from geometry import Body, Ellipsoid, IDENTITY, Layer, Scene, rotation_about

NAMES = {name: getattr(math, name) for name in ("sin", "cos", "exp", "sqrt", "pi")}
NAMES |= {"abs": abs, "min": min, "max": max}


def formula(written):
    if not isinstance(written, str):
        return lambda t: float(written)
    code = compile(written.replace("^", "**"), "<formula>", "eval")
    return lambda t: float(eval(code, {"__builtins__": {}}, NAMES | {"t": t}))


def body_of(table):
    axes = (table["radius"],) * 3 if table["shape"] == "sphere" else tuple(table["axes"])
    rotation = IDENTITY
    if "rotation" in table:
        x, y, z, degrees = table["rotation"]
        rotation = rotation_about((x, y, z), math.radians(degrees))
    body = Body(table["name"], Ellipsoid(tuple(table["centre"]), axes, rotation))
    motion = table.get("motion", {})
    parts = [formula(motion.get(axis, 0)) for axis in "xyz"]
    body.displacement = lambda t: tuple(part(t) for part in parts)
    if "angle" in motion:
        angle, axis = formula(motion["angle"]), [formula(part) for part in motion["axis"]]
        body.turn = lambda t: rotation_about(tuple(part(t) for part in axis), math.radians(angle(t)))
    if "layer" in table:
        body.layer = Layer(**table["layer"])
    return body


def scene_of(case):
    size, time = case["size"], case["time"]
    scene = Scene(tuple(case["domain"]["min"]), tuple(case["domain"]["max"]), size["surface"], size.get("growth", 0.1),
                  size["far"], time["end"], time["steps"])
    scene.bodies = [body_of(table) for table in case.get("body", [])]
    return scene


class Case:
    """scene; floor of R/r; heat_capacity per region [J/(m^3 K)], or None; supply_known: whether the heat set
    free and let in is known without the solution, which `supply` tells then."""

    def __init__(self, path):
        with open(path, "rb") as file:
            case = tomllib.load(file)
        self.scene = scene_of(case)
        self.every = case.get("output", {}).get("every", 1)
        self.floor = case.get("quality", {}).get("max_aspect_ratio", 10.0)
        self.heat_capacity, self.sources, self.fluxes, self.supply_known = None, {}, 0.0, False
        self.temperatures = None  # (least, most) [K] that there may be, where that is known
        if "heat" not in case:
            return
        names = ["surroundings"] + [body.name for body in self.scene.bodies]
        regions = [case["heat"]["region"][name] for name in names]
        self.heat_capacity = [region["density"] * region["specific_heat"] for region in regions]
        faces = case["heat"].get("face", {})
        self.read_supply(regions, faces)
        self.read_bounds(regions, faces)

    def read_bounds(self, regions, faces):
        """The temperatures that conduction and convection allow, unless something heats or cools, or is a formula."""
        values = [face.get("value") for face in faces.values() if face != "insulated"]
        if any("source" in region for region in regions) or not all(isinstance(v, (int, float)) for v in values):
            return
        values += [region["initial"] for region in regions]
        self.temperatures = min(values), max(values)

    def read_supply(self, regions, faces):
        written = {number: region["source"] for number, region in enumerate(regions) if "source" in region}
        known = [isinstance(value, (int, float)) for value in written.values()]
        span = [h - l for h, l in zip(self.scene.high, self.scene.low)]
        for name, face in faces.items():
            if face == "insulated":
                continue
            known.append(isinstance(face.get("flux"), (int, float)))
            if known[-1]:
                axis = "xyz".index(name[0])
                self.fluxes += face["flux"] * span[axis - 1] * span[axis - 2]
        self.supply_known = all(known)
        self.sources = written if self.supply_known else {}

    def supply(self, volumes):
        """The heat that comes in per time [W], with the volumes of the regions."""
        return self.fluxes + sum(value * volumes[region] for region, value in self.sources.items())
