# The library as its users meet it: installed from the tree that was built, found by a project of its own, and
# configured without anything but oneTBB. Run by ctest:
#   cmake -D BUILD=... -D SOURCE=... -D WORK=... -D CXX=... -D OTHER=... -P package_test.cmake
# CXX made the library in BUILD, or is to make a shared one; OTHER is another compiler, which may be the same.
function(run expected)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0 OR NOT output MATCHES "${expected}")
        message(FATAL_ERROR "${ARGN}\nreturned ${result}, or its output has no '${expected}':\n${output}")
    endif()
endfunction()

set(compilers ${CXX} ${OTHER})
list(REMOVE_DUPLICATES compilers)
set(without_the_rest "")
foreach(package PkgConfig MPI HDF5 VTK tomlplusplus CLI11 fmt GTest)
    list(APPEND without_the_rest -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)  # an error where it is required
endforeach()

# The examples, by each compiler against what is installed in `prefix`, and run.
function(run_examples prefix folder)
    foreach(compiler ${compilers})
        cmake_path(GET compiler FILENAME name)
        set(build ${folder}-${name})
        run("" ${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${build} ${without_the_rest}
            -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release)
        run("" ${CMAKE_COMMAND} --build ${build})
        run("worst R/r.*\n3.00 +[0-9]+ +[3-9][.]" ${build}/moving_sphere)
        run("worst R/r.*\n1.00 +[0-9]+ +[3-9][.]" ${build}/own_mesh)
        run("1.00 +worst R/r +[3-9][.].* heat lost +-?[0-9.]+e-1[2-9] " ${build}/carry_fields)
    endforeach()
endfunction()

file(REMOVE_RECURSE ${WORK})
if(SHARED)
    # The library alone, shared, by this compiler; found by CMake and by pkg-config; taken away again.
    run("" ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build ${without_the_rest} -D KROPLA_LIBRARY_ONLY=ON
        -D CMAKE_CXX_COMPILER=${CXX}
        -D KROPLA_DEVELOPER=ON -D BUILD_SHARED_LIBS=ON -D CMAKE_BUILD_TYPE=Release
        -D CMAKE_INSTALL_PREFIX=${WORK}/prefix -D CMAKE_INSTALL_LIBDIR=lib)
    run("" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
    run("kropla_mesh.so" ${CMAKE_COMMAND} --install ${WORK}/build)
    run_examples(${WORK}/prefix ${WORK}/examples)
    set(ENV{PKG_CONFIG_PATH} ${WORK}/prefix/lib/pkgconfig)
    run("" sh -c "${CXX} -std=c++20 ${SOURCE}/examples/moving_sphere.cpp -o ${WORK}/by_pkg_config \
                  $(pkg-config --cflags --libs kropla) -Wl,-rpath,${WORK}/prefix/lib")
    run("worst R/r.*\n3.00 +[0-9]+ +[3-9][.]" ${WORK}/by_pkg_config)
    run("Removing" ${CMAKE_COMMAND} --build ${WORK}/build --target uninstall)
    file(GLOB_RECURSE left ${WORK}/prefix/*)
    if(left)
        message(FATAL_ERROR "uninstall leaves ${left}")
    endif()
    return()
endif()
run("KroplaConfig.cmake" ${CMAKE_COMMAND} --install ${BUILD} --component mesh --prefix ${WORK}/prefix)
run_examples(${WORK}/prefix ${WORK}/examples)

run("" ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/library-only -D KROPLA_LIBRARY_ONLY=ON -D CMAKE_CXX_COMPILER=${CXX}
    ${without_the_rest})
