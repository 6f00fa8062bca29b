#pragma once

/// @file
/// GDAL without network and without other files, whatever a file names: the last gate, behind the
/// look into the file (externalReferences.h), for all readers alike.

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rockfall::gis
{

/// While it lives, GDAL opens no address on this thread, SQLite has no modules that read other
/// files as tables, and nothing in a file is run as a program. Does nothing of it where references
/// are allowed.
class StayLocal
{
public:
  StayLocal();
  ~StayLocal();
  StayLocal(const StayLocal&) = delete;
  StayLocal& operator=(const StayLocal&) = delete;

private:
  bool shut_;
  std::vector<std::pair<const char*, std::optional<std::string>>> before_; ///< Of GDAL's options.
};

/// The first address that was asked for and not opened on this thread since the last call; empty if
/// there was none.
std::string takeRefusedAddress();

} // namespace rockfall::gis
