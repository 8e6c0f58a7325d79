#include "adapt/propose.h"

namespace kropla {

void rename_inserted(Cavity& cavity, Vertex then, const Mesh& now) {
    if (cavity.inserted.empty()) return;
    const Vertex name = next_vertex(now);
    for (NewTet& tet : cavity.added) std::ranges::replace(tet.vertices, then, name);
}

}  // namespace kropla
