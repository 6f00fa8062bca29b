// Where rock blocks come from: the rows of sources and the places of their rocks.

#include "sources/rockBlockSources.h"

#include "base/hectare.h"
#include "base/require.h"
#include "base/text/numberText.h"
#include "shared/inputs.h"
#include "shared/terrainFieldData.h"
#include "sources/drawnSource.h"
#include "statistics/frequency.h"

#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

using rockfall::filters::refuseProperty;
using rockfall::filters::vec3;

//------------------------------------------------------------------------------
void vtkRockBlockSource::FindSources(vtkPolyData* terrainInput, Sources& sources)
{
  if (terrainInput)
  {
    sources.terrain = rockfall::filters::readTerrain(terrainInput);
  }
  const rockfall::Terrain* terrain = sources.ground();
  sources.crs = rockfall::wktOfCrs(this->TargetCRS);
  if (terrain && !terrain->geometry().crs.empty())
  {
    if (!rockfall::sameCrs(terrain->geometry().crs, this->TargetCRS))
    {
      throw rockfall::ParameterError("TargetCRS is \"" + this->TargetCRS +
        "\", but the terrain is in " + rockfall::labelOfCrs(terrain->geometry().crs) +
        "; leave TargetCRS empty where there is a terrain");
    }
    if (const std::string heights =
          rockfall::differentHeights(terrain->geometry().crs, this->TargetCRS);
        !heights.empty())
    {
      throw rockfall::ParameterError("TargetCRS is \"" + this->TargetCRS +
        "\", but heights of the terrain and of TargetCRS refer to " + heights +
        "; leave TargetCRS empty where there is a terrain");
    }
    sources.crs = terrain->geometry().crs;
  }

  rockfall::ReleaseDefaults& defaults = sources.defaults;
  defaults.amount = this->Amount;
  defaults.intensity = this->Intensity;
  defaults.height = this->ReleaseHeight;
  defaults.onGround = this->PlaceOnGround;
  defaults.seed = std::uint64_t(this->Seed);
  defaults.mostRocks = this->MaximumRocks;
  defaults.clusterRadius = this->ClusterRadius;
  defaults.validate();
  rockfall::require(this->TotalVolume >= 0.0 && std::isfinite(this->TotalVolume), "TotalVolume",
    this->TotalVolume, " m³", "finite and at least 0");
  if (this->TotalVolume > 0.0 && this->Intensity > 0.0)
  {
    throw rockfall::ParameterError("TotalVolume is " + rockfall::numberText(this->TotalVolume) +
      " m³ and Intensity is " + rockfall::numberText(this->Intensity) +
      ": the number of rocks is by the one or the other");
  }
  if (this->PlaceOnGround && !terrain)
  {
    throw rockfall::ParameterError("PlaceOnGround is on, which needs the Terrain input");
  }
  rockfall::require(this->SlopeThreshold >= 0.0 && this->SlopeThreshold <= 89.0, "SlopeThreshold",
    this->SlopeThreshold, " degrees", "0 to 89");
  if (this->SlopeThreshold > 0.0)
  {
    if (!terrain || !this->FileName.empty())
    {
      throw rockfall::ParameterError("SlopeThreshold is " +
        rockfall::numberText(this->SlopeThreshold) +
        (terrain ? " degrees and FileName is \"" + this->FileName +
              "\": sources are the one or the other"
                 : " degrees, which needs the Terrain input"));
    }
    rockfall::SourceRow& steep = sources.rows.emplace_back();
    steep.sourceName = this->SourceName.empty() ? "steep cells" : this->SourceName;
    if (this->KeepApart)
    {
      throw rockfall::ParameterError("KeepApart is on and SlopeThreshold is " +
        rockfall::numberText(this->SlopeThreshold) +
        " degrees: rocks of steep terrain cannot be kept apart, take a polygon around it");
    }
    return;
  }
  if (this->FileName.empty())
  {
    this->FindDrawn(sources);
  }
  else
  {
    rockfall::SourceOptions options;
    options.targetCrs = sources.crs;
    options.layer = this->LayerName;
    options.haveTerrain = terrain != nullptr;
    options.terrainUnits = terrain ? terrain->geometry().fileUnits : options.terrainUnits;
    options.mostRocks = this->MaximumRocks;
    rockfall::SourceLayer layer = rockfall::readSourceLayer(this->FileName, options);
    if (terrain)
    {
      rockfall::requireOverlap(layer.rows, *terrain, this->FileName, layer.ownCrs);
    }
    sources.notes = std::move(layer.notes);
    sources.rows = std::move(layer.rows);
    sources.crs = std::move(layer.crs);
  }
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::FindDrawn(Sources& sources)
{
  const rockfall::Terrain* terrain = sources.ground();
  const auto onSlope = [&]
  {
    const rockfall::Vec3 local = vec3(this->Center) - terrain->geometry().origin();
    return terrain->cfeAt(local.x(), local.y()) != 0;
  };
  if (this->Draw == NOTHING && terrain)
  {
    if (const auto place =
          rockfall::filters::placeByDefault(*terrain, this->Center, "the block", sources.notes))
    {
      rockfall::SourceRow& row = sources.rows.emplace_back();
      row.row = 1;
      row.position = *place;
      return;
    }
  }
  if (this->Draw == NOTHING)
  {
    if (terrain && vec3(this->Center).allFinite() && !onSlope())
    {
      throw rockfall::PlacementError("Center: the block at " +
        rockfall::numberText(this->Center[0]) + ", " + rockfall::numberText(this->Center[1]) +
        rockfall::whyNoGround(*terrain, this->Center[0], this->Center[1]));
    }
    sources.rows.emplace_back().position = vec3(this->Center);
    return;
  }
  if (this->Draw < NOTHING || this->Draw > AREA)
  {
    refuseProperty("Draw", this->Draw, "0 (nothing), 1 (points), 2 (line) or 3 (area)");
  }
  std::vector<std::array<double, 3>> points = rockfall::filters::drawnPoints(this->Points);
  if (points.empty() && terrain)
  {
    const std::array<double, 6> placed = rockfall::filters::steepLine(*terrain);
    std::copy(placed.begin(), placed.end(), this->PlacedLine);
    points = { { placed[0], placed[1], placed[2] }, { placed[3], placed[4], placed[5] } };
  }
  sources.rows =
    rockfall::filters::drawnRows(rockfall::SourceGeometry(this->Draw - POINTS), points, terrain);
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::FindPlaces(Sources& sources)
{
  const bool steep = this->SlopeThreshold > 0.0;
  if (this->TotalVolume > 0.0)
  {
    for (rockfall::SourceRow& row : sources.rows)
    {
      if (!row.amount && !row.intensity)
      {
        row.amount = sources.maker->amountOf(
          row, steep ? 0 : std::uint64_t(row.row) << 32, this->TotalVolume, this->MaximumRocks);
      }
    }
  }
  if (steep)
  {
    sources.defaults.amount = sources.rows.front().amount.value_or(this->Amount);
    sources.places = rockfall::steepPlaces(
      *sources.terrain, rockfall::radians(this->SlopeThreshold), sources.defaults);
    return;
  }
  sources.places =
    rockfall::releasePlaces(sources.rows, sources.ground(), sources.defaults, this->FileName);
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::CheckFrequencies() const
{
  const std::pair<const char*, double> typed[] = { { "AnnualFrequency", this->AnnualFrequency },
    { "FrequencyPerHectare", this->FrequencyPerHectare },
    { "PowerLawFrequency", this->PowerLawFrequency } };
  std::string given;
  for (const auto& [name, value] : typed)
  {
    rockfall::require(
      value >= 0.0 && std::isfinite(value), name, value, " per year", "finite and not negative");
    if (value > 0.0)
    {
      if (!given.empty())
      {
        throw rockfall::ParameterError(
          given + " and " + name + " are given: the frequency of a source is by one of them");
      }
      given = name;
    }
  }
}

//------------------------------------------------------------------------------
double vtkRockBlockSource::FrequencyOf(const Sources& sources, std::size_t number) const
{
  rockfall::SourceRow row = sources.rows[number];
  const bool own = row.frequency || row.frequencyPerHectare || row.frequencyA;
  const auto typed = [own](std::optional<double>& value, double property)
  {
    if (!own && property > 0.0)
    {
      value = property;
    }
  };
  typed(row.frequency, this->AnnualFrequency);
  typed(row.frequencyPerHectare, this->FrequencyPerHectare);
  typed(row.frequencyA, this->PowerLawFrequency);
  if (row.frequencyPerHectare)
  {
    const bool steep = this->SlopeThreshold > 0.0;
    if (!steep && row.geometry != rockfall::SourceGeometry::Polygon)
    {
      throw rockfall::ParameterError("FrequencyPerHectare is " +
        rockfall::numberText(this->FrequencyPerHectare) +
        " per year, but a source is no area: a point or a line needs AnnualFrequency");
    }
    return *row.frequencyPerHectare / rockfall::kHectare *
      (steep ? rockfall::steepArea(*sources.terrain, rockfall::radians(this->SlopeThreshold))
             : rockfall::areaOnTerrain(row, sources.ground()));
  }
  if (row.frequencyA)
  {
    const double most = row.volumeMaximum.value_or(this->VolumeMaximum);
    return rockfall::powerLawFrequency(*row.frequencyA,
      row.volumeExponent.value_or(this->VolumeExponent),
      row.volumeMinimum.value_or(this->VolumeMinimum),
      most > 0.0 ? most : std::numeric_limits<double>::infinity());
  }
  return row.frequency.value_or(std::numeric_limits<double>::quiet_NaN());
}

//------------------------------------------------------------------------------
void vtkRockBlockSource::SetFrequencies(Sources& sources) const
{
  std::vector<std::int64_t> rocks(sources.rows.size(), 0);
  for (const rockfall::ReleasePlace& place : sources.places)
  {
    ++rocks[place.source];
  }
  const auto nameOf = [this](const rockfall::SourceRow& row)
  { return this->FileName + ", row " + std::to_string(row.row); };
  std::vector<double> frequencies;
  const rockfall::SourceRow *with = nullptr, *without = nullptr;
  std::int64_t idle = 0, never = 0;
  for (std::size_t k = 0; k < sources.rows.size(); ++k)
  {
    const rockfall::SourceRow& row = sources.rows[k];
    try
    {
      frequencies.push_back(this->FrequencyOf(sources, k));
    }
    catch (const rockfall::ParameterError& error)
    {
      if (this->FileName.empty())
      {
        throw;
      }
      throw rockfall::DataError(nameOf(row) + ": " + error.what());
    }
    (std::isnan(frequencies.back()) ? without : with) = &row;
    idle += frequencies.back() > 0.0 && rocks[k] == 0 ? 1 : 0;
    never += frequencies.back() == 0.0 && rocks[k] > 0 ? 1 : 0;
  }
  if (with && without)
  {
    throw rockfall::DataError(nameOf(*without) + ": has no frequency, but row " +
      std::to_string(with->row) + " has; all have one, or none");
  }
  if (idle > 0)
  {
    sources.notes.push_back(this->FileName + ": " + std::to_string(idle) +
      " sources with a frequency make no rock: it is in no map.");
  }
  if (never > 0)
  {
    sources.notes.push_back(this->FileName + ": " + std::to_string(never) + " of " +
      std::to_string(frequencies.size()) +
      " sources have the frequency 0: in maps of frequencies their rocks never fall.");
  }
  for (std::size_t k = 0; k < sources.rocks.size(); ++k)
  {
    const std::size_t source = sources.places[k].source;
    sources.rocks[k].frequency = frequencies[source] / double(rocks[source]);
  }
}
