#include <kropla/io/checkpoint.h>

#include <kropla/base/error.h>
#include "examples.h"
#include "io/file.h"

#include <bit>

namespace kropla {
namespace {

Checkpoint example() {
    Checkpoint checkpoint;
    checkpoint.mesh = cube_of_tets(3);
    Mesh& mesh = checkpoint.mesh;
    mesh.free_vertices.push_back(mesh.position.push_back({-0.0, 5e-324, 1e300}));  // a free slot has bits too
    mesh.tet_at.push_back({});
    mesh.layer_at.push_back({});
    checkpoint.fields = {{"temperature", "K", Array<Vertex, double>(mesh.position.size(), 0.1)},
                         {"enthalpy", "", Array<Vertex, double>(mesh.position.size(), -1e-9)}};
    checkpoint.time = 0.1;
    checkpoint.next_dt = 1.0 / 3;
    checkpoint.step = std::int64_t{1} << 40;
    checkpoint.case_text = "[domain]\nname = \"T\xc5\x82o\"\n";
    checkpoint.values = {{"global_remeshes", 0}, {"total energy [J]", 1.0 / 7}};
    return checkpoint;
}

std::string refusal(const Folder& folder, const std::string& bytes) {
    put(folder / "b.h5", bytes);
    return message_of<FileError>([&] { (void)read_checkpoint(folder / "b.h5"); });
}

TEST(Checkpoint, ComesBackBitForBit) {
    const Folder folder;
    const Checkpoint written = example();
    write_checkpoint(folder / "a.h5", written);
    const Checkpoint read = read_checkpoint(folder / "a.h5");
    EXPECT_EQ(read.mesh, written.mesh);
    EXPECT_TRUE(std::signbit(read.mesh.position[read.mesh.free_vertices.back()].x));
    ASSERT_EQ(read.fields.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(read.fields[i].name, written.fields[i].name);
        EXPECT_EQ(read.fields[i].unit, written.fields[i].unit);
        EXPECT_EQ(read.fields[i].values, written.fields[i].values);
    }
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.time), std::bit_cast<std::uint64_t>(written.time));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read.next_dt), std::bit_cast<std::uint64_t>(written.next_dt));
    EXPECT_EQ(read.step, written.step);
    EXPECT_EQ(read.case_text, written.case_text);
    EXPECT_EQ(read.values, written.values);
}

TEST(Checkpoint, MayBeEmpty) {
    const Folder folder;
    write_checkpoint(folder / "a.h5", {});
    const Checkpoint read = read_checkpoint(folder / "a.h5");
    EXPECT_EQ(read.mesh, Mesh{});
    EXPECT_TRUE(read.fields.empty() && read.values.empty() && read.case_text.empty());
}

TEST(Checkpoint, CutAnywhereIsRefused) {
    const Folder folder;
    write_checkpoint(folder / "a.h5", example());
    const std::string good = read_file(folder / "a.h5");
    for (std::size_t length = 0; length < good.size(); length += 211)
        EXPECT_NE(refusal(folder, good.substr(0, length)), "") << length;
    EXPECT_NE(refusal(folder, good.substr(0, good.size() - 1)).find("is truncated"), std::string::npos);
}

TEST(Checkpoint, AFlippedBitIsRefused) {
    const Folder folder;
    write_checkpoint(folder / "a.h5", example());
    const std::string good = read_file(folder / "a.h5");
    Random random{3};
    for (int i = 0; i < 200; ++i) {
        std::string bad = good;
        const std::size_t at = 512 + random.below(bad.size() - 512), bit = random.below(8);
        bad[at] = static_cast<char>(bad[at] ^ (1 << bit));
        EXPECT_NE(refusal(folder, bad).find("checksum"), std::string::npos) << at;
    }
}

TEST(Checkpoint, RefusesForeignFilesAndOtherVersions) {
    const Folder folder;
    write_checkpoint(folder / "a.h5", example());
    std::string other = read_file(folder / "a.h5");
    other.replace(other.find("format 2"), 8, "format 1");
    EXPECT_NE(refusal(folder, other).find("format 1, this program reads format 2"), std::string::npos);
    EXPECT_NE(refusal(folder, "").find("is not a checkpoint"), std::string::npos);
    EXPECT_NE(refusal(folder, "\x89HDF\r\n\x1a\n").find("is not a checkpoint"), std::string::npos);
    EXPECT_NE(message_of<FileError>([&] { (void)read_checkpoint(folder / "none.h5"); }).find("No such file"),
              std::string::npos);
}

TEST(Checkpoint, TheOneBeforeSurvivesAFailure) {
    const Folder folder;
    write_checkpoint(folder / "a.h5", example());
    std::filesystem::create_directory(folder / "a.h5.part");  // in the way of the temporary file
    EXPECT_NE(message_of<FileError>([&] { write_checkpoint(folder / "a.h5", {}); }), "");
    EXPECT_EQ(read_checkpoint(folder / "a.h5").mesh, example().mesh);
}

}  // namespace
}  // namespace kropla
