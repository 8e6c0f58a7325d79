list(APPEND KROPLA_MESH_FILES
    generate/delaunay.cpp
    generate/hilbert.cpp
)
