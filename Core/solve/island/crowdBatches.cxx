// How the contacts of a crowd are dealt out: into strips across the island, batches of which no two
// share a rock, and what is only speculative.

#include "solve/island/CrowdSolver.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace rockfall
{

namespace
{

/// Rocks of a strip of the island, and strips at most.
constexpr int kLeastStrip = 56;
constexpr int kMostStrips = 64;
/// To so many speculative contacts of a strip there is an empty batch for those that close.
constexpr std::size_t kSpeculativePerSpare = 32;
/// Batches that are filled at the same time.
constexpr int kOpen = 32;

/// Sorts what may be nearly in order.
void sortNearly(std::vector<std::pair<double, int>>& of)
{
  std::size_t moves = 8 * of.size(); // that are worth it
  for (std::size_t i = 1; i < of.size(); ++i)
  {
    const std::pair<double, int> one = of[i];
    std::size_t k = i;
    for (; k > 0 && one < of[k - 1] && moves > 0; --k, --moves)
    {
      of[k] = of[k - 1];
    }
    of[k] = one;
    if (moves == 0)
    {
      std::sort(of.begin(), of.end());
      return;
    }
  }
}

} // namespace

CrowdSolver::Hand::Hand(int slope)
{
  for (auto& side : body)
  {
    std::fill(std::begin(side), std::end(side), slope);
  }
}

template <class Of>
Of CrowdSolver::Hand::idle() const
{
  Of batch = {};
  std::fill(std::begin(batch.gap), std::end(batch.gap), std::numeric_limits<double>::max());
  for (int side = 0; side < 2; ++side)
  {
    std::copy(std::begin(body[side]), std::end(body[side]), batch.body[side]);
  }
  return batch;
}

void CrowdSolver::lineUp(const std::vector<IslandBody>& bodies)
{
  Vec3 low = work_.front().position, high = low;
  double radii = 0.0;
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    low = low.cwiseMin(work_[i].position);
    high = high.cwiseMax(work_[i].position);
    radii += bodies[i].block->radius();
  }
  int axis = 0;
  const double length = (high - low).maxCoeff(&axis);
  // Narrower than two rocks that touch, and contacts would reach further than to the next strip.
  const double width = 2.0 * radii / double(work_.size());
  const double most = std::min(double(kMostStrips), length / width);
  strips_ = std::clamp(int(work_.size()) / kLeastStrip, 1, std::max(1, int(most)));
  strips_ -= strips_ > 4 ? strips_ % 4 : 0; // two threads get the same number of every second strip
  // Nearly in order they are from the last step, mostly.
  const bool lined = line_.size() == work_.size();
  line_.resize(work_.size());
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    int& body = line_[i].second;
    body = lined ? body : int(i);
    line_[i].first = work_[std::size_t(body)].position[axis];
  }
  sortNearly(line_);
  for (std::size_t mover = 0; mover < line_.size(); ++mover)
  {
    work_[std::size_t(line_[mover].second)].mover = mover;
  }
}

int CrowdSolver::stripOf(const IslandContact& contact) const
{
  const auto stripOfRock = [&](int body)
  { return int(work_[std::size_t(body)].mover * std::size_t(strips_) / work_.size()); };
  const int a = stripOfRock(contact.first);
  const int b = contact.second < 0 ? a : stripOfRock(contact.second);
  return std::abs(a - b) <= 1 ? std::min(a, b) : strips_;
}

void CrowdSolver::arrange(const std::vector<IslandContact>& contacts)
{
  const int bodies = int(work_.size());
  const auto keyOf = [&](const IslandContact& k)
  {
    const int strip = this->stripOf(k);
    const bool open = !k.contact->closed() && mayStayOpen(k, h_);
    return strip * kKinds +
      (open                                 ? Speculative
          : k.second < 0 && strip < strips_ ? OnSlope
                                            : Pairs);
  };
  const std::size_t keys = std::size_t(strips_ + 1) * kKinds;
  keyOf_.resize(contacts.size());
  ends_.assign(keys + 1, 0);
  forEach(contacts.size(), kRowGrain, [&](std::size_t k) { keyOf_[k] = keyOf(contacts[k]); });
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    ++ends_[std::size_t(keyOf_[k]) + 1];
  }
  std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
  order_.resize(contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
  {
    order_[ends_[std::size_t(keyOf_[k])]++] = int(k);
  }
  rows_.resize(contacts.size());
  open_.assign(work_.size(), 0);
  starts_.resize(keys + 1);
  used_.assign(keys, 0);
  hands_.resize(std::max(hands_.size(), std::size_t(strips_) + 1));
  const auto dealStrip = [&](int strip)
  {
    std::vector<Hand>& hands = hands_[std::size_t(strip)];
    hands.clear();
    for (const Kind kind : { Pairs, OnSlope })
    {
      const std::size_t key = std::size_t(strip * kKinds + kind);
      starts_[key] = int(hands.size());
      this->deal(contacts, order_.data() + this->firstOf(key), order_.data() + ends_[key],
        bodies + strip, hands);
      used_[key] = int(hands.size());
      if (strip < strips_)
      {
        const std::size_t speculative = std::size_t(strip * kKinds + Speculative);
        hands.insert(hands.end(),
          1 + (ends_[speculative] - this->firstOf(speculative)) / kSpeculativePerSpare,
          Hand(bodies + strip));
      }
    }
    starts_[std::size_t(strip * kKinds + Speculative)] = int(hands.size());
  };
  this->forStrips(false, dealStrip);
  // Strip after strip.
  int count = 0;
  for (std::size_t key = 0; key < keys; ++key)
  {
    starts_[key] += count;
    used_[key] += count;
    count += (key + 1) % kKinds == 0 ? int(hands_[key / kKinds].size()) : 0;
  }
  starts_[keys] = count;
  room_ = starts_;
  speculativeStarts_.assign(std::size_t(strips_) + 2, 0);
  for (std::size_t strip = 0; strip <= std::size_t(strips_); ++strip)
  {
    const std::size_t key = strip * kKinds + Speculative;
    speculativeStarts_[strip + 1] = speculativeStarts_[strip] +
      int((ends_[key] - this->firstOf(key) + crowd::kLanes - 1) / crowd::kLanes);
  }
  speculative_.resize(std::size_t(speculativeStarts_.back()));
  speculativeContacts_.assign(speculative_.size() * crowd::kLanes, -1);
  closes_.resize(speculative_.size());
  batches_.resize(std::size_t(count));
  filled_.resize(std::size_t(count));
  springs_.assign(std::size_t(count), crowd::Springs{});
  forces_.assign(std::size_t(count), crowd::Forces{});
  const auto layOut = [&](int strip)
  {
    const std::size_t key = std::size_t(strip * kKinds);
    std::size_t at = std::size_t(starts_[key]);
    for (const Hand& hand : hands_[std::size_t(strip)])
    {
      batches_[at] = hand.idle<crowd::Batch>();
      filled_[at++] = hand.filled;
    }
    for (std::size_t k = this->firstOf(key); k < ends_[key + OnSlope]; ++k)
    {
      rows_[std::size_t(order_[k])].batch += starts_[key];
    }
    this->layOutSpeculative(contacts, strip, bodies + strip);
  };
  this->forStrips(false, layOut);
}

void CrowdSolver::deal(const std::vector<IslandContact>& contacts, const int* first,
  const int* last, int slope, std::vector<Hand>& hands)
{
  // Each contact goes to the first batch that is being filled and holds neither of its rocks.
  std::array<int, kOpen> batch{};
  std::uint32_t filling = 0; // those that have room
  int oldest = 0;
  const auto close = [&](int slot)
  {
    const Hand& hand = hands[std::size_t(batch[std::size_t(slot)])];
    for (const int* side : { hand.body[0], hand.body[1] })
    {
      for (int lane = 0; lane < crowd::kLanes; ++lane)
      {
        if (side[lane] < int(work_.size()))
        {
          open_[std::size_t(side[lane])] &= ~(std::uint32_t(1) << slot);
        }
      }
    }
    filling &= ~(std::uint32_t(1) << slot);
  };
  for (const int* k = first; k != last; ++k)
  {
    const IslandContact& contact = contacts[std::size_t(*k)];
    const std::size_t a = work_[std::size_t(contact.first)].mover;
    const std::size_t c = contact.second < 0 ? a : work_[std::size_t(contact.second)].mover;
    const std::uint32_t taken = open_[a] | open_[c];
    int slot = std::countr_zero(filling & ~taken);
    if (slot == kOpen)
    {
      slot = std::countr_one(filling);
      if (slot == kOpen)
      {
        slot = oldest;
        oldest = (oldest + 1) % kOpen;
        close(slot);
      }
      batch[std::size_t(slot)] = int(hands.size());
      filling |= std::uint32_t(1) << slot;
      hands.emplace_back(slope);
    }
    Row& row = rows_[std::size_t(*k)];
    row.batch = batch[std::size_t(slot)];
    Hand& hand = hands[std::size_t(row.batch)];
    row.lane = hand.filled++;
    hand.body[0][row.lane] = int(a);
    hand.body[1][row.lane] = contact.second < 0 ? slope : int(c);
    open_[a] |= std::uint32_t(1) << slot;
    open_[c] |= std::uint32_t(1) << slot;
    if (row.lane + 1 == crowd::kLanes)
    {
      close(slot);
    }
  }
  while (filling != 0)
  {
    close(std::countr_zero(filling));
  }
}

void CrowdSolver::findLanes(
  const std::vector<IslandContact>& contacts, const std::vector<int>& added)
{
  fresh_.clear();
  left_.clear();
  for (const int k : added)
  {
    if (this->findEmptyLane(contacts[std::size_t(k)], rows_[std::size_t(k)]))
    {
      fresh_.push_back(rows_[std::size_t(k)].batch);
    }
    else
    {
      left_.push_back(k);
    }
  }
  std::sort(fresh_.begin(), fresh_.end());
  fresh_.erase(std::unique(fresh_.begin(), fresh_.end()), fresh_.end());
  if (!left_.empty())
  {
    const int first = int(batches_.size());
    this->appendBatches(contacts, left_);
    for (int k = first; k < int(batches_.size()); ++k)
    {
      fresh_.push_back(k);
    }
  }
}

bool CrowdSolver::findEmptyLane(const IslandContact& contact, Row& row)
{
  const int strip = this->stripOf(contact);
  const bool slope = contact.second < 0;
  const std::size_t key =
    std::size_t(strip * kKinds + (slope && strip < strips_ ? OnSlope : Pairs));
  const int a = int(work_[std::size_t(contact.first)].mover);
  const int c = slope ? a : int(work_[std::size_t(contact.second)].mover);
  for (int k = room_[key]; k < starts_[key + 1]; ++k)
  {
    crowd::Batch& batch = batches_[std::size_t(k)];
    int& filled = filled_[std::size_t(k)];
    if (filled == crowd::kLanes)
    {
      room_[key] += k == room_[key] ? 1 : 0;
      continue;
    }
    int has = 0;
    for (int lane = 0; lane < crowd::kLanes; ++lane)
    {
      const int first = batch.body[0][lane], second = batch.body[1][lane];
      has |= int(first == a) | int(first == c) | int(second == a) | int(second == c);
    }
    if (has == 0)
    {
      row.batch = k;
      row.lane = filled++;
      used_[key] = std::max(used_[key], k + 1);
      batch.body[0][row.lane] = a;
      batch.body[1][row.lane] = slope ? batch.body[1][row.lane] : c;
      return true;
    }
  }
  return false;
}

void CrowdSolver::appendBatches(
  const std::vector<IslandContact>& contacts, const std::vector<int>& added)
{
  const std::size_t before = batches_.size();
  std::vector<Hand>& hands = hands_.back();
  hands.clear();
  this->deal(
    contacts, added.data(), added.data() + added.size(), int(work_.size()) + strips_, hands);
  for (const int k : added)
  {
    rows_[std::size_t(k)].batch += int(before);
  }
  for (const Hand& hand : hands)
  {
    batches_.push_back(hand.idle<crowd::Batch>());
    filled_.push_back(hand.filled);
  }
  springs_.resize(batches_.size());
  forces_.resize(batches_.size());
  forcesBefore_.resize(batches_.size());
  forcesAlong_.resize(batches_.size());
  // Contacts go with what reaches further than to the next strip.
  const std::size_t pairs = std::size_t(strips_ * kKinds + Pairs);
  used_[pairs] = int(batches_.size());
  for (std::size_t key = pairs + 1; key < starts_.size(); ++key)
  {
    starts_[key] = int(batches_.size());
  }
  used_[pairs + OnSlope] = int(batches_.size()); // it has none
}

void CrowdSolver::layOutSpeculative(
  const std::vector<IslandContact>& contacts, int strip, int slope)
{
  const auto first = speculative_.begin() + speculativeStarts_[std::size_t(strip)];
  std::for_each(first, speculative_.begin() + speculativeStarts_[std::size_t(strip) + 1],
    [&](crowd::Speculative& four) { four = Hand(slope).idle<crowd::Speculative>(); });
  const std::size_t key = std::size_t(strip * kKinds + Speculative);
  std::size_t at = std::size_t(speculativeStarts_[std::size_t(strip)]) * crowd::kLanes;
  for (std::size_t k = this->firstOf(key); k < ends_[key]; ++k, ++at)
  {
    const int contact = order_[k];
    const IslandContact& asked = contacts[std::size_t(contact)];
    Row& row = rows_[std::size_t(contact)];
    row.batch = ~int(at / crowd::kLanes);
    row.lane = int(at % crowd::kLanes);
    crowd::Speculative& four = speculative_[row.fours()];
    four.body[0][row.lane] = int(work_[std::size_t(asked.first)].mover);
    four.body[1][row.lane] = asked.second < 0 ? slope : int(work_[std::size_t(asked.second)].mover);
    speculativeContacts_[at] = contact;
  }
}

} // namespace rockfall
