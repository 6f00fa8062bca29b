# rockfall_test_program(<name> PREFIX <prefix> SOURCES <source>... LIBRARIES <library>...
#   [PROPERTIES <property> <value>...] [PRECOMPILE <header>...])
#
# One program of all these GoogleTest sources, and each of its suites as <prefix>.<suite> in ctest.
# Each source is a program of its own too, TestFoo of TestFoo.cxx, which is built only when
# asked for: for work on one file. What most of the sources include is precompiled: these headers with
# GoogleTest's, or without any those of all tests of Core.
#
# Under sanitizers a start takes a third of a second, so ctest has shards of the program there,
# <prefix>.shard<k>, with many tests each. What fails is named at the end of a shard's output; what
# crashes or hangs is the last test that it names. GTEST_FILTER leaves tests out.
find_package(GTest REQUIRED)
# More than processors, so that all of these have something to do to the end.
set(ROCKFALL_SHARDS 16 CACHE STRING "Parts of a test program under sanitizers")

# What is precompiled for tests of Core, once for all of their programs and the libraries of these.
find_package(Boost REQUIRED CONFIG)
if(ROCKFALL_PRECOMPILE)
  file(GENERATE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/testHeaders.cxx" CONTENT "// Only its headers count.\n")
  add_library(RockfallTestHeaders OBJECT "${CMAKE_CURRENT_BINARY_DIR}/testHeaders.cxx")
  target_include_directories(RockfallTestHeaders PRIVATE Core .)
  target_link_libraries(RockfallTestHeaders PRIVATE Rockfall::Core Boost::headers GTest::gtest rockfall_warnings)
  target_compile_options(RockfallTestHeaders PRIVATE -fPIE)
  set_target_properties(RockfallTestHeaders PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  rockfall_quick(RockfallTestHeaders)
  rockfall_precompile(RockfallTestHeaders <gtest/gtest.h> <slopes.h> <world/World.h>)
endif()

# rockfall_test_headers(<target>): a library or a program with these headers, and rockfall_quick as they are. A
# compiler takes them for what is compiled alike only: for programs, with the same definitions and the same
# optimisation (GCC 16 refuses others).
function(rockfall_test_headers target)
  rockfall_quick(${target})
  if(ROCKFALL_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM RockfallTestHeaders)
    target_compile_definitions(${target} PRIVATE $<TARGET_PROPERTY:Boost::headers,INTERFACE_COMPILE_DEFINITIONS>)
    target_compile_options(${target} PRIVATE -fPIE $<TARGET_PROPERTY:GTest::gtest,INTERFACE_COMPILE_OPTIONS>)
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE OFF)
  endif()
endfunction()
# rockfall_shards(<name> <prefix> <property> <value>...)
function(rockfall_shards name prefix)
  math(EXPR last "${ROCKFALL_SHARDS} - 1")
  foreach(shard RANGE ${last})
    set(test "${prefix}.shard${shard}")
    add_test(NAME ${test} COMMAND ${name} WORKING_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}")
    if(ARGN)
      set_tests_properties(${test} PROPERTIES ${ARGN})
    endif()
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT
      GTEST_TOTAL_SHARDS=${ROCKFALL_SHARDS} GTEST_SHARD_INDEX=${shard})
  endforeach()
endfunction()

# rockfall_suites(<name> <prefix> <property> <value>...): ctest asks the program for its suites. A start takes as long as
# most tests, so these are not started one by one.
function(rockfall_suites name prefix)
  set(list "${CMAKE_CURRENT_BINARY_DIR}/${name}Suites.cmake")
  file(GENERATE OUTPUT "${list}" CONTENT
"set(name [[${name}]])
set(program [[$<TARGET_FILE:${name}>]])
set(prefix [[${prefix}]])
set(folder [[${CMAKE_CURRENT_BINARY_DIR}]])
set(properties [[${ARGN}]])
include([[${PROJECT_SOURCE_DIR}/Testing/suites.cmake]])
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${list}")
endfunction()

function(rockfall_test_program name)
  cmake_parse_arguments(arg "" "PREFIX" "SOURCES;LIBRARIES;PROPERTIES;PRECOMPILE" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  rockfall_unity(${name} ${arg_SOURCES})
  if(arg_PRECOMPILE)
    rockfall_quick(${name})
    rockfall_precompile(${name} <gtest/gtest.h> ${arg_PRECOMPILE})
  else()
    rockfall_test_headers(${name})
  endif()
  if(ROCKFALL_SANITIZE)
    rockfall_shards(${name} ${arg_PREFIX} ${arg_PROPERTIES})
  else()
    rockfall_suites(${name} ${arg_PREFIX} ${arg_PROPERTIES})
  endif()
  foreach(source ${arg_SOURCES})
    get_filename_component(single ${source} NAME_WE)
    add_executable(${single} EXCLUDE_FROM_ALL ${source})
    target_link_libraries(${single} PRIVATE ${arg_LIBRARIES} GTest::gtest_main)
  endforeach()
endfunction()

# rockfall_display(<variable> <width>x<height>): how a command gets a display of its own. xvfb-run looks
# for a free one and takes it in two steps, so each looks from another number on.
function(rockfall_display variable size)
  find_program(ROCKFALL_XVFB_RUN xvfb-run REQUIRED)
  get_property(number GLOBAL PROPERTY rockfall_displays)
  math(EXPR number "0${number} + 1")
  set_property(GLOBAL PROPERTY rockfall_displays ${number})
  math(EXPR first "200 + 10 * ${number}")
  set(${variable} "${ROCKFALL_XVFB_RUN}" -a -n ${first} -s "-screen 0 ${size}x24 -noreset" PARENT_SCOPE)
endfunction()
