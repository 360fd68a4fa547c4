# holdfast_module(NAME PATH folder [EXCLUDE sub-folder] [DEPENDS module...] [LINK target...]
#                 [PRIVATE_LINK target...])
# Every .cpp of the folder and its sub-folders becomes part of the static library holdfast_NAME.
function(holdfast_module name)
  cmake_parse_arguments(ARG "" "PATH;EXCLUDE" "DEPENDS;LINK;PRIVATE_LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${ARG_PATH}/*.cpp)
  if(ARG_EXCLUDE)
    list(FILTER sources EXCLUDE REGEX "/${ARG_PATH}/${ARG_EXCLUDE}/")
  endif()
  list(TRANSFORM ARG_DEPENDS PREPEND holdfast_)
  if(sources)
    add_library(holdfast_${name} STATIC ${sources})
    target_link_libraries(holdfast_${name} PUBLIC holdfast_flags ${ARG_DEPENDS} ${ARG_LINK}
      PRIVATE ${ARG_PRIVATE_LINK})
  else()
    add_library(holdfast_${name} INTERFACE)
    target_link_libraries(holdfast_${name} INTERFACE holdfast_flags ${ARG_DEPENDS} ${ARG_LINK})
  endif()
endfunction()

# holdfast_test(NAME [INTEGRATION | UNSANITIZED] LINK target...): all .cpp below tests/NAME, as
# NAME_tests. Label unit-NAME and target unit_tests (which the sanitizers run), integration, or, for
# what no robot runs and takes long, offboard.
add_custom_target(unit_tests)
function(holdfast_test name)
  cmake_parse_arguments(ARG "INTEGRATION;UNSANITIZED" "" "LINK" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name}_tests ${sources})
  target_link_libraries(${name}_tests PRIVATE ${ARG_LINK} GTest::gtest GTest::gmock
    GTest::gtest_main)
  target_precompile_headers(${name}_tests REUSE_FROM test_headers)
  if(ARG_INTEGRATION)
    set(label integration)
  elseif(ARG_UNSANITIZED)
    set(label offboard)
  else()
    set(label unit-${name})
    add_dependencies(unit_tests ${name}_tests)
  endif()
  gtest_discover_tests(${name}_tests DISCOVERY_MODE PRE_TEST PROPERTIES LABELS ${label}
    TIMEOUT 600)
endfunction()
