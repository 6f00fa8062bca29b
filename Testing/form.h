#pragma once

/// @file
/// Tests in three forms: reduced with every run of the tests, full with `ninja verification`, small
/// under sanitizers, where every line should run, and what takes minutes decides nothing more.

#include <cstdlib>
#include <cstring>

namespace rockfall::testing
{

inline bool isForm(const char* name)
{
  const char* form = std::getenv("ROCKFALL_VERIFICATION");
  return form && std::strcmp(form, name) == 0;
}
inline bool isFullForm()
{
  return isForm("full");
}
inline bool isSmallForm()
{
  return isForm("small");
}
/// How many of what a test draws: `small` under sanitizers.
inline int someOf(int count, int small)
{
  return isSmallForm() ? small : count;
}

} // namespace rockfall::testing
