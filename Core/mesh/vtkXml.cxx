#include "mesh/MeshBuilder.h"
#include "mesh/cells.h"
#include "mesh/meshFile.h"
#include "mesh/vtkData.h"
#include "mesh/xmlTags.h"

#include <algorithm>

namespace rockfall
{

namespace
{

class XmlReader
{
public:
  XmlReader(std::string_view bytes, const std::string& name)
    : name_(name)
    , mesh_(name)
  {
    encoding_.name = name;
    encoding_.fileSize = bytes.size();
    this->findTags(bytes);
  }

  Mesh read()
  {
    // The arrays of a piece stand in sections, in any order.
    std::string_view section;
    Piece piece;
    bool inPiece = false;
    for (const XmlTag& tag : tags_)
    {
      if (tag.name == "Piece" && !tag.isEnd)
      {
        piece = {};
        inPiece = !tag.isWhole;
      }
      else if (tag.name == "Piece")
      {
        this->addPiece(piece);
        inPiece = false;
      }
      else if (inPiece && tag.name == "DataArray" && !tag.isEnd)
      {
        this->takeArray(tag, section, piece);
      }
      else if (tag.name != "DataArray" && !tag.isWhole)
      {
        section = tag.isEnd ? std::string_view() : tag.name;
      }
    }
    return mesh_.finish(single_, digits_);
  }

private:
  struct Lists
  {
    std::vector<std::int64_t> ids, ends;
  };
  struct Piece
  {
    std::vector<double> coordinates;
    Lists polygons, strips;
  };

  void findTags(std::string_view bytes)
  {
    XmlTags tags(bytes, name_);
    bool isVtk = false;
    while (const std::optional<XmlTag> tag = tags.next())
    {
      if (tag->name == "VTKFile" && !tag->isEnd)
      {
        isVtk = true;
        this->readRoot(*tag);
      }
      if (tag->name == "AppendedData" && !tag->isEnd)
      {
        const std::string_view rest = tags.rest();
        encoding_.appended = rest.substr(std::min(rest.find('_'), rest.size() - 1) + 1);
        encoding_.appendedBase64 = (*tag)["encoding"] == "base64";
        return; // what follows need be no XML
      }
      tags_.push_back(*tag);
    }
    if (!isVtk)
    {
      throw FileError(name_ + ": is no XML file of VTK, which has a tag VTKFile");
    }
    // A file that is cut off has no end.
    if (tags_.back().name != "VTKFile" || !tags_.back().isEnd)
    {
      throw FileError(name_ + ": is truncated: it has no end tag VTKFile");
    }
  }

  void readRoot(const XmlTag& root)
  {
    if (root["type"] != "PolyData")
    {
      throw FileError(name_ + ": its type is " + inQuotes(root["type"]) +
        ", PolyData is needed: extract the surface and save it as .vtp");
    }
    encoding_.bigEndian = root["byte_order"] == "BigEndian";
    encoding_.header = root["header_type"] == "UInt64" ? NumberType::UInt64 : NumberType::UInt32;
    const std::string_view compressor = root["compressor"];
    encoding_.packed = !compressor.empty();
    if (encoding_.packed && compressor != "vtkZLibDataCompressor")
    {
      throw FileError(name_ + ": is packed by " + std::string(compressor) +
        "; save it with the compressor ZLib, or with none");
    }
  }

  void takeArray(const XmlTag& tag, std::string_view section, Piece& piece)
  {
    const bool points = section == "Points";
    Lists* lists = section == "Polys" ? &piece.polygons
      : section == "Strips"           ? &piece.strips
                                      : nullptr;
    if (!points && !lists)
    {
      return; // what is beside the geometry
    }
    const VtkData data(
      encoding_, tag["type"], tag["format"], tag["offset"], tag.isWhole ? "" : tag.text);
    if (points)
    {
      single_ = single_ || (!data.isText() && data.type() == NumberType::Float32);
      piece.coordinates = data.reals(digits_);
    }
    else if (tag["Name"] == "connectivity")
    {
      lists->ids = data.wholes();
    }
    else if (tag["Name"] == "offsets")
    {
      lists->ends = data.wholes();
    }
    values_ += data.mostValues();
    if (values_ > encoding_.mostBytes())
    {
      throw FileError(name_ + ": is damaged: its pieces have one array in common");
    }
  }

  void addPiece(const Piece& piece)
  {
    if (piece.coordinates.size() % 3 != 0)
    {
      throw FileError(name_ + ": its points have " + std::to_string(piece.coordinates.size()) +
        " coordinates, that is not three for each");
    }
    const std::int64_t first = mesh_.points();
    for (std::size_t k = 0; k < piece.coordinates.size(); k += 3)
    {
      mesh_.addPoint({ piece.coordinates[k], piece.coordinates[k + 1], piece.coordinates[k + 2] });
    }
    const std::int64_t last = mesh_.points();
    std::vector<std::int64_t> numbers;
    const auto ofPiece = [&](std::span<const std::int64_t> ids)
    {
      numbers.assign(ids.begin(), ids.end());
      for (std::int64_t& id : numbers)
      {
        if (id < 0 || id >= last - first)
        {
          throw FileError(name_ + ": a face refers to point " + std::to_string(id) +
            ", there are " + std::to_string(last - first));
        }
        id += first;
      }
    };
    forEachCell(piece.polygons.ends, false, piece.polygons.ids, name_,
      [&](std::size_t, auto ids) { ofPiece(ids), mesh_.addFace(numbers); });
    forEachCell(piece.strips.ends, false, piece.strips.ids, name_,
      [&](std::size_t, auto ids) { ofPiece(ids), mesh_.addStrip(numbers); });
  }

  std::string name_;
  MeshBuilder mesh_;
  VtkEncoding encoding_;
  std::vector<XmlTag> tags_;
  bool single_ = false;
  WrittenDigits digits_;
  std::size_t values_ = 0; ///< Of all arrays.
};

} // namespace

Mesh parseVtkXml(std::string_view bytes, const std::string& name)
{
  return XmlReader(bytes, name).read();
}

} // namespace rockfall
