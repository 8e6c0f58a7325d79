#include "case/patches.h"

#include "case/heat.h"
#include <kropla/mesh/topology.h>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

/// The patches of the file by the vertices of their triangles.
std::map<Triangle, int> numbers_of_facets(const FileCells& cells) {
    std::map<Triangle, int> numbers;
    for (const PatchFacet& facet : cells.facets)
        if (!facet.vertices[3].exists()) numbers[sorted({facet.vertices[0], facet.vertices[1], facet.vertices[2]})] = facet.patch;
    return numbers;
}

constexpr int nothing = -1;  // the number of a facet of no patch

}  // namespace

std::map<std::string, Patch> faces_of_patches(const Mesh& mesh, const FileCells& cells) {
    const std::map<Triangle, int> numbers = numbers_of_facets(cells);
    std::map<int, std::set<Patch>> faces_at;    // of the box, by the file's patch
    std::map<Patch, std::set<int>> patches_at;  // the other way round
    for (const Tet t : all_tets(mesh))
        for (int corner = 0; corner < 4; ++corner) {
            if (mesh.neighbour[t][as_size(corner)].exists()) continue;
            const auto found = numbers.find(sorted(facet_vertices(mesh, {t, corner})));
            const int number = found == numbers.end() ? nothing : found->second;
            faces_at[number].insert(mesh.patch[t][as_size(corner)]);
            patches_at[mesh.patch[t][as_size(corner)]].insert(number);
        }
    std::map<std::string, Patch> faces;
    for (const auto& [number, name] : cells.patch_names) {
        const auto& at = faces_at[number];
        const bool is_face = at.size() == 1 && at.begin()->value < box_faces && patches_at[*at.begin()].size() == 1;
        faces[name] = is_face ? *at.begin() : Patch{};
    }
    return faces;
}

namespace {

/// Has a mesh facets in a face of the box that holds it?
bool has_facets_in(const Mesh& mesh, Patch face) {
    for (const Tet t : all_tets(mesh))
        for (std::size_t corner = 0; corner < 4; ++corner)
            if (!mesh.neighbour[t][corner].exists() && mesh.patch[t][corner] == face) return true;
    return false;
}

/// Of a name that is a face of the box itself. Throws CaseError if it is a patch's too, of another face, or if nothing is there
/// that what is told could act on.
void check_face(const CaseTable& table, const Case& given, const std::string& name) {
    if (table.holds_text(name) && (table.text(name) == "wall" || table.text(name) == "insulated")) return;
    const auto face = Patch(static_cast<int>(std::ranges::find(face_keys, name) - face_keys.begin()));
    if (const auto patch = given.mesh->faces.find(name); patch != given.mesh->faces.end() && patch->second != face)
        table.refuse(name, "is a face of the box, and the mesh has a patch of that name elsewhere: that is to have another name");
    if (!has_facets_in(*given.mesh->mesh, face)) table.refuse(name, "is a face of the box that holds the mesh; nothing of the mesh is in it");
}

/// The key of a face, or "" if the name is no patch's. Throws CaseError if the patch is no face.
std::string_view key_of(const CaseTable& table, const Case& given, const std::string& name) {
    if (std::ranges::find(face_keys, name) != face_keys.end()) {
        check_face(table, given, name);
        return "";
    }
    const auto patch = given.mesh->faces.find(name);
    if (patch == given.mesh->faces.end()) return "";
    if (!patch->second.exists())
        table.refuse(name, fmt::format("is a patch that is no face of the box as a whole; conditions are known at those only: {}",
                                       fmt::join(face_keys, ", ")));
    const std::string_view key = face_keys[as_size(patch->second.value)];
    if (table.has(key)) table.refuse(name, fmt::format("is {}, which stands there too", key));
    return key;
}

void rename_keys(const CaseTable& owner, const Case& given, toml::table& table) {
    if (!owner.has("face") || !owner.holds_table("face")) return;
    const CaseTable face = owner.table("face");
    std::vector<std::string> known(face_keys.begin(), face_keys.end());
    for (const auto& [name, patch] : given.mesh->faces) known.push_back(name);
    face.allow(known);
    toml::table& keys = *table["face"].as_table();
    for (const std::string& name : face.keys()) {
        const std::string_view key = key_of(face, given, name);
        if (key.empty()) continue;
        keys.insert_or_assign(key, std::move(*keys.get(name)));
        keys.erase(name);
    }
}

}  // namespace

void name_faces(const CaseTable& file, const Case& given, toml::table& table) {
    if (!given.mesh) return;
    for (const char* owner : {"heat", "flow"})
        if (file.has(owner) && file.holds_table(owner)) rename_keys(file.table(owner), given, *table[owner].as_table());
    if (!file.has("species")) return;
    const std::vector<CaseTable> species = file.tables("species");
    for (std::size_t i = 0; i < species.size(); ++i) rename_keys(species[i], given, *table["species"][i].as_table());
}

}  // namespace kropla
