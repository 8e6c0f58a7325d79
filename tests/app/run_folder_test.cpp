// Who may write into the folder of a run, and what becomes of it when nothing is written.
#include "held_program.h"
#include "run_results.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

namespace fs = std::filesystem;

// Many more cells than a test waits for.
std::string endless_case() {
    return replaced(replaced(short_case(1), "surface = 4e-4", "surface = 3e-5"), "far     = 8e-4", "far = 4e-5");
}

TEST(RunFolder, IsLeftAsItWasIfTheInitialMeshIsInterrupted) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", endless_case());
    for (const int signal : {SIGINT, SIGTERM}) {
        HeldProgram program(folder, {"run", "a.toml", "--out", "deep/d"}, 0, 0);
        ASSERT_TRUE(program.says("initial mesh: "));
        EXPECT_TRUE(fs::exists(folder.path / "deep/d/run.lock"));
        program.signal(signal);
        ASSERT_TRUE(program.ends_within(20));
        const Outcome ended = program.finish();
        EXPECT_EQ(ended.code, 130);
        EXPECT_EQ(ended.err, "kropla: interrupted while the initial mesh was made; nothing was written\n");
        EXPECT_FALSE(fs::exists(folder.path / "deep"));
    }
}

TEST(RunFolder, IsHeldByOneRun) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", endless_case());
    write(folder.path / "b.toml", short_case(1));
    fs::create_directory(folder.path / "d");
    HeldProgram program(folder, {"run", "a.toml", "--out", "d"}, 0, 0);
    ASSERT_TRUE(program.says("initial mesh: "));
    const std::string holder = contents(folder.path / "d/run.lock");
    EXPECT_TRUE(holder.starts_with("process ")) << holder;
    const Outcome second = kropla_program(folder, "run b.toml --out d");
    EXPECT_EQ(second.code, 2);
    EXPECT_EQ(second.err, "kropla: d: another run is at work there, " + holder + "\n");
    program.signal(SIGKILL);  // the lock is gone with the process, its file stays
    static_cast<void>(program.finish());
    EXPECT_TRUE(fs::exists(folder.path / "d/run.lock"));
    EXPECT_EQ(kropla_program(folder, "run b.toml --out d").code, 0);
    EXPECT_FALSE(fs::exists(folder.path / "d/run.lock"));
}

TEST(RunFolder, IsNotTouchedBeforeTheCaseIsRead) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(short_case(1), "radius = ", "radus = "));
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d").code, 2);
    EXPECT_FALSE(fs::exists(folder.path / "d"));
}

TEST(RunFolder, IsOverwrittenByForceButForWhatIsNotOfARun) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(2));
    write(folder.path / "b.toml", short_case(1));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    write(folder.path / "d/notes.txt", "mine");
    ASSERT_EQ(kropla_program(folder, "run b.toml --out d --force").code, 0);
    ASSERT_EQ(kropla_program(folder, "run b.toml --out whole").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
    EXPECT_EQ(contents(folder.path / "d/notes.txt"), "mine");
}

}  // namespace
}  // namespace kropla
