#include "gis/base/planAccuracy.h"

#include "gis/base/gdal.h"

#include <ogr_spatialref.h>
#include <proj.h>

#include <algorithm>
#include <memory>

namespace rockfall::gis
{

namespace
{

using Context = std::unique_ptr<PJ_CONTEXT, PJ_CONTEXT* (*)(PJ_CONTEXT*)>;
using Object = std::unique_ptr<PJ, PJ* (*)(PJ*)>;
using Choice =
  std::unique_ptr<PJ_OPERATION_FACTORY_CONTEXT, void (*)(PJ_OPERATION_FACTORY_CONTEXT*)>;
using List = std::unique_ptr<PJ_OBJ_LIST, void (*)(PJ_OBJ_LIST*)>;

/// A way is rougher if it is so many times less accurate.
constexpr double rougher = 2.0;

/// The grid of a way that is not there; empty if there is none.
std::string missingGrid(PJ_CONTEXT* context, const PJ* way)
{
  for (int k = 0; k < proj_coordoperation_get_grid_used_count(context, way); ++k)
  {
    const char* name = nullptr;
    int there = 0;
    if (proj_coordoperation_get_grid_used(
          context, way, k, &name, nullptr, nullptr, nullptr, nullptr, nullptr, &there) &&
      !there && name)
    {
      return name;
    }
  }
  return {};
}

} // namespace

void noteRoughWay(const std::string& fileName, const CrsPtr& from, const CrsPtr& to,
  std::vector<std::string>& notes)
{
  if (!from || !to || from == to || from->IsSame(to.get()))
  {
    return;
  }
  const Context context(proj_context_create(), proj_context_destroy);
  proj_log_level(context.get(), PJ_LOG_NONE);
  const Object source(proj_create(context.get(), crsWkt(*from).c_str()), proj_destroy);
  const Object target(proj_create(context.get(), crsWkt(*to).c_str()), proj_destroy);
  const Choice choice(proj_create_operation_factory_context(context.get(), nullptr),
    proj_operation_factory_context_destroy);
  if (!source || !target || !choice)
  {
    return;
  }
  // By accuracy, whether a grid is there or not.
  proj_operation_factory_context_set_grid_availability_use(
    context.get(), choice.get(), PROJ_GRID_AVAILABILITY_IGNORED);
  proj_operation_factory_context_set_spatial_criterion(
    context.get(), choice.get(), PROJ_SPATIAL_CRITERION_PARTIAL_INTERSECTION);
  const List ways(proj_create_operations(context.get(), source.get(), target.get(), choice.get()),
    proj_list_destroy);
  const int count = ways ? proj_list_get_count(ways.get()) : 0;
  double best = -1.0, first = -1.0, least = HUGE_VAL, most = 0.0; // m; negative: not known
  std::string grid;
  bool found = false;
  for (int k = 0; k < count; ++k)
  {
    const Object way(proj_list_get(context.get(), ways.get(), k), proj_destroy);
    const double accuracy = proj_coordoperation_get_accuracy(context.get(), way.get());
    const bool there = proj_coordoperation_is_instantiable(context.get(), way.get());
    if (k == 0)
    {
      best = accuracy;
      grid = there ? std::string() : missingGrid(context.get(), way.get());
    }
    if (there && accuracy >= 0.0)
    {
      first = found ? first : accuracy;
      least = std::min(least, accuracy);
      most = std::max(most, accuracy);
    }
    found = found || there;
  }
  if (grid.empty() || best < 0.0 || (first >= 0.0 && first < rougher * best))
  {
    return;
  }
  const std::string accuracy = first < 0.0 ? "no accuracy: places may be metres off"
    : least < most ? "an accuracy of " + number(least) + " to " + number(most) + " m"
                   : "an accuracy of " + number(least) + " m";
  notes.push_back(fileName + ": the best way from " + crsLabel(*from) + " to " + crsLabel(*to) +
    ", accurate to " + number(best) + " m, needs the grid " + grid +
    ", which is not installed. Without it PROJ gives " + accuracy + ".");
}

} // namespace rockfall::gis
