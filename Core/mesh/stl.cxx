#include "mesh/MeshBuilder.h"
#include "mesh/bytes.h"
#include "mesh/meshFile.h"
#include "mesh/words.h"

#include <boost/functional/hash.hpp>

#include <array>
#include <unordered_map>

namespace rockfall
{

namespace
{

constexpr std::size_t kHeader = 84;   ///< A text of 80 bytes and the number of triangles.
constexpr std::size_t kTriangle = 50; ///< Normal, three points, two bytes that nobody uses.

/// STL repeats a point for every triangle that has it; here equal ones get one number.
class Corners
{
public:
  explicit Corners(MeshBuilder& mesh)
    : mesh_(mesh)
  {
  }

  std::int64_t number(Vec3 point)
  {
    point.array() += 0.0; // −0 is 0
    const auto [place, isNew] =
      numbers_.try_emplace({ point.x(), point.y(), point.z() }, mesh_.points());
    if (isNew)
    {
      mesh_.addPoint(point);
    }
    return place->second;
  }

private:
  using Key = std::array<double, 3>;
  MeshBuilder& mesh_;
  std::unordered_map<Key, std::int64_t, boost::hash<Key>> numbers_;
};

std::size_t trianglesOf(std::string_view bytes)
{
  return bytes.size() < kHeader ? 0 : takeNumber<std::uint32_t>(bytes.data() + 80, false);
}

Mesh parseBinary(std::string_view bytes, const std::string& name)
{
  const std::size_t triangles = trianglesOf(bytes);
  if (bytes.size() < kHeader || (bytes.size() - kHeader) / kTriangle < triangles)
  {
    throw FileError(name + ": is no STL file, or a truncated one: it has " +
      std::to_string(bytes.size()) + " bytes, begins with no \"solid\", and a binary one of " +
      std::to_string(triangles) + " triangles has " +
      std::to_string(kHeader + kTriangle * triangles));
  }
  MeshBuilder mesh(name);
  Corners corners(mesh);
  for (std::size_t k = 0; k < triangles; ++k)
  {
    std::int64_t ids[3];
    for (int corner = 0; corner < 3; ++corner)
    {
      const char* at = bytes.data() + kHeader + k * kTriangle + 12 * std::size_t(corner + 1);
      ids[corner] = corners.number({ takeNumber<float>(at, false), takeNumber<float>(at + 4, false),
        takeNumber<float>(at + 8, false) });
    }
    mesh.addFace(ids);
  }
  return mesh.finish(true);
}

void expect(Words& words, std::string_view keyword)
{
  const std::string_view word = words.next();
  if (word.empty())
  {
    words.failTruncated();
  }
  if (lowerCase(word) != keyword)
  {
    words.fail(inQuotes(word) + " stands where \"" + std::string(keyword) + "\" belongs");
  }
}

Mesh parseText(std::string_view bytes, const std::string& name)
{
  Words words(bytes, name);
  MeshBuilder mesh(name);
  Corners corners(mesh);
  WrittenDigits digits;
  std::vector<std::int64_t> ids;
  while (true)
  {
    words.next(); // solid
    words.restOfLine();
    std::string keyword = lowerCase(words.next());
    for (; keyword == "facet"; keyword = lowerCase(words.next()))
    {
      expect(words, "normal");
      for (int k = 0; k < 3; ++k)
      {
        words.next(); // whatever it is: the order of the points says it as well
      }
      expect(words, "outer");
      expect(words, "loop");
      ids.clear();
      for (keyword = lowerCase(words.next()); keyword == "vertex";
           keyword = lowerCase(words.next()))
      {
        Vec3 point;
        for (double& coordinate : point)
        {
          const std::string_view word = words.next();
          const auto number = parsedNumber(word);
          if (!number)
          {
            word.empty() ? words.failTruncated() : words.fail(inQuotes(word) + " is not a number");
          }
          coordinate = *number;
          digits.add(word, coordinate);
        }
        ids.push_back(corners.number(point));
      }
      if (keyword != "endloop")
      {
        keyword.empty() ? words.failTruncated()
                        : words.fail(inQuotes(keyword) + " stands where \"endloop\" belongs");
      }
      expect(words, "endfacet");
      mesh.addFace(ids);
    }
    if (keyword != "endsolid")
    {
      keyword.empty() ? words.failTruncated()
                      : words.fail(inQuotes(keyword) + " stands where \"endsolid\" belongs");
    }
    words.restOfLine();
    const Words before = words;
    const std::string_view more = words.next();
    if (more.empty())
    {
      return mesh.finish(false, digits);
    }
    if (lowerCase(more) != "solid")
    {
      words.fail(inQuotes(more) + " stands where \"solid\" belongs");
    }
    words = before;
  }
}

} // namespace

Mesh parseStl(std::string_view bytes, const std::string& name)
{
  // Binary files may begin with "solid" as well; a zero among the first bytes tells them.
  const bool text = lowerCase(trimmed(bytes).substr(0, 5)) == "solid" &&
    bytes.substr(0, kHeader).find('\0') == std::string_view::npos;
  return text ? parseText(bytes, name) : parseBinary(bytes, name);
}

} // namespace rockfall
