list(APPEND KROPLA_MESH_FILES
    transfer/locate.cpp
    transfer/carry.cpp
)
