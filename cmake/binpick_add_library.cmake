# binpick_add_library(<folder> [DEPS <folder>...] [PRIVATE_DEPS <target>...])
# One folder, one static library, one target binpick::<folder>. DEPS are other folders (public); PRIVATE_DEPS are third
# parties that no public header may show, so their headers are system headers of this folder's .cpp files only.
function(binpick_add_library folder)
  cmake_parse_arguments(ARG "" "" "DEPS;PRIVATE_DEPS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  set(target binpick_${folder})
  if(NOT sources)
    file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/empty.cpp" "")
    set(sources "${CMAKE_CURRENT_BINARY_DIR}/empty.cpp")
  endif()
  add_library(${target} STATIC ${sources})
  add_library(binpick::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder} POSITION_INDEPENDENT_CODE ON)
  list(TRANSFORM ARG_DEPS PREPEND "binpick::")
  target_link_libraries(${target} PUBLIC binpick_flags Eigen3::Eigen ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS})
endfunction()

# One executable <name>_tests of these files and its test. It keeps nothing on disk between runs: what another build has
# cached must not stand in for what this one computes.
function(_binpick_test_executable name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS" ${ARGN})
  add_executable(${name}_tests ${ARG_SOURCES})
  target_link_libraries(${name}_tests PRIVATE binpick_flags ${ARG_DEPS} GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name}_tests PRIVATE BINPICK_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  add_test(NAME ${name} COMMAND ${name}_tests)
  set_tests_properties(${name} PROPERTIES LABELS unit ENVIRONMENT BINPICK_CACHE=off)
endfunction()

# It also runs under the sanitizers (preset asan, target sanitized_tests, label sanitized).
function(_binpick_also_sanitized name)
  set_tests_properties(${name} PROPERTIES LABELS "unit;sanitized")
  add_dependencies(sanitized_tests ${name}_tests)
endfunction()

# binpick_add_tests(<folder> [SANITIZED] [DEPS <target>...]): every tests/<folder>/*_test.cpp in one executable.
function(binpick_add_tests folder)
  cmake_parse_arguments(ARG "SANITIZED" "" "DEPS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*_test.cpp")
  if(NOT sources)
    return()
  endif()
  _binpick_test_executable(${folder} SOURCES ${sources} DEPS ${ARG_DEPS})
  if(ARG_SANITIZED)
    _binpick_also_sanitized(${folder})
  endif()
endfunction()

# binpick_add_sanitized_tests(<name> SOURCES <file>... [DEPS <target>...]): under the sanitizers, only these files of a
# folder whose other tests would take too long there.
function(binpick_add_sanitized_tests name)
  _binpick_test_executable(${name} ${ARGN})
  _binpick_also_sanitized(${name})
endfunction()
