#pragma once

/// @file
/// A vector file or table, and which of its layers is read: the one place that decides it for all
/// readers. Internal to gis/: needs GDAL's headers.

#include "gis/base/crs.h"
#include "gis/base/gdal.h"

#include <ogrsf_frmts.h>

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace rockfall::gis
{

/// Kinds of features: bits of LayerWish::kinds.
enum FeatureKind : unsigned
{
  kPoints = 1,
  kLines = 2, ///< Curves as well.
  kPolygons = 4,
  kRows = 8, ///< Without a geometry.
};

unsigned kindOf(const OGRGeometry* geometry);

/// Names of columns of which one must be there.
using ColumnChoice = std::vector<std::string>;

/// Layers that a reader can take.
struct LayerWish
{
  std::string fileName;
  /// As the user gives it; empty: the one layer that will do. Of a drawing (DXF) the names of its
  /// own layers, with commas between them, or * for all.
  std::string layer;
  std::string property = "LayerName"; ///< Property in which the user gives the layer.
  const char* what = "layer";         ///< For messages: "layer of lines".
  unsigned kinds = 0;
  /// A layer that has one column of each choice will do better than those that have not.
  std::vector<ColumnChoice> columns = {};
  /// Of several kinds those that do better; 0: none.
  unsigned better = 0;
  /// Lines with heights: those of a layer with z are as good as those with a column of heights, and
  /// of a drawing all layers with heights are taken.
  bool heights = false;
};

/// An open file, and the features of the layer that is read.
///
/// A layer will do if its features are of the wished kinds; if several do, those with the wished
/// columns, else those of the better kinds. Layers without features count if there is no other.
/// The rest must be one layer. Where a file has several layers, a note says which was taken. Of a
/// file with one layer it is that one, whatever it is: its reader knows better what is wrong with
/// it.
///
/// In a drawing, what is of another kind (labels, points, hatches) or in paper space is left out
/// with a note, and so are, of lines with heights, layers that lie at z 0 as frames do.
class LayerFile
{
public:
  /// Throws FileError (see openVector) or DataError naming the file and its layers.
  LayerFile(const LayerWish& wish, Messages& messages);

  GDALDataset& dataset() const { return *dataset_; }
  OGRLayer& layer() const { return *layer_; }
  const OGRFeatureDefn& definition() const { return *layer_->GetLayerDefn(); }
  const std::string& fileName() const { return wish_.fileName; }
  bool isOfDrawing() const { return drawing_; }

  /// Throws DataError naming file and layer if that is in degrees, or counts to the west or south,
  /// and `target`, where it is to go, is not known. GeoJSON says degrees of all that has no CRS, and is
  /// believed not to.
  void refuseForeignAxes(const CrsPtr& from, const std::string& target) const;

  /// The next feature, null after the last. Throws FileError if it cannot be read.
  OGRFeatureUniquePtr next();
  /// Of the feature that came last, from 1.
  std::int64_t number() const { return number_; }

  /// Notes on the text, the layer that was taken and what was left out; complete when next() has
  /// given null. `named`: each note begins with the file's name.
  void tell(std::vector<std::string>& notes, bool named) const;

private:
  void choose();
  void chooseInDrawing();
  void checkColumns() const;
  void note(std::string text) { notes_.push_back(std::move(text)); }

  LayerWish wish_;
  Messages& messages_;
  std::vector<std::string> notes_;
  DatasetPtr dataset_;
  OGRLayer* layer_ = nullptr;
  bool drawing_ = false;
  std::set<std::string> drawn_; ///< Layers of a drawing that are read.
  std::int64_t number_ = 0;
  std::int64_t others_ = 0; ///< Entities that were left out.
  bool finished_ = false;
};

/// "a" (Line String, 12 features), "b" (...): the layers of a file, for a message.
std::string layerList(GDALDataset& dataset);

/// How well a layer will do: 0 not, 1 by its kind, 2 by its better kind, 3 by its columns as well.
int fitnessOf(OGRLayer& layer, const LayerWish& wish);

} // namespace rockfall::gis
