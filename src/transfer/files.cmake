list(APPEND KROPLA_MESH_FILES
    transfer/locate.cpp
    transfer/on_interface.cpp
    transfer/changed.cpp
    transfer/clip.cpp
    transfer/overlap.cpp
    transfer/cluster.cpp
    transfer/mass.cpp
    transfer/limit.cpp
    transfer/plan.cpp
    transfer/kept.cpp
    transfer/project.cpp
    transfer/project_cells.cpp
)
# For users: <kropla/transfer/...>.
list(APPEND KROPLA_MESH_HEADERS transfer/transfer.h)
