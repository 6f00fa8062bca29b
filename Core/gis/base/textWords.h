#pragma once

/// @file
/// Words and lines of files of text that may be large. Internal to gis/.

#include "base/abort.h"

#include <cpl_vsi.h>

#include <memory>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// A text file byte by byte, through a buffer.
class Text
{
public:
  explicit Text(const std::string& fileName)
    : file_(VSIFOpenL(fileName.c_str(), "rb"), VSIFCloseL)
    , buffer_(1 << 20)
  {
  }

  bool readable() const { return file_ != nullptr; }

  /// The next word; false at the end.
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

  /// The next line, without its end; false at the end of the file.
  bool line(std::string& text)
  {
    text.clear();
    int c = this->get();
    for (; c >= 0 && c != '\n'; c = this->get())
    {
      if (c != '\r')
      {
        text.push_back(char(c));
      }
    }
    return c >= 0 || !text.empty();
  }

  int peek()
  {
    if (at_ == filled_)
    {
      stayWanted();
      at_ = 0;
      filled_ = VSIFReadL(buffer_.data(), 1, buffer_.size(), file_.get());
    }
    return at_ < filled_ ? static_cast<unsigned char>(buffer_[at_]) : -1;
  }

private:
  int get()
  {
    const int c = this->peek();
    at_ += c >= 0;
    return c;
  }

  std::unique_ptr<VSILFILE, int (*)(VSILFILE*)> file_;
  std::vector<char> buffer_;
  std::size_t at_ = 0;
  std::size_t filled_ = 0;
};

/// Whether all of a word is a number, with a point or a comma as decimal mark in every locale; nan
/// and inf are.
bool isNumber(std::string word);

} // namespace rockfall::gis
