#include "BlockSlope/SlopeBlocks.h"

#include "base/errors.h"
#include "base/text/numberText.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rockfall
{

namespace
{

/// The prism under a triangle that is counter-clockwise seen from above.
VolumeIntegrals prismUnder(const std::array<Vec3, 3>& top, double depth)
{
  std::array<Vec3, 6> points;
  for (int k = 0; k < 3; ++k)
  {
    points[k] = top[k];
    points[3 + k] = top[k] - Vec3(0.0, 0.0, depth);
  }
  static const std::vector<std::vector<int>> faces = { { 0, 1, 2 }, { 5, 4, 3 }, { 0, 3, 4, 1 },
    { 1, 4, 5, 2 }, { 2, 5, 3, 0 } };
  return integrateSimplices(points, faces);
}

/// Volumes, centroids and second moments of two bodies together.
VolumeIntegrals joined(const VolumeIntegrals& a, const VolumeIntegrals& b)
{
  VolumeIntegrals sum;
  sum.volume = a.volume + b.volume;
  sum.centroid = (a.volume * a.centroid + b.volume * b.centroid) / sum.volume;
  for (const VolumeIntegrals* part : { &a, &b })
  {
    const Vec3 arm = part->centroid - sum.centroid;
    sum.second += part->second + part->volume * arm * arm.transpose();
  }
  return sum;
}

} // namespace

void SlopeBlockMaterial::validate() const
{
  const auto positive = [](double value, const char* field)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(std::string("slope block: ") + field + " is " + numberText(value) +
        ", it must be positive and finite");
    }
  };
  positive(this->density, "density");
  positive(this->youngModulus, "Young's modulus");
  positive(this->depth, "depth");
  positive(this->fixity, "fixity");
  if (!(this->poissonRatio >= 0.0 && this->poissonRatio < 0.5))
  {
    throw ParameterError("slope block: Poisson's ratio is " + numberText(this->poissonRatio) +
      ", it must be at least 0 and below 0.5");
  }
}

SlopeBlocks makeSlopeBlocks(
  const Surface& surface, SlopeModel model, const SlopeBlockMaterial& material)
{
  material.validate();
  const Terrain& terrain = surface.terrain();
  const GridGeometry& grid = terrain.geometry();
  SlopeBlocks slope;
  slope.ofCfe.assign(std::size_t(terrain.cfeCapacity()) + 1, -1);
  std::vector<std::vector<std::int64_t>> nodesOf; // of each block, with repetitions
  std::vector<double> sizeOf;                     // ∛V of one of its prisms, m
  const auto place = [&](std::int64_t node)
  {
    const int row = int(node / grid.columns), column = int(node % grid.columns);
    Vec3 p = terrain.node(row, column);
    p.z() = surface.nodeHeight(row * surface.grid().parts, column * surface.grid().parts);
    return p;
  };
  for (std::int64_t cfe = 1; cfe <= terrain.cfeCapacity(); ++cfe)
  {
    if (!terrain.hasCfe(cfe))
    {
      continue;
    }
    const std::array<std::int64_t, 3> nodes = terrain.cfeNodes(cfe);
    const VolumeIntegrals prism =
      prismUnder({ place(nodes[0]), place(nodes[1]), place(nodes[2]) }, material.depth);
    if (model == SlopeModel::ArtificialBlocks || slope.blocks.empty())
    {
      slope.blocks.emplace_back().integrals = prism;
      nodesOf.emplace_back();
      sizeOf.push_back(std::cbrt(prism.volume));
    }
    else
    {
      slope.blocks[0].integrals = joined(slope.blocks[0].integrals, prism);
    }
    slope.ofCfe[std::size_t(cfe)] = int(slope.blocks.size()) - 1;
    nodesOf.back().insert(nodesOf.back().end(), nodes.begin(), nodes.end());
  }

  const Mat6 elasticity = isotropicElasticity(material.youngModulus, material.poissonRatio);
  for (std::size_t i = 0; i < slope.blocks.size(); ++i)
  {
    SlopeBlock& block = slope.blocks[i];
    block.mass = integrateMass(material.density, block.integrals.volume, block.integrals.second);
    block.stiffness.block<6, 6>(kStrain, kStrain) = block.integrals.volume * elasticity;
    std::vector<std::int64_t>& nodes = nodesOf[i];
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (std::int64_t node : nodes)
    {
      const Vec3 top = place(node);
      block.fixedPoints.push_back(top - Vec3(0.0, 0.0, material.depth));
      const std::int64_t row = node / grid.columns, column = node % grid.columns;
      if (row == 0 || column == 0 || row == grid.rows - 1 || column == grid.columns - 1)
      {
        block.fixedPoints.push_back(top);
      }
    }
    // Shi's fixed point: ½ p |T D|².
    const double penalty = material.fixity * material.youngModulus * sizeOf[i];
    for (const Vec3& point : block.fixedPoints)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const Vec12 row = block.row(Vec3::Unit(axis), point);
        block.stiffness += penalty * row * row.transpose();
      }
    }
  }
  return slope;
}

} // namespace rockfall
