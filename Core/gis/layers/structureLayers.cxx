#include "gis/layers/structureLayers.h"

#include "base/errors.h"
#include "gis/layers/structureRows.h"
#include "terrain/Obstacles.h"
#include "terrain/Terrain.h"
#include "terrain/plausible.h"

namespace rockfall
{

using namespace gis;

namespace
{

/// Errors of structures that cannot be built name the file, and so do notes of what is too good to
/// be true. Stems behind the first `alone` were drawn: they may stand side by side.
void tryOut(const StructureReader& reader, const std::string& fileName, Structures part,
  std::size_t alone = 0)
{
  Structures given = part;
  given.trees.resize(alone);
  std::vector<std::string> doubts;
  askAfterNumbers(part, doubts);
  askAfterTwins(given, doubts, reader.terrain.geometry().origin().head<2>());
  reader.tell(fileName, doubts);
  try
  {
    const Obstacles built(std::move(part), reader.terrain);
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
