"""The cases of cases/ in a short form: coarser, a few steps, from the time on when what they are about happens.
Frames are verified by tests/flood; the figures of the whole must be within a tenth of what was reached.

    cases_test.py KROPLA [CASE ...]
"""

import pathlib
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "flood"))
import judge
from case_file import Case

CASES = pathlib.Path(__file__).resolve().parent.parent / "cases"


@dataclass
class Short:
    """From `start` [s] for `steps` of the case's own; bounds: a tenth beyond what was reached."""

    start: float
    steps: int
    worst_ratio: float
    least_dihedral: float  # [degrees]
    surface: float = 4e-4  # [m]
    halvings: int = 0  # of steps, where bodies are too near to each other for a whole one


SHORT = {
    "droplet": Short(0.0, 5, 5.5, 21.6),
    "droplet_layer": Short(0.0, 5, 5.5, 22.2),
    "near_miss": Short(0.004, 5, 5.85, 20.8, 3.3e-4, halvings=4),
    "near_wall": Short(0.0038, 6, 5.5, 21.9),
    "quick": Short(0.0, 5, 5.5, 22.4),
    "tumbling": Short(0.0, 5, 5.5, 22.0, 3.4e-4),
    "two_droplets": Short(0.004, 5, 5.5, 22.2),
}
@dataclass
class ShortRun:
    """A case with a flow, or with bodies that tests/flood does not know, coarser and shorter. Columns of the last step are
    within bounds: of the drag in the cube, what is
    known, give or take a tenth more than it is off; else what was reached, give or take little."""

    settings: list
    bounds: dict  # column: (least, most)


RUNS = {
    "stokes_cube": ShortRun(["size.surface=2.5e-3", "size.far=0.012", "time.steps=1", "time.end=0.02"],
                             {"force_z_sphere [N]": (-0.0030647, -0.0029735)}),
    "sphere_re100": ShortRun(["size.surface=0.15", "size.growth=0.3", "size.far=3", "time.steps=6", "time.end=6"],
                              {"force_x_sphere [N]": (0.477, 0.482)}),
    "settling": ShortRun(["size.surface=2.5e-3", "size.growth=0.3", "size.far=0.02", "time.steps=3", "time.end=0.06"],
                          {"w_sphere [m/s]": (-0.0284, -0.0280), "flow_rounds": (1, 5)}),
    # The upper one is about to touch the other.
    "two_settling": ShortRun(["body.upper.centre=[0.0006, 0, 0.0668]", "body.upper.motion.velocity=[0, 0, -0.05]",
                               "size.surface=1.4e-3", "size.growth=0.4", "size.far=0.01", "time.steps=1", "time.end=0.01"],
                              {"contacts": (1, 1), "gap_upper [m]": (5.53e-4, 5.54e-4)}),
    "wheel": ShortRun(["size.surface=1.5e-4", "time.steps=4", "time.end=2e-3"], {"max_aspect_ratio": (3, 8.3)}),
    "arc_flight": ShortRun(["size.surface=2.2e-4", "size.growth=0.3", "size.far=1.5e-3", "time.steps=3", "time.end=3e-4"],
                            {"w_droplet [m/s]": (-0.437, -0.433), "temperature_mean_droplet [K]": (2402.3, 2402.8),
                             "temperature_max_droplet [K]": (2415, 2418)}),
    "vortex": ShortRun(["size.surface=0.05", "size.growth=0.3", "parameters.period=0.6", "time.end=0.6", "time.steps=20"],
                       {"max_aspect_ratio": (4.8, 5.5), "min_dihedral [deg]": (20, 40),
                        "volume_drop [m^3]": (0.014136, 0.014139), "area_drop [m^2]": (0.2827, 0.286)}),
    "pool": ShortRun(["size.surface=4e-4", "size.growth=0.3", "size.far=1e-3", "time.steps=5", "time.end=1e-3"],
                     {"max_aspect_ratio": (4.8, 5.5), "min_dihedral [deg]": (22, 40),
                      "volume_pool [m^3]": (1.2799997e-7, 1.2800003e-7), "volume_wire [m^3]": (1.659e-9, 1.665e-9),
                      "temperature_mean_wire [K]": (716.8, 717.3), "energy_error [J]": (-1.4e-9, 1.4e-9)}),
    "breathing": ShortRun(["size.surface=8e-4", "size.far=1.5e-3", "time.steps=10", "time.end=0.5"],
                          {"max_aspect_ratio": (4.8, 5.5), "min_dihedral [deg]": (20, 40),
                           "volume_bubble [m^3]": (6.0318e-8, 6.0319e-8)}),
}
# Drops: their volumes to rounding; for the marangoni drop what is known is 0.0229 m/s.
RUNS |= {
    "static_drop": ShortRun(["size.surface=0.35", "size.far=1.5", "time.steps=5", "time.end=5"],
                            {"max_aspect_ratio": (4.8, 5.5), "u_drop [m/s]": (-5e-4, 5e-4),
                             "volume_drop [m^3]": (4.188790204786 - 2e-12, 4.188790204786 + 2e-12)}),
    "oscillating_drop": ShortRun(["size.surface=0.3", "size.far=2", "time.steps=12", "time.end=1.2"],
                                 {"max_aspect_ratio": (4.8, 5.5), "area_drop [m^2]": (12.6193, 12.6203),
                                  "volume_drop [m^3]": (4.188773575289 - 2e-12, 4.188773575289 + 2e-12)}),
    "rising_drop": ShortRun(["size.surface=0.08", "size.growth=0.2", "size.far=0.2", "time.steps=8", "time.end=0.4"],
                            {"max_aspect_ratio": (4.8, 5.5), "w_drop [m/s]": (0.278, 0.282),
                             "momentum_error_z [kg m/s]": (-5.8e-4, 5.8e-4),
                             "volume_drop [m^3]": (0.06544984694979 - 2e-14, 0.06544984694979 + 2e-14)}),
    "sessile": ShortRun(["size.surface=0.35", "size.far=1.5", "time.steps=10", "time.end=1"],
                        {"max_aspect_ratio": (4.8, 5.5), "wetted_drop [m^2]": (5.07, 5.11),
                         "volume_drop [m^3]": (2.003392315414 - 2e-12, 2.003392315414 + 2e-12)}),
    "marangoni_drop": ShortRun(["size.surface=0.35", "size.far=2", "time.steps=5", "time.end=0.5"],
                               {"max_aspect_ratio": (4.8, 5.5), "w_drop [m/s]": (0.0229, 0.0245),
                                "energy_error [J]": (-1e-11, 1e-11)}),
    "droplet_and_pool": ShortRun(["size.surface=2.6e-4", "size.far=8e-4", "time.steps=6", "time.end=3e-4"],
                                 {"max_aspect_ratio": (4.8, 5.5), "w_droplet [m/s]": (-0.603, -0.602),
                                  "volume_pool [m^3]": (1.6e-8 - 1e-20, 1.6e-8 + 1e-20),
                                  "temperature_mean_droplet [K]": (2400.09, 2400.1), "energy_error [J]": (-4e-12, 4e-12)}),
    "falling_steel": ShortRun(["size.surface=1.7e-4", "size.far=1.2e-3", "time.steps=6", "time.end=3e-4"],
                              {"max_aspect_ratio": (4.8, 5.5), "w_droplet [m/s]": (-0.5035, -0.502),
                               "temperature_mean_droplet [K]": (2299.7, 2299.8), "energy_error [J]": (-1e-12, 1e-12)}),
}
# In meshes that are brought, likewise: where the body is, its volume as it was read, how good the mesh is.
RUNS |= {
    "shifting_ball": ShortRun(["time.end=0.1", "time.steps=4"],
                               {"max_aspect_ratio": (5, 6.8), "x_ball [m]": (0.1469463, 0.1469464),
                                "volume_ball [m^3]": (0.249992696073, 0.249992696074), "energy_error [J]": (-1e-9, 1e-9)}),
    "turning_cube": ShortRun(["time.end=0.25", "time.steps=5"],
                              {"max_aspect_ratio": (4, 5.7), "z_rotor [m]": (1.875 - 1e-12, 1.875 + 1e-12),
                               "volume_rotor [m^3]": (0.125 - 1e-13, 0.125 + 1e-13), "energy_error [J]": (-1e-9, 1e-9),
                               "temperature_mean_rotor [K]": (382, 383)}),
}
RUNS["gear"] = ShortRun(["time.end=0.001", "time.steps=2"],
                        {"max_aspect_ratio": (5, 7.6), "volume_wheel [m^3]": (8.1072062482888e-10, 8.1072062482890e-10),
                         "energy_error [J]": (-1e-12, 1e-12), "temperature_mean_wheel [K]": (396, 398)})
CONSERVED = 1e-12  # [-] energy and volumes over the whole run, and each transfer: rounding


def shortened(text, short):
    """The text of the case that begins at `short.start`, and its number of steps."""
    end, steps = (float(re.search(rf"^{key}\s*=\s*(\S+)", text, re.M)[1]) for key in ("end", "steps"))

    def later(match):
        return re.sub(r"\bt\b", f"(t + {short.start!r})", match[0])

    text = re.sub(r'^(x|y|z|angle)\s*=\s*".*?"', later, text, flags=re.M)
    for key, value in {"end": end / steps * short.steps, "steps": short.steps, "surface": short.surface,
                       "far": max(8e-4, 3 * short.surface)}.items():
        text = re.sub(rf"^{key}\s*=\s*\S+", f"{key} = {value!r}", text, count=1, flags=re.M)
    return text + ("" if "[output]" in text else f"\n[output]\nevery = {short.steps}\n")


def verdict_on(program, name):
    with tempfile.TemporaryDirectory() as folder:
        file, out = pathlib.Path(folder) / "case.toml", pathlib.Path(folder) / "out"
        file.write_text(shortened((CASES / f"{name}.toml").read_text(encoding="utf-8"), SHORT[name]), encoding="utf-8")
        done = subprocess.run([program, "run", file, "--out", out], capture_output=True, text=True, check=False)
        return judge.judge(Case(file), out, done.returncode, done.stderr), judge.rows_of(out)


def faults_of(name, verdict, rows):
    short = SHORT[name]
    worst = max([verdict.worst_ratio] + [float(row["max_aspect_ratio"]) for row in rows])
    angle = min([verdict.least_dihedral] + [float(row["min_dihedral [deg]"]) for row in rows])
    print(f"{name}: {verdict.cells} cells, worst R/r {worst:.3f}, least dihedral {angle:.2f} degrees, transfer error "
          f"{verdict.transfer_error:.1e}, energy {verdict.energy_drift:.1e}, volumes {verdict.volume_drift:.1e}")
    faults = list(verdict.faults)
    if not short.steps <= len(rows) <= short.steps + short.halvings:
        faults.append(f"{len(rows)} steps instead of {short.steps} to {short.steps + short.halvings}")
    bounded = (("worst R/r", worst, short.worst_ratio), ("energy", verdict.energy_drift, CONSERVED),
               ("transfer error", verdict.transfer_error, CONSERVED), ("volumes", verdict.volume_drift, CONSERVED),
               ("angle below the bound", short.least_dihedral - angle, 0))
    for what, value, bound in bounded:
        if not value <= bound:
            faults.append(f"{what}: {value}, above {bound}")
    return faults


def faults_of_run(program, name):
    short = RUNS[name]
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        sets = [word for setting in short.settings for word in ("--set", setting)]
        done = subprocess.run([program, "run", CASES / f"{name}.toml", "--out", out, *sets], capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            return [f"exit code {done.returncode}: {done.stderr.strip()}"]
        last = judge.rows_of(out)[-1]
        checked = subprocess.run([program, "check", out], capture_output=True, text=True, check=False)
    found = {column: float(last[column]) for column in short.bounds}
    print(f"{name}: {last['tets']} tets, {found}")
    faults = [] if checked.returncode == 0 else [checked.stdout.strip()]
    for column, (least, most) in short.bounds.items():
        if not least <= found[column] <= most:
            faults.append(f"{column}: {found[column]}, not from {least} to {most}")
    return faults


def main():
    program, names = sys.argv[1], sys.argv[2:] or [*SHORT, *RUNS]
    missing = {path.stem for path in CASES.glob("*.toml")} ^ {*SHORT, *RUNS}
    faults = [f"{name}: not both a case and a short form" for name in missing]
    for name in names:
        found = faults_of_run(program, name) if name in RUNS else faults_of(name, *verdict_on(program, name))
        faults += [f"{name}: {fault}" for fault in found]
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
