# The library as its users meet it: installed from the tree that was built, found by a project of its own, and
# configured without anything but oneTBB. Run by ctest:
#   cmake -D BUILD=... -D SOURCE=... -D WORK=... -D CXX=... -P package_test.cmake
function(run expected)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0 OR NOT output MATCHES "${expected}")
        message(FATAL_ERROR "${ARGN}\nreturned ${result}, or its output has no '${expected}':\n${output}")
    endif()
endfunction()

set(without_the_rest -D CMAKE_CXX_COMPILER=${CXX})
foreach(package PkgConfig MPI HDF5 VTK tomlplusplus CLI11 fmt GTest)
    list(APPEND without_the_rest -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)  # an error where it is required
endforeach()

file(REMOVE_RECURSE ${WORK})
run("KroplaConfig.cmake" ${CMAKE_COMMAND} --install ${BUILD} --component mesh --prefix ${WORK}/prefix)
run("" ${CMAKE_COMMAND} -S ${SOURCE}/examples -B ${WORK}/examples ${without_the_rest}
    -D CMAKE_PREFIX_PATH=${WORK}/prefix -D CMAKE_BUILD_TYPE=Release)
run("" ${CMAKE_COMMAND} --build ${WORK}/examples)
run("worst R/r.*\n3.00 +[0-9]+ +[3-9][.]" ${WORK}/examples/moving_sphere)
run("worst R/r.*\n1.00 +[0-9]+ +[3-9][.]" ${WORK}/examples/own_mesh)

run("" ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/library-only -D KROPLA_LIBRARY_ONLY=ON ${without_the_rest})
