list(APPEND KROPLA_MESH_FILES
    domain/shape.cpp
    domain/triangle_tree.cpp
    domain/triangulated_surface.cpp
    domain/surface_width.cpp
    domain/sharp_edges.cpp
    domain/thin_places.cpp
    domain/of_mesh.cpp
    domain/body_surface.cpp
    domain/cut.cpp
    domain/solids.cpp
    domain/domain.cpp
    domain/gap.cpp
    domain/layer_fit.cpp
    domain/layer_room.cpp
    domain/approach.cpp
    domain/paths.cpp
    domain/placement.cpp
    domain/words.cpp
)
# For users: <kropla/domain/...>.
list(APPEND KROPLA_MESH_HEADERS domain/domain.h domain/shape.h domain/words.h domain/of_mesh.h
     domain/solids.h)
