#pragma once

/// @file
/// Drawings (DXF): one layer for OGR, in which every entity says of which of the drawing's own
/// layers it is. Internal to gis/: needs GDAL's headers.

#include <ogrsf_frmts.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace rockfall::gis
{

struct LayerWish;

/// The drawing's layer that an entity is of.
std::string drawingLayerOf(const OGRFeature& entity);
bool isText(const OGRFeature& entity);  ///< A label.
bool isPaper(const OGRFeature& entity); ///< Of a sheet to be plotted, not of the model.

/// Content of the layers of a drawing.
class DrawingLayers
{
public:
  explicit DrawingLayers(OGRLayer& entities);

  /// Layers that are read. `notes` names them and those that were left out. Throws DataError as
  /// LayerFile does, naming the drawing's layers.
  std::set<std::string> choose(const LayerWish& wish, std::vector<std::string>& notes) const;

private:
  struct Holding
  {
    std::map<unsigned, std::int64_t> count; ///< Entities by kind.
    bool heights = false;                   ///< Some z is not 0.
  };
  std::set<std::string> named(const LayerWish& wish) const;
  std::string list() const;

  std::map<std::string, Holding> layers_;
};

} // namespace rockfall::gis
