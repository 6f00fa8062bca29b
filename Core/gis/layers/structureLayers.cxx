#include "gis/layers/structureLayers.h"

#include "base/Tally.h"
#include "base/errors.h"
#include "geometry/polyline.h"
#include "gis/base/gdal.h"
#include "gis/layers/structureRows.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"
#include "terrain/plausible.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

using namespace gis;

namespace
{

/// Barriers that go on where the slope has no ground: over two cells, as borders are drawn by eye.
void askAfterGroundUnder(
  const std::vector<Barrier>& barriers, const Terrain& terrain, std::vector<std::string>& notes)
{
  const double cell = terrain.geometry().cellSize;
  Tally beyond;
  for (const Barrier& barrier : barriers)
  {
    const double without = lengthWithoutGround(terrain, barrier.points);
    beyond.look(without > 2.0 * cell,
      [&]
      {
        return std::to_string(barrier.feature) + " on " + number(std::round(without)) + " of " +
          number(std::round(lengthOf(barrier.points))) + " m";
      });
  }
  beyond.tell(notes, "",
    " of " + std::to_string(barriers.size()) +
      " barriers go on where the slope has no ground, first feature ",
    ". They hold and record nothing there");
}

/// An embankment by the elevation of its crest gets its greatest height over ground.
void setHeights(std::vector<Embankment>& dams, const Terrain& terrain)
{
  for (Embankment& dam : dams)
  {
    for (const Eigen::Vector2d& p : dam.points)
    {
      dam.height = std::fmax(dam.height, dam.elevation - terrain.elevation(p.x(), p.y()));
    }
  }
}

/// Errors of structures that cannot be built name the file, and so do notes of what is too good to
/// be true. Stems behind the first `alone` were drawn: they may stand side by side.
void tryOut(const StructureReader& reader, const std::string& fileName, Structures part,
  std::size_t alone = 0)
{
  Structures given = part;
  given.trees.resize(alone);
  setHeights(given.embankments, reader.terrain);
  std::vector<std::string> doubts;
  askAfterNumbers(given, doubts); // a stand's numbers are those of its row
  askAfterTwins(given, doubts, reader.terrain.geometry().origin().head<2>());
  askAfterGroundUnder(part.barriers, reader.terrain, doubts);
  try
  {
    const Obstacles built(std::move(part), reader.terrain);
    built.askAfterLying(doubts);
    reader.tell(fileName, doubts);
  }
  catch (const Error& error)
  {
    throw DataError(fileName + ", " + error.what());
  }
}

} // namespace

Structures readStructures(const StructureFiles& files, const Terrain& terrain,
  std::vector<std::string>& notes, std::span<const Stand> cells)
{
  Structures all;
  OwnMaterials own(terrain.material(), all.materials);
  const StructureReader reader{ files, terrain, own, all, notes };
  if (!files.embankments.empty())
  {
    reader.readEmbankments();
    tryOut(reader, files.embankments, { all.embankments, {}, {}, all.materials });
  }
  if (!files.trees.empty())
  {
    const std::size_t alone = reader.readTrees(cells);
    tryOut(reader, files.trees, { {}, all.trees, {}, all.materials }, alone);
  }
  if (!files.barriers.empty())
  {
    reader.readBarriers();
    tryOut(reader, files.barriers, { {}, {}, all.barriers, {} });
  }
  return all;
}

} // namespace rockfall
