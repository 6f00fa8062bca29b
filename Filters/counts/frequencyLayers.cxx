#include "counts/frequencyLayers.h"

#include "base/errors.h"
#include "base/text/numberText.h"
#include "shared/arrays.h"
#include "statistics/HazardRaster.h"
#include "statistics/frequency.h"

#include "vtkCellData.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

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

/// By the cell array Frequency, if there is one.
std::optional<RockFrequencies> frequenciesOf(vtkPolyData* trajectories)
{
  vtkCellData* cells = trajectories->GetCellData();
  vtkDataArray* frequency = cells->GetArray("Frequency");
  vtkDataArray* rock = cells->GetArray("RockId");
  vtkDataArray* block = cells->GetArray("BlockId");
  if (!frequency || !rock || !block)
  {
    return std::nullopt;
  }
  if (frequency->GetNumberOfComponents() != 1)
  {
    throw DataError("The cell array Frequency of the Input has " +
      std::to_string(frequency->GetNumberOfComponents()) + " components, it must have 1");
  }
  RockFrequencies result;
  // Polydata's cells begin with its vertices.
  const vtkIdType first = trajectories->GetNumberOfVerts();
  for (vtkIdType line = 0; line < trajectories->GetNumberOfLines(); ++line)
  {
    result.add(int(rock->GetTuple1(first + line)), std::int64_t(block->GetTuple1(first + line)),
      frequency->GetTuple1(first + line));
  }
  return result;
}

} // namespace

void checkFrequencies(const FrequencyOptions& options)
{
  if (!(options.annualFrequency >= 0.0) || !std::isfinite(options.annualFrequency))
  {
    throw ParameterError("AnnualFrequency is " + numberText(options.annualFrequency) +
      " per year, it must be finite and not negative");
  }
  checkPositive(options.energyThresholds, "EnergyThresholds", "kJ");
  checkPositive(options.returnPeriods, "ReturnPeriods", "a");
}

void addFrequencies(HazardRaster& raster, vtkPolyData* trajectories,
  const FrequencyOptions& options, vtkImageData* image)
{
  const bool together = options.annualFrequency > 0.0;
  const auto rocks = together ? std::nullopt : frequenciesOf(trajectories);
  if (!together && !rocks)
  {
    return;
  }
  const double released = double(raster.released());
  const auto weight = [&](const Passage& of)
  { return rocks ? rocks->weight(of) : options.annualFrequency / released; };

  vtkFieldData* data = image->GetCellData();
  const vtkIdType cells = image->GetNumberOfCells();
  const auto number = [&](const std::string& name, float empty)
  {
    auto array = addArray<vtkFloatArray>(data, name.c_str());
    array->SetNumberOfTuples(cells);
    array->FillValue(empty);
    return array;
  };
  std::vector<vtkSmartPointer<vtkFloatArray>> exceedances, frequencies;
  frequencies.push_back(number("AnnualFrequency", 0.0F));
  const auto period = number("ReturnPeriod", std::numeric_limits<float>::quiet_NaN());
  std::vector<double> joules;
  for (const double threshold : ordered(options.energyThresholds))
  {
    const std::string end = numberText(threshold) + "kJ";
    joules.push_back(1000.0 * threshold);
    exceedances.push_back(number("ExceedanceProbability" + end, 0.0F));
    frequencies.push_back(number("AnnualFrequency" + end, 0.0F));
  }
  std::vector<vtkSmartPointer<vtkIntArray>> intensities;
  const std::vector<double> periods = ordered(options.returnPeriods);
  for (const double years : periods)
  {
    const std::string name = "Intensity" + numberText(years) + "a";
    intensities.push_back(addArray<vtkIntArray>(data, name.c_str()));
    intensities.back()->SetNumberOfTuples(cells);
    intensities.back()->FillValue(0);
  }
  const auto set = [&](const CellFrequency& cell)
  {
    const vtkIdType id = cell.cell;
    for (std::size_t k = 0; k < frequencies.size(); ++k)
    {
      frequencies[k]->SetValue(id, float(cell.frequencies[k]));
    }
    if (cell.frequencies[0] > 0.0)
    {
      period->SetValue(id, float(1.0 / cell.frequencies[0]));
    }
    for (std::size_t k = 0; k < exceedances.size(); ++k)
    {
      exceedances[k]->SetValue(id, float(double(cell.rocks[k + 1]) / released));
    }
    for (std::size_t k = 0; k < intensities.size(); ++k)
    {
      intensities[k]->SetValue(id, intensityClass(cell.frequencies, periods[k]));
    }
  };
  summarizeFrequencies(raster.sorted(), joules, weight, set);
}

} // namespace rockfall::filters
