"""Does the flood's reader see what is wrong? A good frame is spoilt in one way after another, and each must be found.

    reader_test.py KROPLA
"""

import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import flow_judge
import judge
import mesh_checks
import vtu
from case_file import Case
from geometry import Ellipsoid, gap, rotation_about

CASE = """
domain = {min = [0, 0, 0], max = [6, 6, 5]}
size = {surface = 1, far = 1.5}
time = {end = 1, steps = 1}
[[body]]
name = "ball"
shape = "sphere"
centre = [3, 3, 2.5]
radius = 1.5
motion = {x = "0.2*t"}
layer = {count = 1, first_height = 0.3}
[heat.region]
surroundings = {conductivity = 1, density = 1, specific_heat = 1, initial = 300}
ball = {conductivity = 1, density = 1, specific_heat = 1, initial = 400}
"""


class Reader(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.file, cls.out = cls.folder / "case.toml", cls.folder / "out"
        cls.file.write_text(CASE, encoding="utf-8")
        command = [PROGRAM, "run", cls.file, "--out", cls.out]
        cls.done = subprocess.run(command, capture_output=True, text=True, check=True)
        cls.case = Case(cls.file)

    def setUp(self):
        self.frame = vtu.Frame(self.out / "frames" / "00001.vtu")

    def faults(self, t=1.0):
        return " | ".join(mesh_checks.look_at(self.frame, self.case.scene, t).faults)

    def test_a_good_run_has_no_faults(self):
        verdict = judge.judge(self.case, self.out, 0, self.done.stderr)
        self.assertEqual((verdict.outcome, verdict.faults), ("done", []))
        self.assertTrue(self.frame.prisms)

    def test_a_tet_that_is_turned(self):
        a, b, c, d = self.frame.tets[5]
        self.frame.tets[5] = (b, a, c, d)
        self.assertIn("not positive", self.faults())

    def test_a_prism_that_is_turned(self):
        self.frame.prisms[0] = self.frame.prisms[0][3:] + self.frame.prisms[0][:3]
        self.assertIn("a prism, is not positive", self.faults())

    def test_a_cell_that_is_not_there(self):
        del self.frame.tets[7], self.frame.tet_cells[7]
        self.assertIn("has one cell, but is not on the box", self.faults())
        self.assertIn("of the box", self.faults())

    def test_a_cell_that_is_there_twice(self):
        self.frame.tets.append(self.frame.tets[0])
        self.frame.tet_cells.append(self.frame.tet_cells[0])
        self.assertIn("is shared by the cells", self.faults())

    def test_a_vertex_that_left_the_box(self):
        wall = next(v for v, (x, _, _) in enumerate(self.frame.points) if x == 0)
        x, y, z = self.frame.points[wall]
        self.frame.points[wall] = (x - 1e-9, y, z)
        self.assertIn("not on the box", self.faults())

    def test_a_body_in_another_place(self):
        body = self.case.scene.bodies[0]
        self.addCleanup(setattr, body, "displacement", body.displacement)
        body.displacement = lambda t: (1.0, 0.0, 0.0)
        self.assertIn("off the surface of body 1", self.faults())

    def test_a_cell_of_another_region(self):
        far = next(c for c, vs in zip(self.frame.tet_cells, self.frame.tets) if (0.0, 0.0, 0.0) in
                   [self.frame.points[v] for v in vs])
        self.frame.region[far] = 1
        self.assertIn("region 1 is in 2 pieces", self.faults())

    def test_a_temperature_that_is_no_number(self):
        self.frame.temperature[3] = math.nan
        self.assertIn("temperature is not finite", self.faults())

    def test_energy_and_ratio_that_the_table_tells_otherwise(self):
        row = judge.rows_of(self.out)[0]
        figures = mesh_checks.look_at(self.frame, self.case.scene, 1.0)
        for key, told in (("max_aspect_ratio", "max_aspect_ratio"), ("energy_integral [J]", "energy")):
            verdict = judge.Verdict("done")
            judge.check_row(self.case, row | {key: str(float(row[key]) * (1 + 1e-5))}, self.frame, figures, verdict)
            self.assertIn(told, " ".join(verdict.faults))

    def test_files_that_are_damaged(self):
        data = (self.out / "frames" / "00001.vtu").read_bytes()
        for spoilt in (data[: len(data) // 2], data.replace(b"appended", b"upended", 1), b""):
            (self.folder / "spoilt.vtu").write_bytes(spoilt)
            with self.assertRaises(vtu.Damaged):
                vtu.Frame(self.folder / "spoilt.vtu")

    def test_codes_and_words_that_are_no_refusal(self):
        wrong = ((1, ""), (-11, ""), (4, "kropla: x"), (2, "kropla: a\nb"), (2, "kropla: 1 m apart"), (3, ""))
        for code, errors in wrong:
            self.assertEqual(judge.judge(self.case, self.folder, code, errors).outcome, "failed", (code, errors))

    def test_a_gap_that_is_not_there(self):
        said = 'kropla: at t = 500 ms body "ball" is {} m from the wall z min, too close: R/r 11, limit 10'
        for gap_told, outcome in ((1.0, "refused: floor"), (0.9, "failed")):
            self.assertEqual(judge.judge(self.case, self.folder, 3, said.format(gap_told)).outcome, outcome)


FLOW = """
domain = {min = [0, 0, 0], max = [9, 6, 6]}
size = {surface = 0.5, far = 1.5}
time = {end = 1, steps = 2}
output = {every = 1}
[[body]]
name = "ball"
shape = "sphere"
centre = [2, 3, 3]
radius = 1
motion = {x = "0.2*t"}
[[body]]
name = "drop"
shape = "sphere"
centre = [6, 3, 3]
radius = 1
motion = {kind = "flow"}
[flow.region]
surroundings = {density = 1, viscosity = 0.1}
drop = {density = 2, viscosity = 0.1}
[flow.surface.drop]
tension = 1
[heat.region]
surroundings = {conductivity = 1, density = 1, specific_heat = 1, initial = 300}
ball = {conductivity = 1, density = 1, specific_heat = 1, initial = 400}
drop = {conductivity = 1, density = 1, specific_heat = 1, initial = 400}
"""


class Flow(unittest.TestCase):
    """What steps.csv says of a run, spoilt."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        file, cls.out = pathlib.Path(folder.name) / "case.toml", pathlib.Path(folder.name) / "out"
        file.write_text(FLOW, encoding="utf-8")
        cls.done = subprocess.run([PROGRAM, "run", file, "--out", cls.out], capture_output=True, text=True, check=True)
        cls.case = flow_judge.FlowCase(file)

    def setUp(self):
        self.rows = judge.rows_of(self.out)

    def faults(self):
        verdict = judge.Verdict("done")
        volumes = flow_judge.check_frames(self.case, judge.frames_of(self.out), verdict)
        flow_judge.check_balances(self.case, self.rows, volumes, verdict)
        return " | ".join(verdict.faults)

    def test_a_good_run_has_no_faults(self):
        verdict = flow_judge.judge(self.case, self.out, 0, self.done.stderr)
        self.assertEqual((verdict.outcome, verdict.faults), ("done", []))
        self.assertEqual(self.case.kinds, {"ball": "path", "drop": "flow"})

    def test_what_is_not_so(self):
        wrong = {"mass_error_drop [kg]": "1e-10", "energy_error [J]": "1e-6", "area_drop [m^2]": "12.5", "x_ball [m]": "2.3",
                 "force_z_ball [N]": "nan", "energy_transfer_error": "1e-9"}
        said = {"mass_error_drop [kg]": "masses", "energy_error [J]": "the energy", "area_drop [m^2]": "less than a ball",
                "x_ball [m]": "off its path", "force_z_ball [N]": "is nan", "energy_transfer_error": "transfers"}
        self.assertEqual(self.faults(), "")
        for name, value in wrong.items():
            kept, self.rows[1][name] = self.rows[1][name], value
            self.assertIn(said[name], self.faults(), name)
            self.rows[1][name] = kept

    def test_codes_that_are_no_end(self):
        for code, errors in ((1, ""), (-9, ""), (4, "kropla: x"), (3, "kropla: a\nb")):
            self.assertEqual(flow_judge.judge(self.case, self.out, code, errors).outcome, "failed", (code, errors))


class Figures(unittest.TestCase):
    def test_of_a_regular_tet(self):
        volume, ratio, cosine = mesh_checks.tet_figures((1, 1, 1), (-1, 1, -1), (1, -1, -1), (-1, -1, 1))
        self.assertAlmostEqual(volume, 8 / 3)
        self.assertAlmostEqual(ratio, 3)
        self.assertAlmostEqual(cosine, 1 / 3)

    def test_of_a_straight_wedge(self):
        corners = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 2), (0, 1, 2), (1, 0, 2)]  # VTK's: first triangle outwards
        volume, jacobian, integral = mesh_checks.wedge_figures(corners, [z for _, _, z in corners])
        self.assertAlmostEqual(volume, 1)
        self.assertAlmostEqual(integral, 1)
        self.assertAlmostEqual(jacobian, math.sqrt(0.5) / (math.sqrt(3) / 2))

    def test_gaps_of_ellipsoids(self):
        turn = rotation_about((0, 0, 1), math.pi / 2)
        a, b = Ellipsoid((0, 0, 0), (2, 1, 1)), Ellipsoid((4, 0, 0), (3, 1, 1), turn)
        self.assertAlmostEqual(gap(a, b), 1, 3)
        self.assertEqual(gap(a, Ellipsoid((2.5, 0, 0), (3, 1, 1), turn)), 0)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
