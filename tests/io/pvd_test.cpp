#include <kropla/io/pvd.h>

#include <kropla/base/error.h>
#include "examples.h"
#include "io/file.h"

namespace kropla {
namespace {

const std::vector<SeriesEntry> three = {
    {0, "frames/00000.vtu"}, {0.1 / 3, "frames/00001.vtu"}, {1e-300, "a&\"<b>.vtu"}};

TEST(Pvd, ComesBackBitForBit) {
    const Folder folder;
    write_pvd(folder / "a.pvd", three);
    EXPECT_EQ(read_pvd(folder / "a.pvd"), three);
    write_pvd(folder / "a.pvd", {});
    EXPECT_TRUE(read_pvd(folder / "a.pvd").empty());
}

TEST(Pvd, RefusesWhatIsNotASeries) {
    const Folder folder;
    write_pvd(folder / "a.pvd", three);
    const std::string good = read_file(folder / "a.pvd");
    const auto refused = [&](const std::string& text) {
        put(folder / "b.pvd", text);
        return message_of<FileError>([&] { (void)read_pvd(folder / "b.pvd"); });
    };
    for (std::size_t length = 0; length + 12 < good.size(); length += 11)
        EXPECT_NE(refused(good.substr(0, length)), "") << length;
    EXPECT_NE(refused("garbage").find("is not a PVD file"), std::string::npos);
    std::string no_time = good;
    no_time.replace(no_time.find("timestep=\"0\""), 12, "timestep=\"x\"");
    EXPECT_NE(refused(no_time).find("frame 0 has no time or no file"), std::string::npos);
    EXPECT_NE(message_of<FileError>([&] { (void)read_pvd(folder / "none.pvd"); }), "");
}

}  // namespace
}  // namespace kropla
