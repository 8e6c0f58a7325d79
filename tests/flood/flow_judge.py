"""Judges what a run of a flow left: each frame as a mesh by mesh_checks.py, and what steps.csv says of bodies and balances."""

import math
import tomllib

import mesh_checks
from case_file import scene_of
from geometry import minus, norm
from judge import TRANSFER_ERROR, Verdict, check_series, frames_of, read_frame, rows_of

CONSERVED = 1e-12  # [-] of a region's mass, and of the energy or what of it passes faces, in a step
ON_ITS_WAY = 1e-9  # [-] of the box: where a body that goes by a path is
FOLLOWED = 1e-7  # [-] of a volume that a field takes along, by the method of Runge and Kutta; 2.3e-8 in forty cases
ROUNDER = 1e-3  # [-] a polyhedron may have less surface than a ball of its volume by this


class FlowCase:
    """scene: with bodies where they are at the start, or on their paths; kinds: of their motions; densities [kg/m^3] of
    what flows, by its name."""

    def __init__(self, path):
        with open(path, "rb") as file:
            case = tomllib.load(file)
        self.scene = scene_of(case)
        self.every = case["output"]["every"]
        self.floor = case.get("quality", {}).get("max_aspect_ratio", 10.0)
        self.kinds = {body["name"]: body.get("motion", {}).get("kind", "path") for body in case["body"]}
        self.densities = {name: region["density"] for name, region in case["flow"]["region"].items()}


def check_frames(case, frames, verdict):
    volumes = {}
    for _, path in frames:
        frame = read_frame(path, verdict)
        if frame is None:
            continue
        figures = mesh_checks.look_at_cells(frame, case.scene)
        verdict.faults += [f"{path.name}: {fault}" for fault in figures.faults[:5]]
        if figures.worst_ratio > case.floor * (1 + 1e-9):
            verdict.faults.append(f"{path.name}: worst R/r {figures.worst_ratio}, above {case.floor}")
        volumes = volumes or figures.volumes
        for number, body in enumerate(case.scene.bodies, 1):
            drift = abs(figures.volumes.get(number, math.nan) / volumes.get(number, math.nan) - 1)
            told = case.kinds[body.name] == "field"
            if not told:
                verdict.volume_drift = max(verdict.volume_drift, drift)
            if not drift <= (FOLLOWED if told else mesh_checks.rounding(case.scene)):
                verdict.faults.append(f"{path.name}: the volume of {body.name} is off by {drift}")
        verdict.worst_ratio = max(verdict.worst_ratio, figures.worst_ratio)
        verdict.least_dihedral = min(verdict.least_dihedral, math.degrees(figures.least_dihedral))
        verdict.cells = max(verdict.cells, len(frame.region))
    return volumes


def check_bodies(case, first, row, verdict):
    """Those on paths have gone with them since the first step; liquid ones have no less surface than balls."""
    span = max(high - low for low, high in zip(case.scene.low, case.scene.high))
    for body in case.scene.bodies:
        if case.kinds[body.name] == "path":
            begun, told = (tuple(float(at[f"{axis}_{body.name} [m]"]) for axis in "xyz") for at in (first, row))
            begins, ends = (body.displacement(float(at["time [s]"])) for at in (first, row))
            off = norm(minus(minus(told, begun), minus(ends, begins)))
            if off > ON_ITS_WAY * span:
                verdict.faults.append(f"step {row['step']}: {body.name} is {off} m off its path")
        if case.kinds[body.name] == "flow":
            volume, area = (float(row[f"{what}_{body.name} [{unit}]"]) for what, unit in (("volume", "m^3"), ("area", "m^2")))
            if area < (36 * math.pi * volume**2) ** (1 / 3) * (1 - ROUNDER):
                verdict.faults.append(f"step {row['step']}: {body.name} has an area of {area}, less than a ball")


def check_balances(case, rows, volumes, verdict):
    masses = {name: density * volumes.get(number, math.nan)
              for number, name in enumerate(["surroundings", *case.kinds])
              for density in [case.densities.get(name)] if density is not None}
    for row in rows:
        verdict.attempts = max(verdict.attempts, int(row["attempts"]))
        verdict.faults += [f"step {row['step']}: {name} is {value}" for name, value in row.items()
                           if not math.isfinite(float(value))]
        errors = [abs(float(value)) for name, value in row.items() if name.endswith("_transfer_error")]
        verdict.transfer_error = max([verdict.transfer_error, *errors])
        for name, mass in masses.items():
            off = abs(float(row[f"mass_error_{name} [kg]"])) / mass
            verdict.mass_drift = max(verdict.mass_drift, off)
        if "energy_error [J]" in row:
            passed = float(row["dt [s]"]) * sum(abs(float(value)) for name, value in row.items() if name.startswith("heat_out_"))
            off = abs(float(row["energy_error [J]"])) / max(abs(float(row["energy_integral [J]"])), passed)
            verdict.energy_drift = max(verdict.energy_drift, off)
        check_bodies(case, rows[0], row, verdict)
    for what, drift, most in (("transfers", verdict.transfer_error, TRANSFER_ERROR), ("masses", verdict.mass_drift, CONSERVED),
                              ("the energy", verdict.energy_drift, CONSERVED)):
        if not drift <= most:
            verdict.faults.append(f"{what}: off by {drift}")


def judge(case, folder, code, errors):
    """The verdict on a run that ended with `code` and these lines on stderr."""
    verdict = Verdict("done", said=errors)
    lines = [line for line in errors.splitlines() if not line.startswith("kropla: warning: ")]
    if code == 3 and len(lines) == 1 and lines[0].startswith("kropla: "):
        verdict.outcome = "refused: floor"
    elif code != 0 or lines:
        verdict.faults.append(f"ended with code {code}: {' | '.join(lines[-3:])[:500]}")
    if code in (0, 3):
        rows, frames = rows_of(folder), frames_of(folder)
        if code == 0:
            check_series(case, rows, frames, verdict)
        check_balances(case, rows, check_frames(case, frames, verdict), verdict)
        if not (folder / "report.html").is_file():
            verdict.faults.append("there is no report.html")
    if verdict.faults:
        verdict.outcome = "failed"
    return verdict
