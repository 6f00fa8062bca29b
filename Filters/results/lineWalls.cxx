#include "results/lineWalls.h"

#include "shared/arrays.h"
#include "shared/cells.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>

namespace rockfall::filters
{

namespace
{

/// More panels than this a line is not cut into.
constexpr double kMostPanels = 10000.0;
/// How far a line across paths goes beyond them, as a share of their width or length.
constexpr double kBeyond = 0.05;

/// The ground under a place in the plane, local frame, m; NaN beyond the slope and in its holes,
/// `level` everywhere without a slope.
double groundAt(const Terrain* terrain, double level, const Eigen::Vector2d& place)
{
  return terrain ? terrain->elevation(place.x(), place.y()) : level;
}

/// Places along a line at which its wall follows the ground, cell by cell.
std::vector<Eigen::Vector2d> stepsOf(const CollectorLine& line, const Terrain* terrain)
{
  double length = 0.0;
  for (std::size_t k = 1; k < line.points.size(); ++k)
  {
    length += (line.points[k] - line.points[k - 1]).norm();
  }
  const double step =
    std::max(terrain ? terrain->geometry().cellSize : length, length / kMostPanels);
  std::vector<Eigen::Vector2d> places{ line.points.front() };
  for (std::size_t k = 1; k < line.points.size(); ++k)
  {
    const Eigen::Vector2d from = line.points[k - 1], way = line.points[k] - from;
    const int panels = std::max(1, int(std::ceil(way.norm() / step)));
    for (int panel = 1; panel <= panels; ++panel)
    {
      places.push_back(from + way * (double(panel) / panels));
    }
  }
  return places;
}

} // namespace

void writeWalls(std::span<const CollectorLine> lines, std::span<const LineSummary> summaries,
  const Terrain* terrain, double level, const Vec3& origin, vtkPolyData* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> panels;
  vtkFieldData* data = output->GetCellData();
  const auto share = addArray<vtkDoubleArray>(data, "Share");
  const auto number = addArray<vtkIntArray>(data, "Line");
  const auto name = addArray<vtkStringArray>(data, "LineName");
  const auto rocks = addArray<vtkIntArray>(data, "Rocks");
  for (std::size_t k = 0; k < lines.size(); ++k)
  {
    const CollectorLine& line = lines[k];
    vtkIdType before = -1;
    for (const Eigen::Vector2d& place : stepsOf(line, terrain))
    {
      const double ground = groundAt(terrain, level, place);
      if (std::isnan(ground))
      {
        before = -1; // nothing to stand on
        continue;
      }
      const Vec3 foot = origin + Vec3(place.x(), place.y(), ground);
      const vtkIdType here = points->InsertNextPoint(foot.data());
      points->InsertNextPoint(foot.x(), foot.y(), foot.z() + line.barrierHeight);
      if (before >= 0)
      {
        const vtkIdType corners[4] = { before, here, here + 1, before + 1 };
        panels->InsertNextCell(4, corners);
        share->InsertNextValue(summaries[k].share);
        number->InsertNextValue(int(k));
        name->InsertNextValue(line.name);
        rocks->InsertNextValue(summaries[k].rocks);
      }
      before = here;
    }
  }
  output->SetPoints(points);
  output->SetPolys(panels);
  output->GetCellData()->SetActiveScalars("Share");
}

std::array<double, 6> lineAcross(
  vtkPolyData* trajectories, const Terrain* terrain, const Vec3& origin)
{
  const auto place = [&](vtkIdType point)
  {
    double p[3];
    trajectories->GetPoint(point, p);
    return Eigen::Vector2d(p[0], p[1]);
  };
  Eigen::Vector2d start(0.0, 0.0), way(0.0, 0.0);
  double paths = 0.0;
  forEachLine(trajectories,
    [&](vtkIdType, std::span<const vtkIdType> ids)
    {
      if (ids.size() > 1)
      {
        start += place(ids.front());
        way += place(ids.back()) - place(ids.front());
        paths += 1.0;
      }
    });
  start /= std::max(paths, 1.0);
  way /= std::max(paths, 1.0);
  const Eigen::Vector2d middle = start + 0.5 * way;
  const Eigen::Vector2d along =
    way.norm() > 0.0 ? Eigen::Vector2d(-way.y(), way.x()).normalized() : Eigen::Vector2d(0.0, 1.0);
  double least = 0.0, most = 0.0;
  for (vtkIdType k = 0; k < trajectories->GetNumberOfPoints(); ++k)
  {
    const double aside = (place(k) - middle).dot(along);
    least = std::min(least, aside);
    most = std::max(most, aside);
  }
  // A single path may have no width at all.
  const double beyond = std::max(kBeyond * (most - least), kBeyond * way.norm());
  const Eigen::Vector2d ends[2] = { middle + along * (least - beyond),
    middle + along * (most + beyond) };
  std::array<double, 6> line;
  for (std::size_t end = 0; end < 2; ++end)
  {
    const double level = trajectories->GetBounds()[4] - origin.z();
    const double found = groundAt(terrain, level, Eigen::Vector2d(ends[end] - origin.head<2>()));
    const double ground = (std::isnan(found) ? level : found) + origin.z();
    line[3 * end] = ends[end].x();
    line[3 * end + 1] = ends[end].y();
    line[3 * end + 2] = ground;
  }
  return line;
}

} // namespace rockfall::filters
