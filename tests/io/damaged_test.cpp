#include <kropla/base/error.h>
#include "examples.h"
#include "io/file.h"
#include <kropla/io/vtk.h>

/// Asked by the leak sanitizer: VTK's reader loses its array of cell types where it stops at certain errors.
extern "C" const char* __lsan_default_suppressions() { return "leak:vtkUnsignedCharArray"; }

namespace kropla {
namespace {

/// Reads the bytes as a VTU file: whether it was refused. Anything but a mesh or a FileError ends the test.
bool refused(const std::filesystem::path& path, const std::string& bytes) {
    put(path, bytes);
    try {
        (void)read_vtu(path);
        return false;
    } catch (const FileError&) {
        return true;
    }
}

std::string good_file(const std::filesystem::path& path) {
    const Mesh mesh = cube_of_tets(3);
    write_vtu(path, mesh,
              std::vector{NodalField{"x", "m", Array<Vertex, double>(mesh.position.size(), 1.5)}});
    return read_file(path);
}

TEST(DamagedVtu, CutAnywhereIsRefused) {
    const Folder folder;
    const std::string good = good_file(folder / "a.vtu");
    ASSERT_FALSE(refused(folder / "a.vtu", good));
    for (std::size_t length = 0; length + 12 < good.size(); length += 97)
        EXPECT_TRUE(refused(folder / "a.vtu", good.substr(0, length))) << length;
}

TEST(DamagedVtu, APieceMissingIsRefused) {
    const Folder folder;
    const std::string good = good_file(folder / "a.vtu");
    const std::size_t data = good.find("<AppendedData");
    for (std::size_t at = data + 40; at + 150 < good.size(); at += 97)
        EXPECT_TRUE(refused(folder / "a.vtu", good.substr(0, at) + good.substr(at + 50))) << at;
}

TEST(DamagedVtu, FlippedBytesNeverDoHarm) {
    const Folder folder;
    const std::string good = good_file(folder / "a.vtu");
    const std::size_t data = good.find("<AppendedData");
    int refusals = 0;
    testing::internal::CaptureStderr();
    for (std::uint64_t seed = 1; seed <= 600; ++seed) {
        SCOPED_TRACE(seed);
        Random random{seed};
        std::string bad = good;
        for (std::uint64_t flips = 1 + random.below(3); flips > 0; --flips) {
            const std::size_t at = random.below(seed % 2 == 0 ? data : bad.size());
            bad[at] = static_cast<char>(seed % 3 == 0 ? '0' + random.below(10) : random.bits() & 0xff);
        }
        refusals += refused(folder / "a.vtu", bad) ? 1 : 0;
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_GT(refusals, 400);  // the others hit blanks, names of arrays and the like
}

/// The header of each array is where VTK's reader believes most.
TEST(DamagedVtu, FlippedHeadersNeverDoHarm) {
    const Folder folder;
    const std::string good = good_file(folder / "a.vtu");
    const std::size_t data = good.find('_', good.find("<AppendedData")) + 1;
    int arrays = 0;
    for (std::size_t at = good.find(" offset=\""); at < data;
         at = good.find(" offset=\"", at + 1), ++arrays) {
        const std::size_t start = data + std::stoul(good.substr(at + 9));
        for (std::size_t byte = 0; byte < 12; ++byte)
            for (const char value : {'\0', '\1', '\x7f', '\xff'}) {
                std::string bad = good;
                bad[start + byte] = value;
                (void)refused(folder / "a.vtu", bad);
            }
    }
    EXPECT_EQ(arrays, 9);
}

}  // namespace
}  // namespace kropla
