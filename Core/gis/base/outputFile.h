#pragma once

/// @file
/// Files are written beside their name and renamed when they are whole, so that nobody ever finds
/// half of one, and an older one stays until the new one is there.

#include <string>
#include <vector>

namespace rockfall::gis
{

class OutputFile
{
public:
  /// `companions`: extensions of further files that the writer makes beside, such as "prj". Throws
  /// FileError for no name, or a folder that does not exist or is none.
  explicit OutputFile(const std::string& fileName, std::vector<std::string> companions = {});
  /// Removes what was not committed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write: of the same extension, in the same folder.
  const std::string& temporary() const { return temporary_; }
  /// Gives the file and its companions their names. Throws FileError.
  void commit();

private:
  std::string fileName_;
  std::string temporary_;
  std::vector<std::string> companions_;
};

/// Extension in lower case, without the point; ASCII only.
std::string extensionOf(const std::string& fileName);

} // namespace rockfall::gis
