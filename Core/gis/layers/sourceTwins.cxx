#include "gis/layers/sourceTwins.h"

#include "base/Tally.h"
#include "base/text/numberText.h"
#include "geometry/twins.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace rockfall::gis
{

namespace
{

/// Whether both release the same rocks, if at one place in plan.
bool sameRocks(SourceRow a, SourceRow b)
{
  const double rise = std::abs(a.position.z() - b.position.z());
  if (rise > kTwinDistance || std::isnan(a.position.z()) != std::isnan(b.position.z()))
  {
    return false;
  }
  // How many, and of which name, is no difference.
  a.row = b.row;
  a.position = b.position = Vec3::Zero();
  a.parts.clear();
  b.parts.clear();
  a.sourceId = b.sourceId;
  a.sourceName = b.sourceName;
  a.amount = b.amount;
  a.intensity = b.intensity;
  return a == b;
}

/// Rows of one kind of place, by their numbers in the list of all.
struct RowsAtPlaces
{
  std::vector<int> rows;
  std::vector<Eigen::Vector2d> points;
  std::vector<PlanLines> lines;
};

RowsAtPlaces rowsOf(const std::vector<SourceRow>& all, SourceGeometry geometry)
{
  RowsAtPlaces those;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (all[i].geometry != geometry)
    {
      continue;
    }
    those.rows.push_back(int(i));
    those.points.push_back(all[i].position.head<2>());
    PlanLines& lines = those.lines.emplace_back();
    for (const std::vector<Vec3>& part : all[i].parts)
    {
      PlanLine& line = lines.emplace_back();
      for (const Vec3& corner : part)
      {
        line.push_back(corner.head<2>());
      }
    }
  }
  return those;
}

/// Rows that release again what another one does at the same place.
class SourceTwins
{
public:
  explicit SourceTwins(const std::vector<SourceRow>& rows)
    : rows_(rows)
    , twin_(rows.size(), false)
  {
  }

  /// `earlier`: of each place the first one there.
  void lookAtPlaces(const RowsAtPlaces& of, const std::vector<int>& earlier)
  {
    constexpr std::size_t mostCompared = 100;
    std::map<int, std::vector<int>> places; // of the first one: all with other rocks
    for (std::size_t i = 0; i < of.rows.size(); ++i)
    {
      if (earlier[i] < 0)
      {
        continue;
      }
      std::vector<int>& there =
        places.try_emplace(earlier[i], 1, of.rows[std::size_t(earlier[i])]).first->second;
      const auto same =
        std::find_if(there.begin(), there.end(), [&](int k) { return this->alike(k, of.rows[i]); });
      if (same != there.end())
      {
        twin_[std::size_t(of.rows[i])] = true;
        whole_.look(
          true, [&] { return this->rowText(*same) + " and " + this->rowText(of.rows[i]); });
      }
      else if (there.size() < mostCompared)
      {
        there.push_back(of.rows[i]);
      }
    }
  }

  void lookAtStretches(const RowsAtPlaces& lines)
  {
    const std::vector<SharedStretch> stretches = sharedStretches(lines.lines,
      [&](int a, int b)
      { return this->alike(lines.rows[std::size_t(a)], lines.rows[std::size_t(b)]); });
    for (std::size_t i = 0; i < stretches.size(); ++i)
    {
      const int row = lines.rows[i], earlier = stretches[i].earlier;
      if (earlier >= 0 && !twin_[std::size_t(row)])
      {
        this->countPart(row,
          (earlier == int(i) ? "itself"
                             : "row " + this->rowText(lines.rows[std::size_t(earlier)])) +
            " over " + numberText(stretches[i].length, 3) + " m");
      }
    }
  }

  void lookAtGround(const RowsAtPlaces& polygons)
  {
    std::vector<PlanRings> rings;
    for (const int row : polygons.rows)
    {
      rings.push_back(rows_[std::size_t(row)].parts);
    }
    const auto alike = [&](int a, int b)
    { return this->alike(polygons.rows[std::size_t(a)], polygons.rows[std::size_t(b)]); };
    const std::vector<SharedGround> shared = sharedGround(rings, alike);
    for (std::size_t i = 0; i < shared.size(); ++i)
    {
      const int row = polygons.rows[i];
      if (shared[i].earlier >= 0 && !twin_[std::size_t(row)])
      {
        this->countPart(row,
          "row " + this->rowText(polygons.rows[std::size_t(shared[i].earlier)]) + " on " +
            numberText(shared[i].area, 6) + " m²");
      }
    }
  }

  void tell(const std::string& fileName, std::vector<std::string>& notes) const
  {
    const std::string of =
      " of " + std::to_string(rows_.size()) + " sources release the same rocks ";
    whole_.tell(notes, fileName + ": ",
      of + "within " + numberText(kTwinDistance) + " m of another one, first rows ",
      ". Was something given twice?");
    parts_.tell(notes, fileName + ": ",
      of + "on a part of another one or of themselves, first row ",
      ". Their rocks add up there: was something given twice?");
  }

private:
  bool alike(int a, int b) const { return sameRocks(rows_[std::size_t(a)], rows_[std::size_t(b)]); }
  std::string rowText(int row) const { return std::to_string(rows_[std::size_t(row)].row); }
  void countPart(int row, const std::string& on)
  {
    parts_.look(true, [&] { return this->rowText(row) + " on " + on; });
  }

  const std::vector<SourceRow>& rows_;
  std::vector<bool> twin_; ///< Of all: told as a whole.
  Tally whole_, parts_;
};

} // namespace

void tellSourceTwins(
  const std::vector<SourceRow>& rows, const std::string& fileName, std::vector<std::string>& notes)
{
  SourceTwins twins(rows);
  const RowsAtPlaces points = rowsOf(rows, SourceGeometry::Point);
  twins.lookAtPlaces(points, earlierPoints(points.points));
  const RowsAtPlaces lines = rowsOf(rows, SourceGeometry::Line);
  const RowsAtPlaces polygons = rowsOf(rows, SourceGeometry::Polygon);
  for (const RowsAtPlaces* those : { &lines, &polygons })
  {
    PlanLines whole;
    for (const PlanLines& parts : those->lines)
    {
      PlanLine& all = whole.emplace_back();
      for (const PlanLine& part : parts)
      {
        all.insert(all.end(), part.begin(), part.end());
      }
    }
    twins.lookAtPlaces(*those, earlierLines(whole));
  }
  twins.lookAtStretches(lines);
  twins.lookAtGround(polygons);
  twins.tell(fileName, notes);
}

} // namespace rockfall::gis
