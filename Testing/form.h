#pragma once

/// @file
/// Tests in two forms: reduced with every run of the tests, full with `ninja verification`.

#include <cstdlib>
#include <cstring>

namespace rockfall::testing
{

inline bool isFullForm()
{
  const char* form = std::getenv("ROCKFALL_VERIFICATION");
  return form && std::strcmp(form, "full") == 0;
}

} // namespace rockfall::testing
