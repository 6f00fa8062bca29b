#include "base/text/tableText.h"

#include "base/abort.h"
#include "base/errors.h"
#include "base/text/nameKey.h"
#include "base/text/plainText.h"

#include <unicode/ucnv.h>
#include <unicode/unistr.h>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace rockfall
{

namespace
{

constexpr char western[] = "windows-1252";

/// Number of the line of a byte, from 1.
std::size_t lineAt(std::string_view text, std::size_t byte)
{
  return 1 + std::size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(byte), '\n'));
}

bool isAscii(char c)
{
  return (c & 0x80) == 0;
}

/// The first of the lines that is not UTF-8, 0 if all are; and whether any has letters beyond ASCII
/// that are.
struct Utf8Lines
{
  std::size_t firstBad = 0;
  bool someGood = false;

  explicit Utf8Lines(std::string_view text)
  {
    std::size_t number = 0;
    while (!text.empty())
    {
      const auto end = std::min(text.find('\n'), text.size() - 1) + 1;
      stayWanted();
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end);
      ++number;
      if (std::all_of(line.begin(), line.end(), isAscii))
      {
        continue;
      }
      const bool good = isUtf8(line);
      someGood = someGood || good;
      firstBad = !good && firstBad == 0 ? number : firstBad;
    }
  }
};

std::string fromConverter(
  const std::string& text, const std::string& encoding, const std::string& fileName)
{
  UErrorCode status = U_ZERO_ERROR;
  const std::unique_ptr<UConverter, void (*)(UConverter*)> converter(
    ucnv_open(encoding.c_str(), &status), ucnv_close);
  if (U_FAILURE(status))
  {
    throw DataError(
      fileName + ": its .cpg file says the encoding \"" + encoding + "\", which is not known");
  }
  // Line by line, so that a byte that is no letter is found.
  std::string result;
  std::size_t number = 0;
  const bool lines = ucnv_getMinCharSize(converter.get()) == 1;
  ucnv_setToUCallBack(converter.get(), UCNV_TO_U_CALLBACK_STOP, nullptr, nullptr, nullptr, &status);
  for (std::size_t first = 0; first < text.size();)
  {
    const auto end = lines ? std::min(text.find('\n', first), text.size() - 1) + 1 : text.size();
    stayWanted();
    ++number;
    ucnv_resetToUnicode(converter.get());
    const icu::UnicodeString decoded(
      text.data() + first, int32_t(end - first), converter.get(), status);
    // U+0080 to U+009F are letters of no text: ICU gives them for bytes that an encoding leaves
    // free.
    bool letters = U_SUCCESS(status);
    for (int32_t k = 0; k < decoded.length() && letters; ++k)
    {
      letters = decoded[k] < 0x80 || decoded[k] > 0x9f;
    }
    if (!letters)
    {
      throw DataError(lineName(fileName, number) + ": is neither UTF-8 nor text in " + encoding +
        "; save the table as UTF-8, or name its encoding in a .cpg file beside it");
    }
    decoded.toUTF8String(result);
    first = end;
  }
  return result;
}

std::string fromUtf16(std::string_view text, bool bigEnd)
{
  icu::UnicodeString units;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
  {
    const auto one = std::uint8_t(text[i]), two = std::uint8_t(text[i + 1]);
    units.append(char16_t(bigEnd ? one << 8 | two : two << 8 | one));
  }
  std::string result;
  return units.toUTF8String(result);
}

std::string fromUtf32(std::string_view text, bool bigEnd)
{
  icu::UnicodeString units;
  for (std::size_t i = 0; i + 3 < text.size(); i += 4)
  {
    std::uint32_t code = 0;
    for (std::size_t k = 0; k < 4; ++k)
    {
      code = code << 8 | std::uint8_t(text[i + (bigEnd ? k : 3 - k)]);
    }
    units.append(UChar32(std::min<std::uint32_t>(code, 0xfffd)));
  }
  std::string result;
  return units.toUTF8String(result);
}

/// The word about a byte.
std::string wordAt(const std::string& text, std::size_t byte)
{
  const char* const ends = " \t\r\n,;\"|";
  const auto before = text.find_last_of(ends, byte);
  const auto first = before == std::string::npos ? 0 : before + 1;
  return text.substr(first, text.find_first_of(ends, byte) - first);
}

/// Throws if signs stand within words, as ” does in H”hle: the text is of another code page.
void refuseSignsInWords(const std::string& text, const std::string& fileName)
{
  const auto letter = [](char c)
  { return !isAscii(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  for (const std::string sign : { "„", "…", "†", "‡", "ˆ", "‰", "‹", "“", "”", "•", "˜", "™", "›" })
  {
    for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign, at + 1))
    {
      const auto after = at + sign.size();
      if (at > 0 && after < text.size() && letter(text[at - 1]) && letter(text[after]))
      {
        throw DataError(lineName(fileName, lineAt(text, at)) + ": is not UTF-8, and \"" +
          wordAt(text, at) +
          "\", as it is in Windows-1252, is no word; save the table as UTF-8, or name its encoding "
          "in a .cpg file beside it");
      }
    }
  }
}

/// Little end (even) or big end (odd) of UTF-16 without a mark; −1: it is none.
int unmarkedUtf16(std::string_view text)
{
  std::size_t zeros[2] = { 0, 0 };
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    zeros[i % 2] += text[i] == '\0';
  }
  const std::size_t half = text.size() / 2;
  return zeros[1] > half * 6 / 10 && zeros[0] == 0 ? 0
    : zeros[0] > half * 6 / 10 && zeros[1] == 0    ? 1
                                                   : -1;
}

std::string decoded(std::string text, const std::string& declared, const std::string& fileName,
  std::vector<std::string>& notes)
{
  const std::string_view view = text;
  using namespace std::string_view_literals;
  if (view.starts_with("\xff\xfe\0\0"sv) || view.starts_with("\0\0\xfe\xff"sv))
  {
    return fromUtf32(view.substr(4), view.starts_with("\0\0\xfe\xff"sv));
  }
  if (view.starts_with("\xff\xfe"sv) || view.starts_with("\xfe\xff"sv))
  {
    return fromUtf16(view.substr(2), view[0] == '\xfe');
  }
  if (view.starts_with("\xef\xbb\xbf"sv))
  {
    text.erase(0, 3);
  }
  else if (const int end = unmarkedUtf16(view); end >= 0)
  {
    notes.emplace_back("The table's text is UTF-16 without a mark that says so.");
    return fromUtf16(view, end == 1);
  }
  if (const auto zero = text.find('\0'); zero != std::string::npos)
  {
    throw DataError(lineName(fileName, lineAt(text, zero)) +
      ": holds a byte 0, which no text does; save the table as UTF-8");
  }
  const Utf8Lines utf8(text);
  if (utf8.firstBad == 0)
  {
    return text;
  }
  if (!declared.empty() && nameKey(declared) != "utf-8" && nameKey(declared) != "65001")
  {
    const bool page = declared.find_first_not_of("0123456789") == std::string::npos;
    return fromConverter(text, (page ? "cp" : "") + declared, fileName);
  }
  if (utf8.someGood)
  {
    throw DataError(lineName(fileName, utf8.firstBad) +
      ": is not UTF-8 as others are; save the table in one encoding, UTF-8");
  }
  std::string result = fromConverter(text, western, fileName);
  refuseSignsInWords(result, fileName);
  const auto first =
    std::size_t(std::find_if_not(result.begin(), result.end(), isAscii) - result.begin());
  notes.push_back("The table is not UTF-8; it was read as Windows-1252 (Latin-1): line " +
    std::to_string(utf8.firstBad) + " has \"" + wordAt(result, first) +
    "\". A .cpg file beside it can name another encoding.");
  return result;
}

} // namespace

std::string lineName(const std::string& fileName, std::size_t line)
{
  return fileName + ", line " + std::to_string(line);
}

std::string asUtf8(std::string text, const std::string& declared, const std::string& fileName,
  std::vector<std::string>& notes)
{
  std::string result = decoded(std::move(text), std::string(trimmed(declared)), fileName, notes);
  // Of UTF-16 as well.
  if (result.starts_with("\xef\xbb\xbf"))
  {
    result.erase(0, 3);
  }
  return result;
}

std::vector<std::string> quotedCells(std::string_view line, char separator)
{
  std::vector<std::string> cells(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i)
  {
    const char c = line[i];
    if (c == '"' && inside && i + 1 < line.size() && line[i + 1] == '"')
    {
      cells.back() += line[i++];
    }
    else if (c == '"')
    {
      inside = !inside;
    }
    else if (c == separator && !inside)
    {
      cells.emplace_back();
    }
    else
    {
      cells.back() += c;
    }
  }
  std::transform(cells.begin(), cells.end(), cells.begin(),
    [](const std::string& cell) { return std::string(trimmed(cell)); });
  return cells;
}

std::optional<char> separatorLine(std::string_view line)
{
  std::string text(line.substr(0, line.find_last_not_of("\r\n") + 1));
  text.erase(std::remove(text.begin(), text.end(), '"'), text.end());
  return text.size() == 5 && nameKey(text).starts_with("sep=") ? std::optional(text[4])
    : nameKey(text) == "sep="                                  ? std::optional('\t')
                                                               : std::nullopt;
}

} // namespace rockfall
