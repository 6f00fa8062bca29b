#include "geometry/shell.h"

#include "base/detachedCall.h"
#include "base/errors.h"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

namespace rockfall
{

namespace
{

/// One run of Qhull, its messages kept in a temporary file: it has no other way than a FILE.
class Hull
{
public:
  Hull(std::vector<double>& coordinates, const char* options)
    : log_(std::tmpfile(), &std::fclose)
  {
    if (!log_)
    {
      throw FileError("no temporary file can be made for Qhull's messages");
    }
    qh_zero(&qh_, log_.get());
    // Neither C++ objects nor exceptions live in what Qhull's own error handling jumps over.
    code_ = qh_new_qhull(&qh_, 3, int(coordinates.size() / 3), coordinates.data(), False,
      const_cast<char*>(options), nullptr, log_.get());
  }
  ~Hull()
  {
    qh_freeqhull(&qh_, !qh_ALL);
    int count = 0, bytes = 0;
    qh_memfreeshort(&qh_, &count, &bytes);
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;

  bool good() const { return code_ == 0; }

  /// The first line of what Qhull has to say.
  std::string message() const
  {
    std::rewind(log_.get());
    char line[256] = "";
    if (!std::fgets(line, sizeof line, log_.get()))
    {
      return "error " + std::to_string(code_);
    }
    std::string text = line;
    text.erase(std::remove(text.begin(), text.end(), '\n'), text.end());
    return text;
  }

  /// Loops, counter-clockwise seen from outside. Empty if a facet's ridges are no simple loop. Only
  /// walks the structures: once the hull is made, an error inside a function of Qhull ends the
  /// process.
  std::vector<std::vector<int>> loops()
  {
    std::vector<std::vector<int>> result;
    qhT* qh = &qh_; // the macros want this name
    facetT* facet;
    FORALLfacets
    {
      result.push_back(facet->simplicial ? this->triangle(facet) : this->polygon(facet));
      if (result.back().size() < 3)
      {
        return {};
      }
    }
    return result;
  }

private:
  int id(const vertexT* vertex) { return qh_pointid(&qh_, vertex->point); }

  std::vector<int> triangle(facetT* facet)
  {
    std::vector<int> loop;
    vertexT *vertex, **vertexp;
    FOREACHvertex_(facet->vertices)
    {
      loop.push_back(this->id(vertex));
    }
    if (facet->toporient)
    {
      std::reverse(loop.begin(), loop.end());
    }
    return loop;
  }

  /// A merged facet: its ridges are directed edges, in no order.
  std::vector<int> polygon(facetT* facet)
  {
    std::unordered_map<int, int> next;
    ridgeT *ridge, **ridgep;
    int start = -1;
    FOREACHridge_(facet->ridges)
    {
      int a = this->id(SETfirstt_(ridge->vertices, vertexT));
      int b = this->id(SETsecondt_(ridge->vertices, vertexT));
      if (ridge->top == facet)
      {
        std::swap(a, b);
      }
      if (!next.emplace(a, b).second)
      {
        return {};
      }
      start = a;
    }
    std::vector<int> loop;
    for (int v = start; loop.size() < next.size();)
    {
      loop.push_back(v);
      const auto step = next.find(v);
      if (step == next.end())
      {
        return {};
      }
      v = step->second;
      if (v == start && loop.size() < next.size())
      {
        return {};
      }
    }
    return loop;
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> log_;
  qhT qh_;
  int code_ = 0;
};

/// Points that take Qhull a second or so.
constexpr std::size_t manyPoints = 50000;

struct HullRun
{
  std::vector<std::vector<int>> loops;
  std::string fault; ///< Empty: none.
};

HullRun runQhull(std::vector<double>& coordinates)
{
  // Only the numbers of the points are taken, never Qhull's coordinates. Pp: no warnings.
  Hull hull(coordinates, "qhull Pp");
  if (!hull.good())
  {
    return { {}, hull.message() };
  }
  std::vector<std::vector<int>> loops = hull.loops();
  const bool closed = !loops.empty() && DirectedEdges(loops).closed();
  return { std::move(loops), closed ? "" : "its facets do not close" };
}

} // namespace

std::vector<std::vector<int>> hullFaces(std::span<const Vec3> points, const std::string& name)
{
  std::vector<double> coordinates;
  for (const Vec3& point : points)
  {
    coordinates.insert(coordinates.end(), { point.x(), point.y(), point.z() });
  }
  HullRun run = points.size() < manyPoints
    ? runQhull(coordinates)
    : detachedCall(
        [coordinates = std::move(coordinates)]() mutable { return runQhull(coordinates); });
  if (!run.fault.empty())
  {
    throw GeometryError(name + ": no convex hull of its " + std::to_string(points.size()) +
      " points is found (" + run.fault + ")");
  }
  return std::move(run.loops);
}

} // namespace rockfall
