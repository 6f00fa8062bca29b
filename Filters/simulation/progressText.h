#pragma once

/// @file
/// Text that a user reads while a run goes on.

#include <chrono>
#include <cstdint>
#include <string>

class vtkAlgorithm;

namespace rockfall::filters
{

/// Whole seconds, minutes and seconds, or hours and minutes: "42 s", "3 min 20 s", "2 h 05 min".
std::string durationText(double seconds);

/// With commas between thousands, whatever the locale.
std::string countText(std::int64_t count);

/// "12,300 of 100,000 trajectories (12 %), about 3 min 20 s left". `share`: done, 0 … 1; `units`:
/// of what there are `total`, and only whole ones are done; `elapsed`: time that this took, s. The
/// rest is taken to go at the same pace; nothing is said of it before one second or a thousandth
/// are through.
std::string progressText(
  double share, std::int64_t total, const std::string& units, double elapsed);

/// Whether a line of progress is due: the count has moved since the last one, and so has the time,
/// by half of what had gone by then and by 10 s at least. A log of a day has some 20 lines.
bool lineIsDue(double now, double last, std::int64_t count, std::int64_t lastCount);

/// Tells the world how far a filter's run is: as progress with its text, and on standard error if
/// `print`. Where `first` is false (a rank that is not the first) it only listens for an abort.
class ProgressReport
{
public:
  ProgressReport(
    vtkAlgorithm* filter, std::int64_t total, std::string units, bool first, bool print);
  ~ProgressReport();
  /// False to abort.
  bool operator()(double share);
  /// Says that it is done.
  void finish();

  ProgressReport(const ProgressReport&) = delete;
  ProgressReport& operator=(const ProgressReport&) = delete;

private:
  double elapsed() const; ///< s

  vtkAlgorithm* filter_;
  std::int64_t total_;
  std::string units_;
  bool first_, print_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  double printed_ = 0.0; ///< When it last did, s after the start.
  std::int64_t printedCount_ = 0;
};

} // namespace rockfall::filters
