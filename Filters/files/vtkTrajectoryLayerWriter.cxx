#include "vtkTrajectoryLayerWriter.h"

#include "base/errors.h"
#include "base/types.h"
#include "files/layerStyles.h"
#include "gis/layers/layerWriter.h"
#include "shared/cells.h"
#include "shared/errorReport.h"
#include "shared/inputs.h"
#include "shared/rockPaths.h"
#include "shared/streamingPieces.h"
#include "shared/terrainFieldData.h"
#include "shared/withAbort.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

vtkStandardNewMacro(vtkTrajectoryLayerWriter);

namespace
{

using rockfall::FieldType;
using rockfall::FieldValue;
using rockfall::LayerField;
using rockfall::LayerWriter;
using rockfall::Vec3;

/// The arrays of a data set as attributes.
class Attributes
{
public:
  void Append(vtkFieldData* data)
  {
    for (int k = 0; k < data->GetNumberOfArrays(); ++k)
    {
      vtkAbstractArray* array = data->GetAbstractArray(k);
      const std::string name = array->GetName() ? array->GetName() : "Array" + std::to_string(k);
      auto* texts = vtkStringArray::SafeDownCast(array);
      auto* numbers = vtkDataArray::SafeDownCast(array);
      if (!texts && !numbers)
      {
        continue;
      }
      const bool real =
        numbers && (numbers->GetDataType() == VTK_DOUBLE || numbers->GetDataType() == VTK_FLOAT);
      const int components = array->GetNumberOfComponents();
      for (int c = 0; c < components; ++c)
      {
        std::string full = name;
        if (components == 3)
        {
          full += "XYZ"[c];
        }
        else if (components > 1)
        {
          full += '_';
          full += std::to_string(c);
        }
        this->Fields.push_back({ full,
          texts    ? FieldType::Text
            : real ? FieldType::Real
                   : FieldType::Integer });
        this->Sources.push_back({ texts, numbers, components, c });
      }
    }
  }

  /// The values of a tuple, behind what is there.
  void AppendValues(vtkIdType tuple, std::vector<FieldValue>& values) const
  {
    for (std::size_t k = 0; k < this->Fields.size(); ++k)
    {
      const Source& source = this->Sources[k];
      if (source.Texts)
      {
        values.emplace_back(
          std::string(source.Texts->GetValue(tuple * source.Components + source.Component)));
      }
      else if (this->Fields[k].type == FieldType::Real)
      {
        values.emplace_back(source.Numbers->GetComponent(tuple, source.Component));
      }
      else
      {
        values.emplace_back(std::int64_t(source.Numbers->GetComponent(tuple, source.Component)));
      }
    }
  }

  std::vector<LayerField> Fields;

private:
  struct Source
  {
    vtkStringArray* Texts;
    vtkDataArray* Numbers;
    int Components;
    int Component;
  };
  std::vector<Source> Sources;
};

Vec3 pointOf(vtkPolyData* data, vtkIdType id)
{
  Vec3 point;
  data->GetPoint(id, point.data());
  return point;
}

void writeTrajectories(vtkPolyData* data, LayerWriter& writer)
{
  Attributes attributes;
  attributes.Append(data->GetCellData());
  vtkDataArray* time = data->GetPointData()->GetArray("Time");
  writer.beginLayer("trajectories", LayerWriter::Geometry::MeasuredLine, attributes.Fields);
  writer.setStyle(rockfall::filters::layerStyle("trajectories", attributes.Fields));
  std::vector<Vec3> places;
  std::vector<double> measures;
  std::vector<FieldValue> values;
  rockfall::filters::forEachLine(data,
    [&](vtkIdType cell, std::span<const vtkIdType> ids)
    {
      places.clear();
      measures.clear();
      values.clear();
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        places.push_back(pointOf(data, ids[k]));
        measures.push_back(time ? time->GetTuple1(ids[k]) : double(k));
      }
      attributes.AppendValues(cell, values);
      writer.add(places, measures, values);
    });
}

/// A layer of points with the attributes of their cell and their own. `forEach` calls its argument
/// with the number of each cell and its points.
template <typename ForEach>
void writePoints(vtkPolyData* data, const std::string& name, LayerWriter& writer, ForEach&& forEach)
{
  Attributes ofCell, ofPoint;
  ofCell.Append(data->GetCellData());
  ofPoint.Append(data->GetPointData());
  std::vector<LayerField> fields = ofCell.Fields;
  fields.insert(fields.end(), ofPoint.Fields.begin(), ofPoint.Fields.end());
  writer.beginLayer(name, LayerWriter::Geometry::Point, fields);
  writer.setStyle(rockfall::filters::layerStyle(name, fields));
  std::vector<FieldValue> values;
  forEach(
    [&](vtkIdType cell, std::span<const vtkIdType> ids)
    {
      for (const vtkIdType id : ids)
      {
        const Vec3 place = pointOf(data, id);
        values.clear();
        ofCell.AppendValues(cell, values);
        ofPoint.AppendValues(id, values);
        writer.add({ &place, 1 }, {}, values);
      }
    });
}

/// The last points of the lines, or all of them.
void writeLinePoints(vtkPolyData* data, bool all, LayerWriter& writer)
{
  writePoints(data, all ? "samples" : "ends", writer,
    [&](auto&& use)
    {
      rockfall::filters::forEachLine(data,
        [&](vtkIdType cell, std::span<const vtkIdType> ids)
        { use(cell, all || ids.empty() ? ids : ids.last(1)); });
    });
}

void writeVertices(vtkPolyData* data, LayerWriter& writer)
{
  writePoints(data, "points", writer,
    [data](auto&& use) { rockfall::filters::forEachCell(data->GetVerts(), 0, use); });
}

} // namespace

//------------------------------------------------------------------------------
vtkTrajectoryLayerWriter::vtkTrajectoryLayerWriter() = default;

//------------------------------------------------------------------------------
vtkTrajectoryLayerWriter::~vtkTrajectoryLayerWriter() = default;

//------------------------------------------------------------------------------
int vtkTrajectoryLayerWriter::FillInputPortInformation(int, vtkInformation* info)
{
  rockfall::filters::acceptPolyData(info);
  return 1;
}

//------------------------------------------------------------------------------
vtkTypeBool vtkTrajectoryLayerWriter::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  rockfall::filters::requestOwnPieces(request, inputs, 1);
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

//------------------------------------------------------------------------------
void vtkTrajectoryLayerWriter::WriteData()
{
  rockfall::filters::Input taken(rockfall::filters::InputKind::Any);
  vtkPolyData* data = taken.take(this->GetInput());
  if (!data ||
    (data->GetNumberOfPoints() == 0 && taken.problem().empty() &&
      rockfall::filters::isFurtherRank()))
  {
    return; // the first rank has it all
  }
  try
  {
    taken.require();
    rockfall::filters::requireWhole(data->GetFieldData(), this->FileName + ": the Input");
    if (data->GetNumberOfLines() == 0 && data->GetNumberOfVerts() == 0)
    {
      throw rockfall::DataError(
        this->FileName + ": cannot be written, as the Input has neither lines nor vertices");
    }
    LayerWriter writer(this->FileName, rockfall::filters::readCrs(data->GetFieldData()));
    if (data->GetNumberOfLines() > 0)
    {
      writeTrajectories(data, writer);
      if (writer.manyLayers())
      {
        writeLinePoints(data, false, writer);
      }
      if (writer.manyLayers() && this->WriteSamples)
      {
        writeLinePoints(data, true, writer);
      }
    }
    if (this->WriteSamples && !(writer.manyLayers() && data->GetNumberOfLines() > 0))
    {
      rockfall::filters::showNote(this->FileName + ": WriteSamples is on, but has no effect: " +
        (writer.manyLayers() ? "the Input has no lines" : "a CSV file has one layer"));
    }
    if (data->GetNumberOfVerts() > 0 && (writer.manyLayers() || data->GetNumberOfLines() == 0))
    {
      writeVertices(data, writer);
    }
    writer.commit();
  }
  catch (...)
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro(<< rockfall::filters::reasonOf(
                    this->FileName + ": there is not enough memory to write it"));
  }
}

//------------------------------------------------------------------------------
void vtkTrajectoryLayerWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << this->FileName << "\n";
  os << indent << "WriteSamples: " << this->WriteSamples << "\n";
}
