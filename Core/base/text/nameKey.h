#pragma once

/// @file
/// When two names are the same: columns, classes, materials, layers, shapes and presets.

#include <string>
#include <string_view>

namespace rockfall
{

/// Names with one key are one name. Upper and lower case are one in every script (GERÖLL, Geröll),
/// and so are the ways to write a letter in Unicode (ö, or o with a combining diaeresis), a wide or
/// a no-break blank and a plain one. Blanks at the ends are left out. NFKC_Casefold of UTF-8;
/// bytes that are not UTF-8 are all one letter.
std::string nameKey(std::string_view name);

/// Letters a to z and digits of the key alone: "North_American_Vertical_Datum_1988" is as good as
/// with blanks.
std::string letterKey(std::string_view name);

/// Whether all of it is UTF-8.
bool isUtf8(std::string_view text);

} // namespace rockfall
