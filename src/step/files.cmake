list(APPEND KROPLA_MESH_FILES
    step/initial_mesh.cpp
    step/fields.cpp
    step/advance.cpp
)
