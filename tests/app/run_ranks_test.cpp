// Several processes that share the solution: mpirun -n 2.
#include <kropla/io/vtk.h>
#include "run_results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// The program on two ranks; the code is mpirun's, 124 if it does not end.
Outcome two_ranks(const TemporaryFolder& folder, const std::string& arguments) {
    const std::string command =
        "cd '" + folder.path.string() +
        "' && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout 60 '" KROPLA_MPIRUN
        "' --oversubscribe -n 2 '" KROPLA_PROGRAM "' " +
        arguments + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(folder.path / "out.txt"),
            contents(folder.path / "err.txt")};
}

/// The program's own lines but for warnings; mpirun adds some about itself.
int complaints(const std::string& err) {
    const auto count = [&](const std::string& what) {
        int found = err.starts_with(what) ? 1 : 0;
        for (std::size_t at = 0; (at = err.find('\n' + what, at)) != std::string::npos; ++at) ++found;
        return found;
    };
    return count("kropla: ") - count("kropla: warning: ");
}

TEST(Ranks, MoveTheSameMeshAndShareTheSolution) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out one").code, 0);
    const Outcome ended = two_ranks(folder, "run a.toml --out two");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string steps_said = ended.out.substr(opening_of(ended.out));
    EXPECT_EQ(std::ranges::count(steps_said, '\n'), 7) << ended.out;  // every line once, and the last four
    EXPECT_EQ(ended.out.find('\r'), std::string::npos) << ended.out;
    for (const auto& [name, bytes] : frames(folder.path / "one")) {
        SCOPED_TRACE(name);
        const Frame one = read_vtu(folder.path / "one/frames" / name);
        const Frame two = read_vtu(folder.path / "two/frames" / name);
        EXPECT_TRUE(std::ranges::equal(one.mesh.position, two.mesh.position));
        EXPECT_TRUE(std::ranges::equal(one.mesh.tets, two.mesh.tets));
        EXPECT_TRUE(std::ranges::equal(one.mesh.region, two.mesh.region));
        const auto& a = one.fields.at(0).values;
        const auto& b = two.fields.at(0).values;
        ASSERT_EQ(a.size(), b.size());
        for (Vertex v : a.indices()) ASSERT_NEAR(a[v], b[v], 1e-6 * std::abs(a[v])) << v.value;
    }
}

TEST(Ranks, ComplainOnceAndEndWithTheSameCode) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    write(folder.path / "wrong.toml", replaced(short_case(3), "radius = 0.001", "radius = -0.001"));
    write(folder.path / "land.toml", landing_case());
    write(folder.path / "file", "");
    std::filesystem::create_directories(folder.path / "taken/frames/00002.vtu");
    std::filesystem::create_directory(folder.path / "there");
    write(folder.path / "there/case.toml", "");
    const std::pair<const char*, int> runs[] = {
        {"run wrong.toml --out d", 2}, {"run a.toml --out there", 2},
        {"run land.toml --out d3", 3}, {"run a.toml --out d4 -ksp_max_it 1", 4},
        {"run none.toml --out d5", 5}, {"run a.toml --out file/below", 5},
        {"run a.toml --out taken", 5}};
    for (const auto& [arguments, code] : runs) {
        SCOPED_TRACE(arguments);
        const Outcome ended = two_ranks(folder, arguments);
        EXPECT_EQ(ended.code, code);
        EXPECT_EQ(complaints(ended.err), 1) << ended.err;
    }
}

}  // namespace
}  // namespace kropla
