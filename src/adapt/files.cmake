list(APPEND KROPLA_MESH_FILES
    adapt/star.cpp
    adapt/zone.cpp
    adapt/propose.cpp
    adapt/optimise.cpp
    adapt/smooth.cpp
    adapt/paper.cpp
    adapt/swap.cpp
    adapt/refine.cpp
    adapt/refusal.cpp
    adapt/improve.cpp
    adapt/remesh.cpp
    adapt/surface_star.cpp
    adapt/surface_volume.cpp
    adapt/surface.cpp
    adapt/surface_collapse.cpp
    adapt/adapt_surface.cpp
    adapt/way.cpp
    adapt/move.cpp
    adapt/correction.cpp
    adapt/mesh_step.cpp
    adapt/step_surfaces.cpp
    adapt/fits_domain.cpp
    adapt/moving_mesh.cpp
    adapt/attempt.cpp
)
# For users: <kropla/adapt/...>.
list(APPEND KROPLA_MESH_HEADERS adapt/adapt.h adapt/refusal.h adapt/moving_mesh.h adapt/attempt.h)
