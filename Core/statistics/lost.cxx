#include "statistics/lost.h"

#include "base/text/numberText.h"

#include <algorithm>

namespace rockfall
{

void LostRocks::add(Loss loss, double time, double way, int piece)
{
  ++(piece == 0 ? this->rocks : this->pieces);
  this->unmoved += piece == 0 && way < kLeastWay;
  if (piece > 0 && this->lastLost)
  {
    return;
  }
  this->lastLost = loss != Loss::None;
  switch (loss)
  {
    case Loss::Moving:
      ++this->moving;
      this->endTime = std::max(this->endTime, time);
      break;
    case Loss::OverEdge:
      ++this->overEdge;
      break;
    case Loss::InNodata:
      ++this->inNodata;
      break;
    case Loss::None:
      break;
  }
}

void LostRocks::add(const LostRocks& other)
{
  if (other.moving > 0)
  {
    const double first = other.firstEnd > 0.0 ? other.firstEnd : other.endTime;
    const double own = this->firstEnd > 0.0 ? this->firstEnd : this->endTime;
    this->firstEnd = this->moving > 0 ? std::min(own, first) : first;
  }
  this->rocks += other.rocks;
  this->pieces += other.pieces;
  this->moving += other.moving;
  this->overEdge += other.overEdge;
  this->inNodata += other.inNodata;
  this->unmoved += other.unmoved;
  this->endTime = std::max(this->endTime, other.endTime);
}

std::vector<std::string> lostNotes(const LostRocks& lost, const std::string& before)
{
  std::vector<std::string> notes;
  const auto tell = [&](std::int64_t count, const std::string& how, const std::string& what)
  {
    if (count > 0)
    {
      notes.push_back(std::to_string(count) + " of " + std::to_string(lost.rocks) + " rocks " +
        how + before + ": " + what);
    }
  };
  if (lost.endTime >= kLeastRun)
  {
    const std::string latest = numberText(lost.endTime, 4);
    const std::string first = lost.firstEnd > 0.0 ? numberText(lost.firstEnd, 4) : latest;
    tell(lost.moving,
      "were still moving at EndTime (" + (first == latest ? "" : first + " to ") + latest + " s)",
      "they count as if they stopped there; give a larger EndTime");
  }
  tell(lost.overEdge, "went over the edge of the DEM",
    "the danger goes on beyond it; a larger DEM shows how far");
  tell(lost.inNodata, "were lost in nodata of the DEM",
    "what lies behind such a hole or seam gets too few; fill it in the DEM");
  return notes;
}

std::vector<std::string> stillNotes(const LostRocks& lost)
{
  if (lost.rocks == 0 || lost.unmoved < lost.rocks || (lost.moving > 0 && lost.endTime < kLeastRun))
  {
    return {};
  }
  return { "None of " + std::to_string(lost.rocks) + " rocks moved farther than " +
    numberText(kLeastWay) +
    " m: they lie still where they are released; give them a Velocity, or "
    "a place that is steeper" };
}

} // namespace rockfall
