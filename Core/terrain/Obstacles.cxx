#include "terrain/Obstacles.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "geometry/shell.h"
#include "law/settings.h"
#include "terrain/Surface.h"
#include "terrain/Terrain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace rockfall
{

namespace
{

/// Keys of the slope's features are far below.
constexpr std::int64_t firstKey = std::int64_t(1) << 60;

FlatBox boxOf(const ObstacleMesh& mesh, const ObstacleMesh::Triangle& t)
{
  const Vec3& a = mesh.nodes[t.nodes[0]].position;
  const Vec3& b = mesh.nodes[t.nodes[1]].position;
  const Vec3& c = mesh.nodes[t.nodes[2]].position;
  const Vec3 least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
  return { least.x(), most.x(), least.y(), most.y(), most.z() };
}

void check(bool good, std::int64_t feature, const char* what, double value, const char* range)
{
  if (!good)
  {
    throw ParameterError("feature " + std::to_string(feature) + ": " + what + " is " +
      numberText(value) + ", it must be " + range);
  }
}

bool positive(double value)
{
  return value > 0.0 && std::isfinite(value);
}

/// Whether a line comes over ground, looked at in every half a cell.
bool isOverGround(const Terrain& terrain, const Eigen::Vector2d& p, const Eigen::Vector2d& q)
{
  const Eigen::AlignedBox2d slope(
    Eigen::Vector2d::Zero(), Eigen::Vector2d(terrain.width(), terrain.height()));
  if (!slope.intersects(Eigen::AlignedBox2d(p.cwiseMin(q), p.cwiseMax(q))))
  {
    return false;
  }
  constexpr double kMostLooks = 1e6;
  const double looks =
    std::min(kMostLooks, std::ceil(2.0 * (q - p).norm() / terrain.geometry().cellSize));
  for (double k = 0.0; k <= looks; ++k)
  {
    const Eigen::Vector2d at = p + (looks > 0.0 ? k / looks : 0.0) * (q - p);
    if (!std::isnan(terrain.elevation(at.x(), at.y())))
    {
      return true;
    }
  }
  return false;
}

} // namespace

bool isLoaded(const Barrier& barrier)
{
  return !std::isnan(barrier.residual) || std::isfinite(barrier.room);
}

BarrierState stateOf(const Barrier& barrier, const BarrierLoad& load)
{
  BarrierState state{ barrier.capacity, barrier.height, 0.0 };
  if (!std::isnan(barrier.residual) && load.energy > 0.0)
  {
    state.capacity = std::max(0.0, barrier.capacity - load.energy);
    const double used = std::min(1.0, load.energy / barrier.capacity);
    state.rope *= 1.0 - (1.0 - barrier.residual) * used;
  }
  if (load.volume > 0.0)
  {
    double length = 0.0;
    for (std::size_t k = 1; k < barrier.points.size(); ++k)
    {
      length += (barrier.points[k] - barrier.points[k - 1]).norm();
    }
    state.fill = barrier.height * std::min(1.0, load.volume / (barrier.room * length));
  }
  return state;
}

double brakingDistance(const Barrier& barrier, const BarrierLoad& before, double energy)
{
  if (barrier.braking == 0.0)
  {
    return 0.0;
  }
  const double held = std::isnan(barrier.residual) ? 0.0 : before.energy;
  return barrier.braking * std::sqrt(std::min(1.0, (held + energy) / barrier.capacity));
}

double stemCapacity(double diameter, double factor)
{
  return factor * 38.7 * std::pow(100.0 * diameter, 2.31);
}

void ObstacleMesh::connect(std::size_t from)
{
  std::unordered_map<std::uint64_t, std::array<int, 2>> open;
  for (std::size_t i = from; i < triangles.size(); ++i)
  {
    Triangle& t = triangles[i];
    const Vec3& a = nodes[t.nodes[0]].position;
    t.normal = (nodes[t.nodes[1]].position - a).cross(nodes[t.nodes[2]].position - a).normalized();
    for (int k = 0; k < 3; ++k)
    {
      const std::uint64_t u = std::uint64_t(t.nodes[k]), v = std::uint64_t(t.nodes[(k + 1) % 3]);
      const auto found = open.find((v << 32) | u);
      if (found == open.end())
      {
        open.emplace((u << 32) | v, std::array<int, 2>{ int(i), k });
        continue;
      }
      const auto [other, back] = found->second;
      t.neighbours[k] = other;
      triangles[other].neighbours[back] = int(i);
    }
  }
  for (std::size_t i = from; i < triangles.size(); ++i)
  {
    Triangle& t = triangles[i];
    for (int k = 0; k < 3; ++k)
    {
      const int j = t.neighbours[k];
      if (j < int(i))
      {
        continue;
      }
      Triangle& other = triangles[j];
      int back = 0;
      while (other.neighbours[back] != int(i))
      {
        ++back;
      }
      const int a = t.nodes[k], b = t.nodes[(k + 1) % 3], wing = other.nodes[(back + 2) % 3];
      t.bends[k] = other.bends[back] =
        SurfacePatch::bendOf(t.normal, nodes[wing].position - nodes[a].position);
      if (t.bends[k] == 0)
      {
        continue;
      }
      for (const auto& [one, two] : { std::array{ a, b }, std::array{ b, a } })
      {
        Node& n = nodes[one];
        n.peak = n.peak || t.bends[k] > 0;
        auto slot = std::find(n.neighbours.begin(), n.neighbours.end(), -1);
        if (slot != n.neighbours.end())
        {
          *slot = two;
        }
      }
    }
  }
  for (Node& n : nodes)
  {
    // Where there are fewer, one of them again.
    std::replace(n.neighbours.begin(), n.neighbours.end(), -1, n.neighbours[0]);
  }
}

const ObstacleMesh& Obstacles::treeShape()
{
  static const ObstacleMesh shape = []
  {
    ObstacleMesh mesh;
    for (const double z : { 0.0, 1.0 })
    {
      for (int k = 0; k < treeSides; ++k)
      {
        const double angle = 2.0 * std::numbers::pi * (k + 0.5) / treeSides;
        mesh.nodes.emplace_back();
        mesh.nodes.back().position = Vec3(std::cos(angle), std::sin(angle), z);
      }
    }
    const auto add = [&](int a, int b, int c)
    {
      mesh.triangles.emplace_back();
      mesh.triangles.back().nodes = { a, b, c };
    };
    for (int k = 0; k < treeSides; ++k)
    {
      const int next = (k + 1) % treeSides;
      add(k, next, treeSides + next);
      add(k, treeSides + next, treeSides + k);
    }
    for (int k = 1; k + 1 < treeSides; ++k)
    {
      add(treeSides, treeSides + k, treeSides + k + 1);
    }
    mesh.connect();
    return mesh;
  }();
  return shape;
}

Obstacles::Obstacles(Structures structures, const Terrain& terrain)
  : structures_(std::move(structures))
  , firstCfe_(terrain.cfeCapacity() + 1)
{
  const GridGeometry& g = terrain.geometry();
  const int materials = int(structures_.materials.size());
  for (const SurfaceMaterial& m : structures_.materials)
  {
    m.validate();
  }
  for (const Embankment& e : structures_.embankments)
  {
    const bool high = std::isnan(e.elevation);
    check(!high || positive(e.height), e.feature, "the height of the embankment", e.height,
      "above 0 m");
    check(high || std::isfinite(e.elevation), e.feature, "the crest's elevation", e.elevation,
      "finite");
    check(positive(e.crestWidth), e.feature, "the width of the crest", e.crestWidth, "above 0 m");
    for (const double s : { e.mountainSlope, e.valleySlope })
    {
      check(
        s >= 0.0 && s <= 20.0, e.feature, "the slope of a side", s, "0 to 20 m across per m down");
    }
    check(e.material >= 0 && e.material <= materials, e.feature, "the material", e.material,
      "one that there is");
    addEmbankment(e, terrain, mesh_);
    owners_.resize(mesh_.triangles.size(), int(&e - structures_.embankments.data()));
  }
  std::vector<FlatBox> boxes;
  for (const ObstacleMesh::Triangle& t : mesh_.triangles)
  {
    boxes.push_back(boxOf(mesh_, t));
  }
  meshIndex_ = BoxIndex(boxes);

  boxes.clear();
  const double lowered = terrain.roughnessDepth();
  for (std::size_t k = 0; k < structures_.trees.size(); ++k)
  {
    const Tree& t = structures_.trees[k];
    check(positive(t.diameter) && t.diameter <= 20.0, t.feature, "the diameter of the tree",
      t.diameter, "above 0 and at most 20 m");
    check(t.lies() || (positive(t.height) && t.height <= kLongestStem), t.feature,
      "the height of the tree", t.height, "above 0 and at most 150 m");
    check(t.capacity >= 0.0, t.feature, "the capacity of the tree", t.capacity, "at least 0 J");
    check(t.material >= 0 && t.material <= materials, t.feature, "the material", t.material,
      "one that there is");
    if (t.lies())
    {
      lyingNumbers_.resize(k + 1, -1);
      lyingNumbers_[k] = int(lying_.size());
      lying_.push_back(lay(t, terrain));
      const LyingStem& stem = lying_.back();
      treeEnds_.push_back({ std::min(stem.from.z(), stem.to.z()) - stem.depth,
        std::max(stem.from.z(), stem.to.z()) + stem.rise });
      boxes.push_back(this->treeBox(int(k)));
      continue;
    }
    const double ground = terrain.elevation(t.position.x(), t.position.y());
    if (std::isnan(ground))
    {
      throw DataError("feature " + std::to_string(t.feature) + ": the tree at " +
        numberText(t.position.x() + g.xOrigin) + ", " + numberText(t.position.y() + g.yOrigin) +
        " stands where the terrain has no ground");
    }
    const double root = ground - kRootDepth - kRootPerDiameter * t.diameter - lowered;
    treeEnds_.push_back({ root, ground + t.height });
    boxes.push_back(this->treeBox(int(k)));
  }
  treeIndex_ = BoxIndex(boxes);

  boxes.clear();
  for (std::size_t k = 0; k < structures_.barriers.size(); ++k)
  {
    const Barrier& b = structures_.barriers[k];
    check(positive(b.height), b.feature, "the height of the barrier", b.height, "above 0 m");
    check(b.capacity >= 0.0, b.feature, "the capacity of the barrier", b.capacity, "at least 0 J");
    check(b.overhang >= 0.0 && b.overhang <= 0.5, b.feature, "the overhang of the barrier",
      b.overhang, "0 to 0.5");
    check(b.braking >= 0.0 && std::isfinite(b.braking), b.feature,
      "the braking distance of the barrier", b.braking, "at least 0 m");
    check(!(b.residual < 0.0 || b.residual > 1.0), b.feature, "the residual height of the barrier",
      100.0 * b.residual, "0 to 100 %");
    check(b.room > 0.0, b.feature, "the volume that fills the barrier", b.room, "above 0 m³/m");
    check(std::isfinite(b.capacity) || (b.braking == 0.0 && std::isnan(b.residual)), b.feature,
      "the capacity of the barrier", b.capacity,
      "finite where its braking distance or residual height is given");
    bool over = false;
    for (std::size_t i = 0; i < b.points.size(); ++i)
    {
      if (i > 0)
      {
        const Eigen::Vector2d &p = b.points[i - 1], &q = b.points[i];
        over = over || isOverGround(terrain, p, q);
        barrierPieces_.push_back({ int(k), p, q, i == 1, i + 1 == b.points.size() });
        boxes.push_back({ std::min(p.x(), q.x()), std::max(p.x(), q.x()), std::min(p.y(), q.y()),
          std::max(p.y(), q.y()), 0.0 });
      }
    }
    if (!over)
    {
      throw DataError("feature " + std::to_string(b.feature) +
        ": no part of the barrier is where the terrain has ground");
    }
  }
  barrierIndex_ = BoxIndex(boxes);
}

double Obstacles::treeRadius(int tree) const
{
  // The prism has the section of the stem: ½ n R² sin(2π/n) = π d²/4.
  constexpr double n = treeSides;
  static const double factor =
    0.5 * std::sqrt(2.0 * std::numbers::pi / (n * std::sin(2.0 * std::numbers::pi / n)));
  return factor * structures_.trees[std::size_t(tree)].diameter;
}

FlatBox Obstacles::treeBox(int tree) const
{
  const Tree& t = structures_.trees[std::size_t(tree)];
  if (this->lyingOf(tree))
  {
    FlatBox box{ t.position.x(), t.position.x(), t.position.y(), t.position.y(),
      this->treeTop(tree) };
    for (int k = 0; k < int(lyingShape().nodes.size()); ++k)
    {
      const Vec3 p = this->treeCorner(tree, k);
      box.xMin = std::min(box.xMin, p.x());
      box.xMax = std::max(box.xMax, p.x());
      box.yMin = std::min(box.yMin, p.y());
      box.yMax = std::max(box.yMax, p.y());
    }
    return box;
  }
  const double r = this->treeRadius(tree);
  return { t.position.x() - r, t.position.x() + r, t.position.y() - r, t.position.y() + r,
    this->treeTop(tree) };
}

bool Obstacles::isInTree(int tree, const Vec3& place) const
{
  if (const LyingStem* stem = this->lyingOf(tree))
  {
    return isIn(*stem, place);
  }
  const Eigen::Vector2d off = place.head<2>() - structures_.trees[std::size_t(tree)].position;
  return off.norm() < this->treeRadius(tree) && place.z() < this->treeTop(tree);
}

Vec3 Obstacles::treeNormal(int tree, int triangle) const
{
  const ObstacleMesh::Triangle& t = this->shapeOf(tree).triangles[std::size_t(triangle)];
  if (!this->lyingOf(tree))
  {
    return t.normal;
  }
  const Vec3 a = this->treeCorner(tree, t.nodes[0]);
  return (this->treeCorner(tree, t.nodes[1]) - a)
    .cross(this->treeCorner(tree, t.nodes[2]) - a)
    .normalized();
}

Vec3 Obstacles::treeCorner(int tree, int corner) const
{
  if (const LyingStem* stem = this->lyingOf(tree))
  {
    return lyingCorner(*stem, corner);
  }
  const Vec3& unit = treeShape().nodes[std::size_t(corner)].position;
  const Eigen::Vector2d p =
    structures_.trees[std::size_t(tree)].position + this->treeRadius(tree) * unit.head<2>();
  return { p.x(), p.y(), treeEnds_[std::size_t(tree)][corner / treeSides] };
}

int Obstacles::treeOf(std::int64_t cfe) const
{
  const std::int64_t k = cfe - firstCfe_ - std::int64_t(mesh_.triangles.size());
  return k < 0 ? -1 : int(k / treeTriangles);
}

int Obstacles::materialOf(std::int64_t cfe) const
{
  const int tree = this->treeOf(cfe);
  return tree >= 0
    ? structures_.trees[std::size_t(tree)].material
    : structures_.embankments[std::size_t(owners_[std::size_t(cfe - firstCfe_)])].material;
}

bool Obstacles::isFirm(std::int64_t cfe) const
{
  if (this->treeOf(cfe) >= 0)
  {
    return true;
  }
  const int material = this->materialOf(cfe);
  return material > 0 && !structures_.materials[std::size_t(material) - 1].yielding.scars();
}

double Obstacles::embankmentTop(double x, double y) const
{
  double top = -std::numeric_limits<double>::infinity();
  this->visitTriangles(x, x, y, y,
    [&](int k)
    {
      const ObstacleMesh::Triangle& t = mesh_.triangles[std::size_t(k)];
      if (!(t.normal.z() > 0.0))
      {
        return; // an upright side has no elevation
      }
      const auto corner = [&](int i) -> const Vec3&
      { return mesh_.nodes[std::size_t(t.nodes[std::size_t(i % 3)])].position; };
      const auto isLeftOf = [&](int i)
      {
        const Eigen::Vector2d side = (corner(i + 1) - corner(i)).head<2>();
        return side.x() * (y - corner(i).y()) - side.y() * (x - corner(i).x()) >= 0.0;
      };
      if (isLeftOf(0) && isLeftOf(1) && isLeftOf(2))
      {
        const Vec3& p = corner(0);
        top = std::max(
          top, p.z() - (t.normal.x() * (x - p.x()) + t.normal.y() * (y - p.y())) / t.normal.z());
      }
    });
  return top;
}

void Obstacles::append(double xMin, double xMax, double yMin, double yMax,
  std::span<const int> gone, SurfacePatch& patch) const
{
  thread_local std::vector<int> triangles, trees;
  triangles.clear();
  trees.clear();
  this->visitTriangles(xMin, xMax, yMin, yMax,
    [&](int k)
    {
      if (boxOf(mesh_, mesh_.triangles[std::size_t(k)]).meets(xMin, xMax, yMin, yMax))
      {
        triangles.push_back(k);
      }
    });
  this->visitTrees(xMin, xMax, yMin, yMax,
    [&](int k)
    {
      if (this->treeBox(k).meets(xMin, xMax, yMin, yMax) &&
        !std::binary_search(gone.begin(), gone.end(), k))
      {
        trees.push_back(k);
      }
    });
  std::sort(triangles.begin(), triangles.end());
  std::sort(trees.begin(), trees.end());
  this->append(triangles, trees, patch);
}

namespace
{

/// Numbers of a mesh in the patch.
struct Numbering
{
  int nodes, triangles; ///< First of each in the patch.
  std::int64_t nodeKey, triangleKey, cfe;
  const Obstacles* of;
};

/// `nodeAt`, `triangleAt`: place among those appended, −1 if it is not among them.
template <typename Position, typename Normal, typename NodeAt, typename TriangleAt>
void appendMesh(const ObstacleMesh& mesh, std::span<const int> nodes,
  std::span<const int> triangles, const Numbering& from, Position&& position, Normal&& normal,
  NodeAt&& nodeAt, TriangleAt&& triangleAt, SurfacePatch& patch)
{
  for (const int n : nodes)
  {
    const ObstacleMesh::Node& node = mesh.nodes[std::size_t(n)];
    SurfacePatch::Node& q = patch.nodes.emplace_back();
    q.position = position(n);
    q.key = from.nodeKey + n;
    q.cfe = 0;
    q.peak = node.peak;
    for (std::size_t k = 0; k < q.neighbours.size() && q.peak; ++k)
    {
      const int at = nodeAt(node.neighbours[k < node.neighbours.size() ? k : 0]);
      q.neighbours[k] = from.nodes + at;
      q.peak = at >= 0;
    }
  }
  for (const int i : triangles)
  {
    const ObstacleMesh::Triangle& source = mesh.triangles[std::size_t(i)];
    SurfacePatch::Triangle& t = patch.triangles.emplace_back();
    t.normal = normal(i);
    t.bends = source.bends;
    t.cfe = from.cfe + i;
    t.key = from.triangleKey + i;
    t.firm = from.of->isFirm(t.cfe);
    t.ridges.fill(-1);
    for (int k = 0; k < 3; ++k)
    {
      t.nodes[k] = from.nodes + nodeAt(source.nodes[k]);
      const int at = source.neighbours[k] < 0 ? -1 : triangleAt(source.neighbours[k]);
      t.neighbours[k] = at < 0 ? -1 : from.triangles + at;
      SurfacePatch::Node& q = patch.nodes[std::size_t(t.nodes[k])];
      q.cfe = std::max(q.cfe, t.cfe);
      q.firm = t.firm;
    }
    t.offset = t.normal.dot(patch.nodes[std::size_t(t.nodes[0])].position);
  }
  for (int i = from.triangles; i < int(patch.triangles.size()); ++i)
  {
    const SurfacePatch::Triangle& t = patch.triangles[std::size_t(i)];
    for (int k = 0; k < 3; ++k)
    {
      const int j = t.neighbours[k];
      if (j > i && t.bends[k] > 0)
      {
        const SurfacePatch::Triangle& other = patch.triangles[std::size_t(j)];
        int wing = other.nodes[0];
        for (const int n : other.nodes)
        {
          wing = n != t.nodes[k] && n != t.nodes[(k + 1) % 3] ? n : wing;
        }
        patch.ridges.push_back({ { t.nodes[k], t.nodes[(k + 1) % 3] }, { i, j },
          { t.nodes[(k + 2) % 3], wing }, firstKey + 3 * (t.key - firstKey) + k });
      }
    }
  }
}

} // namespace

void Obstacles::append(
  std::span<const int> triangles, std::span<const int> trees, SurfacePatch& patch) const
{
  thread_local std::vector<int> nodes;
  nodes.clear();
  for (const int i : triangles)
  {
    const auto& corners = mesh_.triangles[std::size_t(i)].nodes;
    nodes.insert(nodes.end(), corners.begin(), corners.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const auto among = [](std::span<const int> list, int k)
  {
    const auto found = std::lower_bound(list.begin(), list.end(), k);
    return found != list.end() && *found == k ? int(found - list.begin()) : -1;
  };
  Numbering from{ int(patch.nodes.size()), int(patch.triangles.size()), firstKey, firstKey,
    firstCfe_, this };
  appendMesh(
    mesh_, nodes, triangles, from, [&](int n) { return mesh_.nodes[std::size_t(n)].position; },
    [&](int i) { return mesh_.triangles[std::size_t(i)].normal; },
    [&](int n) { return among(nodes, n); }, [&](int i) { return among(triangles, i); }, patch);

  static const std::vector<int> all = []
  {
    std::vector<int> numbers;
    for (int k = 0; k < treeTriangles; ++k)
    {
      numbers.push_back(k);
    }
    return numbers;
  }();
  const auto itself = [](int k) { return k; };
  for (const int tree : trees)
  {
    const std::int64_t meshTriangles = std::int64_t(mesh_.triangles.size());
    from = { int(patch.nodes.size()), int(patch.triangles.size()),
      firstKey + std::int64_t(mesh_.nodes.size()) + std::int64_t(tree) * 2 * treeSides,
      firstKey + meshTriangles + std::int64_t(tree) * treeTriangles,
      firstCfe_ + meshTriangles + std::int64_t(tree) * treeTriangles, this };
    const bool lies = this->lyingOf(tree) != nullptr;
    const ObstacleMesh& shape = this->shapeOf(tree);
    appendMesh(
      shape, std::span(all).first(shape.nodes.size()), std::span(all).first(shape.triangles.size()),
      from, [&](int n) { return this->treeCorner(tree, n); },
      [&](int i)
      { return lies ? this->treeNormal(tree, i) : shape.triangles[std::size_t(i)].normal; },
      itself, itself, patch);
  }
}

} // namespace rockfall
