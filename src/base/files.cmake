list(APPEND KROPLA_MESH_FILES
    base/tetrahedron.cpp
    base/predicates.cpp
)
# For users: <kropla/base/...>.
list(APPEND KROPLA_MESH_HEADERS base/error.h base/index.h base/predicates.h base/vec3.h base/watch.h)
