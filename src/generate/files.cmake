list(APPEND KROPLA_MESH_FILES
    generate/box.cpp
    generate/clearance.cpp
    generate/conform.cpp
    generate/creases.cpp
    generate/delaunay.cpp
    generate/delaunay_kernel.cpp
    generate/hilbert.cpp
    generate/layers.cpp
    generate/mesh.cpp
    generate/normals.cpp
    generate/points.cpp
    generate/relax.cpp
    generate/resample.cpp
    generate/sampling.cpp
    generate/sheet.cpp
    generate/skin.cpp
    generate/surface.cpp
)
# For users: <kropla/generate/...>.
list(APPEND KROPLA_MESH_HEADERS generate/generate.h)
