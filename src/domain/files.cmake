list(APPEND KROPLA_MESH_FILES
    domain/shape.cpp
    domain/domain.cpp
    domain/gap.cpp
    domain/layer_fit.cpp
    domain/layer_room.cpp
    domain/placement.cpp
)
