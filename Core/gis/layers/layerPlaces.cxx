#include "gis/layers/layerPlaces.h"

namespace rockfall::gis
{

LayerPlaces::LayerPlaces(const std::string& fileName, const LayerHeights& heights,
  const std::string& targetCrs, const FileUnits& slope, const char* of,
  std::vector<std::string>& notes)
  : doubt(heights, slope)
  , heights_(heights)
  , of_(of)
{
  if (heights.horizontal && !targetCrs.empty())
  {
    target_ = crsFromText(targetCrs);
    change_ = layerChange(fileName, heights.horizontal, target_, notes);
  }
}

Eigen::Vector2d LayerPlaces::at(const FeatureRow& row, double x, double y)
{
  doubt.place(row, x, y);
  Eigen::Vector2d place = Eigen::Vector2d(x, y) * heights_.plane;
  if (!place.allFinite())
  {
    row.fail("the point " + number(x) + ", " + number(y) + " is not finite");
  }
  if (!change_.forth(1, &place.x(), &place.y()))
  {
    row.fail("the point " + number(x) + ", " + number(y) + " cannot be brought from " +
      crsLabel(*heights_.horizontal) + " to " + crsLabel(*target_) + ", the CRS of " + of_);
  }
  box.extend(place);
  return place;
}

std::vector<Eigen::Vector2d> LayerPlaces::line(
  const FeatureRow& row, const OGRLineString& part, double apart)
{
  std::vector<Eigen::Vector2d> corners;
  for (int k = 0; k < part.getNumPoints(); ++k)
  {
    const Eigen::Vector2d place = this->at(row, part.getX(k), part.getY(k));
    if (corners.empty() || (corners.back() - place).norm() > apart)
    {
      corners.push_back(place);
    }
  }
  if (corners.size() < 2)
  {
    row.fail("is a line of one place only");
  }
  return corners;
}

} // namespace rockfall::gis
