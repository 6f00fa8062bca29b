#include "simulation/progressText.h"

#include "vtkAlgorithm.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

namespace rockfall::filters
{

namespace
{

constexpr double leastInterval = 10.0; // s, between lines
/// Of the time that has gone.
constexpr double intervalShare = 0.5;
/// A share of so many is whole but for this.
constexpr double kRounding = 1e-3;

std::int64_t wholeOnes(double share, std::int64_t total)
{
  return std::int64_t(share * double(total) + kRounding);
}

std::string twoDigits(std::int64_t number)
{
  return (number < 10 ? "0" : "") + std::to_string(number);
}

} // namespace

std::string countText(std::int64_t count)
{
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t k = 0; k < digits.size(); ++k)
  {
    text += k > 0 && (digits.size() - k) % 3 == 0 ? "," : "";
    text += digits[k];
  }
  return text;
}

std::string durationText(double seconds)
{
  const std::int64_t s = std::llround(std::ceil(seconds));
  if (s < 60)
  {
    return std::to_string(s) + " s";
  }
  if (s < 3600)
  {
    return std::to_string(s / 60) + " min " + twoDigits(s % 60) + " s";
  }
  const std::int64_t minutes = (s + 59) / 60;
  return std::to_string(minutes / 60) + " h " + twoDigits(minutes % 60) + " min";
}

std::string progressText(double share, std::int64_t total, const std::string& units, double elapsed)
{
  std::string text = countText(wholeOnes(share, total)) + " of " + countText(total) + " " + units +
    " (" + std::to_string(int(100.0 * share)) + " %)";
  if (share >= 1e-3 && elapsed >= 1.0)
  {
    text += ", about " + durationText(elapsed * (1.0 - share) / share) + " left";
  }
  return text;
}

bool lineIsDue(double now, double last, std::int64_t count, std::int64_t lastCount)
{
  return count > lastCount && now - last >= std::max(leastInterval, intervalShare * last);
}

ProgressReport::ProgressReport(
  vtkAlgorithm* filter, std::int64_t total, std::string units, bool first, bool print)
  : filter_(filter)
  , total_(total)
  , units_(std::move(units))
  , first_(first)
  , print_(first && print)
{
}

ProgressReport::~ProgressReport()
{
  filter_->SetProgressText(nullptr);
}

double ProgressReport::elapsed() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
}

bool ProgressReport::operator()(double share)
{
  if (first_)
  {
    const double now = this->elapsed();
    const std::string text = progressText(share, total_, units_, now);
    filter_->SetProgressText(text.c_str());
    filter_->UpdateProgress(share);
    const std::int64_t count = wholeOnes(share, total_);
    if (print_ && lineIsDue(now, printed_, count, printedCount_))
    {
      printed_ = now;
      printedCount_ = count;
      std::cerr << "Rockfall Simulation: " << text << std::endl;
    }
  }
  return !filter_->CheckAbort();
}

void ProgressReport::finish()
{
  if (print_)
  {
    std::cerr << "Rockfall Simulation: " << countText(total_) << " " << units_ << " in "
              << durationText(this->elapsed()) << std::endl;
  }
}

} // namespace rockfall::filters
