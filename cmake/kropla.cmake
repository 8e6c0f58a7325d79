# What all our targets share.

# Same source, same bits: no fused or reordered arithmetic, on which the exact predicates rely too. Nobody reads errno
# after a square root. Fours (base/four.h) are passed within inline functions only, where no ABI matters.
function(kropla_settings target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    target_compile_options(${target} PRIVATE -ffp-contract=off -fno-math-errno -Wno-psabi)
    if(KROPLA_DEVELOPER)
        target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -Wconversion -Werror)
    endif()
    if(KROPLA_SANITIZE)
        # What is undefined ends the program: a test that goes on past it would be counted as passed.
        target_compile_options(${target} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                 -fno-omit-frame-pointer)
        target_compile_definitions(${target} PRIVATE _GLIBCXX_ASSERTIONS)
        target_link_options(${target} PUBLIC -fsanitize=address,undefined)
    endif()
endfunction()

# kropla_library(NAME FILES ...): one static library of the product.
function(kropla_library name)
    add_library(${name} STATIC ${ARGN})
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/kropla>)
    kropla_settings(${name})
endfunction()

# kropla_test(FOLDER LIBRARIES ... FILES ...): the tests of one folder, as one program, one ctest entry per TEST.
function(kropla_test folder)
    cmake_parse_arguments(ARG "" "" "LIBRARIES;FILES" ${ARGN})
    add_executable(test_${folder} ${ARG_FILES})
    target_link_libraries(test_${folder} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main)
    target_include_directories(test_${folder} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    kropla_settings(test_${folder})
    gtest_discover_tests(test_${folder} TEST_PREFIX ${folder}. DISCOVERY_TIMEOUT 60)
endfunction()
