#include "classLooks.h"

#include "proxyNumbers.h"
#include "rock/results.h"

#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace rockfall::window
{

namespace
{

/// Of class 0: something may have come, but less often than once in the scenario's years.
constexpr Colour kNone = { 0.80, 0.84, 0.80 };
/// Weak, medium, strong, as in the styles for a GIS (Examples/study_parts/gis.py).
constexpr std::array<Colour, 3> kClasses = { { { 1.00, 0.902, 0.502 }, { 0.878, 0.541, 0.18 },
  { 0.545, 0.039, 0.102 } } };

/// What a number stands for.
struct Meaning
{
  std::string name;
  Colour colour;
};
using Meanings = std::vector<Meaning>; ///< Of 0, 1, …

// Colours that colour-blind people tell apart (Okabe & Ito 2008).
constexpr Colour kBlue = { 0.0, 0.447, 0.698 }, kGreen = { 0.0, 0.62, 0.451 },
                 kOrange = { 0.902, 0.624, 0.0 }, kRed = { 0.835, 0.369, 0.0 },
                 kPink = { 0.8, 0.475, 0.655 }, kGrey = { 0.6, 0.6, 0.6 },
                 kYellow = { 0.941, 0.894, 0.259 }, kSky = { 0.337, 0.706, 0.914 };

/// Of the codes that RockfallSimulationOutput.md lists; none: the array has no such codes.
Meanings meaningsOf(const std::string& array)
{
  if (array == "Fate" || array == "FateCode")
  {
    Meanings fates;
    for (const Colour& colour : { kGreen, kGrey, kOrange, kBlue, kPink, kRed })
    {
      fates.push_back({ fateName(Fate(fates.size())), colour });
    }
    return fates;
  }
  if (array == "Outcome")
  {
    return { { "barrier held", kBlue }, { "barrier broke", kRed }, { "recorded", kGrey },
      { "stem broke", kOrange }, { "stem turned it", kGreen }, { "barrier struck", kPink },
      { "barrier passed", kYellow }, { "barrier gone", kSky } };
  }
  return {};
}

/// Colour of class `k` of `count`, 1 the weakest.
Colour colourOf(std::size_t k, std::size_t count)
{
  if (k == 0)
  {
    return kNone;
  }
  const double last = double(kClasses.size() - 1);
  const double at = count > 1 ? last * double(k - 1) / double(count - 1) : last;
  const std::size_t low = std::min(std::size_t(at), kClasses.size() - 2);
  Colour colour;
  for (std::size_t c = 0; c < colour.size(); ++c)
  {
    colour[c] = kClasses[low][c] + (at - double(low)) * (kClasses[low + 1][c] - kClasses[low][c]);
  }
  return colour;
}

/// Thresholds between the classes as their arrays name them, kJ, ascending.
std::vector<std::string> thresholdsOf(const Shown& shown)
{
  const std::string begin = "ExceedanceProbability", end = "kJ";
  std::vector<std::pair<double, std::string>> found;
  vtkPVDataSetAttributesInformation* arrays =
    shown.source->GetDataInformation(unsigned(shown.port))->GetCellDataInformation();
  for (int k = 0; k < arrays->GetNumberOfArrays(); ++k)
  {
    const std::string name = arrays->GetArrayInformation(k)->GetName();
    if (name.rfind(begin, 0) == 0 && name.size() > begin.size() + end.size() &&
      name.compare(name.size() - end.size(), end.size(), end) == 0)
    {
      const std::string number = name.substr(begin.size(), name.size() - begin.size() - end.size());
      found.emplace_back(std::strtod(number.c_str(), nullptr), number);
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> thresholds;
  for (auto& [value, number] : found)
  {
    thresholds.push_back(number);
  }
  return thresholds;
}

/// From class 0 on; three classes have the names of the national sets.
std::vector<std::string> namesOf(const std::vector<std::string>& thresholds)
{
  std::vector<std::string> names = { "none" };
  if (thresholds.empty())
  {
    names.emplace_back("reached");
    return names;
  }
  const std::size_t count = thresholds.size() + 1;
  constexpr std::array<const char*, 3> words = { "weak, ", "medium, ", "strong, " };
  for (std::size_t k = 0; k < count; ++k)
  {
    const std::string word = count == words.size() ? words[k] : "";
    names.push_back(word +
      (k == 0             ? "below " + thresholds[0] + " kJ"
          : k + 1 < count ? thresholds[k - 1] + " to " + thresholds[k] + " kJ"
                          : "from " + thresholds[k - 1] + " kJ"));
  }
  return names;
}

bool isIntensity(const std::string& array)
{
  const std::string begin = "Intensity"; // LiDAR has an array of that name
  return array.rfind(begin, 0) == 0 && array.size() > begin.size() &&
    array.find_first_not_of("0123456789.e+-", begin.size()) == array.size() - 1 &&
    array.back() == 'a';
}

Meanings classesOf(const Shown& shown)
{
  const std::vector<std::string> names = namesOf(thresholdsOf(shown));
  Meanings classes;
  for (std::size_t k = 0; k < names.size(); ++k)
  {
    classes.push_back({ names[k], colourOf(k, names.size() - 1) });
  }
  return classes;
}

} // namespace

bool nameNumbers(const std::string& array, const Shown& shown, vtkSMProxy* table)
{
  const Meanings meanings = isIntensity(array) ? classesOf(shown) : meaningsOf(array);
  if (meanings.empty())
  {
    return false;
  }
  std::string all;
  for (const Meaning& meaning : meanings)
  {
    all += meaning.name + ';';
  }
  constexpr const char* done = "RockfallClasses";
  if (table->HasAnnotation(done) && table->GetAnnotation(done) == all)
  {
    return true;
  }
  table->SetAnnotation(done, all.c_str());
  vtkSMPropertyHelper texts(table, "Annotations");
  texts.SetNumberOfElements(unsigned(2 * meanings.size()));
  std::vector<double> colours;
  // A legend begins at its top, where the strongest class belongs.
  for (std::size_t row = 0; row < meanings.size(); ++row)
  {
    const std::size_t k = meanings.size() - 1 - row;
    texts.Set(unsigned(2 * row), std::to_string(k).c_str());
    texts.Set(unsigned(2 * row + 1), meanings[k].name.c_str());
    colours.insert(colours.end(), meanings[k].colour.begin(), meanings[k].colour.end());
  }
  vtkSMPropertyHelper(table, "IndexedColors").Set(colours.data(), unsigned(colours.size()));
  set(table, "IndexedLookup", 1);
  table->UpdateVTKObjects();
  return true;
}

} // namespace rockfall::window
