#include <kropla/base/error.h>
#include "examples.h"
#include "io/file.h"
#include <kropla/io/vtk.h>

/// Asked by the leak sanitizer: VTK's reader loses its array of cell types where it stops at certain errors.
extern "C" const char* __lsan_default_suppressions() { return "leak:vtkUnsignedCharArray"; }

namespace kropla {
namespace {

/// A tet in plain text, with these arrays of points, of cells and of the whole file.
std::string in_plain_text(const std::string& points, const std::string& cells, const std::string& whole) {
    return "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
           "<UnstructuredGrid><FieldData>" + whole + "</FieldData>\n"
           "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<PointData>" + points + "</PointData><CellData>" + cells +
           "</CellData>\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
           "0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>\n"
           "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells>\n"
           "</Piece></UnstructuredGrid></VTKFile>\n";
}

std::string array_of(const std::string& type, const std::string& values, const std::string& more = "") {
    return "<DataArray type=\"" + type + "\" Name=\"a\" " + more + " format=\"ascii\">" + values + "</DataArray>";
}

/// What is said of these bytes as a VTU file; empty if it is read.
std::string refusal(const std::filesystem::path& path, const std::string& bytes) {
    put(path, bytes);
    try {
        (void)read_vtu(path);
        return "";
    } catch (const FileError& error) {
        return error.what();
    }
}

/// Reads the bytes as a VTU file: whether it was refused. Anything but a mesh or a FileError ends the test.
bool refused(const std::filesystem::path& path, const std::string& bytes) {
    return !refusal(path, bytes).empty();
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

TEST(DamagedVtu, ValuesInPlainTextAreOfTheirTypeAndAllThere) {
    const Folder folder;
    const auto expect = [&](const std::string& points, const std::string& cells, const std::string& whole, const char* said) {
        const std::string found = refusal(folder / "a.vtu", in_plain_text(points, cells, whole));
        if (*said == 0) EXPECT_EQ(found, "");
        else EXPECT_NE(found.find(said), std::string::npos) << found;
    };
    const std::string two_texts = "NumberOfTuples=\"2\"";
    expect(array_of("Float64", "1 +2.5 -3e2 4"), array_of("Int32", "7"), array_of("String", "65 0 66 0", two_texts), "");
    expect(array_of("String", "65 66"), array_of("String", ""), "", "");  // such are not read
    expect(array_of("Float64", "1 2 3"), "", "", "the array a has fewer values than are promised");
    expect(array_of("Float64", "1 2 3 4", "NumberOfComponents=\"2\""), "", "", "has fewer values");
    expect(array_of("Float64", "1 2 3 4", "NumberOfComponents=\"-1\""), "", "", "how many components");
    expect(array_of("Float64", "1 2 x 4"), "", "", "holds \"x\", which is not a finite number of the type Float64");
    expect(array_of("Float64", "1 2 nan 4"), "", "", "holds \"nan\"");
    expect("", array_of("Int32", "1.5"), "", "holds \"1.5\", which is not a finite number of the type Int32");
    expect("", array_of("Int32", "99999999999"), "", "holds \"99999999999\"");
    expect("", array_of("Foo", "1"), "", "the type \"Foo\", which is none of VTK's");
    expect("", "", array_of("Foo", "1"), "the type \"Foo\", which is none of VTK's");
    expect("", "", array_of("String", "65 0 66", two_texts), "");  // nor is this one, but as bytes
    expect("", "", array_of("String", "65 0 66 0 67 0", two_texts), "");
    expect("", "", array_of("String", "65 300", two_texts), "holds \"300\", which is not a finite number of the type String");
}

TEST(DamagedVtu, FlippedBytesOfPlainTextNeverDoHarm) {
    const Folder folder;
    const std::string good = in_plain_text(array_of("Float64", "1 2 3 4") + array_of("String", "65 0 66 0 67 0 68 0"),
                                           array_of("Int32", "7") + array_of("String", "65 0"),
                                           array_of("String", "65 0 66 0", "NumberOfTuples=\"2\""));
    ASSERT_FALSE(refused(folder / "a.vtu", good));
    testing::internal::CaptureStderr();
    for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
        SCOPED_TRACE(seed);
        Random random{seed};
        std::string bad = good;
        for (std::uint64_t flips = 1 + random.below(3); flips > 0; --flips) {
            const std::size_t at = random.below(bad.size());
            if (random.below(3) == 0) bad.erase(at, 1 + random.below(12));
            else bad[at] = static_cast<char>(seed % 2 == 0 ? '0' + random.below(10) : random.bits() & 0x7f);
        }
        (void)refused(folder / "a.vtu", bad);
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
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
