// A checkpoint is an HDF5 file made and read in memory (HDF5's core driver); the disk is io/file.h's
// business. In HDF5's user block, the first 512 bytes, which HDF5 itself passes over, stands one line of
// text:
//
//     Kropla checkpoint, format 2, 123456 bytes, checksum 0123456789abcdef
//
// so that a file that is foreign, of another version, truncated or damaged is known before HDF5 reads it. The
// checksum, of all after the user block, is made as FNV-1a of 64 bits [Fowler, Noll, Vo 1991], here by words
// of 8 bytes, for speed.
//
//     /                   attributes format, time [s], next_dt [s], step; dataset case (text)
//     /mesh               position (n x 3), tet_at, layer_at, tets (m x 4), neighbour (m x 4), patch (m x 4),
//                         region, free_tets, free_vertices; -1 names nothing
//     /mesh/layers/0, ... attributes region, body, count; datasets triangles (k x 3), columns
//     /fields/0, 1, ...   attributes name, unit; dataset values (n)
//     /values             an attribute each

#include <kropla/io/checkpoint.h>

#include <kropla/base/error.h>
#include "io/file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <hdf5.h>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>

namespace kropla {
namespace {

constexpr int format_version = 2;
constexpr std::size_t user_block = 512;  // [bytes] the least that HDF5 allows

/// What HDF5 refuses; the path is put before it where it is known.
struct HdfError : std::runtime_error { using runtime_error::runtime_error; };

hid_t opened(hid_t id, const char* what) {
    if (id < 0) throw HdfError(std::string("HDF5 cannot ") + what);
    return id;
}

void check(herr_t status, const char* what) {
    if (status < 0) throw HdfError(std::string("HDF5 cannot ") + what);
}

/// Owns one thing of HDF5.
template <herr_t (*Close)(hid_t)>
class Owner {
public:
    Owner(hid_t id, const char* what) : id_(opened(id, what)) {}
    ~Owner() { Close(id_); }
    Owner(const Owner&) = delete;
    Owner& operator=(const Owner&) = delete;
    operator hid_t() const { return id_; }

private:
    hid_t id_;
};
using File = Owner<H5Fclose>;
using Group = Owner<H5Gclose>;
using Dataset = Owner<H5Dclose>;
using Dataspace = Owner<H5Sclose>;
using Datatype = Owner<H5Tclose>;
using Attribute = Owner<H5Aclose>;
using Properties = Owner<H5Pclose>;

/// While it lives, HDF5 does not print its errors.
class QuietHdf {
public:
    QuietHdf() {
        H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~QuietHdf() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
    QuietHdf(const QuietHdf&) = delete;
    QuietHdf& operator=(const QuietHdf&) = delete;

private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

// ---- arrays: each element is one number, or a row of Width numbers of one kind

template <class T>
struct Layout;  // of an element in memory
template <>
struct Layout<double> {
    static constexpr hsize_t width = 1;
    static hid_t type() { return H5T_NATIVE_DOUBLE; }
};
template <>
struct Layout<char> {
    static constexpr hsize_t width = 1;
    static hid_t type() { return H5T_NATIVE_CHAR; }
};
template <>
struct Layout<Vec3> {
    static constexpr hsize_t width = 3;
    static hid_t type() { return H5T_NATIVE_DOUBLE; }
};
template <class Tag>
struct Layout<Index<Tag>> {
    static constexpr hsize_t width = 1;
    static hid_t type() { return H5T_NATIVE_INT32; }
};
template <>
struct Layout<int> {
    static constexpr hsize_t width = 1;
    static hid_t type() { return H5T_NATIVE_INT; }
};
template <class Item, std::size_t N>
struct Layout<std::array<Item, N>> {
    static constexpr hsize_t width = N;
    static hid_t type() { return Layout<Item>::type(); }
};

template <class Sequence>
void write_array(hid_t parent, const char* name, const Sequence& items) {
    using Element = std::remove_cvref_t<decltype(*items.data())>;
    static_assert(std::is_trivially_copyable_v<Element>);
    const std::array<hsize_t, 2> shape = {items.size(), Layout<Element>::width};
    const Dataspace space(H5Screate_simple(shape[1] == 1 ? 1 : 2, shape.data(), nullptr), "make a dataspace");
    const Dataset set(
        H5Dcreate2(parent, name, Layout<Element>::type(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        "make a dataset");
    if (items.size() > 0)
        check(H5Dwrite(set, Layout<Element>::type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, items.data()),
              "write a dataset");
}

template <class Sequence>
void read_array(hid_t parent, const char* name, Sequence& items) {
    using Element = std::remove_cvref_t<decltype(*items.data())>;
    const Dataset set(H5Dopen2(parent, name, H5P_DEFAULT), "find a dataset");
    const Dataspace space(H5Dget_space(set), "tell a dataset's shape");
    constexpr int rank = Layout<Element>::width == 1 ? 1 : 2;
    std::array<hsize_t, 2> shape = {0, 1};
    if (H5Sget_simple_extent_ndims(space) != rank ||
        H5Sget_simple_extent_dims(space, shape.data(), nullptr) != rank || shape[1] != Layout<Element>::width)
        throw HdfError(std::string("the dataset ") + name + " has another shape than expected");
    items.resize(shape[0]);
    if (shape[0] > 0)
        check(H5Dread(set, Layout<Element>::type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, items.data()),
              "read a dataset");
}

// ---- attributes

template <class Number>
hid_t type_of() {
    return std::is_same_v<Number, double> ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
}

template <class Number>
void write_number(hid_t parent, const char* name, Number value) {
    const Dataspace space(H5Screate(H5S_SCALAR), "make a dataspace");
    const Attribute attribute(H5Acreate2(parent, name, type_of<Number>(), space, H5P_DEFAULT, H5P_DEFAULT),
                              "make an attribute");
    check(H5Awrite(attribute, type_of<Number>(), &value), "write an attribute");
}

template <class Number>
Number read_number(hid_t parent, const char* name) {
    const Attribute attribute(H5Aopen(parent, name, H5P_DEFAULT), "find an attribute");
    Number value = 0;
    check(H5Aread(attribute, type_of<Number>(), &value), "read an attribute");
    return value;
}

/// With its closing zero, as HDF5 has no strings of length 0.
void write_text(hid_t parent, const char* name, const std::string& text) {
    const Datatype type(H5Tcopy(H5T_C_S1), "make a type");
    check(H5Tset_size(type, text.size() + 1), "make a type");
    const Dataspace space(H5Screate(H5S_SCALAR), "make a dataspace");
    const Attribute attribute(H5Acreate2(parent, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                              "make an attribute");
    check(H5Awrite(attribute, type, text.c_str()), "write an attribute");
}

std::string read_text(hid_t parent, const char* name) {
    const Attribute attribute(H5Aopen(parent, name, H5P_DEFAULT), "find an attribute");
    const Datatype type(H5Aget_type(attribute), "tell an attribute's type");
    std::string text(H5Tget_size(type), '\0');
    check(H5Aread(attribute, type, text.data()), "read an attribute");
    text.pop_back();
    return text;
}

// ---- the parts

Group new_group(hid_t parent, const std::string& name) {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "make a group"};
}

/// How many groups 0, 1, ... there are.
std::size_t count_groups(hid_t all) {
    H5G_info_t info = {};
    check(H5Gget_info(all, &info), "count the parts of a group");
    return info.nlinks;
}

void write_layers(hid_t parent, const std::vector<PrismLayer>& layers) {
    const Group all = new_group(parent, "layers");
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Group one = new_group(all, std::to_string(i));
        write_number<std::int64_t>(one, "region", layers[i].region.value);
        write_number<std::int64_t>(one, "body", layers[i].body.value);
        write_number<std::int64_t>(one, "count", layers[i].count);
        write_array(one, "triangles", layers[i].triangles);
        write_array(one, "columns", layers[i].columns);
    }
}

std::vector<PrismLayer> read_layers(hid_t parent) {
    const Group all(H5Gopen2(parent, "layers", H5P_DEFAULT), "find the group layers");
    std::vector<PrismLayer> layers(count_groups(all));
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Group one(H5Gopen2(all, std::to_string(i).c_str(), H5P_DEFAULT), "find a layer");
        const auto number = [&](const char* name) {
            return static_cast<std::int32_t>(read_number<std::int64_t>(one, name));
        };
        layers[i].region = Region(number("region"));
        layers[i].body = Region(number("body"));
        layers[i].count = number("count");
        read_array(one, "triangles", layers[i].triangles);
        read_array(one, "columns", layers[i].columns);
    }
    return layers;
}

/// Calls visit(name, array) for each array of the mesh: what is written is what is read.
template <class AnyMesh, class Visit>
void for_each_array(AnyMesh& mesh, const Visit& visit) {
    visit("position", mesh.position);
    visit("tet_at", mesh.tet_at);
    visit("layer_at", mesh.layer_at);
    visit("tets", mesh.tets);
    visit("neighbour", mesh.neighbour);
    visit("patch", mesh.patch);
    visit("region", mesh.region);
    visit("free_tets", mesh.free_tets);
    visit("free_vertices", mesh.free_vertices);
}

void write_mesh(hid_t file, const Mesh& mesh) {
    const Group group = new_group(file, "mesh");
    for_each_array(mesh, [&](const char* name, const auto& items) { write_array(group, name, items); });
    write_layers(group, mesh.layers);
}

Mesh read_mesh(hid_t file) {
    const Group group(H5Gopen2(file, "mesh", H5P_DEFAULT), "find the group mesh");
    Mesh mesh;
    for_each_array(mesh, [&](const char* name, auto& items) { read_array(group, name, items); });
    mesh.layers = read_layers(group);
    return mesh;
}

void write_fields(hid_t file, const std::vector<NodalField>& fields) {
    const Group all = new_group(file, "fields");
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const Group one = new_group(all, std::to_string(i));
        write_text(one, "name", fields[i].name);
        write_text(one, "unit", fields[i].unit);
        write_array(one, "values", fields[i].values);
    }
}

std::vector<NodalField> read_fields(hid_t file) {
    const Group all(H5Gopen2(file, "fields", H5P_DEFAULT), "find the group fields");
    std::vector<NodalField> fields(count_groups(all));
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const Group one(H5Gopen2(all, std::to_string(i).c_str(), H5P_DEFAULT), "find a field");
        fields[i].name = read_text(one, "name");
        fields[i].unit = read_text(one, "unit");
        read_array(one, "values", fields[i].values);
    }
    return fields;
}

void write_values(hid_t file, const std::map<std::string, double>& values) {
    const Group group = new_group(file, "values");
    for (const auto& [name, value] : values) write_number(group, name.c_str(), value);
}

std::map<std::string, double> read_values(hid_t file) {
    const Group group(H5Gopen2(file, "values", H5P_DEFAULT), "find the group values");
    std::map<std::string, double> values;
    const auto add = [](hid_t parent, const char* name, const H5A_info_t*, void* found) -> herr_t {
        // No exception may pass through HDF5's own code.
        try {
            static_cast<std::map<std::string, double>*>(found)->emplace(name,
                                                                        read_number<double>(parent, name));
            return 0;
        } catch (const std::exception&) {
            return -1;
        }
    };
    check(H5Aiterate2(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &values), "read the values");
    return values;
}

// ---- the file as a whole

std::uint64_t checksum(std::string_view bytes) {
    constexpr std::uint64_t offset = 0xcbf29ce484222325u, prime = 0x100000001b3u;
    std::uint64_t sum = offset;
    while (!bytes.empty()) {
        std::uint64_t word = 0;
        const std::size_t size = std::min(bytes.size(), sizeof word);
        std::memcpy(&word, bytes.data(), size);
        sum = std::rotl((sum ^ word) * prime, 29);  // turned: the product alone never reaches the lower bits
        bytes.remove_prefix(size);
    }
    return sum;
}

/// The line in the user block.
std::string header(std::string_view body) {
    std::array<char, 128> line = {};
    std::snprintf(line.data(), line.size(), "Kropla checkpoint, format %d, %zu bytes, checksum %016llx\n",
                  format_version, body.size(), static_cast<unsigned long long>(checksum(body)));
    return line.data();
}

/// Throws FileError unless the file is a whole checkpoint of our version.
void check_header(const std::filesystem::path& path, const std::string& bytes) {
    int version = 0;
    std::size_t size = 0;
    const int found = std::sscanf(bytes.c_str(), "Kropla checkpoint, format %d, %zu bytes", &version, &size);
    if (found < 1) throw FileError(path.string() + ": is not a checkpoint of Kropla");
    if (version != format_version)
        throw FileError(path.string() + ": is a checkpoint of format " + std::to_string(version) +
                        ", this program reads format " + std::to_string(format_version));
    if (found < 2 || bytes.size() < user_block || bytes.size() - user_block < size)
        throw FileError(path.string() + ": is truncated");
    const std::string_view body = std::string_view(bytes).substr(user_block);
    if (!bytes.starts_with(header(body)))
        throw FileError(path.string() + ": is damaged: its checksum is wrong");
}

std::string file_image(const Checkpoint& checkpoint) {
    const Properties creation(H5Pcreate(H5P_FILE_CREATE), "make properties");
    check(H5Pset_userblock(creation, user_block), "leave room for a user block");
    const Properties access(H5Pcreate(H5P_FILE_ACCESS), "make properties");
    constexpr std::size_t growth = std::size_t{1} << 22;  // [bytes] by which the memory grows
    check(H5Pset_fapl_core(access, growth, false), "work in memory");
    const File file(H5Fcreate("checkpoint", H5F_ACC_TRUNC, creation, access), "make a file in memory");

    write_number<std::int64_t>(file, "format", format_version);
    write_number(file, "time", checkpoint.time);
    write_number(file, "next_dt", checkpoint.next_dt);
    write_number(file, "step", checkpoint.step);
    write_array(file, "case", checkpoint.case_text);
    write_mesh(file, checkpoint.mesh);
    write_fields(file, checkpoint.fields);
    write_values(file, checkpoint.values);

    check(H5Fflush(file, H5F_SCOPE_GLOBAL), "flush the file");
    const ssize_t size = H5Fget_file_image(file, nullptr, 0);
    if (size < 0) throw HdfError("HDF5 cannot tell the size of the file");
    std::string image(user_block + static_cast<std::size_t>(size), '\0');  // HDF5 gives what comes after it
    if (H5Fget_file_image(file, image.data() + user_block, static_cast<std::size_t>(size)) != size)
        throw HdfError("HDF5 cannot give the file");
    return image;
}

Checkpoint parse(std::string& image) {
    const Properties access(H5Pcreate(H5P_FILE_ACCESS), "make properties");
    check(H5Pset_fapl_core(access, std::size_t{1} << 16, false), "work in memory");
    check(H5Pset_file_image(access, image.data(), image.size()), "take the file from memory");
    const File file(H5Fopen("checkpoint", H5F_ACC_RDONLY, access), "open the file");
    Checkpoint checkpoint;
    checkpoint.time = read_number<double>(file, "time");
    checkpoint.next_dt = read_number<double>(file, "next_dt");
    checkpoint.step = read_number<std::int64_t>(file, "step");
    read_array(file, "case", checkpoint.case_text);
    checkpoint.mesh = read_mesh(file);
    checkpoint.fields = read_fields(file);
    checkpoint.values = read_values(file);
    return checkpoint;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
    const QuietHdf quiet;
    try {
        std::string image = file_image(checkpoint);
        const std::string line = header(std::string_view(image).substr(user_block));
        image.replace(0, line.size(), line);
        write_file(path, image);
    } catch (const HdfError& error) {
        throw FileError(path.string() + ": cannot be written: " + error.what());
    }
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    std::string image = read_file(path);
    check_header(path, image);
    const QuietHdf quiet;
    try {
        return parse(image);
    } catch (const HdfError& error) {
        throw FileError(path.string() + ": is damaged: " + error.what());
    }
}

}  // namespace kropla
