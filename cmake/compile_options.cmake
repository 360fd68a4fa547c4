# Flags of every target live in one interface target, so that each is set in one place.
set(HOLDFAST_MARCH "x86-64-v3" CACHE STRING "-march on x86-64 (empty: the compiler's default)")
set(HOLDFAST_SANITIZE "" CACHE STRING "sanitizers, as -fsanitize takes them (address,undefined)")

add_library(holdfast_flags INTERFACE)
target_include_directories(holdfast_flags INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(holdfast_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  -fno-math-errno)
# Eigen's kernels must not differ between modules, so the architecture is global.
if(HOLDFAST_MARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-march=${HOLDFAST_MARCH})
endif()
if(HOLDFAST_SANITIZE)
  add_compile_options(-fsanitize=${HOLDFAST_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${HOLDFAST_SANITIZE})
endif()

find_program(CCACHE ccache)
if(CCACHE)
  # Without these ccache takes no file that uses a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER
    ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()
