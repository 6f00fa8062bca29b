#pragma once

/// @file
/// The numbers of a DataArray of VTK's XML files: text, base64 or bytes, packed by zlib or not.

#include "mesh/bytes.h"
#include "mesh/precision.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rockfall
{

/// Properties of all arrays of a file.
struct VtkEncoding
{
  std::string name; ///< Of the file, for messages.
  bool bigEndian = false;
  NumberType header = NumberType::UInt32;
  bool packed = false;       ///< By zlib.
  std::string_view appended; ///< Behind the underscore; empty if nothing is.
  bool appendedBase64 = false;
  std::size_t fileSize = 0;

  /// Values that all arrays together can have: points that compress to less are no body's, and a
  /// file could ask for any memory.
  std::size_t mostBytes() const
  {
    constexpr std::size_t mostPacking = 200, small = 1 << 20;
    return small + (packed ? mostPacking * fileSize : fileSize);
  }
};

/// The bytes of an array, or its text if `format` is ascii.
class VtkData
{
public:
  /// `format` is ascii, binary (base64 in `text`) or appended (at `offset`). Throws FileError.
  VtkData(const VtkEncoding& encoding, std::string_view typeName, std::string_view format,
    std::string_view offset, std::string_view text);

  NumberType type() const { return type_; }
  bool isText() const { return isText_; }
  /// As many as there are at most, for a sum over arrays.
  std::size_t mostValues() const { return isText_ ? text_.size() / 2 : bytes_.size(); }
  std::vector<double> reals(WrittenDigits& digits) const;
  /// −1 for what is no whole number of 63 bits.
  std::vector<std::int64_t> wholes() const;

private:
  std::string name_;
  NumberType type_ = NumberType::None;
  bool isText_ = false;
  bool bigEndian_ = false;
  std::string_view text_;
  std::string bytes_;
};

} // namespace rockfall
