#include "counts/vtkHazardMapAlgorithm.h"

#include "counts/hazardImage.h"

namespace
{

template <class Number>
void print(ostream& os, const char* name, const std::vector<Number>& numbers)
{
  os << name << ":";
  for (const Number number : numbers)
  {
    os << " " << number;
  }
  os << "\n";
}

} // namespace

//------------------------------------------------------------------------------
vtkHazardMapAlgorithm::vtkHazardMapAlgorithm()
  : Statistics(rockfall::filters::usualStatistics)
  , EnergyThresholds(rockfall::filters::FrequencyOptions().energyThresholds)
  , ReturnPeriods(rockfall::filters::FrequencyOptions().returnPeriods)
{
}

//------------------------------------------------------------------------------
vtkHazardMapAlgorithm::~vtkHazardMapAlgorithm() = default;

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::AddStatistic(int statistic)
{
  this->Statistics.push_back(statistic);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::RemoveAllStatistics()
{
  if (!this->Statistics.empty())
  {
    this->Statistics.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::AddEnergyThreshold(double threshold)
{
  this->EnergyThresholds.push_back(threshold);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::RemoveAllEnergyThresholds()
{
  if (!this->EnergyThresholds.empty())
  {
    this->EnergyThresholds.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::AddReturnPeriod(double period)
{
  this->ReturnPeriods.push_back(period);
  this->Modified();
}

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::RemoveAllReturnPeriods()
{
  if (!this->ReturnPeriods.empty())
  {
    this->ReturnPeriods.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
rockfall::filters::HazardMapOptions vtkHazardMapAlgorithm::MapOptions() const
{
  rockfall::filters::HazardMapOptions options;
  options.statistics = this->Statistics;
  options.frequency = { this->AnnualFrequency, this->EnergyThresholds, this->ReturnPeriods };
  options.leastReach = this->LeastReach;
  options.leastAngle = this->LeastAngle;
  return options;
}

//------------------------------------------------------------------------------
void vtkHazardMapAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  print(os << indent, "Statistics", this->Statistics);
  os << indent << "AnnualFrequency: " << this->AnnualFrequency << "\n";
  print(os << indent, "EnergyThresholds", this->EnergyThresholds);
  print(os << indent, "ReturnPeriods", this->ReturnPeriods);
  os << indent << "LeastReach: " << this->LeastReach << "\n";
  os << indent << "LeastAngle: " << this->LeastAngle << "\n";
}
