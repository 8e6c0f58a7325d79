list(APPEND KROPLA_MESH_FILES
    mesh/mesh.cpp
    mesh/topology.cpp
    mesh/triangle.cpp
    mesh/cavity.cpp
    mesh/prisms.cpp
    mesh/quality.cpp
    mesh/crossing.cpp
    mesh/verify.cpp
    mesh/verify_layers.cpp
)
# For users: <kropla/mesh/...>.
list(APPEND KROPLA_MESH_HEADERS mesh/mesh.h mesh/cells.h mesh/topology.h mesh/cavity.h mesh/quality.h mesh/verify.h mesh/prisms.h)
