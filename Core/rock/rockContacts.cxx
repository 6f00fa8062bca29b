#include "rock/rockContacts.h"

#include "base/RockMaterial.h"
#include "base/require.h"
#include "base/text/nameKey.h"
#include "geometry/shell.h"
#include "law/springs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace rockfall
{

namespace
{

/// Of a dense table.
constexpr std::size_t kMostMaterials = 255;

PairLaw lawOf(const RockContact& contact)
{
  PairLaw law;
  law.restitution = contact.restitution;
  law.friction = std::tan(contact.frictionAngle);
  law.cohesion = contact.cohesion;
  law.damping = dampingRatio(contact.restitution);
  return law;
}

} // namespace

void validateRockContacts(std::span<const RockContactPair> pairs)
{
  std::set<std::string> materials;
  std::set<std::pair<std::string, std::string>> known;
  for (const RockContactPair& pair : pairs)
  {
    const std::string name = "the contact of \"" + pair.first + "\" and \"" + pair.second + "\"";
    std::string a = nameKey(pair.first), b = nameKey(pair.second);
    if (a.empty() || b.empty())
    {
      throw ParameterError(name + " is of a material without a name");
    }
    materials.insert({ a, b });
    if (!known.insert(std::minmax(a, b)).second)
    {
      throw ParameterError(name + " is there twice");
    }
    const RockContact& c = pair.contact;
    require(c.restitution >= 0.0 && c.restitution <= 1.0, name + ": the restitution", c.restitution,
      "", "0 to 1");
    require(c.frictionAngle >= 0.0 && c.frictionAngle <= radians(89.0),
      name + ": the friction angle", degrees(c.frictionAngle), "°", "0 to 89");
    require(c.cohesion >= 0.0 && std::isfinite(c.cohesion), name + ": the cohesion", c.cohesion,
      " N", "finite and not negative");
  }
  if (materials.size() > kMostMaterials)
  {
    throw ParameterError("the contacts of rocks are of " + std::to_string(materials.size()) +
      " materials, more than " + std::to_string(kMostMaterials));
  }
}

RockContacts::RockContacts(std::span<const Rock> rocks, const SimulationParameters& parameters)
{
  std::map<std::string, int> kinds;
  for (const RockContactPair& pair : parameters.rockContactPairs)
  {
    for (const std::string* name : { &pair.first, &pair.second })
    {
      kinds.emplace(nameKey(*name), int(kinds.size()) + 1);
    }
  }
  kinds_ = kinds.size() + 1;
  kindOf_.reserve(rocks.size());
  for (const Rock& rock : rocks)
  {
    const auto kind =
      kinds.empty() || rock.material.empty() ? kinds.end() : kinds.find(nameKey(rock.material));
    kindOf_.push_back(kind == kinds.end() ? 0 : kind->second);
  }
  laws_.assign(kinds_ * kinds_,
    lawOf({ parameters.rockRestitution, parameters.rockFrictionAngle, parameters.rockCohesion }));
  for (const RockContactPair& pair : parameters.rockContactPairs)
  {
    const std::size_t a = std::size_t(kinds.at(nameKey(pair.first)));
    const std::size_t b = std::size_t(kinds.at(nameKey(pair.second)));
    laws_[a * kinds_ + b] = laws_[b * kinds_ + a] = lawOf(pair.contact);
  }
}

double RockContacts::largestRestitution() const
{
  double largest = 0.0;
  for (const PairLaw& law : laws_)
  {
    largest = std::max(largest, law.restitution);
  }
  return largest;
}

} // namespace rockfall
