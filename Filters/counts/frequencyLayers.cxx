#include "counts/frequencyLayers.h"

#include "base/require.h"
#include "base/text/numberText.h"
#include "shared/arrays.h"
#include "shared/inputs.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace rockfall::filters
{

namespace
{

void checkPositive(const std::vector<double>& values, const char* name, const char* unit)
{
  for (const double value : values)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      throw ParameterError(std::string(name) + " has " + numberText(value) + " " + unit +
        ", they must be finite and above 0");
    }
  }
}

/// Ascending, each once.
std::vector<double> ordered(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Thresholds in joules.
std::vector<double> joulesOf(const FrequencyOptions& options)
{
  std::vector<double> joules = ordered(options.energyThresholds);
  for (double& threshold : joules)
  {
    threshold *= 1000.0;
  }
  return joules;
}

/// An array of one component; null without it.
vtkDataArray* singleArray(vtkCellData* cells, const char* name)
{
  vtkDataArray* array = cells->GetArray(name);
  if (array && array->GetNumberOfComponents() != 1)
  {
    throw DataError("The cell array " + std::string(name) + " of the Input has " +
      std::to_string(array->GetNumberOfComponents()) + " components, it must have 1");
  }
  return array;
}

} // namespace

RockReleases rocksOf(vtkPolyData* trajectories, bool frequencies, bool sources)
{
  RockReleases result;
  vtkCellData* cells = trajectories->GetCellData();
  vtkDataArray* rock = cells->GetArray("RockId");
  vtkDataArray* block = cells->GetArray("BlockId");
  if (!rock || !block)
  {
    return result;
  }
  vtkDataArray* frequency = frequencies ? singleArray(cells, "Frequency") : nullptr;
  vtkDataArray* source = sources ? singleArray(cells, "SourceId") : nullptr;
  // A rock is released once, whatever it breaks into.
  vtkDataArray* piece = cells->GetArray("Piece");
  // Polydata's cells begin with its vertices.
  const vtkIdType first = trajectories->GetNumberOfVerts();
  const vtkIdType lines = frequency || source ? trajectories->GetNumberOfLines() : 0;
  for (vtkIdType line = first; line < first + lines; ++line)
  {
    if (!piece || piece->GetTuple1(line) == 0.0)
    {
      RockRelease release;
      if (frequency)
      {
        release.frequency = frequency->GetTuple1(line);
      }
      if (source)
      {
        release.source = std::int64_t(source->GetTuple1(line));
      }
      result.add(int(rock->GetTuple1(line)), std::int64_t(block->GetTuple1(line)), release);
    }
  }
  return result;
}

void checkFrequencies(const FrequencyOptions& options)
{
  require(options.annualFrequency >= 0.0 && std::isfinite(options.annualFrequency),
    "AnnualFrequency", options.annualFrequency, " per year", "finite and not negative");
  requireFew(options.energyThresholds.size(), "EnergyThresholds");
  requireFew(options.returnPeriods.size(), "ReturnPeriods");
  checkPositive(options.energyThresholds, "EnergyThresholds", "kJ");
  checkPositive(options.returnPeriods, "ReturnPeriods", "a");
}

FrequencyLayers::FrequencyLayers(const FrequencyOptions& options, double released,
  const RockReleases& rocks, std::function<bool(std::uint32_t)> isLeftOut, vtkImageData* image)
  : known_(options.annualFrequency > 0.0 || rocks.haveFrequencies())
  , released_(released)
  , periods_(ordered(options.returnPeriods))
  , isLeftOut_(std::move(isLeftOut))
  , summarizer_(
      joulesOf(options),
      [&rocks, together = options.annualFrequency, released](const Passage& of)
      { return together > 0.0 ? together / released : rocks.weight(of); },
      [this](const CellFrequency& cell) { this->set(cell); })
{
  if (!known_)
  {
    return;
  }
  vtkFieldData* data = image->GetCellData();
  const vtkIdType cells = image->GetNumberOfCells();
  const auto number = [&](const std::string& name, float empty)
  { return addFilledArray<vtkFloatArray>(data, name, cells, empty); };
  frequencies_.push_back(number("AnnualFrequency", 0.0F));
  period_ = number("ReturnPeriod", std::numeric_limits<float>::quiet_NaN());
  for (const double threshold : ordered(options.energyThresholds))
  {
    const std::string end = numberText(threshold) + "kJ";
    exceedances_.push_back(number("ExceedanceProbability" + end, 0.0F));
    frequencies_.push_back(number("AnnualFrequency" + end, 0.0F));
  }
  for (const double years : periods_)
  {
    const std::string end = numberText(years) + "a";
    probabilities_.push_back(number("PassageProbability" + end, 0.0F));
    intensities_.push_back(addFilledArray<vtkIntArray>(data, "Intensity" + end, cells, 0));
  }
  addArray<vtkDoubleArray>(image->GetFieldData(), "AnnualFrequencyLimit")
    ->InsertNextValue(frequencyLimit(
      options.annualFrequency > 0.0 ? options.annualFrequency / released : rocks.largestWeight()));
}

void FrequencyLayers::set(const CellFrequency& cell)
{
  const vtkIdType id = cell.cell;
  if (isLeftOut_(cell.cell))
  {
    return;
  }
  for (std::size_t k = 0; k < frequencies_.size(); ++k)
  {
    frequencies_[k]->SetValue(id, float(cell.frequencies[k]));
  }
  if (cell.frequencies[0] > 0.0)
  {
    period_->SetValue(id, float(1.0 / cell.frequencies[0]));
  }
  for (std::size_t k = 0; k < exceedances_.size(); ++k)
  {
    exceedances_[k]->SetValue(id, float(double(cell.rocks[k + 1]) / released_));
  }
  for (std::size_t k = 0; k < periods_.size(); ++k)
  {
    probabilities_[k]->SetValue(id, float(probabilityWithin(cell.frequencies[0], periods_[k])));
    intensities_[k]->SetValue(id, intensityClass(cell.frequencies, periods_[k]));
  }
}

} // namespace rockfall::filters
