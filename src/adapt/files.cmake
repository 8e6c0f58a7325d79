list(APPEND KROPLA_MESH_FILES
    adapt/star.cpp
    adapt/zone.cpp
    adapt/propose.cpp
    adapt/optimise.cpp
    adapt/smooth.cpp
    adapt/swap.cpp
    adapt/refine.cpp
    adapt/refusal.cpp
    adapt/improve.cpp
    adapt/remesh.cpp
    adapt/way.cpp
    adapt/move.cpp
    adapt/moving_mesh.cpp
)
