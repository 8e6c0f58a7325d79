list(APPEND KROPLA_MESH_FILES
    mesh/mesh.cpp
    mesh/topology.cpp
    mesh/cavity.cpp
    mesh/prisms.cpp
    mesh/quality.cpp
    mesh/crossing.cpp
    mesh/verify.cpp
    mesh/verify_layers.cpp
)
