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
