#include "gis/asciiGrid.h"

#include "base/errors.h"

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace rockfall::gis
{

namespace
{

/// The words of a text file one after the other, through a buffer.
class Words
{
public:
  explicit Words(const std::string& fileName)
    : file_(VSIFOpenL(fileName.c_str(), "rb"), VSIFCloseL)
    , buffer_(1 << 20)
  {
  }

  bool readable() const { return file_ != nullptr; }

  bool next(std::string& word)
  {
    word.clear();
    for (int c = this->get(); c >= 0; c = this->get())
    {
      const bool blank = c == ' ' || (c >= '\t' && c <= '\r') || c == '\0';
      if (!blank)
      {
        word.push_back(char(c));
      }
      else if (!word.empty())
      {
        return true;
      }
    }
    return !word.empty();
  }

private:
  int get()
  {
    if (at_ == filled_)
    {
      at_ = 0;
      filled_ = VSIFReadL(buffer_.data(), 1, buffer_.size(), file_.get());
    }
    return at_ < filled_ ? static_cast<unsigned char>(buffer_[at_++]) : -1;
  }

  std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file_;
  std::vector<char> buffer_;
  std::size_t at_ = 0;
  std::size_t filled_ = 0;
};

bool isNumber(std::string word)
{
  std::replace(word.begin(), word.end(), ',', '.');
  char* end = nullptr;
  CPLStrtod(word.c_str(), &end); // a point in every locale; nan and inf in all their spellings
  return end != word.c_str() && *end == '\0';
}

} // namespace

void checkAsciiGrid(const std::string& fileName, std::int64_t columns, std::int64_t rows)
{
  Words words(fileName);
  std::string word;
  if (!words.readable())
  {
    return;
  }
  // The header: pairs of a keyword and its value, until a number stands where a keyword would.
  bool more = words.next(word);
  while (more && !isNumber(word))
  {
    more = words.next(word) && words.next(word);
  }
  std::int64_t count = 0;
  for (; more; more = words.next(word), ++count)
  {
    if (!isNumber(word))
    {
      throw DataError(fileName + ": \"" + word + "\" in row " +
        std::to_string(count / columns + 1) + ", column " + std::to_string(count % columns + 1) +
        " is not a number");
    }
  }
  if (count != columns * rows)
  {
    throw FileError(fileName + ": cannot be read: it has " + std::to_string(count) +
      " numbers, its header promises " + std::to_string(columns) + " x " + std::to_string(rows) +
      " = " + std::to_string(columns * rows));
  }
}

} // namespace rockfall::gis
