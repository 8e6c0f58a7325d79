list(APPEND KROPLA_MESH_FILES
    generate/box.cpp
    generate/clearance.cpp
    generate/delaunay.cpp
    generate/delaunay_kernel.cpp
    generate/hilbert.cpp
    generate/mesh.cpp
    generate/points.cpp
    generate/relax.cpp
    generate/sampling.cpp
    generate/skin.cpp
    generate/surface.cpp
)
