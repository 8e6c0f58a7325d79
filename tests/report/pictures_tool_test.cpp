#include "io/file.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace kropla {
namespace {

int run_tool(const std::filesystem::path& run, const std::filesystem::path& out) {
    const std::string command = std::string(DRAW_PICTURES) + " '" + run.string() + "' '" + out.string() +
                                "' '" + PICTURES_PROGRAM + "' 2>'" + (out.string() + ".err'");
    return WEXITSTATUS(std::system(command.c_str()));
}

bool has_screen_in_memory() { return std::system("command -v xvfb-run >/dev/null") == 0; }

TEST(DrawPictures, DrawsATinyRun) {
    if (!has_screen_in_memory()) GTEST_SKIP() << "xvfb-run is not installed";
    const auto dir = test_folder("pictures");
    write_tiny_run(dir, {.flow = true});
    ASSERT_EQ(run_tool(dir, dir / "out"), 0) << read_file(dir / "out.err");
    for (const char* name : {"initial-mesh", "positions", "whole-box", "quality", "temperature", "velocity",
                             "pressure"}) {
        const std::string png = read_file(dir / "out" / (std::string(name) + ".png"));
        EXPECT_EQ(png.substr(1, 3), "PNG") << name;
        EXPECT_GT(png.size(), 10'000U) << name;  // not a blank sheet
    }
    std::filesystem::remove_all(dir);
}

TEST(DrawPictures, NamesAMissingFrame) {
    if (!has_screen_in_memory()) GTEST_SKIP() << "xvfb-run is not installed";
    const auto dir = test_folder("no-pictures");
    write_tiny_run(dir);
    std::filesystem::remove(dir / "frames/00000.vtu");
    EXPECT_EQ(run_tool(dir, dir / "out"), 5);
    EXPECT_NE(read_file(dir / "out.err").find("00000.vtu"), std::string::npos);
    std::filesystem::remove_all(dir);
}

}  // namespace
}  // namespace kropla
