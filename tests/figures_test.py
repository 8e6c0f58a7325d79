"""tools/figures: what it prints of a run, and how it ends when there is none."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parent.parent / "tools" / "figures"
NAMES = ("step,attempts,tets,max_aspect_ratio,p999_aspect_ratio,min_dihedral [deg],max_dihedral [deg],swaps,splits,"
         "collapses,local_remeshes,global_remeshes,touched_fraction,mesh_seconds [s],simulate_seconds [s],"
         "transfer_seconds [s],energy_integral [J],energy_transfer_error")
ROWS = ("1,1,1000,5,4,25,130,10,2,3,0,0,0.5,0.1,0.2,0.01,50,1e-8",
        "2,3,1200,7,4.5,20,140,30,4,5,1,0,0.7,0.4,0.2,0.03,51,-3e-8")


def figures(run):
    return subprocess.run([sys.executable, TOOL, run], capture_output=True, text=True, check=False)


class Figures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.run_folder = pathlib.Path(folder.name)

    def write(self, *lines):
        (self.run_folder / "steps.csv").write_text("".join(line + "\n" for line in lines))

    def test_are_those_of_the_steps(self):
        self.write(NAMES, *ROWS)
        printed = figures(self.run_folder).stdout.splitlines()
        for line in ("| attempts refused | 2 |", "| tets | 1000 to 1200 |",
                     "| worst R/r of a step: median / of the run | 6.00 / 7.00 |",
                     "| dihedral angles of the run [degrees] | 20.0 to 140.0 |",
                     "| cells touched per step [%]: median / most | 60.0 / 70.0 |",
                     "| mesh, seconds per step: median / most | 0.250 / 0.400 |",
                     "| energy: change from the first step to the last | 2.0e-02 |",
                     "| energy: most that one transfer changed it | -3.0e-08 |"):
            self.assertIn(line, printed)

    def test_without_a_run_there_are_none(self):
        for lines in (None, (), (NAMES,), ("step,tets", "1,1000")):
            if lines is not None:
                self.write(*lines)
            ended = figures(self.run_folder)
            self.assertEqual(ended.returncode, 5, lines)
            self.assertEqual(len(ended.stderr.splitlines()), 1, ended.stderr)


if __name__ == "__main__":
    unittest.main()
