// The format: Gmsh reference manual, "MSH file format" (4.1) and "MSH file format version 2 (Legacy)". Sections stand
// between $Name and $EndName; those that are not of use here are passed over.

#include <kropla/io/msh.h>

#include "io/file.h"
#include "io/msh_elements.h"
#include "io/scanner.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <unordered_map>

namespace kropla {
namespace {

/// An element as the file has it, its vertices as ours.
struct Element {
    std::uint64_t tag;
    const MshType* type;
    int physical, entity;  // 0: none
    std::array<Vertex, 6> vertices;
};

class MshReader {
public:
    MshReader(const std::filesystem::path& path, std::string_view bytes, const Watch* watch)
        : in_(path, bytes), watch_(watch) {}

    FileCells read() {
        if (in_.word() != "$MeshFormat") in_.fail("is no MSH file of Gmsh: those begin with $MeshFormat");
        read_format();
        bool has_elements = false;
        while (!in_.at_end()) {
            heed(watch_);
            const std::string section(in_.word());
            if (section.size() < 2 || section[0] != '$')
                in_.fail("a section, such as $Nodes, is expected, not \"" + section.substr(0, 40) + "\"");
            read_section(section);
            has_elements = has_elements || section == "$Elements";
        }
        if (!has_elements) in_.fail("ends without $Elements: it is cut off");
        take_elements();
        if (cells_.tets.empty()) in_.fail("has no tets");
        return std::move(cells_);
    }

private:
    void read_format() {
        const std::string version(in_.word());
        if (version != "2.2" && version != "4.1")
            in_.fail("is of MSH version " + version.substr(0, 10) + "; 2.2 and 4.1 are read");
        is_old_ = version == "2.2";
        binary_ = in_.number<int>("the kind of file") == 1;
        if (in_.number<int>("the size of numbers") != 8) in_.fail("has numbers that are not of 8 bytes");
        if (binary_) {
            begin_bytes();
            const int one = in_.number<int>("the number one");
            constexpr int reversed_one = 0x01000000;
            if (one != 1 && one != reversed_one) in_.fail("is binary, but has no number one to tell the order of bytes");
            reversed_ = one != 1;
        }
        end_section("$MeshFormat");
    }

    void begin_bytes() {
        (void)in_.line();  // what is left of the one before
        in_.read_bytes(reversed_);
    }

    void end_section(const std::string& section) {
        in_.read_text();
        const std::string end = "$End" + section.substr(1);
        if (in_.word() != end) in_.fail(section + " does not end with " + end + " where it should");
    }

    void read_section(const std::string& section) {
        if (section == "$PartitionedEntities") in_.fail("is a mesh in parts (partitioned); save it as one");
        const bool known = section == "$PhysicalNames" || section == "$Nodes" || section == "$Elements" ||
                           (section == "$Entities" && !is_old_);
        if (!known) {
            if (!in_.skip_past("$End" + section.substr(1))) in_.fail(section + " has no end: the file is cut off");
            return;
        }
        if (section == "$PhysicalNames") read_names();  // text in binary files too
        else {
            if (binary_) begin_bytes();
            if (section == "$Entities") read_entities();
            else if (section == "$Nodes") is_old_ ? read_old_nodes() : read_nodes();
            else is_old_ ? read_old_elements() : read_elements();
        }
        end_section(section);
    }

    void read_names() {
        const std::size_t count = in_.count("names", 4);
        for (std::size_t i = 0; i < count; ++i) {
            const int dimension = in_.number<int>("the dimension of a name");
            const int number = in_.number<int>("the number of a name");
            const std::string_view line = in_.line();
            const std::size_t begin = line.find('"'), end = line.rfind('"');
            if (begin == end) in_.fail("a name is to stand between quotes");
            const std::string name(line.substr(begin + 1, end - begin - 1));
            if (dimension == 3) cells_.region_names[std::abs(number)] = name;
            if (dimension == 2) cells_.patch_names[std::abs(number)] = name;
        }
    }

    /// Which group each entity is of.
    void read_entities() {
        std::array<std::size_t, 4> counts{};
        for (std::size_t& count : counts) count = in_.count("entities", 1);
        for (std::size_t dimension = 0; dimension < 4; ++dimension)
            for (std::size_t i = 0; i < counts[dimension]; ++i) {
                const int tag = in_.number<int>("the tag of an entity");
                for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) (void)in_.number<double>("the bounds of an entity");
                const int group = read_numbers("groups");
                if (dimension > 0) (void)read_numbers("entities around another");
                if (group != 0) group_of_[dimension][tag] = group;
            }
    }

    /// The first of a list, which is not negative; 0 if it is empty.
    int read_numbers(std::string_view what) {
        const std::size_t count = in_.count(what, 1);
        int first = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const int number = std::abs(in_.number<int>(what));
            if (i == 0) first = number;
        }
        return first;
    }

    void add_node(std::uint64_t tag, const Vec3& x) {
        if (!vertex_.emplace(tag, cells_.position.push_back(x)).second)
            in_.fail("node " + std::to_string(tag) + " is there twice");
    }

    Vec3 read_place() {
        Vec3 x;
        for (int axis = 0; axis < 3; ++axis) x[axis] = in_.number<double>("a coordinate");
        return x;
    }

    void read_old_nodes() {
        const std::size_t count = old_count("nodes", 8);
        vertex_.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            const int tag = in_.number<int>("the number of a node");
            add_node(static_cast<std::uint64_t>(tag), read_place());
        }
    }

    /// In binary files of version 2.2 counts are lines of text.
    std::size_t old_count(std::string_view what, std::size_t least_bytes) {
        in_.read_text();
        const std::size_t count = in_.count(what, least_bytes);
        if (binary_) begin_bytes();
        return count;
    }

    void read_nodes() {
        const std::size_t blocks = in_.count("blocks of nodes", 8);
        vertex_.reserve(in_.count("nodes", 8));
        for (int k = 0; k < 2; ++k) (void)in_.number<std::uint64_t>("a node's tag");
        std::vector<std::uint64_t> tags;
        for (std::size_t block = 0; block < blocks; ++block) {
            const int dimension = in_.number<int>("the dimension of an entity");
            (void)in_.number<int>("the tag of an entity");
            const bool parametric = in_.number<int>("whether nodes have parameters") != 0;
            tags.resize(in_.count("nodes", 8));
            for (auto& tag : tags) tag = in_.number<std::uint64_t>("the tag of a node");
            for (const auto tag : tags) {
                add_node(tag, read_place());
                for (int k = 0; parametric && k < dimension; ++k) (void)in_.number<double>("a parameter");
            }
        }
    }

    const MshType* read_type() {
        const int number = in_.number<int>("the type of an element");
        const auto known = std::ranges::find(msh_types, number, &MshType::number);
        if (known != msh_types.end()) return &*known;
        const auto refused = std::ranges::find(msh_refused, number, &MshType::number);
        in_.fail("has " + (refused != msh_refused.end() ? std::string(refused->name)
                                                        : "elements of type " + std::to_string(number)) +
                 "; only linear tets and prisms, and their facets, are read" +
                 (refused != msh_refused.end() && refused->name.starts_with("second") ? " (Gmsh: SetOrder 1)" : ""));
    }

    Vertex vertex_of(std::uint64_t tag) {
        const auto found = vertex_.find(tag);
        if (found == vertex_.end()) in_.fail("node " + std::to_string(tag) + " of an element is not in the file");
        return found->second;
    }

    template <class Tag>
    void read_corners(Element& element) {
        for (int k = 0; k < element.type->nodes; ++k)
            element.vertices[as_size(k)] = vertex_of(static_cast<std::uint64_t>(in_.number<Tag>("the node of an element")));
        if (element.type->dimension < 2) ++cells_.passed_over;
        else elements_.push_back(element);
    }

    void read_elements() {
        const std::size_t blocks = in_.count("blocks of elements", 8);
        elements_.reserve(in_.count("elements", 4));
        for (int k = 0; k < 2; ++k) (void)in_.number<std::uint64_t>("an element's tag");
        for (std::size_t block = 0; block < blocks; ++block) {
            heed(watch_);
            (void)in_.number<int>("the dimension of an entity");
            Element element{};
            element.entity = in_.number<int>("the tag of an entity");
            element.type = read_type();
            const auto& groups = group_of_[as_size(element.type->dimension)];
            const auto group = groups.find(element.entity);
            element.physical = group == groups.end() ? 0 : group->second;
            const std::size_t count = in_.count("elements", 4);
            for (std::size_t i = 0; i < count; ++i) {
                element.tag = in_.number<std::uint64_t>("the tag of an element");
                read_corners<std::uint64_t>(element);
            }
        }
    }

    /// In version 2.2 an element of several groups stands there once for each, one after another: the first counts.
    void drop_further_group() {
        if (elements_.size() < 2) return;
        const Element &last = elements_.back(), &before = elements_[elements_.size() - 2];
        const bool same = last.type == before.type && last.entity == before.entity && last.vertices == before.vertices;
        if (same && last.physical != before.physical) elements_.pop_back();
    }

    void read_old_elements() {
        const std::size_t count = old_count("elements", 4);
        elements_.reserve(count);
        for (std::size_t i = 0; i < count;) {
            int number = binary_ ? 0 : in_.number<int>("the number of an element");
            Element element{};
            element.type = read_type();
            const int same = binary_ ? in_.number<int>("a number of elements") : 1;
            const int tags = in_.number<int>("a number of tags");
            if (same < 1 || tags < 0) in_.fail("elements are counted with " + std::to_string(std::min(same, tags)));
            for (int k = 0; k < same; ++k, ++i) {
                if (binary_) number = in_.number<int>("the number of an element");
                element.tag = static_cast<std::uint64_t>(number);
                for (int tag = 0; tag < tags; ++tag) {
                    const int value = std::abs(in_.number<int>("a tag of an element"));
                    if (tag == 0) element.physical = value;
                    if (tag == 1) element.entity = value;
                }
                read_corners<int>(element);
                drop_further_group();
            }
        }
    }

    /// Whether any element of the dimension is of a group: where none is, entities stand for groups.
    bool has_groups(int dimension) const {
        return std::ranges::any_of(
            elements_, [&](const Element& e) { return e.type->dimension == dimension && e.physical != 0; });
    }

    Region region_of(int number) const {
        const auto name = cells_.region_names.find(number);
        return name != cells_.region_names.end() && name->second == msh_surroundings ? surroundings : Region(number);
    }

    void take_elements() {
        std::ranges::stable_sort(elements_, {}, &Element::tag);
        const std::array<bool, 4> grouped = {false, false, has_groups(2), has_groups(3)};
        for (const Element& e : elements_) {
            const int number = grouped[as_size(e.type->dimension)] ? e.physical : e.entity;
            const auto& v = e.vertices;
            if (e.type->number == msh_tet) {
                cells_.tets.push_back({v[0], v[1], v[2], v[3]});
                cells_.region.push_back(region_of(number));
            } else if (e.type->number == msh_prism) {
                cells_.prisms.push_back({static_cast<int>(e.tag), v, region_of(number), 0});
            } else if (number == 0) {
                ++cells_.passed_over;
            } else {
                cells_.facets.push_back({{v[0], v[1], v[2], e.type->number == msh_quad ? v[3] : Vertex{}}, number});
            }
        }
        for (auto& [number, name] : Names(cells_.region_names))
            if (name == msh_surroundings) {
                cells_.region_names.erase(number);
                cells_.region_names[surroundings.value] = name;
            }
    }

    Scanner in_;
    const Watch* watch_;
    bool is_old_ = false, binary_ = false, reversed_ = false;
    std::array<std::unordered_map<int, int>, 4> group_of_;  // by dimension, of an entity
    std::unordered_map<std::uint64_t, Vertex> vertex_;      // by the node's tag
    std::vector<Element> elements_;
    FileCells cells_;
};

}  // namespace

FileCells read_msh(const std::filesystem::path& path, const Watch* watch) {
    const std::string bytes = read_file(path);
    return MshReader(path, bytes, watch).read();
}

}  // namespace kropla
