// The format: P. J. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253 (2001), section 7.
// Vertices are counted from 1. Keywords that are not of use here are passed over with their numbers.

#include <kropla/io/medit.h>

#include "io/file.h"
#include "io/scanner.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>
#include <string>

namespace kropla {
namespace {

constexpr std::size_t least_line = 2;  // bytes of a number and what parts it from the next

class MeditReader {
public:
    MeditReader(const std::filesystem::path& path, std::string_view bytes, const Watch* watch)
        : in_(path, bytes), watch_(watch) {
        in_.comments('#');
    }

    FileCells read() {
        if (in_.word() != "MeshVersionFormatted")
            in_.fail("is no Medit file: those begin with MeshVersionFormatted (binary ones, .meshb, are not read)");
        (void)in_.number<int>("the version");
        bool ended = false;
        while (!ended && !in_.at_end()) {
            heed(watch_);
            ended = read_part(in_.word());
        }
        if (!ended) in_.fail("ends without the word End: it is cut off");
        if (cells_.tets.empty()) in_.fail("has no tets");
        read_names();
        return std::move(cells_);
    }

private:
    /// Whether this was the last.
    bool read_part(std::string_view keyword) {
        if (keyword == "End") return true;
        if (keyword == "Dimension") read_dimension();
        else if (keyword == "Vertices") read_vertices();
        else if (keyword == "Tetrahedra") read_tets();
        else if (keyword == "Prisms") read_prisms();
        else if (keyword == "Triangles") read_facets(3, "triangles");
        else if (keyword == "Quadrilaterals") read_facets(4, "quadrilaterals");
        else if (keyword == "Hexahedra" || keyword == "Pyramids") refuse_cells(keyword);
        else if (keyword.ends_with("P2") || keyword.ends_with("Q2")) refuse_cells(keyword);
        else pass_over(keyword);
        return false;
    }

    void read_dimension() {
        const int dimension = in_.number<int>("the dimension");
        if (dimension != 3) in_.fail("is of dimension " + std::to_string(dimension) + ", not 3");
    }

    void read_vertices() {
        const std::size_t count = in_.count("vertices", 4 * least_line);
        cells_.position.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            Vec3 x;
            for (int axis = 0; axis < 3; ++axis) x[axis] = in_.number<double>("a coordinate");
            (void)in_.number<int>("the reference of a vertex");
            cells_.position.push_back(x);
        }
    }

    Vertex read_vertex() {
        const int number = in_.number<int>("a vertex");
        if (number < 1 || static_cast<std::size_t>(number) > cells_.position.size())
            in_.fail("vertex " + std::to_string(number) + " is not among the " +
                     std::to_string(cells_.position.size()) + " before it");
        return Vertex(number - 1);
    }

    int read_signed() {
        const int reference = in_.number<int>("a reference");
        if (reference < -std::numeric_limits<int>::max()) in_.fail("a reference is too far below 0");
        return reference;
    }
    int read_reference() { return std::abs(read_signed()); }

    Region read_region() {
        const int reference = read_signed();
        regions_.insert(reference);
        if (reference != 0 && regions_.contains(-reference))
            in_.fail("has cells of " + std::to_string(std::abs(reference)) + " and of " + std::to_string(-std::abs(reference)) +
                     ", which would be one region");
        return Region(std::abs(reference));
    }

    void read_tets() {
        const std::size_t count = in_.count("tets", 5 * least_line);
        cells_.tets.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            std::array<Vertex, 4> tet;
            for (Vertex& v : tet) v = read_vertex();
            cells_.tets.push_back(tet);
            cells_.region.push_back(read_region());
        }
    }

    void read_prisms() {
        const std::size_t count = in_.count("prisms", 7 * least_line);
        for (std::size_t i = 0; i < count; ++i) {
            LoosePrism prism{.cell = static_cast<int>(i), .vertices = {}, .region = {}, .layer = 0};
            for (Vertex& v : prism.vertices) v = read_vertex();
            prism.region = read_region();
            cells_.prisms.push_back(prism);
        }
    }

    void read_facets(std::size_t corners, std::string_view what) {
        const std::size_t count = in_.count(what, (corners + 1) * least_line);
        for (std::size_t i = 0; i < count; ++i) {
            PatchFacet facet;
            for (std::size_t corner = 0; corner < corners; ++corner) facet.vertices[corner] = read_vertex();
            facet.patch = read_reference();
            cells_.facets.push_back(facet);
        }
    }

    void refuse_cells(std::string_view keyword) {
        if (in_.number<std::size_t>("a count") > 0)
            in_.fail("has " + std::string(keyword) + "; only linear tets and prisms are read");
    }

    /// Takes all numbers up to the next keyword.
    void pass_over(std::string_view keyword) {
        if (std::isalpha(static_cast<unsigned char>(keyword.front())) == 0)
            in_.fail("a keyword is expected, not \"" + std::string(keyword.substr(0, 40)) + "\"");
        const bool is_edges = keyword == "Edges";
        if (is_edges) cells_.passed_over += in_.count("edges", 3 * least_line);
        while (!in_.at_end() && std::isalpha(static_cast<unsigned char>(in_.next_word().front())) == 0) (void)in_.word();
    }

    /// From the lines of comment.
    void read_names() {
        std::istringstream lines(in_.passed_comments());
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string hash, kind, name;
            int number = 0;
            if (!(words >> hash >> kind >> number) || hash != "#" || !std::getline(words >> std::ws, name)) continue;
            if (kind == "region") cells_.region_names[number] = name;
            if (kind == "patch") cells_.patch_names[number] = name;
        }
    }

    Scanner in_;
    const Watch* watch_;
    FileCells cells_;
    std::set<int> regions_;  // as the file has them
};

// ---- writing

void append_vertices(std::string& text, std::span<const Vertex> vertices, int reference) {
    for (const Vertex v : vertices) {
        append_number(text, as_size(v.value) + 1);
        text += ' ';
    }
    append_number(text, as_size(reference));
    text += '\n';
}

void append_heading(std::string& text, std::string_view keyword, std::size_t count) {
    text += '\n';
    text += keyword;
    text += '\n' + std::to_string(count) + '\n';
}

void append_names(std::string& text, std::string_view kind, const Names& names) {
    for (const auto& [number, name] : names)
        text += "# " + std::string(kind) + ' ' + std::to_string(number) + ' ' + name + '\n';
}

void append_facets(std::string& text, const std::vector<PatchFacet>& facets, std::string_view keyword, bool quads) {
    const auto is_one = [&](const PatchFacet& facet) { return facet.vertices[3].exists() == quads; };
    const auto count = static_cast<std::size_t>(std::ranges::count_if(facets, is_one));
    if (count == 0) return;
    append_heading(text, keyword, count);
    for (const PatchFacet& facet : facets)
        if (is_one(facet)) append_vertices(text, std::span(facet.vertices).first(quads ? 4 : 3), facet.patch);
}

}  // namespace

FileCells read_medit(const std::filesystem::path& path, const Watch* watch) {
    const std::string bytes = read_file(path);
    return MeditReader(path, bytes, watch).read();
}

void write_medit(const std::filesystem::path& path, const FileCells& cells, const Watch* watch) {
    std::string text = "MeshVersionFormatted 2\nDimension 3\n";
    append_names(text, "region", cells.region_names);
    append_names(text, "patch", cells.patch_names);
    append_heading(text, "Vertices", cells.position.size());
    for (const Vec3& x : cells.position) {
        for (int axis = 0; axis < 3; ++axis) {
            append_number(text, x[axis]);
            text += ' ';
        }
        text += "0\n";
    }
    heed(watch);
    append_heading(text, "Tetrahedra", cells.tets.size());
    for (const Tet t : cells.tets.indices()) append_vertices(text, cells.tets[t], cells.region[t].value);
    if (!cells.prisms.empty()) append_heading(text, "Prisms", cells.prisms.size());
    for (const LoosePrism& prism : cells.prisms) append_vertices(text, prism.vertices, prism.region.value);
    append_facets(text, cells.facets, "Triangles", false);
    append_facets(text, cells.facets, "Quadrilaterals", true);
    text += "\nEnd\n";
    write_file(path, text, watch);
}

}  // namespace kropla
