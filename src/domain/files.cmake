list(APPEND KROPLA_MESH_FILES
    domain/shape.cpp
    domain/domain.cpp
    domain/placement.cpp
)
