#pragma once

/// @file
/// Names of files as files write them: paths, GDAL's file systems, drivers before a name, XML.

#include <cstdint>
#include <optional>
#include <string>

struct CPLXMLNode;

namespace rockfall::gis
{

/// Whether a name has a file system of GDAL's in it that is neither memory nor a local file.
bool isOnOtherSystem(const std::string& name);

/// Whether a name is on such a file system, or an address (://).
bool isAddress(const std::string& name);

/// Whether the name is itself the text of a virtual dataset.
bool isXml(const std::string& name);

/// All of a file; nothing if it is none, or of more bytes than `largest`.
std::optional<std::string> wholeFile(const std::string& fileName, std::int64_t largest);

/// The same of a virtual dataset's file; empty if it is none, or too large for one.
std::string xmlOf(const std::string& fileName);

/// Whether a file lies in a folder or below, after all its links.
bool isWithin(const std::string& fileName, const std::string& folder);

std::string folderOf(const std::string& fileName);

/// Name of the file in an element of a virtual dataset in this folder, as SourceFilename; empty if
/// there is none.
std::string sourceFile(const CPLXMLNode* element, const std::string& folder);

/// The file of a name like NETCDF:"a.nc":z or HDF5:a.h5://z; other names as they are.
std::string fileWithin(const std::string& name);

} // namespace rockfall::gis
