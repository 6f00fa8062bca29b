#include "geometry/ShapeMix.h"

#include "base/errors.h"
#include "base/text/plainText.h"

#include <cmath>

namespace rockfall
{

namespace
{

double weightOf(const std::string& word, const std::string& text)
{
  const auto weight = parsedNumber(word);
  if (!weight || !(*weight >= 0.0) || !std::isfinite(*weight))
  {
    throw ParameterError("Shape mix \"" + text + "\": the weight \"" + word +
      "\" must be a number, at least 0" +
      (word.find(',') != std::string::npos ? " (the decimal sign is a point)" : ""));
  }
  return *weight;
}

} // namespace

ShapeMix ShapeMix::fromText(const std::string& text)
{
  ShapeMix mix;
  double sum = 0.0;
  std::size_t from = 0;
  while (from <= text.size())
  {
    const std::size_t to = std::min(text.find(';', from), text.size());
    const std::string part(trimmed(text.substr(from, to - from)));
    from = to + 1;
    if (part.empty())
    {
      continue;
    }
    const std::size_t colon = part.find(':');
    Part& next = mix.parts.emplace_back();
    next.shape = shapeFromName(std::string(trimmed(part.substr(0, colon))));
    if (colon != std::string::npos)
    {
      next.weight = weightOf(std::string(trimmed(part.substr(colon + 1))), text);
    }
    sum += next.weight;
  }
  if (!(sum > 0.0) || !std::isfinite(sum))
  {
    throw ParameterError(
      "Shape mix \"" + text + "\": the weights must have a sum that is positive and finite");
  }
  return mix;
}

Shape ShapeMix::pick(double u) const
{
  double sum = 0.0;
  for (const Part& part : this->parts)
  {
    sum += part.weight;
  }
  double below = 0.0;
  for (const Part& part : this->parts)
  {
    below += part.weight;
    if (u * sum < below)
    {
      return part.shape;
    }
  }
  return this->parts.back().shape;
}

} // namespace rockfall
