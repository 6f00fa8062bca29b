#include "handles.h"

#include "looks.h"
#include "panel.h"

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkAlgorithm.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkStaticCellLocator.h"

#include <QAbstractItemView>
#include <QGuiApplication>
#include <QLineEdit>
#include <QMainWindow>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace rockfall::window
{

namespace
{

constexpr double kNear = 0.01; ///< m, of a height that need not be changed

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
    if (mesh != mesh_ || mesh->GetMTime() != time_)
    {
      mesh_ = mesh;
      time_ = mesh->GetMTime();
      vtkNew<vtkPolyData> copy; // the locator would keep the pipeline's own alive
      copy->ShallowCopy(mesh);
      locator_->SetDataSet(copy);
      locator_->BuildLocator();
    }
    const double above[3] = { x, y, b[5] + 1.0 }, below[3] = { x, y, b[4] - 1.0 };
    double t = 0.0, place[3], local[3];
    int part = 0;
    if (!locator_->IntersectWithLine(above, below, 0.0, t, place, local, part))
    {
      return {};
    }
    return place[2];
  }

private:
  vtkPolyData* mesh_ = nullptr; ///< To compare with, not to look at.
  vtkMTimeType time_ = 0;
  vtkNew<vtkStaticCellLocator> locator_;
};

/// The height of a slope that is there; nothing beyond all of them.
std::optional<double> groundAt(double x, double y)
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
      if (const std::optional<double> height = heights.at(mesh, x, y))
      {
        return height;
      }
    }
  }
  return {};
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

void layHandles(pqPipelineSource* source)
{
  vtkSMSourceProxy* proxy = source ? source->getSourceProxy() : nullptr;
  if (QGuiApplication::mouseButtons() != Qt::NoButton || isTyping() ||
    !isOf(proxy, { "vtkRockBlockSource", "vtkTrajectoryCollector", "vtkDrawnStructure" }) ||
    !proxy->GetProperty("Points"))
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
    const std::optional<double> ground = known ? std::nullopt : groundAt(points[k], points[k + 1]);
    if (ground && std::abs(*ground - points[k + 2]) > kNear)
    {
      points[k + 2] = *ground;
      moved = true;
    }
  }
  if (moved)
  {
    panel.Set(points.data(), unsigned(points.size()));
  }
}

} // namespace rockfall::window
