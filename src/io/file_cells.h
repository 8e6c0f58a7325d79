#pragma once

#include <kropla/io/stacks.h>
#include <kropla/simulate/fields.h>

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace kropla {

/// Names of numbered parts; those that have none are left out.
using Names = std::map<int, std::string>;

/// A facet of a surface that a file gives a number: on the boundary, between two regions, or within one.
struct PatchFacet {
    std::array<Vertex, 4> vertices;  // of a triangle, the last does not exist; either way round
    int patch = 0;

    bool operator==(const PatchFacet&) const = default;
};

/// What a mesh file says, before neighbours are known: cells as they stand, right or wrong.
struct FileCells {
    Array<Vertex, Vec3> position;            // [m]
    Array<Tet, std::array<Vertex, 4>> tets;  // vertices exist; orientation and conformity are not looked at
    Array<Tet, Region> region;               // the file's numbers; 0 where it has none
    std::vector<LoosePrism> prisms;          // vertices exist; layer 0: the file does not say
    std::vector<PatchFacet> facets = {};     // vertices exist; they need not be all of the boundary
    Names region_names = {}, patch_names = {};
    std::vector<NodalField> fields = {};          // point arrays of one component
    std::vector<NodalVectorField> vectors = {};   // of three
    std::size_t passed_over = 0;             // cells of surfaces without a number, of lines and points
};

/// What `tidy` did.
struct Tidied {
    std::size_t unused = 0;  // vertices of no cell, dropped
    std::size_t united = 0;  // vertices at the place of another, exactly, which took their part
    std::size_t turned = 0;  // tets and prisms that were inside out
};

/// Makes one vertex of those at one place, drops vertices of no cell, turns cells round that are inside out (the sign
/// of a tet's volume is exact; flat ones stay). The order of what stays is kept.
Tidied tidy(FileCells& cells);

/// Drops vertices of no cell, and facets that had one; returns how many vertices.
std::size_t drop_unused(FileCells& cells);

/// The facets that have one cell, in the order of the cells, all of the patch given.
[[nodiscard]] std::vector<PatchFacet> boundary_of(const FileCells& cells, int patch);

/// Where the file has no facets, gives it those of its boundary, as one patch of the name "boundary". Returns whether
/// it did.
bool add_boundary(FileCells& cells);

/// Gives the prisms their layers, counted from where two regions meet, if the file does not: turns them so that they
/// stand on it. Throws FileError, naming the cell but not the file, if one is in no such stack.
void number_layers(FileCells& cells);

/// The cells of a mesh, without its free slots, tets before prisms, and its boundary by patches, each as its number
/// and one: the names that `patch_names` has are of those. Facets of layers are no boundary.
[[nodiscard]] FileCells cells_of(const Mesh& mesh, Names region_names = {}, Names patch_names = {});

/// The numbers of the regions that have cells, and of the patches that have facets, ascending.
[[nodiscard]] std::vector<int> region_numbers(const FileCells& cells);
[[nodiscard]] std::vector<int> patch_numbers(const FileCells& cells);

}  // namespace kropla
