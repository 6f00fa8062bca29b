# Read by ctest, see rockfall_suites: the suites of a program of GoogleTest as ctest's tests.
if(NOT EXISTS "${program}")
  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)
  return()
endif()
execute_process(COMMAND "${program}" --gtest_list_tests WORKING_DIRECTORY "${folder}"
  OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
# Lines that begin with a name and a point; tests are indented. Those of values are called <values>/<suite>.
string(REGEX MATCHALL "\n[A-Za-z0-9_/]+\\." suites "\n${listed}")
foreach(suite ${suites})
  string(REGEX REPLACE "\n(.*)\\." "\\1" suite "${suite}")
  add_test("${prefix}.${suite}" "${program}" "--gtest_filter=${suite}.*")
  set_tests_properties("${prefix}.${suite}" PROPERTIES WORKING_DIRECTORY "${folder}" ${properties})
endforeach()
