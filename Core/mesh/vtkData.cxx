#include "mesh/vtkData.h"

#include "base/errors.h"
#include "mesh/words.h"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace rockfall
{

namespace
{

NumberType xmlTypeOf(std::string_view word)
{
  constexpr std::string_view names[] = { "None", "Int8", "UInt8", "Int16", "UInt16", "Int32",
    "UInt32", "Int64", "UInt64", "Float32", "Float64" };
  for (int k = 1; k < int(std::size(names)); ++k)
  {
    if (names[k] == word)
    {
      return NumberType(k);
    }
  }
  return NumberType::None;
}

int valueOf64(char c)
{
  return c >= 'A' && c <= 'Z' ? c - 'A'
    : c >= 'a' && c <= 'z'    ? c - 'a' + 26
    : c >= '0' && c <= '9'    ? c - '0' + 52
    : c == '+'                ? 62
    : c == '/'                ? 63
                              : -1;
}

/// Bytes one after the other, out of base64 or as they are.
class Source
{
public:
  Source(std::string_view text, bool base64, const std::string& name)
    : text_(text)
    , base64_(base64)
    , name_(name)
  {
  }

  std::string take(std::size_t count)
  {
    std::string bytes;
    if (!base64_)
    {
      if (count > text_.size())
      {
        this->failTruncated();
      }
      bytes = text_.substr(0, count);
      text_.remove_prefix(count);
      return bytes;
    }
    if (count > text_.size()) // four letters are three bytes
    {
      this->failTruncated();
    }
    while (bytes.size() < count)
    {
      if (begun_ == left_)
      {
        this->refill();
      }
      bytes.push_back(group_[begun_++]);
    }
    return bytes;
  }

  /// Up to here it was one piece of base64, what follows is another.
  void beginAnew() { begun_ = left_ = 0; }

private:
  [[noreturn]] void failTruncated() const { throw FileError(name_ + ": is truncated"); }

  void refill()
  {
    int values[4];
    int digits = 0;
    for (int k = 0; k < 4;)
    {
      if (text_.empty())
      {
        this->failTruncated();
      }
      const char c = text_.front();
      text_.remove_prefix(1);
      if (c == ' ' || (c >= '\t' && c <= '\r'))
      {
        continue;
      }
      values[k] = c == '=' ? 0 : valueOf64(c);
      if (values[k] < 0)
      {
        throw FileError(name_ + ": " + inQuotes({ &c, 1 }) + " is no letter of base64");
      }
      digits += c == '=' ? 0 : 1;
      ++k;
    }
    const int all = values[0] << 18 | values[1] << 12 | values[2] << 6 | values[3];
    group_ = { char(all >> 16 & 0xFF), char(all >> 8 & 0xFF), char(all & 0xFF) };
    begun_ = 0;
    left_ = std::max(0, digits - 1);
    if (left_ == 0)
    {
      this->failTruncated();
    }
  }

  std::string_view text_;
  bool base64_;
  std::string name_;
  std::array<char, 3> group_{};
  int begun_ = 0, left_ = 0; ///< Of the group.
};

std::uint64_t takeHeader(Source& source, const VtkEncoding& of)
{
  const std::string bytes = source.take(std::size_t(sizeOf(of.header)));
  const std::int64_t value = takeInteger(of.header, bytes.data(), of.bigEndian);
  if (value < 0)
  {
    throw FileError(of.name + ": the header of an array is damaged");
  }
  return std::uint64_t(value);
}

/// Number of blocks, size of each and of the last, and packed sizes of all; then the blocks.
std::string unpack(Source& source, const VtkEncoding& of)
{
  const std::uint64_t blocks = takeHeader(source, of);
  if (blocks > of.fileSize)
  {
    throw FileError(of.name + ": is truncated");
  }
  const std::uint64_t whole = takeHeader(source, of), last = takeHeader(source, of);
  std::vector<std::uint64_t> sizes;
  for (std::uint64_t k = 0; k < blocks; ++k)
  {
    sizes.push_back(takeHeader(source, of));
  }
  source.beginAnew();
  const std::size_t most = of.mostBytes();
  std::string bytes;
  for (std::uint64_t k = 0; k < blocks; ++k)
  {
    const std::uint64_t size = k + 1 == blocks && last > 0 ? last : whole;
    if (sizes[k] > of.fileSize || size > most || bytes.size() + size > most)
    {
      throw FileError(of.name + ": is damaged: an array is larger than a file of " +
        std::to_string(of.fileSize) + " bytes can have");
    }
    const std::string packed = source.take(std::size_t(sizes[k]));
    const std::size_t begin = bytes.size();
    bytes.resize(begin + std::size_t(size));
    uLongf unpacked = uLongf(size);
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data() + begin), &unpacked,
          reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size())) != Z_OK ||
      unpacked != size)
    {
      throw FileError(of.name + ": an array cannot be unpacked, the file is damaged");
    }
  }
  return bytes;
}

} // namespace

VtkData::VtkData(const VtkEncoding& encoding, std::string_view typeName, std::string_view format,
  std::string_view offset, std::string_view text)
  : name_(encoding.name)
  , type_(xmlTypeOf(typeName))
  , isText_(format == "ascii")
  , bigEndian_(encoding.bigEndian)
  , text_(text)
{
  if (type_ == NumberType::None)
  {
    throw FileError(name_ + ": " + inQuotes(typeName) + " is no type of numbers");
  }
  if (isText_)
  {
    return;
  }
  const bool isAppended = format == "appended";
  std::int64_t begin = 0;
  if ((!isAppended && format != "binary") || (isAppended && !parseInteger(offset, begin)))
  {
    throw FileError(name_ + ": an array is neither ascii, binary nor appended at an offset");
  }
  if (isAppended && (begin < 0 || std::uint64_t(begin) > encoding.appended.size()))
  {
    throw FileError(name_ + ": is truncated: an array begins at byte " + std::to_string(begin) +
      " of the appended data, which have " + std::to_string(encoding.appended.size()));
  }
  Source source(isAppended ? encoding.appended.substr(std::size_t(begin)) : text,
    !isAppended || encoding.appendedBase64, name_);
  if (encoding.packed)
  {
    bytes_ = unpack(source, encoding);
  }
  else
  {
    bytes_ = source.take(std::size_t(takeHeader(source, encoding)));
  }
}

std::vector<double> VtkData::reals(WrittenDigits& digits) const
{
  std::vector<double> values;
  if (isText_)
  {
    Words words(text_, name_);
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
    {
      if (!parseNumber(word, values.emplace_back()))
      {
        throw FileError(name_ + ": " + inQuotes(word) + " is not a number");
      }
      digits.add(word, values.back());
    }
    return values;
  }
  const auto size = std::size_t(sizeOf(type_));
  for (std::size_t at = 0; at + size <= bytes_.size(); at += size)
  {
    values.push_back(takeNumber(type_, bytes_.data() + at, bigEndian_));
  }
  return values;
}

std::vector<std::int64_t> VtkData::wholes() const
{
  std::vector<std::int64_t> values;
  if (isText_)
  {
    Words words(text_, name_);
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
    {
      if (!parseInteger(word, values.emplace_back()))
      {
        throw FileError(name_ + ": " + inQuotes(word) + " is not a whole number");
      }
    }
    return values;
  }
  const auto size = std::size_t(sizeOf(type_));
  for (std::size_t at = 0; at + size <= bytes_.size(); at += size)
  {
    values.push_back(takeInteger(type_, bytes_.data() + at, bigEndian_));
  }
  return values;
}

} // namespace rockfall
