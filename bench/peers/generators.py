"""The other mesh generators, driven as programs: each meshes box and sphere of one frame anew.

A generator is a function (frame, scale, folder, tools) -> Meshed. `scale` multiplies the target size everywhere.
Seconds are those that the program itself reports for meshing, of the processor; what it takes to start, to read and to
write files is left out.
"""

import dataclasses
import pathlib
import re
import shutil
import subprocess


@dataclasses.dataclass
class Frame:
    file: pathlib.Path   # of ours, at the same time
    centre: tuple        # of the sphere [m]
    radius: float
    box: tuple           # (min, max) [m]
    surface: float       # target size at the sphere [m]
    growth: float        # its rise per metre of distance
    far: float           # its limit [m]


@dataclasses.dataclass
class Meshed:
    file: pathlib.Path
    seconds: float         # of the processor, for all of the mesh
    volume_seconds: float  # of it, for the tets, the surfaces being there


GMSH_SCRIPT = """SetFactory("OpenCASCADE");
Box(1) = {{{box_corner}, {box_extent}}};
Sphere(2) = {{{centre}, {radius!r}}};
BooleanFragments{{ Volume{{1}}; Delete; }}{{ Volume{{2}}; Delete; }}
// min(far, surface + growth * distance from the sphere): outside, then inside.
Field[1] = Ball;
Field[1].VIn = {surface!r}; Field[1].VOut = {far!r}; Field[1].Radius = {radius!r}; Field[1].Thickness = {rise!r};
Field[2] = Ball;
Field[2].VIn = {core!r}; Field[2].VOut = {surface!r}; Field[2].Radius = 0; Field[2].Thickness = {radius!r};
For i In {{1:2}}
  Field[i].XCenter = {x!r}; Field[i].YCenter = {y!r}; Field[i].ZCenter = {z!r};
EndFor
Field[3] = Max;
Field[3].FieldsList = {{1, 2}};
Background Field = 3;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MshFileVersion = 2.2;
Mesh.SaveAll = 1;
"""


def numbers(values):
    return ", ".join(repr(v) for v in values)


def write_gmsh_script(frame, file):
    low, high = frame.box
    x, y, z = frame.centre
    file.write_text(GMSH_SCRIPT.format(
        box_corner=numbers(low), box_extent=numbers([b - a for a, b in zip(low, high)]),
        centre=numbers(frame.centre), radius=frame.radius, surface=frame.surface, far=frame.far,
        rise=(frame.far - frame.surface) / frame.growth,
        core=min(frame.far, frame.surface + frame.growth * frame.radius), x=x, y=y, z=z))


def gmsh(algorithm):
    def mesh(frame, scale, folder, _tools):
        script, out = folder / "gmsh.geo", folder / "gmsh.msh"
        write_gmsh_script(frame, script)
        done = subprocess.run(["gmsh", script, "-3", "-algo", algorithm, "-nt", "1", "-clscale", repr(scale),
                               "-o", out], capture_output=True, text=True, check=True)
        log = done.stdout + done.stderr
        seconds = {"1D": 0.0, "2D": 0.0, "3D": 0.0, "optimizing": 0.0}
        for what, cpu in re.findall(r"Done (?:meshing )?(1D|2D|3D|optimizing)[^(]*\(Wall [^,]*, CPU ([\d.e+-]+)s\)", log):
            seconds[what] += float(cpu)
        if not seconds["3D"]:
            raise RuntimeError("Gmsh does not tell its seconds:\n" + log)
        return Meshed(out, sum(seconds.values()), seconds["3D"] + seconds["optimizing"])
    return mesh


def tetgen(frame, scale, folder, tools):
    base = folder / "tetgen"
    size = [frame.radius] + [scale * s for s in (frame.surface, frame.growth, frame.far)]
    subprocess.run([tools / "peers_surfaces", frame.file, base, *map(repr, frame.centre), *map(repr, size)], check=True)
    done = subprocess.run(["tetgen", "-pq1.2/14mYAO9/7", base.with_suffix(".smesh")], capture_output=True, text=True,
                          check=True)
    seconds = {what: float(s) for what, s in re.findall(r"^(.*) seconds:\s+([\d.e+-]+)", done.stdout, re.MULTILINE)}
    taken = seconds["Total running"] - seconds["Output"] - seconds["Background mesh reconstruct"]
    return Meshed(folder / "tetgen.1.ele", taken, taken)


@dataclasses.dataclass
class Peer:
    name: str
    program: str
    package: str         # of Debian, that has it
    mesh: callable
    same_count: bool     # the target size is scaled so that there are as many tets as ours


PEERS = [
    Peer("Gmsh HXT, target size", "gmsh", "gmsh", gmsh("hxt"), False),
    Peer("Gmsh HXT, as many tets", "gmsh", "gmsh", gmsh("hxt"), True),
    Peer("Gmsh Delaunay, as many tets", "gmsh", "gmsh", gmsh("del3d"), True),
    Peer("TetGen, as many tets", "tetgen", "tetgen", tetgen, True),
]


def installed(peer):
    return shutil.which(peer.program) is not None
