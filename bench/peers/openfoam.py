"""Flow around a moving sphere by OpenFOAM's pimpleFoam: writes the case, on tets of a frame of ours, runs it, and
reads what came of it. Debian's package `openfoam` has the programs; without them nothing here but `cpu_seconds` is
called."""

import array
import os
import re
import resource
import shutil
import subprocess
import types

PROGRAMS = ("pimpleFoam", "renumberMesh")
FACES = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))  # of a tet, normals outwards


def installed():
    return all(shutil.which(program) for program in PROGRAMS)


def cpu_seconds(command, log, **more):
    """CPU seconds of the command, and its exit code; what it says goes to the file `log`."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log, "w") as said:
        code = subprocess.run(command, stdout=said, stderr=subprocess.STDOUT, **more).returncode
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, code


def head(kind, name):
    return f"FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"


def write(case, where, text, kind="dictionary"):
    file = case / where
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(head(kind, file.name) + text)


def write_list(case, name, kind, rows):
    write(case, f"constant/polyMesh/{name}", f"{len(rows)}\n(\n" + "\n".join(rows) + "\n)\n", kind)


def write_mesh(case, points, tets, on_sphere):
    """constant/polyMesh: inner faces in the order of their cells, then those of the sphere, then the walls.
    `on_sphere` tells a vertex of the sphere."""
    open_faces, inner = {}, []
    for cell, tet in enumerate(tets):
        for corners in FACES:
            face = tuple(tet[i] for i in corners)
            other = open_faces.pop(frozenset(face), None)
            if other:
                inner.append((other[0], cell, other[1]))
            else:
                open_faces[frozenset(face)] = (cell, face)
    inner.sort()
    sphere = [f for f in open_faces.values() if all(on_sphere(points[v]) for v in f[1])]
    walls = [f for f in open_faces.values() if not all(on_sphere(points[v]) for v in f[1])]
    faces = [face for _, _, face in inner] + [face for _, face in sphere + walls]
    write_list(case, "points", "vectorField", ["({!r} {!r} {!r})".format(*p) for p in points])
    write_list(case, "faces", "faceList", ["3({} {} {})".format(*face) for face in faces])
    write_list(case, "owner", "labelList", [str(f[0]) for f in inner + sphere + walls])
    write_list(case, "neighbour", "labelList", [str(f[1]) for f in inner])
    write(case, "constant/polyMesh/boundary", f"""2 (
sphere {{ type wall; nFaces {len(sphere)}; startFace {len(inner)}; }}
walls {{ type wall; nFaces {len(walls)}; startFace {len(inner) + len(sphere)}; }}
)
""", "polyBoundaryMesh")


def write_field(case, name, kind, dimensions, zero, sphere, walls):
    write(case, f"0/{name}", f"""dimensions [{dimensions}];
internalField uniform {zero};
boundaryField {{ sphere {{ {sphere} }} walls {{ {walls} }} }}
""", kind)


def write_control(case, end, dt, steps):
    write(case, "system/controlDict", f"""startFrom startTime; startTime 0; endTime {end}; deltaT {dt}; stopAt endTime;
writeControl timeStep; writeInterval {steps}; writeFormat binary; writePrecision 12; runTimeModifiable no;
functions {{ forces {{ type forces; libs (forces); patches (sphere); rho rhoInf; rhoInf 1; CofR (0 0 0); }} }}
""")


# Time and space of second order, as ours; what is not orthogonal is corrected by half.
SCHEMES = """ddtSchemes { default backward; }
gradSchemes { default Gauss linear; }
divSchemes
{
    default none;
    div(phi,U) Gauss linearUpwind grad(U);
    div((nuEff*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear limited corrected 0.5; }
interpolationSchemes { default linear; }
snGradSchemes { default limited corrected 0.5; }
"""

# As in OpenFOAM's own example of a moving wing, but for two pressure correctors, U by PBiCGStab, and pressure to 1e-6,
# where that asks for 1e-7: ours is solved for to 1e-4 of what changes in the step.
SOLUTION = """solvers
{{
    "pcorr.*" {{ solver GAMG; smoother GaussSeidel; tolerance 0.02; relTol 0; }}
    p {{ solver GAMG; smoother GaussSeidel; tolerance 1e-6; relTol 0.01; }}
    pFinal {{ $p; relTol 0; }}
    U {{ solver PBiCGStab; preconditioner DILU; tolerance 1e-6; relTol 0.1; }}
    UFinal {{ $U; relTol 0; }}
    "cellDisplacement.*" {{ solver GAMG; smoother GaussSeidel; tolerance 1e-5; relTol 0; }}
}}
PIMPLE
{{
    correctPhi yes; nOuterCorrectors {outer}; nCorrectors 2; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0;
}}
relaxationFactors {{ equations {{ ".*" 1; }} }}
cache {{ grad(U); }}
"""


def write_case(case, problem, outer):
    """A sphere that goes down by `speed`; box and sphere have no slip."""
    shutil.rmtree(case, ignore_errors=True)
    write_mesh(case, problem.points, problem.tets, problem.on_sphere)
    still = "type fixedValue; value uniform (0 0 0);"
    write_field(case, "U", "volVectorField", "0 1 -1 0 0 0 0", "(0 0 0)",
                "type movingWallVelocity; value uniform (0 0 0);", "type noSlip;")
    write_field(case, "p", "volScalarField", "0 2 -2 0 0 0 0", "0", "type zeroGradient;", "type zeroGradient;")
    path = f"((0 (0 0 0)) (100 (0 0 {-100 * problem.speed})))"
    write_field(case, "pointDisplacement", "pointVectorField", "0 1 0 0 0 0 0", "(0 0 0)",
                f"type uniformFixedValue; uniformValue table {path}; value uniform (0 0 0);", still)
    write(case, "constant/dynamicMeshDict", """dynamicFvMesh dynamicMotionSolverFvMesh;
motionSolverLibs (fvMotionSolvers);
motionSolver displacementLaplacian;
displacementLaplacianCoeffs { diffusivity quadratic inverseDistance (sphere); }
""")
    write(case, "constant/transportProperties", f"transportModel Newtonian; nu {problem.viscosity};\n")
    write(case, "constant/turbulenceProperties", "simulationType laminar;\n")
    write(case, "system/fvSchemes", SCHEMES)
    write(case, "system/fvSolution", SOLUTION.format(outer=outer))
    write_control(case, problem.dt * problem.steps, problem.dt, problem.steps)
    call(case, "renumberMesh", "-overwrite")


def call(case, program, *words):
    return cpu_seconds([program, *words, "-case", case], case / f"{program}.log",
                       env=os.environ | {"WM_PROJECT_DIR": "/usr/share/openfoam"})


def moved_points(file):
    """The vertices as OpenFOAM writes them, binary."""
    data = file.read_bytes()
    start = re.search(rb"\n(\d+)\s*\n\(", data)
    x = array.array("d", data[start.end() : start.end() + 24 * int(start[1])])
    return list(zip(x[0::3], x[1::3], x[2::3]))


def start_seconds(case, problem):
    """CPU seconds of a run that takes no step."""
    write_control(case, 0, problem.dt, problem.steps)
    seconds, _ = call(case, "pimpleFoam")
    write_control(case, problem.dt * problem.steps, problem.dt, problem.steps)
    return seconds


def run(case, problem):
    """CPU seconds a step, without the start; the steps done; vertices at the end and the drag, if it came there."""
    start = start_seconds(case, problem)
    seconds, code = call(case, "pimpleFoam")
    log = (case / "pimpleFoam.log").read_text()
    done = len(re.findall(r"(?m)^ExecutionTime = ", log))
    result = types.SimpleNamespace(seconds=(seconds - start) / max(done, 1), steps=done, points=None, drag=None)
    if code == 0:
        result.points = moved_points(case / f"{problem.dt * problem.steps:g}" / "polyMesh/points")
        last = (case / "postProcessing/forces/0/force.dat").read_text().split("\n")[-2]
        result.drag = float(last.replace("(", " ").replace(")", " ").split()[3])
    return result
