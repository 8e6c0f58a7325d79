"""Judges what a run left: each frame by mesh_checks.py, steps.csv and frames.pvd against it, refusals by geometry."""

import csv
import math
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field

import mesh_checks
import vtu
from geometry import gap, least_gaps

LEAST_JACOBIAN = 0.1  # [-] scaled, of a prism's corners: the floor of prisms
LEAST_GAP = 0.25  # [surface sizes] that bodies' triangulated surfaces must keep
TRANSFER_ERROR = 1e-12  # [-]
CONSERVED = 1e-10  # [-] of an insulated box's energy
BEYOND = 1e-10  # [-] of the range of temperatures
ROUNDING = 1e-14  # [-] of the largest
SUPPLIED = 1e-8  # [-] of the energy, where heat comes in


@dataclass
class Verdict:
    """`outcome`: "done", "refused: why" or "failed"; faults say what is wrong."""

    outcome: str
    faults: list = field(default_factory=list)
    said: str = ""  # on stderr
    worst_ratio: float = 0.0
    least_dihedral: float = 180.0  # [degrees]
    cells: int = 0
    transfer_error: float = 0.0
    energy_drift: float = 0.0
    volume_drift: float = 0.0
    mass_drift: float = 0.0  # of what flows
    attempts: int = 0


def rows_of(folder):
    with open(folder / "steps.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def frames_of(folder):
    """[(time, file)] as the series lists them."""
    series = ElementTree.parse(folder / "frames.pvd").getroot().iter("DataSet")
    return [(float(item.get("timestep")), folder / item.get("file")) for item in series]


def check_series(case, rows, frames, verdict):
    """Steps and frames tell of the same times, and all of the way."""
    times = [0.0] + [float(row["time [s]"]) for row in rows]
    total = math.fsum(float(row["dt [s]"]) for row in rows)
    if abs(total - case.scene.end) > 1e-9 * case.scene.end or abs(times[-1] - case.scene.end) > 1e-9 * case.scene.end:
        verdict.faults.append(f"the steps sum to {total} s and end at {times[-1]} s, not {case.scene.end}")
    shown = [times[i] for i in range(len(times)) if i % case.every == 0 or i == len(times) - 1]
    if len(frames) != len(shown) or any(abs(t - s) > 1e-12 * case.scene.end for (t, _), s in zip(frames, shown)):
        verdict.faults.append(f"frames.pvd has the times {[t for t, _ in frames]}, the steps {shown}")


def read_frame(path, verdict):
    """The frame; None, with a fault, if the file is not one."""
    try:
        return vtu.Frame(path)
    except (vtu.Damaged, OSError) as error:
        verdict.faults.append(f"{path.name}: {error}")
        return None


def check_frames(case, rows, frames, verdict):
    first = None
    for t, path in frames:
        frame = read_frame(path, verdict)
        if frame is None:
            continue
        figures = mesh_checks.look_at(frame, case.scene, t)
        verdict.faults += [f"{path.name}: {fault}" for fault in figures.faults[:5]]
        if figures.worst_ratio > case.floor * (1 + 1e-9):
            verdict.faults.append(f"{path.name}: worst R/r {figures.worst_ratio}, above {case.floor}")
        if figures.least_jacobian < LEAST_JACOBIAN * (1 - 1e-9):
            verdict.faults.append(f"{path.name}: a prism's scaled Jacobian is {figures.least_jacobian}")
        if case.temperatures:
            check_bounds(case.temperatures, path.name, frame.temperature, verdict)
        first = first or figures
        for region, volume in figures.volumes.items():
            drift = abs(volume / first.volumes.get(region, math.nan) - 1)
            verdict.volume_drift = max(verdict.volume_drift, drift)
            if not drift <= mesh_checks.rounding(case.scene):
                verdict.faults.append(f"{path.name}: the volume of region {region} is off by {drift}")
        verdict.worst_ratio = max(verdict.worst_ratio, figures.worst_ratio)
        verdict.least_dihedral = min(verdict.least_dihedral, math.degrees(figures.least_dihedral))
        verdict.cells = max(verdict.cells, len(frame.region))
        row = next((row for row in rows if float(row["time [s]"]) == t), None)
        if row:
            check_row(case, row, frame, figures, verdict)
    return first


def check_bounds(bounds, name, temperature, verdict):
    """No temperature is beyond those that there were and that hold at faces."""
    least, most = bounds
    room = BEYOND * (most - least) + ROUNDING * max(abs(least), abs(most))
    if min(temperature) < least - room or max(temperature) > most + room:
        verdict.faults.append(f"{name}: temperatures {min(temperature)} to {max(temperature)} K, of {least} to {most} K allowed")


def check_row(case, row, frame, figures, verdict):
    """What steps.csv says of the mesh and the energy is what the frame shows."""
    if (int(row["tets"]), int(row["prisms"])) != (len(frame.tets), len(frame.prisms)):
        verdict.faults.append(f"step {row['step']}: its counts of cells are not those of its frame")
    if abs(float(row["max_aspect_ratio"]) / figures.worst_ratio - 1) > 1e-6:
        told = row["max_aspect_ratio"]
        verdict.faults.append(f"step {row['step']}: max_aspect_ratio {told}, not {figures.worst_ratio}")
    if case.heat_capacity:
        parts = [case.heat_capacity[region] * integral for region, integral in figures.integrals.items()]
        energy, size = math.fsum(parts), math.fsum(map(abs, parts))
        if abs(float(row["energy_integral [J]"]) - energy) > CONSERVED * size:
            verdict.faults.append(f"step {row['step']}: energy {row['energy_integral [J]']} J, the frame has {energy}")


def check_balances(case, rows, first, verdict):
    for row in rows:
        verdict.attempts = max(verdict.attempts, int(row["attempts"]))
        for name, value in row.items():
            if not math.isfinite(float(value)):
                verdict.faults.append(f"step {row['step']}: {name} is {value}")
            if name.endswith("_transfer_error"):
                verdict.transfer_error = max(verdict.transfer_error, abs(float(value)))
    if verdict.transfer_error > TRANSFER_ERROR:
        verdict.faults.append(f"a transfer error of {verdict.transfer_error}")
    if not (case.heat_capacity and case.supply_known and first):
        return
    energy = [float(row["energy_integral [J]"]) for row in rows]
    start = math.fsum(case.heat_capacity[region] * heat for region, heat in first.integrals.items())
    supply = case.supply(first.volumes)
    for row, now in zip(rows, energy):
        off = abs(now - start - supply * float(row["time [s]"])) / max(map(abs, energy + [start]))
        verdict.energy_drift = max(verdict.energy_drift, off)
    if verdict.energy_drift > (SUPPLIED if supply else CONSERVED):
        verdict.faults.append(f"the energy is off its balance by {verdict.energy_drift}")


def judge_frames(case, folder, verdict, finished):
    """Everything that lies in the folder; `finished`: the run came to its end."""
    rows, frames = rows_of(folder), frames_of(folder)
    if finished:
        check_series(case, rows, frames, verdict)
    first = check_frames(case, rows, frames, verdict)
    check_balances(case, rows, first, verdict)
    if not (folder / "report.html").is_file():
        verdict.faults.append("there is no report.html")


def told_gap_is_true(scene, said):
    """Whether the gap that a refusal in mid-run tells, if it tells one, is that of these bodies at that time."""
    when = re.search(r"t = ([-+.\de]+) (s|ms|us|ns)\b", said)
    what = re.search(r'body "([^"]+)"(?: and body "([^"]+)")? (?:is|are) ([-+.\de]+) m (?:apart|from)', said)
    if not (when and what):
        return True
    t = float(when[1]) * {"s": 1, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[when[2]]
    shapes = [body.at(t) for body in scene.bodies if body.name in (what[1], what[2])]
    found = gap(*shapes) if len(shapes) == 2 else scene.wall_gap(shapes[0])
    return abs(found - float(what[3])) <= 0.01 * found + 0.01 * scene.surface


def reason_of(case, said):
    """(the kind of a refusal, whether it is true by the flood's own geometry)."""
    scene = case.scene
    if re.search(r"jump|leap|turns it by|can follow|origin", said):
        return "leap", False  # the flood's bodies go two sizes in a step at most
    if "curved" in said:
        return "curvature", any(scene.surface_size(b) > b.shape.curvature_radius() * 0.999 for b in scene.bodies)
    if re.search(r"\btets\b", said):
        return "count", False  # the flood's cases have some thousands
    wall, pair = least_gaps(scene, looks_per_step=32)
    if re.search(r"out of the box|not inside the box", said):
        return "outside", wall[0] < 0
    if "layer" in said:
        return "layer", any(too_thick(scene, body, min(wall[0], pair[0])) for body in scene.bodies if body.layer)
    if re.search(r"apart|overlap|into each other|from the wall|touches|gap|comes? within|too close", said):
        to_wall, between = scene.needed_gaps(LEAST_GAP)
        return "gap", wall[0] < to_wall or pair[0] < between
    if re.search(r"\bfar\b|thin", said):
        return "thin box", min(h - l for h, l in zip(scene.high, scene.low)) < scene.far
    return "other", False


def too_thick(scene, body, gap):
    thick = body.layer.thickness()
    others = max((b.layer.thickness() for b in scene.bodies if b.layer and b is not body), default=0.0)
    inside = body.layer.side != "outside" and thick > body.shape.curvature_radius()
    return inside or gap < body.layer.least_gap() or thick + others > gap


def judge(case, folder, code, errors):
    """The verdict on a run that ended with `code` and these lines on stderr."""
    verdict = Verdict("done", said=errors)
    lines = [line for line in errors.splitlines() if not line.startswith("kropla: warning: ")]
    if code == 0:
        verdict.faults += [f"said on stderr: {line}" for line in lines if not line.startswith("kropla: ")]
    elif code in (2, 3) and len(lines) == 1 and lines[0].startswith("kropla: "):
        is_floor = code == 3
        kind, is_true = ("floor", told_gap_is_true(case.scene, lines[0])) if is_floor else reason_of(case, lines[0])
        verdict.outcome = f"refused: {kind}"
        if not is_true:
            verdict.faults.append(f"refused without reason ({kind}): {lines[0]}")
    else:
        verdict.faults.append(f"ended with code {code}: {' | '.join(lines[-3:])[:500]}")
    if code in (0, 3) and (folder / "frames.pvd").is_file():
        judge_frames(case, folder, verdict, finished=code == 0)
    elif code == 0:
        verdict.faults.append("there are no frames")
    if verdict.faults:
        verdict.outcome = "failed"
    return verdict
