// Barriers of a layer.
#include "gis/layers/structureRows.h"

#include "base/text/nameKey.h"
#include "gis/base/gdal.h"
#include "gis/layers/barrierUnits.h"

namespace rockfall::gis
{

void StructureReader::readBarriers() const
{
  LayerWish wish = lineWish(files.barriers, files.barrierLayer, "BarrierLayerName");
  wish.columns = { { "height" } };
  this->forEachRow(wish,
    { "height", "capacity", "overhang", "braking", "residual", "fill", "mode", "absorbs" },
    [&](const FeatureRow& row, std::int64_t count, StructurePlaces& places)
    {
      Barrier b;
      b.feature = count;
      b.name = row.text("name").value_or("");
      b.height = needed(row, "height", "that of the barrier over ground in m");
      const auto capacity = row.notNegative("capacity");
      b.capacity = capacity ? kJ * *capacity : b.capacity;
      const std::string mode = nameKey(row.text("mode").value_or("stop"));
      if (mode != "stop" && mode != "record")
      {
        row.failField("mode", " is \"" + mode + "\", it must be stop or record");
      }
      b.records = mode == "record";
      if (!b.records) // what records may be as high as it likes
      {
        refuseOtherUnits(row, b.height, capacity);
      }
      b.overhang = row.ranged({ "overhang" }, 0.0, 0.5, "0 to 0.5").value_or(b.overhang);
      b.braking = row.notNegative("braking").value_or(b.braking);
      const auto residual = row.ranged({ "residual" }, 0.0, 100.0, "0 to 100 %");
      b.residual = residual ? 0.01 * *residual : b.residual;
      b.room = row.positive("fill").value_or(b.room);
      for (const char* field : { "braking", "residual" })
      {
        if (row.number(field) && !capacity)
        {
          row.failField(field, " is given without a \"capacity\", which it refers to");
        }
      }
      const double absorbs = row.ranged({ "absorbs" }, 0.0, 1.0, "1 or 0").value_or(1.0);
      if (absorbs != 0.0 && absorbs != 1.0)
      {
        row.failField("absorbs", " is " + number(absorbs) + ", it must be 1 or 0");
      }
      b.absorbs = absorbs != 0.0;
      for (std::vector<Eigen::Vector2d>& line : places.lines(row))
      {
        b.points = std::move(line);
        all.barriers.push_back(b);
      }
    });
}

} // namespace rockfall::gis
