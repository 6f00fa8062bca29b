#include "rock/statement.h"

#include "base/text/numberText.h"

namespace rockfall
{

std::string statementOf(const SimulationParameters& p)
{
  std::string text;
  const auto add = [&text](const char* name, double value, const char* unit = "")
  { text += (text.empty() ? "" : "\n") + std::string(name) + " " + numberText(value) + unit; };
  add("TimeStep", p.timeStep, " s");
  add("Gravity", p.gravity, " m/s²");
  add("NormalPenalty", p.normalPenalty, " N/m");
  add("ShearPenaltyRatio", p.shearRatio);
  add("Rigid", double(p.rigid));
  add("ImpactResolution", double(p.impactResolution));
  add("RockRockContact", double(p.rockRockContact));
  if (p.rockRockContact)
  {
    add("RockRestitution", p.rockRestitution);
    add("RockFrictionAngle", degrees(p.rockFrictionAngle), " degrees");
    add("RockCohesion", p.rockCohesion, " N");
    for (const RockContactPair& pair : p.rockContactPairs)
    {
      add(("Pair " + pair.first + "–" + pair.second + ": restitution").c_str(),
        pair.contact.restitution);
      add("friction", degrees(pair.contact.frictionAngle), " degrees");
      add("cohesion", pair.contact.cohesion, " N");
    }
  }
  add("Fragmentation", double(p.fragmentation.on));
  if (p.fragmentation.on)
  {
    add("FragmentationEnergy", p.fragmentation.energy, " J/m³");
    add("FractalDimension", p.fragmentation.fractalDimension);
    add("LeastFragment", p.fragmentation.leastVolume, " m³");
    add("SurvivalRate", p.fragmentation.survival);
    add("FragmentationLoss", p.fragmentation.loss);
    add("FragmentSpread", degrees(p.fragmentation.spread), " degrees");
  }
  return text;
}

} // namespace rockfall
