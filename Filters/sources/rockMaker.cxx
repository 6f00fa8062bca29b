#include "sources/rockMaker.h"

#include "base/RockMaterial.h"
#include "base/abort.h"
#include "base/errors.h"
#include "base/random.h"
#include "base/text/numberText.h"
#include "geometry/shapes.h"
#include "geometry/shell.h"
#include "law/settings.h"
#include "mesh/shapeFile.h"
#include "rock/placement.h"
#include "shared/inputs.h"
#include "sources/shapeInput.h"

#include <cmath>

namespace rockfall::filters
{

void refuseProperty(const char* name, int value, const char* rule)
{
  throw ParameterError(std::string(name) + " is " + std::to_string(value) + ", it must be " + rule);
}

void requireFinite(const Vec3& value, const char* field)
{
  for (int k = 0; k < 3; ++k)
  {
    if (!std::isfinite(value[k]))
    {
      throw ParameterError(std::string(field) + " has " + numberText(value[k]) + " for its " +
        "xyz"[k] + ", it must be finite");
    }
  }
}

void takeMaterial(
  int number, double& density, double& youngModulus, double& poissonRatio, std::string& name)
{
  const auto materials = rockMaterials();
  if (number < 0 || number > int(materials.size()))
  {
    throw ParameterError(
      "Material is " + std::to_string(number) + ", it must be 0 (as given) to 7 (shale)");
  }
  if (number > 0)
  {
    const RockMaterial& material = materials[std::size_t(number) - 1];
    density = material.density;
    youngModulus = material.youngModulus;
    poissonRatio = material.poissonRatio;
    name = name.empty() ? material.name : name;
  }
}

Quat orientationFromDegrees(const Vec3& angles)
{
  return Eigen::AngleAxisd(radians(angles.z()), Vec3::UnitZ()) *
    Eigen::AngleAxisd(radians(angles.x()), Vec3::UnitX()) *
    Eigen::AngleAxisd(radians(angles.y()), Vec3::UnitY());
}

VolumeDistribution RockMaker::volume(const SourceRow& row) const
{
  VolumeDistribution law = defaults_.volume;
  law.law = row.volumeLaw.value_or(law.law);
  const bool hasMean = law.law != VolumeLaw::Uniform && law.law != VolumeLaw::PowerLaw;
  if (row.volume && !row.volumeLaw && !hasMean)
  {
    law.law = VolumeLaw::Fixed; // the row's one volume is meant
  }
  law.mean = row.volume.value_or(law.mean);
  law.deviation = row.volumeDeviation.value_or(law.deviation);
  law.minimum = row.volumeMinimum.value_or(law.minimum);
  law.maximum = row.volumeMaximum.value_or(law.maximum);
  law.exponent = row.volumeExponent.value_or(law.exponent);
  return law;
}

Polyhedron RockMaker::givenShape()
{
  const bool asItIs = defaults_.shapeAsItIs;
  if (defaults_.shapeMesh)
  {
    return shapeOf(*defaults_.shapeMesh, kShapeInput, asItIs, notes_);
  }
  if (defaults_.shapeFile.empty())
  {
    throw FileError("ShapeFileName is empty, and nothing is connected to the Shape input: the "
                    "shape \"file\" needs points or a mesh");
  }
  return readShape(defaults_.shapeFile, asItIs, notes_);
}

Polyhedron RockMaker::shape(
  Shape kind, const SourceRow& row, const VolumeDistribution& law, std::uint64_t draw)
{
  // A volume that the row itself gives is meant, and so is a distribution; the property has a fixed
  // one always.
  const bool fixed = law.law == VolumeLaw::Fixed;
  const bool meant = row.volume || !fixed;
  const auto drawn = [&]
  {
    law.validate();
    return fixed ? law.mean
                 : law.quantile(uniformDeviate(defaults_.seed, 0, Draw::SourceVolume, draw));
  };
  if (kind == Shape::Box || kind == Shape::Ellipsoid)
  {
    const Vec3 lengths = row.lengths.value_or(defaults_.lengths);
    const Polyhedron made = kind == Shape::Box ? makeBox(lengths) : makeEllipsoid(lengths);
    return meant ? made.withVolume(drawn()) : made;
  }
  if (kind != Shape::File && fixed)
  {
    law.validate();
  }
  const auto [place, isNew] = made_.try_emplace(kind);
  if (isNew)
  {
    try
    {
      place->second = kind == Shape::File ? this->givenShape().centred() : makeShape(kind, 1.0);
    }
    catch (...)
    {
      made_.erase(place);
      throw;
    }
  }
  const bool keep = kind == Shape::File && !defaults_.scaleToVolume && !meant;
  return keep ? place->second : place->second.withVolume(drawn());
}

void RockMaker::setMaterial(const SourceRow& row, Rock& rock) const
{
  rock.density = defaults_.density;
  rock.youngModulus = defaults_.youngModulus;
  rock.poissonRatio = defaults_.poissonRatio;
  rock.material = defaults_.material;
  if (!row.material.empty())
  {
    const RockMaterial& material = rockMaterialFromName(row.material);
    rock.density = material.density;
    rock.youngModulus = material.youngModulus;
    rock.poissonRatio = material.poissonRatio;
    rock.material = material.name;
  }
  rock.material = row.materialName.empty() ? rock.material : row.materialName;
  rock.density = row.density.value_or(rock.density);
  rock.youngModulus = row.youngModulus.value_or(rock.youngModulus);
  rock.poissonRatio = row.poissonRatio.value_or(rock.poissonRatio);
}

void RockMaker::setUncertainty(
  const SourceRow& row, const VolumeDistribution& law, ReleaseUncertainty& unsure) const
{
  unsure = defaults_.uncertainty;
  if (defaults_.randomUnlessGiven)
  {
    const bool given =
      row.orientation || defaults_.randomOrientation || !defaults_.orientation.isZero(0.0);
    unsure.attitude = given ? AttitudeLaw::AsGiven : AttitudeLaw::Random;
  }
  unsure.horizontalDeviation = row.horizontalDeviation.value_or(unsure.horizontalDeviation);
  unsure.verticalDeviation = row.verticalDeviation.value_or(unsure.verticalDeviation);
  if (row.randomAttitude)
  {
    unsure.attitude = AttitudeLaw::Random;
  }
  else if (row.attitudeDeviation)
  {
    unsure.attitude = *row.attitudeDeviation > 0.0 ? AttitudeLaw::Deviate : AttitudeLaw::AsGiven;
    unsure.attitudeDeviation = radians(*row.attitudeDeviation);
  }
  unsure.volume =
    defaults_.redrawVolume && law.law != VolumeLaw::Fixed ? law : VolumeDistribution();
}

Shape RockMaker::kindOf(const SourceRow& row, std::uint64_t draw) const
{
  const ShapeMix& shapes = row.shapes ? *row.shapes : defaults_.shapes;
  return shapes.parts.size() == 1
    ? shapes.parts.front().shape
    : shapes.pick(uniformDeviate(defaults_.seed, 0, Draw::SourceShape, draw));
}

std::int64_t RockMaker::amountOf(
  const SourceRow& row, std::uint64_t firstDraw, double totalVolume, std::int64_t most)
{
  const VolumeDistribution law = this->volume(row);
  if (!(totalVolume <= kMostVolume * double(most)))
  {
    throw ParameterError("TotalVolume is " + numberText(totalVolume) + " m³, which " +
      std::to_string(most) + " rocks (MaximumRocks) do not have: none has more than " +
      numberText(kMostVolume) + " m³");
  }
  double sum = 0.0;
  for (std::int64_t amount = 1; amount <= most; ++amount)
  {
    stayWanted();
    const std::uint64_t draw = firstDraw + std::uint64_t(amount) - 1;
    const double volume = this->shape(this->kindOf(row, draw), row, law, draw).integrals().volume;
    if (sum + volume >= totalVolume)
    {
      return amount > 1 && totalVolume - sum < sum + volume - totalVolume ? amount - 1 : amount;
    }
    sum += volume;
  }
  throw ParameterError("TotalVolume is " + numberText(totalVolume) + " m³, which " +
    std::to_string(most) + " rocks (MaximumRocks) do not have: they have " + numberText(sum) +
    " m³");
}

void RockMaker::refuseLengths(const SourceRow& row) const
{
  const ShapeMix& shapes = row.shapes ? *row.shapes : defaults_.shapes;
  std::string names;
  for (const auto& part : shapes.parts)
  {
    if (part.shape == Shape::Box || part.shape == Shape::Ellipsoid)
    {
      return;
    }
    names += (names.empty() ? "" : ", ") + shapeName(part.shape);
  }
  const Vec3& l = *row.lengths;
  throw ParameterError("fields \"lx\", \"ly\" and \"lz\" are " + numberText(l.x()) + ", " +
    numberText(l.y()) + " and " + numberText(l.z()) + " m, but " +
    (row.shapes ? "field \"shape\"" : "Shape") + " is " + names +
    ": lengths are those of a box or an ellipsoid, other shapes have a \"volume\"");
}

ReleasedRock RockMaker::make(
  const SourceRow& row, std::size_t index, const ReleasePlace& place, std::int64_t blockId)
{
  stayWanted();
  if (row.lengths)
  {
    this->refuseLengths(row);
  }
  ReleasedRock released;
  released.shape = this->kindOf(row, place.draw);
  released.sourceId = row.sourceId.value_or(defaults_.firstSourceId + std::int64_t(index));
  released.sourceName = !row.sourceName.empty() ? row.sourceName
    : !defaults_.sourceName.empty()             ? defaults_.sourceName
                                                : "source " + std::to_string(released.sourceId);

  Rock& rock = released.rock;
  rock.blockId = blockId;
  const VolumeDistribution law = this->volume(row);
  rock.shape = this->shape(released.shape, row, law, place.draw);
  rock.position = place.position;
  rock.position.z() = place.overGround ? 0.0 : rock.position.z();
  requireFinite(rock.position, "Center");
  const Vec3 angles = row.orientation.value_or(defaults_.orientation);
  requireFinite(angles, "Orientation");
  rock.orientation = orientationFromDegrees(angles);
  if (defaults_.randomOrientation && !row.orientation)
  {
    const auto [u, v] = uniformDeviates(defaults_.seed, 0, Draw::SourceAttitude, place.draw);
    rock.orientation =
      randomRotation(u, v, uniformDeviate(defaults_.seed, 1, Draw::SourceAttitude, place.draw));
  }
  rock.velocity = row.velocity.value_or(defaults_.velocity);
  rock.angularVelocity = row.angularVelocity.value_or(defaults_.angularVelocity);
  this->setMaterial(row, rock);
  this->setUncertainty(row, law, rock.uncertainty);
  rock.validate();
  if (place.overGround)
  {
    const Vec3 local = place.position - terrain_->geometry().origin();
    rock.position.z() = place.height +
      touchingHeight(
        Surface::asSurveyed(*terrain_), rock.shape, rock.orientation, local.x(), local.y());
    requireFinite(rock.position, "Center");
  }
  return released;
}

} // namespace rockfall::filters
