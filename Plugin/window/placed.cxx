#include "placed.h"

#include "looks.h"

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"
#include "vtkPVDataInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"

#include <algorithm>
#include <array>
#include <cmath>
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
