#include "placed.h"

#include "handles.h"
#include "looks.h"

#include "pqApplicationCore.h"
#include "pqOutputPort.h"
#include "pqPipelineFilter.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkPVDataInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rockfall::window
{

namespace
{

/// Rock Blocks on a slope begin where their block is released, as long as they have the centre of
/// the test slope; a line that they may be told to draw begins there, too.
void standWhereReleased(vtkSMSourceProxy* proxy)
{
  vtkSMPropertyHelper draw(proxy, "Draw");
  if (draw.GetAsInt() != 0 || !proxy->GetProperty("Center")->IsValueDefault())
  {
    return;
  }
  constexpr int line = 2;
  std::array<double, 6> b{};
  proxy->GetDataInformation(0)->GetBounds(b.data());
  if (b[0] > b[1])
  {
    return; // the message says why
  }
  const std::array<double, 3> centre = { 0.5 * (b[0] + b[1]), 0.5 * (b[2] + b[3]),
    0.5 * (b[4] + b[5]) };
  draw.Set(line);
  proxy->UpdateVTKObjects();
  proxy->UpdatePipeline();
  draw.Set(0);
  vtkSMPropertyHelper(proxy, "Center").Set(centre.data(), unsigned(centre.size()));
}

/// A source or filter, and all that it is made of.
void visit(pqPipelineSource* made, const std::function<void(pqPipelineSource*)>& look)
{
  look(made);
  if (auto* filter = qobject_cast<pqPipelineFilter*>(made))
  {
    for (pqOutputPort* input : filter->getAllInputs())
    {
      visit(input->getSource(), look);
    }
  }
}

/// Across the paths of a slope, up from the line that counts them, and from other structures: in the
/// middle of the slope a net is often out of sight. Empty if there is no such line.
std::vector<double> aboveLine(vtkSMProxy* slope)
{
  constexpr double above = 10.0; // m
  double steps = 1.0;
  for (; isOf(slope, { "vtkDrawnStructure" }); steps += 1.0)
  {
    slope = vtkSMPropertyHelper(slope, "Terrain").GetAsProxy();
  }
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* line : model->findItems<pqPipelineSource*>())
  {
    if (!isOf(line->getProxy(), { "vtkTrajectoryCollector" }))
    {
      continue;
    }
    const std::vector<double> ends =
      vtkSMPropertyHelper(line->getProxy(), "Points").GetDoubleArray();
    bool here = false;
    pqPipelineSource* rocks = nullptr;
    visit(line,
      [&](pqPipelineSource* source)
      {
        here = here || source->getProxy() == slope;
        rocks = isOf(source->getProxy(), { "vtkRockBlockSource" }) ? source : rocks;
      });
    if (!here || !rocks || ends.size() != 6)
    {
      continue;
    }
    std::array<double, 6> b{};
    rocks->getSourceProxy()->GetDataInformation(0)->GetBounds(b.data());
    const double across[2] = { ends[1] - ends[4], ends[3] - ends[0] };
    const double up[2] = { 0.5 * (b[0] + b[1] - ends[0] - ends[3]),
      0.5 * (b[2] + b[3] - ends[1] - ends[4]) };
    const double length = std::hypot(across[0], across[1]);
    const double far = (across[0] * up[0] + across[1] * up[1]) / std::max(length, 1e-9);
    const double step = std::copysign(
      std::min(steps * std::min(above, 0.25 * std::abs(far)), 0.9 * std::abs(far)), far);
    std::vector<double> placed;
    for (std::size_t k = 0; k < ends.size(); k += 3)
    {
      const double middle[2] = { 0.5 * (ends[0] + ends[3]), 0.5 * (ends[1] + ends[4]) };
      // As far out as the slope is there.
      for (double share = 1.0; share > 0.5 && placed.size() < k + 3; share -= 0.02)
      {
        const double x =
          middle[0] + share * (ends[k] - middle[0]) + step * across[0] / std::max(length, 1e-9);
        const double y =
          middle[1] + share * (ends[k + 1] - middle[1]) + step * across[1] / std::max(length, 1e-9);
        if (const std::optional<double> ground = groundAt(x, y))
        {
          placed.insert(placed.end(), { x, y, *ground });
        }
      }
    }
    if (placed.size() == ends.size())
    {
      return placed;
    }
  }
  return {};
}

} // namespace

void drawPlaced(vtkSMSourceProxy* proxy)
{
  vtkSMPropertyHelper points(proxy, "Points");
  if (points.GetNumberOfElements() > 0)
  {
    return;
  }
  std::vector<double> placed = { 5.0, 45.0, 58.0, 5.0, 55.0, 58.0 }; // on the test slope
  vtkSMPropertyHelper terrain(proxy, "Terrain", true);
  const bool onSlope = terrain.GetNumberOfElements() > 0 && terrain.GetAsProxy();
  const bool blocks = proxy->GetXMLName() == std::string("RockBlocks");
  if (onSlope || !blocks)
  {
    proxy->UpdateVTKObjects();
    proxy->UpdatePipeline();
    if (blocks)
    {
      standWhereReleased(proxy);
    }
    proxy->UpdatePropertyInformation();
    placed = vtkSMPropertyHelper(proxy, "PlacedLine").GetDoubleArray();
    const std::vector<double> across = onSlope && isOf(proxy, { "vtkDrawnStructure" })
      ? aboveLine(terrain.GetAsProxy())
      : std::vector<double>();
    placed = across.empty() ? placed : across;
  }
  if (placed.size() == 6 &&
    std::any_of(placed.begin(), placed.end(), [](double x) { return x != 0.0; }))
  {
    for (double& x : placed)
    {
      x = std::round(x * 100.0) / 100.0; // cm: nobody draws finer
    }
    points.Set(placed.data(), unsigned(placed.size()));
  }
  proxy->UpdateVTKObjects();
}

void standOnSlope(pqPipelineSource* rocks)
{
  vtkSMPropertyHelper terrain(rocks->getProxy(), "Terrain");
  if (pqApplicationCore::instance()->isLoadingState() ||
    (terrain.GetNumberOfElements() > 0 && terrain.GetAsProxy()))
  {
    return;
  }
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  for (pqPipelineSource* slope : model->findItems<pqPipelineSource*>(rocks->getServer()))
  {
    if (isOf(slope->getProxy(), { "vtkDEMToCFESource", "vtkDrawnStructure" }))
    {
      terrain.Set(slope->getProxy(), 0);
    }
  }
  rocks->getProxy()->UpdateVTKObjects();
}

} // namespace rockfall::window
