"""A drop of one liquid in another by OpenFOAM's interFoam, in an eighth of its box, on cubes: writes the case, runs it, and
reads what came of it. Debian's package `openfoam` has the program."""

import itertools
import math
import re
import shutil
import types

from openfoam import call, write

PROGRAMS = ("blockMesh", "interFoam")
PARTS = 6  # of a cell's edge, to find how much of it is within the drop


def installed():
    return all(shutil.which(program) for program in PROGRAMS)


BLOCK = """convertToMeters 1;
vertices ((0 0 0) ({b} 0 0) ({b} {b} 0) (0 {b} 0) (0 0 {b}) ({b} 0 {b}) ({b} {b} {b}) (0 {b} {b}));
blocks (hex (0 1 2 3 4 5 6 7) ({n} {n} {n}) simpleGrading (1 1 1));
boundary
(
    x0 {{ type symmetryPlane; faces ((0 4 7 3)); }}
    y0 {{ type symmetryPlane; faces ((0 1 5 4)); }}
    z0 {{ type symmetryPlane; faces ((0 3 2 1)); }}
    walls {{ type wall; faces ((1 2 6 5) (3 7 6 2) (4 5 6 7)); }}
);
"""

SCHEMES = """ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes
{
    div(rhoPhi,U) Gauss linearUpwind grad(U);
    div(phi,alpha) Gauss vanLeer;
    div(phirb,alpha) Gauss linear;
    div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""

# As in OpenFOAM's own example of a capillary rise, with pressure to 1e-8.
SOLUTION = """solvers
{
    "alpha.*"
    {
        nAlphaCorr 2; nAlphaSubCycles 1; cAlpha 1; MULESCorr yes; nLimiterIter 5;
        solver smoothSolver; smoother symGaussSeidel; tolerance 1e-9; relTol 0;
    }
    "pcorr.*" { solver PCG; preconditioner DIC; tolerance 1e-8; relTol 0; }
    p_rgh { solver PCG; preconditioner DIC; tolerance 1e-8; relTol 0.01; }
    p_rghFinal { $p_rgh; relTol 0; }
    "U.*" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0; }
}
PIMPLE { momentumPredictor yes; nOuterCorrectors 1; nCorrectors 3; nNonOrthogonalCorrectors 0; pRefCell 0; pRefValue 0; }
"""


def share_within(lower, edge, within):
    """The share of a cube in which `within` holds, by points, where its corners do not agree."""
    corners = {within(*(l + edge * s for l, s in zip(lower, sides))) for sides in itertools.product((0, 1), repeat=3)}
    if len(corners) == 1:
        return float(corners.pop())
    middles = [edge * (i + 0.5) / PARTS for i in range(PARTS)]
    inner = sum(within(lower[0] + x, lower[1] + y, lower[2] + z) for x in middles for y in middles for z in middles)
    return inner / PARTS**3


def cells_of(drop):
    """The lower corners of the cubes, in the order of blockMesh."""
    edge = drop.box / drop.cells
    return [(i * edge, j * edge, k * edge) for k in range(drop.cells) for j in range(drop.cells) for i in range(drop.cells)]


def write_field(case, name, kind, dimensions, inner, walls):
    write(case, f"0/{name}", f"""dimensions [{dimensions}];
internalField {inner};
boundaryField {{ "[xyz]0" {{ type symmetryPlane; }} walls {{ {walls} }} }}
""", kind)


def write_case(case, drop):
    """`drop`: box, cells along it, within(x, y, z), density and viscosity of drop and surroundings, tension, dt, end, and
    every, the time between what is written."""
    shutil.rmtree(case, ignore_errors=True)
    edge = drop.box / drop.cells
    write(case, "system/blockMeshDict", BLOCK.format(b=drop.box, n=drop.cells))
    write(case, "system/fvSchemes", SCHEMES)
    write(case, "system/fvSolution", SOLUTION)
    write(case, "system/controlDict", f"""startFrom startTime; startTime 0; endTime {drop.end}; deltaT {drop.dt};
stopAt endTime; writeControl adjustableRunTime; writeInterval {drop.every}; writeFormat ascii; writePrecision 10;
adjustTimeStep yes; maxCo 0.3; maxAlphaCo 0.3; maxDeltaT {drop.dt}; runTimeModifiable no;
""")
    fluids = "".join(f"{name} {{ transportModel Newtonian; nu {viscosity / density}; rho {density}; }}\n"
                     for name, density, viscosity in zip(("drop", "rest"), drop.density, drop.viscosity))
    write(case, "constant/transportProperties", f"phases (drop rest);\n{fluids}sigma {drop.tension};\n")
    write(case, "constant/turbulenceProperties", "simulationType laminar;\n")
    write(case, "constant/g", "dimensions [0 1 -2 0 0 0 0]; value (0 0 0);\n", "uniformDimensionedVectorField")
    shares = "\n".join(f"{share_within(lower, edge, drop.within):.8g}" for lower in cells_of(drop))
    write_field(case, "alpha.drop", "volScalarField", "0 0 0 0 0 0 0",
                f"nonuniform List<scalar> {drop.cells**3}\n(\n{shares}\n)", "type zeroGradient;")
    write_field(case, "U", "volVectorField", "0 1 -1 0 0 0 0", "uniform (0 0 0)", "type noSlip;")
    write_field(case, "p_rgh", "volScalarField", "1 -1 -2 0 0 0 0", "uniform 0", "type fixedFluxPressure; value uniform 0;")
    call(case, "blockMesh")


def numbers(file):
    """Of a field that is written as text and is not uniform: a list of numbers or of triples."""
    text = file.read_text()
    start = re.search(r"nonuniform List<\w+>\s*\d+\s*\(", text)
    body = text[start.end() : text.index("\n)\n", start.end())]
    values = [float(word) for word in body.replace("(", " ").replace(")", " ").split()]
    return values if "List<scalar>" in start[0] else list(zip(values[0::3], values[1::3], values[2::3]))


def elongation(case, drop, time):
    """The integral over the drop of z^2 - (x^2 + y^2) / 2, by that of x^2 + y^2 + z^2."""
    half, along, all_together = drop.box / drop.cells / 2, 0, 0
    for (x, y, z), share in zip(cells_of(drop), numbers(case / time / "alpha.drop")):
        x2, y2, z2 = (x + half) ** 2, (y + half) ** 2, (z + half) ** 2
        along += share * (z2 - (x2 + y2) / 2)
        all_together += share * (x2 + y2 + z2)
    return along / all_together


def run(case, drop):
    """CPU seconds; (time, elongation) of each time that is written; the largest velocity at the end."""
    seconds, code = call(case, "interFoam")
    times = sorted((p.name for p in case.iterdir() if re.fullmatch(r"[\d.]+(e-\d+)?", p.name)), key=float)
    if code or len(times) < 2:
        return types.SimpleNamespace(seconds=seconds, course=[], fastest=math.nan)
    course = [(float(time), elongation(case, drop, time)) for time in times if float(time) > 0]
    return types.SimpleNamespace(seconds=seconds, course=course,
                                 fastest=max(math.hypot(*u) for u in numbers(case / times[-1] / "U")))
