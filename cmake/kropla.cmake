# What all our targets share.

# Same source, same bits: no fused or reordered arithmetic, on which the exact predicates rely too. Nobody reads errno
# after a square root. Fours (base/four.h) are passed within inline functions only, where no ABI matters.
function(kropla_settings target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno -Wno-psabi)
    if(KROPLA_DEVELOPER)
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Werror
                               $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)  # which g++'s -Wconversion has not
    endif()
    if(KROPLA_SANITIZE)
        # What is undefined ends the program: a test that goes on past it would be counted as passed.
        target_compile_options(${target} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                 -fno-omit-frame-pointer)
        target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS)
        target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    endif()
endfunction()

# Headers for users are included as <kropla/FOLDER/FILE.h>, inside too: here are their folders.
set(KROPLA_INCLUDE ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${KROPLA_INCLUDE}/kropla)
configure_file(${PROJECT_SOURCE_DIR}/src/version.h.in ${KROPLA_INCLUDE}/kropla/version.h @ONLY)
foreach(folder base mesh domain generate adapt transfer step simulate io)
    file(CREATE_LINK ${PROJECT_SOURCE_DIR}/src/${folder} ${KROPLA_INCLUDE}/kropla/${folder} SYMBOLIC)
endforeach()

# kropla_library(NAME FILES ...): one library of the product, static unless BUILD_SHARED_LIBS says otherwise. Headers that
# are not for users are seen by our own targets alone (kropla_inside).
function(kropla_library name)
    add_library(${name} ${ARGN})
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${KROPLA_INCLUDE}>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_target_properties(${name} PROPERTIES VERSION ${PROJECT_VERSION}
                          SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
    kropla_inside(${name})
    kropla_settings(${name})
endfunction()

# A target that is written with the library, not for it.
function(kropla_inside target)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
endfunction()

# kropla_test(FOLDER LIBRARIES ... FILES ...): the tests of one folder, as one program, one ctest entry per TEST.
function(kropla_test folder)
    cmake_parse_arguments(ARG "" "" "LIBRARIES;FILES" ${ARGN})
    add_executable(test_${folder} ${ARG_FILES})
    target_link_libraries(test_${folder} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main)
    target_include_directories(test_${folder} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    kropla_inside(test_${folder})
    kropla_settings(test_${folder})
    target_compile_options(test_${folder} PRIVATE $<$<CONFIG:Release>:-O1>)  # what is tested is in the libraries
    if(NOT CMAKE_CXX_COMPILER_LAUNCHER)  # a second of each file; ccache and its like look files up without it
        target_precompile_headers(test_${folder} PRIVATE <gtest/gtest.h>)
    endif()
    gtest_discover_tests(test_${folder} TEST_PREFIX ${folder}. DISCOVERY_TIMEOUT 60)
endfunction()
