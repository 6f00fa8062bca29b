#include "mesh/MeshBuilder.h"
#include "mesh/meshFile.h"
#include "mesh/words.h"

#include <algorithm>
#include <iterator>

namespace rockfall
{

namespace
{

/// Statements that say nothing of where points and faces are.
bool isOtherStatement(std::string_view keyword)
{
  constexpr std::string_view known[] = { "vt", "vn", "g", "o", "s", "usemtl", "mtllib", "l", "p",
    "mg", "usemap", "maplib", "lod", "shadow_obj", "trace_obj", "bevel", "c_interp", "d_interp" };
  return std::find(std::begin(known), std::end(known), keyword) != std::end(known);
}

class ObjReader
{
public:
  ObjReader(std::string_view bytes, const std::string& name)
    : words_(bytes, name)
    , mesh_(name)
  {
  }

  Mesh read()
  {
    for (std::string_view keyword = words_.next(); !keyword.empty(); keyword = words_.next())
    {
      if (keyword == "v")
      {
        this->readPoint();
      }
      else if (keyword == "f" || keyword == "fo")
      {
        this->readFace();
      }
      else if (isOtherStatement(keyword))
      {
        while (!this->nextWord().empty())
        {
        }
      }
      else if (keyword[0] == '#')
      {
        words_.restOfLine();
      }
      else if (keyword != "\\")
      {
        words_.fail(inQuotes(keyword) + " is no statement of an OBJ file of points and faces");
      }
    }
    return mesh_.finish(false, digits_);
  }

private:
  /// Of this statement, which goes on behind a backslash at the end of a line.
  std::string_view nextWord()
  {
    std::string_view word = words_.nextInLine();
    while (word == "\\")
    {
      words_.restOfLine();
      word = words_.nextInLine();
    }
    if (!word.empty() && word[0] == '#')
    {
      words_.restOfLine();
      return {};
    }
    return word;
  }

  void readPoint()
  {
    Vec3 point;
    for (double& coordinate : point)
    {
      const std::string_view word = this->nextWord();
      const auto number = parsedNumber(word);
      if (!number)
      {
        words_.fail(word.empty() ? "a vertex has three numbers x, y, z"
                                 : inQuotes(word) + " is not a number");
      }
      coordinate = *number;
      digits_.add(word, coordinate);
    }
    while (!this->nextWord().empty()) // a weight, or colours
    {
    }
    mesh_.addPoint(point);
  }

  void readFace()
  {
    ids_.clear();
    for (std::string_view word = this->nextWord(); !word.empty(); word = this->nextWord())
    {
      // point/texture/normal
      const std::int64_t id = parsedInteger(word.substr(0, word.find('/'))).value_or(0);
      if (id == 0)
      {
        words_.fail(inQuotes(word) + " is no number of a vertex; they count from 1");
      }
      if (id < 0 && id < -mesh_.points())
      {
        words_.fail("vertex " + std::to_string(id) + " is not there, " +
          std::to_string(mesh_.points()) + " stand before");
      }
      ids_.push_back(id < 0 ? mesh_.points() + id : id - 1);
    }
    mesh_.addFace(ids_);
  }

  Words words_;
  MeshBuilder mesh_;
  WrittenDigits digits_;
  std::vector<std::int64_t> ids_;
};

} // namespace

Mesh parseObj(std::string_view bytes, const std::string& name)
{
  return ObjReader(bytes, name).read();
}

} // namespace rockfall
