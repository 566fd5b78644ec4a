# Rooms: every folder directly below a part (engine, io, tools, program) is one static library `ldso_<room>` with one
# test program `<room>_test`. Which file is what is said by its name: *_test.cpp and test_*.cpp are tests, all other
# .cpp files of the folder are its sources.

# ldso_add_room(<name> [COLD] [DIR folder] [PRECOMPILE header] [EXCLUDE patterns...] [DEPENDS rooms...] [LINK targets...]
#   [PRIVATE_LINK targets...] [TEST_SOURCES files...] [TEST_LINK targets...] [LONG_TESTS patterns...])
#     COLD          nothing in it takes time: it is compiled fast rather than well
#     DIR           folder of the room below the current one (default: its name)
#     PRECOMPILE    header of cmake/ that is parsed once for it (default: precompiled.h)
#     EXCLUDE       regular expressions of files that are not built here
#     TEST_SOURCES  helpers of other rooms' tests that this room's tests use
#     LONG_TESTS    tests (patterns of GoogleTest) that take many seconds: left out by scripts/test.sh --short
# LDSO_PART, LDSO_INCLUDE_ROOT: the part, and the folder that its includes are relative to.
function(ldso_add_room name)
  cmake_parse_arguments(ROOM "COLD" "DIR;PRECOMPILE" "EXCLUDE;DEPENDS;LINK;PRIVATE_LINK;TEST_SOURCES;TEST_LINK;LONG_TESTS"
    ${ARGN})
  if(NOT DEFINED ROOM_DIR)
    set(ROOM_DIR ${name})
  endif()
  if(NOT DEFINED ROOM_PRECOMPILE)
    set(ROOM_PRECOMPILE precompiled.h)
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${ROOM_DIR}/*.cpp)
  foreach(pattern IN LISTS ROOM_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX ${pattern})
  endforeach()
  set(tests ${sources})
  list(FILTER sources EXCLUDE REGEX "(^|/)test_[^/]*\\.cpp$|_test\\.cpp$")
  list(FILTER tests INCLUDE REGEX "(^|/)test_[^/]*\\.cpp$|_test\\.cpp$")

  add_library(ldso_${name} STATIC ${sources})
  add_library(ldso::${name} ALIAS ldso_${name})
  target_include_directories(ldso_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${LDSO_INCLUDE_ROOT}>
    $<INSTALL_INTERFACE:include>)
  target_compile_features(ldso_${name} PUBLIC cxx_std_20)
  list(TRANSFORM ROOM_DEPENDS PREPEND ldso_)
  target_link_libraries(ldso_${name} PUBLIC ${ROOM_DEPENDS} ${ROOM_LINK}
    PRIVATE $<BUILD_INTERFACE:ldso_warnings> ${ROOM_PRIVATE_LINK})
  set_target_properties(ldso_${name} PROPERTIES EXPORT_NAME ${name})
  set_target_properties(ldso_${name} PROPERTIES UNITY_BUILD ${LDSO_UNITY_BUILD})
  set_property(GLOBAL APPEND PROPERTY LDSO_ROOMS_OF_${LDSO_PART} ldso_${name})
  if(ROOM_COLD)
    target_compile_options(ldso_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  if(ROOM_DEPENDS OR "Eigen3::Eigen" IN_LIST ROOM_LINK)
    ldso_precompile(ldso_${name} ${ROOM_PRECOMPILE} ${sources})
  endif()
  if(LDSO_BUILD_TESTS AND tests)
    add_executable(${name}_test ${tests} ${ROOM_TEST_SOURCES})
    target_link_libraries(${name}_test PRIVATE ldso_${name} ${ROOM_TEST_LINK} ldso_warnings GTest::gtest_main Eigen3::Eigen)
    # Tests are compiled once and run once: they need not be fast.
    target_compile_options(${name}_test PRIVATE $<$<CONFIG:Release>:-O1>)
    ldso_precompile(${name}_test precompiled_test.h)
    ldso_discover_tests(${name}_test ${name} ${ROOM_LONG_TESTS})
  endif()
endfunction()

# ldso_discover_tests(<target> <prefix> [patterns of long tests...]): each test of a GoogleTest program is one of ctest's,
# called prefix/Suite.Name; long ones are labelled so.
function(ldso_discover_tests target prefix)
  list(JOIN ARGN ":" long)
  gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 TEST_PREFIX "${prefix}/" TEST_FILTER "-${long}")
  if(ARGN)
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 TEST_PREFIX "${prefix}/" TEST_FILTER "${long}"
      PROPERTIES LABELS long)
  endif()
endfunction()
