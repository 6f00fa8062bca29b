#include "handles.h"

#include "looks.h"
#include "panel.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "pqView.h"
#include "vtkAlgorithm.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSourceProxy.h"
#include "vtkStaticCellLocator.h"

#include <QAbstractItemView>
#include <QGuiApplication>
#include <QLineEdit>
#include <QMainWindow>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace rockfall::window
{

namespace
{

constexpr double kNear = 0.01; ///< m, of a height that need not be changed: nobody draws finer
constexpr double kSeen = 1e-3; ///< of the way to a point, beside a line of sight that it is on

using Place = std::array<double, 3>;

/// Heights of one mesh. The index is made once for each state of it.
class Heights
{
public:
  std::optional<double> at(vtkPolyData* mesh, double x, double y)
  {
    double b[6];
    mesh->GetBounds(b);
    if (x < b[0] || x > b[1] || y < b[2] || y > b[3])
    {
      return {};
    }
    const std::optional<Place> place =
      on(mesh, { x, y, b[5] + 1.0 }, { x, y, b[4] - 1.0 }); // from above
    return place ? std::optional<double>((*place)[2]) : std::nullopt;
  }

  /// The first place of the mesh on the way from one point to another.
  std::optional<Place> on(vtkPolyData* mesh, const Place& from, const Place& to)
  {
    if (mesh != mesh_ || mesh->GetMTime() != time_)
    {
      mesh_ = mesh;
      time_ = mesh->GetMTime();
      vtkNew<vtkPolyData> copy; // the locator would keep the pipeline's own alive
      copy->ShallowCopy(mesh);
      locator_->SetDataSet(copy);
      locator_->BuildLocator();
    }
    Place place;
    double t = 0.0, local[3];
    int part = 0;
    if (!locator_->IntersectWithLine(from.data(), to.data(), 0.0, t, place.data(), local, part))
    {
      return {};
    }
    return place;
  }

private:
  vtkPolyData* mesh_ = nullptr; ///< To compare with, not to look at.
  vtkMTimeType time_ = 0;
  vtkNew<vtkStaticCellLocator> locator_;
};

/// What `find` gives of the first slope that is there and has it.
template <class Find>
auto ofSlopes(Find find) -> decltype(find(std::declval<Heights&>(), nullptr))
{
  static Heights heights;
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* slope : model->findItems<pqPipelineSource*>())
  {
    vtkSMSourceProxy* proxy = slope->getSourceProxy();
    auto* algorithm = isOf(proxy, { "vtkDEMToCFESource" })
      ? vtkAlgorithm::SafeDownCast(proxy->GetClientSideObject())
      : nullptr;
    auto* mesh = algorithm ? vtkPolyData::SafeDownCast(algorithm->GetOutputDataObject(0)) : nullptr;
    if (mesh && mesh->GetNumberOfCells() > 0)
    {
      if (const auto found = find(heights, mesh))
      {
        return found;
      }
    }
  }
  return {};
}

/// The line of sight under the mouse in the active view, from before the eye to its end.
std::optional<std::array<Place, 2>> sightUnderMouse()
{
  pqView* active = pqActiveObjects::instance().activeView();
  auto* view = vtkSMRenderViewProxy::SafeDownCast(active ? active->getProxy() : nullptr);
  vtkRenderWindowInteractor* mouse = view ? view->GetInteractor() : nullptr;
  if (!mouse)
  {
    return {};
  }
  vtkRenderer* renderer = view->GetRenderer();
  std::array<Place, 2> ends;
  for (int k = 0; k < 2; ++k)
  {
    renderer->SetDisplayPoint(mouse->GetEventPosition()[0], mouse->GetEventPosition()[1], k);
    renderer->DisplayToWorld();
    const double* world = renderer->GetWorldPoint();
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      ends[k][axis] = world[axis] / world[3];
    }
  }
  return ends;
}

/// Whether a point is seen on this line.
bool isSeenOn(const std::array<Place, 2>& line, const double* point)
{
  double along = 0.0, length = 0.0, away = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double way = line[1][axis] - line[0][axis];
    along += way * (point[axis] - line[0][axis]);
    length += way * way;
  }
  const double part = length > 0.0 ? along / length : 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double foot = line[0][axis] + part * (line[1][axis] - line[0][axis]);
    away += (point[axis] - foot) * (point[axis] - foot);
  }
  return away <= kSeen * kSeen * part * part * length;
}

/// The first place of a slope along a line of sight.
std::optional<Place> slopeOn(const std::array<Place, 2>& sight)
{
  return ofSlopes(
    [&sight](Heights& heights, vtkPolyData* mesh) { return heights.on(mesh, sight[0], sight[1]); });
}

/// The place of the slope under the mouse for a point that ParaView has picked beside it: where P is
/// pressed on a map or a path, which lie on the slope, it gives 0, 0, 0 or the height 0.
std::optional<Place> pickedAnew(const double* point)
{
  if (point[2] != 0.0)
  {
    return {};
  }
  const auto sight = sightUnderMouse();
  const bool none = point[0] == 0.0 && point[1] == 0.0;
  return sight && (none || isSeenOn(*sight, point)) ? slopeOn(*sight) : std::nullopt;
}

/// Whether points of it are drawn in a view.
bool isDrawn(vtkSMSourceProxy* proxy)
{
  return isOf(proxy, { "vtkRockBlockSource", "vtkTrajectoryCollector", "vtkDrawnStructure" }) &&
    proxy->GetProperty("Points");
}

/// Whether somebody types into the table of points, whose editor closes when points are set.
bool isTyping()
{
  for (QAbstractItemView* table : mainWindow()->findChildren<QAbstractItemView*>("PointsTable"))
  {
    if (table->viewport()->findChild<QLineEdit*>())
    {
      return true;
    }
  }
  return false;
}

} // namespace

std::optional<double> groundAt(double x, double y)
{
  const std::optional<double> ground =
    ofSlopes([x, y](Heights& heights, vtkPolyData* mesh) { return heights.at(mesh, x, y); });
  return ground ? std::optional<double>(std::round(*ground / kNear) * kNear) : std::nullopt;
}

bool missesSlope(pqPipelineSource* source)
{
  const auto sight = sightUnderMouse();
  return source && isDrawn(source->getSourceProxy()) && sight && !slopeOn(*sight);
}

void layHandles(pqPipelineSource* source)
{
  vtkSMSourceProxy* proxy = source ? source->getSourceProxy() : nullptr;
  if (QGuiApplication::mouseButtons() != Qt::NoButton || isTyping() || !isDrawn(proxy))
  {
    return;
  }
  const std::vector<double> applied = vtkSMPropertyHelper(proxy, "Points").GetDoubleArray();
  vtkSMPropertyHelper panel(proxy, "Points");
  panel.SetUseUnchecked(true);
  std::vector<double> points = panel.GetDoubleArray();
  if (points == applied)
  {
    return;
  }
  bool moved = false;
  for (std::size_t k = 0; k + 2 < points.size(); k += 3)
  {
    const bool known =
      k + 2 < applied.size() && points[k] == applied[k] && points[k + 1] == applied[k + 1];
    if (const std::optional<Place> place = known ? std::nullopt : pickedAnew(&points[k]))
    {
      std::transform(place->begin(), place->end(), points.begin() + std::ptrdiff_t(k),
        [](double x) { return std::round(x / kNear) * kNear; });
      moved = true;
      continue;
    }
    const std::optional<double> ground = known ? std::nullopt : groundAt(points[k], points[k + 1]);
    if (ground && std::abs(*ground - points[k + 2]) > 1.5 * kNear)
    {
      points[k + 2] = *ground;
      moved = true;
    }
  }
  if (moved)
  {
    panel.Set(points.data(), unsigned(points.size()));
    if (pqView* view = pqActiveObjects::instance().activeView())
    {
      view->render(); // the handles go along only when it is drawn
    }
  }
}

} // namespace rockfall::window
