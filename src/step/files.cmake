list(APPEND KROPLA_MESH_FILES
    step/improve_mesh.cpp
    step/initial_mesh.cpp
    step/remesh_interfaces.cpp
    step/fields.cpp
    step/advance.cpp
)
# For users: <kropla/step/...>.
list(APPEND KROPLA_MESH_HEADERS step/fields.h step/advance.h step/improve_mesh.h step/initial_mesh.h step/remesh_interfaces.h
     step/stuck.h)
