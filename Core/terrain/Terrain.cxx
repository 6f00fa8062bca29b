#include "terrain/Terrain.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "terrain/Obstacles.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Parts of the side of a cell, and nodes along that of a slope: keys of triangles, ridges and
/// walls have room for them.
constexpr double kMostParts = 200.0, kMostNodes = 1e7;

} // namespace

Terrain::Terrain(GridGeometry geometry, std::span<const double> heights,
  std::shared_ptr<const void> owner, SurfaceMaterial material, Roughness roughness)
  : HeightGrid(std::move(geometry), heights, std::move(owner))
  , material_(material)
  , roughness_(roughness)
{
  material_.validate();
  roughness_.validate();
  this->findRefinement();
}

Terrain::Terrain(
  GridGeometry geometry, std::vector<double> heights, SurfaceMaterial material, Roughness roughness)
{
  auto kept = std::make_shared<std::vector<double>>(std::move(heights));
  std::span<const double> view(*kept);
  *this = Terrain(std::move(geometry), view, std::move(kept), material, roughness);
}

Terrain::Terrain(const Terrain& other, SurfaceMaterial material, Roughness roughness)
  : Terrain(other)
{
  material_ = material;
  roughness_ = roughness;
  material_.validate();
  roughness_.validate();
  restitutionClasses_ = jointClasses_ = {};
  obstacles_.reset();
  this->findRefinement();
}

void Terrain::setRestitutionClasses(MaterialClasses classes)
{
  classes.validate(this->geometry().cellCount(), "restitution");
  restitutionClasses_ = std::move(classes);
  this->findRefinement();
}

void Terrain::setJointClasses(MaterialClasses classes)
{
  classes.validate(this->geometry().cellCount(), "joint");
  jointClasses_ = std::move(classes);
}

double Terrain::roughnessHeight() const
{
  double most = 0.0;
  for (int k = 0; k <= restitutionClasses_.count(); ++k)
  {
    most = std::max(most, this->roughnessOf(k).highest());
  }
  return most;
}

double Terrain::roughnessDepth() const
{
  double most = 0.0;
  for (int k = 0; k <= restitutionClasses_.count(); ++k)
  {
    most = std::max(most, this->roughnessOf(k).deepest());
  }
  return most;
}

bool Terrain::draws() const
{
  const auto deviates = [](const SurfaceMaterial& m) {
    return m.restitutionDeviation > 0.0 || m.frictionAngleDeviation > 0.0 || m.yielding.deviates();
  };
  const auto any = [&](const std::vector<SurfaceMaterial>& materials)
  { return std::any_of(materials.begin(), materials.end(), deviates); };
  bool drawn = deviates(material_) || any(restitutionClasses_.materials) ||
    any(jointClasses_.materials) || (obstacles_ && any(obstacles_->structures().materials));
  for (int k = 0; k <= restitutionClasses_.count(); ++k)
  {
    drawn = drawn || this->roughnessOf(k).varies();
  }
  return drawn;
}

void Terrain::findRefinement()
{
  refinement_ = 1;
  for (int k = 0; k <= restitutionClasses_.count(); ++k)
  {
    const double spacing = this->roughnessOf(k).resolvedBy();
    const double parts =
      spacing > 0.0 ? std::ceil(this->geometry().cellSize / spacing - 1e-9) : 1.0;
    const double nodes = parts * std::max(this->geometry().rows, this->geometry().columns);
    if (parts > kMostParts || nodes > kMostNodes)
    {
      throw ParameterError("RoughnessLength is " + numberText(this->roughnessOf(k).length) +
        " m on cells of " + numberText(this->geometry().cellSize) +
        " m, which it would cut into too many: take a smaller CellSize or a longer length");
    }
    refinement_ = std::max(refinement_, int(parts));
  }
}

void Terrain::setStructures(Structures structures)
{
  obstacles_ =
    structures.any() ? std::make_shared<const Obstacles>(std::move(structures), *this) : nullptr;
}

int Terrain::obstacleClass(std::int64_t cfe, int layerClasses) const
{
  const int material = obstacles_->materialOf(cfe);
  return material == 0 ? 0 : layerClasses + material;
}

const SurfaceMaterial& Terrain::obstacleMaterial(int number) const
{
  return obstacles_->structures().materials[std::size_t(number) - 1];
}

Terrain makeBiplanarSlope(double cellSize)
{
  if (!(cellSize > 0.0) || !(cellSize <= 50.0))
  {
    throw ParameterError("CellSize is " + numberText(cellSize) +
      " m, the test slope takes more than 0 and at most 50");
  }
  const double incline = 100.0;
  const double rise = 57.7;
  GridGeometry geometry;
  geometry.cellSize = cellSize;
  geometry.columns = int(std::lround(250.0 / cellSize)) + 1;
  geometry.rows = int(std::lround(100.0 / cellSize)) + 1;
  std::vector<double> heights(std::size_t(geometry.nodeCount()));
  for (int row = 0; row < geometry.rows; ++row)
  {
    for (int column = 0; column < geometry.columns; ++column)
    {
      const double x = column * cellSize;
      heights[std::size_t(row) * geometry.columns + column] =
        std::max(0.0, rise * (1.0 - x / incline));
    }
  }
  return Terrain(std::move(geometry), std::move(heights));
}

bool Terrain::isSoft(bool (YieldingGround::*how)() const) const
{
  const int built = obstacles_ ? int(obstacles_->structures().materials.size()) : 0;
  for (int k = 0; k <= restitutionClasses_.count() + built; ++k)
  {
    if ((this->restitutionMaterial(k).yielding.*how)())
    {
      return true;
    }
  }
  return false;
}

} // namespace rockfall
