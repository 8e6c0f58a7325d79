list(APPEND KROPLA_MESH_FILES
    base/tetrahedron.cpp
    base/predicates.cpp
)
