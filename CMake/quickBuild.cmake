# Builds that take less: files compiled together, headers compiled once, tests optimised little.
#
# The first two are for builds from nothing. With ccache each file by itself is found again, and a precompiled
# header, whose bits depend on its folder, is not.
set(from_nothing ON)
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(from_nothing OFF)
endif()
# Names in anonymous namespaces must differ within a folder.
option(ROCKFALL_UNITY "Compile several files of a folder together" ${from_nothing})
option(ROCKFALL_PRECOMPILE "Compile the most used headers once" ${from_nothing})
if(ROCKFALL_UNITY AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Files that are compiled together fill GCC's heap over and over; to look for what may go takes a
  # twentieth of the time.
  add_compile_options(--param=ggc-min-heapsize=524288) # kB
endif()

# rockfall_precompile(<target> [<header>...]): Eigen, the most used of the standard library, and these.
function(rockfall_precompile target)
  if(ROCKFALL_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE
      <Eigen/Dense>
      <algorithm> <array> <cmath> <cstdint> <functional> <limits> <map> <memory> <numbers> <numeric>
      <optional> <random> <span> <sstream> <string> <vector>
      ${ARGN})
  endif()
endfunction()

# rockfall_unity(<target> <source>...): each folder's sources together, as what templates they share is
# made once then. To be called in the target's own folder, after properties of single sources have
# been set.
function(rockfall_unity target)
  if(NOT ROCKFALL_UNITY)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  foreach(source IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH source)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder)
    string(REPLACE "/" "_" folder "in_${folder}")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${folder}")
  endforeach()
endfunction()

# rockfall_quick(<target>): what a test does itself is a small part of what it runs, and most of the
# time to compile it goes into optimising. Of the levels the last counts. Instrumented code is not
# optimised at all, which takes a third of the time; of functions that are in headers the linker keeps
# those that it meets first, so Core's, which are optimised, come before the test's own.
function(rockfall_quick target)
  if(ROCKFALL_SANITIZE)
    target_compile_options(${target} PRIVATE -O0)
    target_link_options(${target} PRIVATE
      -Wl,--whole-archive $<TARGET_FILE:RockfallCore> -Wl,--no-whole-archive)
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS $<TARGET_FILE:RockfallCore>)
  else()
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
