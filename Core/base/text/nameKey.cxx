#include "base/text/nameKey.h"

#include "base/text/plainText.h"

#include <unicode/bytestream.h>
#include <unicode/normalizer2.h>
#include <unicode/utf8.h>

#include <algorithm>

namespace rockfall
{

std::string nameKey(std::string_view name)
{
  std::string key;
  if (std::all_of(name.begin(), name.end(), [](char c) { return (c & 0x80) == 0; }))
  {
    return lowerCase(trimmed(name));
  }
  UErrorCode status = U_ZERO_ERROR;
  const icu::Normalizer2* folding = icu::Normalizer2::getNFKCCasefoldInstance(status);
  icu::StringByteSink<std::string> sink(&key);
  if (U_SUCCESS(status))
  {
    folding->normalizeUTF8(
      0, icu::StringPiece(name.data(), int32_t(name.size())), sink, nullptr, status);
  }
  return std::string(trimmed(U_SUCCESS(status) ? std::string_view(key) : name));
}

std::string letterKey(std::string_view name)
{
  std::string key = nameKey(name);
  std::erase_if(key, [](char c) { return !((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')); });
  return key;
}

bool isUtf8(std::string_view text)
{
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  for (std::size_t i = 0; i < text.size();)
  {
    // Letters have four bytes at most; the macro counts in 32 bits.
    const std::uint8_t* letter = bytes + i;
    int32_t used = 0;
    UChar32 code = 0;
    U8_NEXT(letter, used, int32_t(std::min<std::size_t>(4, text.size() - i)), code);
    if (code < 0)
    {
      return false;
    }
    i += std::size_t(used);
  }
  return true;
}

} // namespace rockfall
