"""Which folder of src/ may include which: fails on an #include against the arrows (docs/architecture.md)."""

import pathlib
import re
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent / "src"

# Folder by folder, the ones it sees directly; it sees what those see too.
SEES = {
    "base": [],
    "mesh": ["base"],
    "domain": ["mesh"],
    "generate": ["domain"],
    "adapt": ["generate"],
    "transfer": ["mesh"],
    "step": ["adapt", "transfer"],
    "simulate": ["mesh", "transfer"],
    "io": ["mesh", "simulate"],
    "report": ["io"],
    "motion": ["domain", "simulate"],
    "case": ["motion", "step", "io"],
    "app": ["base", "mesh", "domain", "generate", "adapt", "transfer", "step", "simulate", "io", "report", "case"],
}
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"|<kropla/)([^">]+)[">]')
HEADERS = re.compile(r"list\(APPEND KROPLA_\w+_HEADERS([^)]*)\)")


def seen_from(folder):
    """The folder itself and all that its arrows lead to."""
    seen = {folder}
    for other in SEES[folder]:
        seen |= seen_from(other)
    return seen


def wrong_includes(source):
    """One line per include that goes against the arrows, or does not begin with a folder of src/."""
    wrong = []
    for path in sorted(source.rglob("*")):
        if path.suffix not in (".h", ".cpp", ".in") or path.parent == source:
            continue
        folder = path.relative_to(source).parts[0]
        for number, line in enumerate(path.read_text().splitlines(), 1):
            include = INCLUDE.match(line)
            if include is None:
                continue
            other = include[1].split("/")[0]
            place = f"{path.relative_to(source)}:{number}: "
            if folder not in SEES:
                wrong.append(f"{place}{folder} is not a folder that the arrows know")
            elif "/" not in include[1] or other not in SEES:
                wrong.append(f'{place}"{include[1]}" does not begin with a folder of src/')
            elif other not in seen_from(folder):
                wrong.append(f'{place}{folder} may not see "{include[1]}"')
    return wrong


def headers_for_users(source):
    """FOLDER/FILE.h of each header that is installed."""
    lists = [*source.glob("*/files.cmake"), *source.glob("*/CMakeLists.txt")]
    return {header for path in lists for found in HEADERS.findall(path.read_text()) for header in found.split()}


def wrong_spelling(source):
    """One line per include of a header for users that is not spelt <kropla/...>, of another that is, or of another by one
    that is for users."""
    known = headers_for_users(source)
    wrong = []
    for path in sorted(source.rglob("*")):
        if path.suffix not in (".h", ".cpp") or path.parent == source:
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            include = INCLUDE.match(line)
            if include is None:
                continue
            place = f"{path.relative_to(source)}:{number}: "
            if ("<kropla/" in line) != (include[1] in known):
                wrong.append(f"{place}{line.strip()}")
            if str(path.relative_to(source)) in known and include[1] not in known:
                wrong.append(f"{place}is for users, {include[1]} is not")
    return wrong


class Arrows(unittest.TestCase):
    def test_the_source_keeps_to_them(self):
        self.assertGreater(len(list(SOURCE.rglob("*.cpp"))), 10, f"no source in {SOURCE}")
        self.assertEqual(wrong_includes(SOURCE), [])

    def test_what_is_for_users_shows_them_nothing_else(self):
        self.assertGreater(len(headers_for_users(SOURCE)), 20)
        self.assertEqual(wrong_spelling(SOURCE), [])

    def test_no_arrow_leads_back(self):
        for folder in SEES:
            for other in seen_from(folder) - {folder}:
                self.assertNotIn(folder, seen_from(other))

    def test_a_tree_that_breaks_them_is_found_out(self):
        with tempfile.TemporaryDirectory() as name:
            source = pathlib.Path(name)
            for path, text in {
                "base/vec3.h": "#include <cmath>\n",
                "mesh/mesh.h": '#include "base/vec3.h"\n// #include "app/case.h"\n',
                "mesh/up.cpp": '#include <array>\n  #  include "domain/domain.h"\n',
                "transfer/side.cpp": '#include "mesh/mesh.h"\n#include "domain/domain.h"\n',
                "generate/far.cpp": '#include "base/vec3.h"\n#include "generate/generate.h"\n',
                "io/bare.cpp": '#include "vtk.h"\n',
                "utils/all.cpp": '#include "base/vec3.h"\n',
                "app/all.cpp": '#include "report/report.h"\n#include "adapt/adapt.h"\n',
            }.items():
                (source / path).parent.mkdir(exist_ok=True)
                (source / path).write_text(text)
            self.assertEqual(wrong_includes(source), [
                'io/bare.cpp:1: "vtk.h" does not begin with a folder of src/',
                'mesh/up.cpp:2: mesh may not see "domain/domain.h"',
                'transfer/side.cpp:2: transfer may not see "domain/domain.h"',
                "utils/all.cpp:1: utils is not a folder that the arrows know",
            ])


if __name__ == "__main__":
    unittest.main()
