// A crowd's step: contacts into batches, sweeps over them, and what comes of it.

#include "system/CrowdSolver.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace rockfall
{

namespace
{

/// Where nothing bounces forces are to be exact, and few contacts still change: so many times more
/// sweeps.
constexpr int kCalmSweeps = 50;
/// As long as the last sweep has moved something by more than this many times the tolerance, 3 % of
/// the longest way, so many times more sweeps are made: forces as wrong as that would throw rocks
/// about. It happens where light rocks with sharp corners lie under heavy ones.
constexpr double kRough = 300.0;
constexpr int kRoughSweeps = 200;
/// After what has changed here and there (a bounce held back, a contact found), and where it is
/// rough, the sweeps go on around it, where things move by more than this share of the longest way.
/// Forces are not that exact yet anywhere: else each of these runs would go on with all of them.
constexpr double kNoticed = 3e-3;
/// What is found in a second look is met to this many times the tolerance, which is about as exact
/// as it is found, unless nothing bounces.
constexpr double kFound = 4.0;
/// A step whose last look still finds something deeper than this share of a radius is far from
/// settled.
constexpr double kDeepMiss = 0.02;
/// What is less deep than this share of a radius in the look before the last one leaves nothing
/// deep behind it.
constexpr double kWorthALook = 0.25 * kDeepMiss;
/// In each so many sweeps watched contacts are looked at, and so many follow on one that closes.
constexpr int kWatchEvery = 2;
constexpr int kAfterWatched = 2;
/// Rocks of a part of the group, and parts at most.
constexpr int kPart = 56;
constexpr int kMostParts = 64;
/// Batches that are filled at the same time.
constexpr int kOpen = 32;

} // namespace

CrowdSolver::Hand::Hand(int slope)
{
  for (auto& side : body)
  {
    std::fill(std::begin(side), std::end(side), slope);
  }
}

/// A batch of contacts that do nothing as yet.
crowd::Batch CrowdSolver::Hand::idle() const
{
  crowd::Batch batch = {};
  std::fill(std::begin(batch.gap), std::end(batch.gap), std::numeric_limits<double>::max());
  for (int side = 0; side < 2; ++side)
  {
    std::copy(std::begin(body[side]), std::end(body[side]), batch.body[side]);
  }
  return batch;
}

crowd::Watched CrowdSolver::Hand::watchedIdle() const
{
  crowd::Watched four = {};
  std::fill(std::begin(four.gap), std::end(four.gap), std::numeric_limits<double>::max());
  for (int side = 0; side < 2; ++side)
  {
    std::copy(std::begin(body[side]), std::end(body[side]), four.body[side]);
  }
  return four;
}

void CrowdSolver::lineUp()
{
  parts_ = std::clamp(int(work_.size()) / kPart, 1, kMostParts);
  parts_ -= parts_ > 4 ? parts_ % 4 : 0; // two threads get the same number of every second part
  Vec3 low = work_.front().position, high = low;
  for (const Work& w : work_)
  {
    low = low.cwiseMin(w.position);
    high = high.cwiseMax(w.position);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  line_.resize(work_.size());
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    line_[i] = { work_[i].position[axis], int(i) };
  }
  std::sort(line_.begin(), line_.end());
  for (std::size_t mover = 0; mover < line_.size(); ++mover)
  {
    work_[std::size_t(line_[mover].second)].mover = mover;
  }
}

void CrowdSolver::arrange(const std::vector<GroupContact>& contacts)
{
  const int bodies = int(work_.size());
  const auto partOf = [&](int body)
  { return int(work_[std::size_t(body)].mover * std::size_t(parts_) / work_.size()); };
  const auto keyOf = [&](const GroupContact& k)
  {
    const int a = partOf(k.first);
    const int b = k.second < 0 ? a : partOf(k.second);
    const int part = std::abs(a - b) <= 1 ? std::min(a, b) : parts_;
    const bool open = !k.contact->closed() && mayStayOpen(k, h_);
    return part * kKinds + (open ? Watching : k.second < 0 && part < parts_ ? OnSlope : Pairs);
  };
  const std::size_t keys = std::size_t(parts_ + 1) * kKinds;
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
  hands_.resize(std::max(hands_.size(), std::size_t(parts_) + 1));
  const auto dealPart = [&](int part)
  {
    std::vector<Hand>& hands = hands_[std::size_t(part)];
    hands.clear();
    for (const Kind kind : { Pairs, OnSlope })
    {
      const std::size_t key = std::size_t(part * kKinds + kind);
      starts_[key] = int(hands.size());
      this->deal(contacts, order_.data() + this->firstOf(key), order_.data() + ends_[key],
        bodies + part, hands);
    }
    starts_[std::size_t(part * kKinds + Watching)] = int(hands.size());
  };
  this->forParts(false, dealPart);
  // Part after part.
  int count = 0;
  for (std::size_t key = 0; key < keys; ++key)
  {
    starts_[key] += count;
    count += (key + 1) % kKinds == 0 ? int(hands_[key / kKinds].size()) : 0;
  }
  starts_[keys] = count;
  watchStarts_.assign(std::size_t(parts_) + 2, 0);
  for (std::size_t part = 0; part <= std::size_t(parts_); ++part)
  {
    const std::size_t key = part * kKinds + Watching;
    watchStarts_[part + 1] = watchStarts_[part] +
      int((ends_[key] - this->firstOf(key) + crowd::kLanes - 1) / crowd::kLanes);
  }
  watched_.resize(std::size_t(watchStarts_.back()));
  watchedContacts_.assign(watched_.size() * crowd::kLanes, -1);
  closes_.resize(watched_.size());
  batches_.resize(std::size_t(count));
  springs_.assign(std::size_t(count), crowd::Springs{});
  forces_.assign(std::size_t(count), crowd::Forces{});
  const auto layOut = [&](int part)
  {
    const std::size_t key = std::size_t(part * kKinds);
    std::transform(hands_[std::size_t(part)].begin(), hands_[std::size_t(part)].end(),
      batches_.begin() + starts_[key], [](const Hand& hand) { return hand.idle(); });
    for (std::size_t k = this->firstOf(key); k < ends_[key + OnSlope]; ++k)
    {
      rows_[std::size_t(order_[k])].batch += starts_[key];
    }
    this->layOutWatched(contacts, part, bodies + part);
  };
  this->forParts(false, layOut);
}

void CrowdSolver::deal(const std::vector<GroupContact>& contacts, const int* first, const int* last,
  int slope, std::vector<Hand>& hands)
{
  // Each contact goes to the first batch that is being filled and holds neither of its rocks.
  std::array<int, kOpen> batch{}, filled{};
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
    const GroupContact& contact = contacts[std::size_t(*k)];
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
      filled[std::size_t(slot)] = 0;
      filling |= std::uint32_t(1) << slot;
      hands.emplace_back(slope);
    }
    Row& row = rows_[std::size_t(*k)];
    row.batch = batch[std::size_t(slot)];
    row.lane = filled[std::size_t(slot)]++;
    Hand& hand = hands[std::size_t(row.batch)];
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

void CrowdSolver::layOutWatched(const std::vector<GroupContact>& contacts, int part, int slope)
{
  const auto first = watched_.begin() + watchStarts_[std::size_t(part)];
  std::for_each(first, watched_.begin() + watchStarts_[std::size_t(part) + 1],
    [&](crowd::Watched& four) { four = Hand(slope).watchedIdle(); });
  const std::size_t key = std::size_t(part * kKinds + Watching);
  std::size_t at = std::size_t(watchStarts_[std::size_t(part)]) * crowd::kLanes;
  for (std::size_t k = this->firstOf(key); k < ends_[key]; ++k, ++at)
  {
    const int contact = order_[k];
    const GroupContact& group = contacts[std::size_t(contact)];
    Row& row = rows_[std::size_t(contact)];
    row.batch = ~int(at / crowd::kLanes);
    row.lane = int(at % crowd::kLanes);
    crowd::Watched& four = watched_[row.fours()];
    four.body[0][row.lane] = int(work_[std::size_t(group.first)].mover);
    four.body[1][row.lane] = group.second < 0 ? slope : int(work_[std::size_t(group.second)].mover);
    watchedContacts_[at] = contact;
  }
}

double CrowdSolver::visit(int part)
{
  crowd::Pass pass;
  pass.backwards = sweep_ % 2 != 0;
  pass.movers = movers_.data();
  pass.changed = changed_.data();
  pass.number = sweep_;
  pass.quiet = quiet_;
  double most = 0.0;
  for (const bool slope : { pass.backwards, !pass.backwards })
  {
    const std::size_t key = std::size_t(part * kKinds + (slope ? OnSlope : Pairs));
    pass.first = batches_.data() + starts_[key];
    pass.forces = forces_.data() + starts_[key];
    pass.count = starts_[key + 1] - starts_[key];
    pass.slope = slope;
    most = std::max(most, kernel_->sweep(pass));
  }
  return most;
}

double CrowdSolver::sweep()
{
  most_.assign(std::size_t(parts_) + 1, 0.0);
  this->forParts(sweep_ % 2 != 0, [&](int part) { most_[std::size_t(part)] = this->visit(part); });
  changed_.back() = kNever; // the slope of the last part, where its contacts are among the others
  return *std::max_element(most_.begin(), most_.end());
}

bool CrowdSolver::sweepTo(double goal, int most, bool conjugate, GroupOutcome& outcome)
{
  bool reached = false, extended = false;
  for (int k = 0; k < most && !reached; ++k, ++sweep_)
  {
    if (conjugate && k > 0)
    {
      this->goFurther();
    }
    ++outcome.iterations;
    outcome.residual = this->sweep();
    reached = outcome.residual <= goal;
    // What closes in the end gets some sweeps more, once.
    const bool last = reached || k + 1 == most;
    if ((last ? !extended : k % kWatchEvery == 0) && this->watch(sweep_ + 1))
    {
      reached = false;
      most = std::max(most, k + 1 + kAfterWatched);
      extended = last;
    }
  }
  return reached;
}

bool CrowdSolver::sweeps(int most, bool everywhere, GroupOutcome& outcome)
{
  const double rough = kRough * enough_;
  const double noticed = kNoticed * scale_;
  const auto sweepAround = [&](double goal, double least, int count, bool conjugate)
  {
    quiet_ = std::max(kQuiet * enough_, least);
    if (conjugate)
    {
      this->begin();
    }
    return this->sweepTo(goal, count, conjugate, outcome);
  };
  // What goes on as one cannot be left alone here and there.
  bool settled = sweepAround(enough_, everywhere ? 0.0 : noticed, most, everywhere) && everywhere;
  if (outcome.residual > rough)
  {
    // Most have settled by then: on around where it is rough.
    sweepAround(rough, noticed, kRoughSweeps * most, false);
    settled = false;
  }
  return settled;
}

bool CrowdSolver::holdBounces(std::vector<GroupContact>& contacts)
{
  const auto gives = [&](std::size_t k)
  {
    const Row& row = rows_[k];
    const Vec3 force = this->forceOf(row);
    if (contacts[k].bounce <= 0.0 || force[0] <= 0.0)
    {
      return false;
    }
    crowd::Batch& p = batches_[std::size_t(row.batch)];
    const auto [before, after] = this->velocities(row);
    const double held = heldBounce(contacts[k], force, before, after);
    if (held >= 0.0)
    {
      contacts[k].bounce = held;
      p.gap[row.lane] = bounceGap(
        contacts[k], h_, springs_[std::size_t(row.batch)].penalty[row.lane] * p.w[row.lane]);
    }
    return held >= 0.0;
  };
  bool any = false;
  const auto goOn = [&](std::size_t k)
  {
    any = true;
    this->noteChange(contacts[k]);
  };
  forThose(rows_.size(), kRowGrain, gives_, gives, goOn);
  return any;
}

void CrowdSolver::settle(
  int most, bool everywhere, std::vector<GroupContact>& contacts, GroupOutcome& outcome)
{
  for (int k = 0; k < kHeldBounces && this->holdBounces(contacts); ++k)
  {
    outcome.settled = this->sweeps(most, everywhere, outcome);
    this->collect();
  }
}

void CrowdSolver::collect()
{
  const auto take = [&](std::size_t i)
  {
    Work& w = work_[i];
    const crowd::Mover& m = movers_[w.mover];
    const Eigen::Map<const Vec3> spun(m.turn);
    this->goTo(w, Eigen::Map<const Vec3>(m.way));
    if (w.spun != spun)
    {
      w.moved = w.moved || !this->isNear(w.spun, spun);
      this->turnAs(w, w.spun = spun);
    }
  };
  forEach(work_.size(), kBodyGrain, take);
}

GroupOutcome CrowdSolver::step(const StepRequest& request, std::vector<GroupBody>& bodies,
  std::vector<GroupContact>& contacts, Taken take, const std::function<double()>& lookAgain)
{
  GroupOutcome outcome;
  if (bodies.empty())
  {
    outcome.settled = outcome.taken = true;
    return outcome;
  }
  kernel_ = &crowd::suitedKernel();
  bodies_ = &bodies;
  contacts_ = &contacts;
  this->prepareBodies(request, bodies);
  this->lineUp();
  this->arrange(contacts);
  this->startMovers(bodies);
  this->prepareRows(bodies, contacts);
  // Displacements matter in relation to how far gravity and the rocks' speed move them in the step.
  double scale = 0.5 * request.gravity * h_ * h_;
  bool calm = true;
  for (const Work& w : work_)
  {
    scale = std::max(scale, w.way.norm());
  }
  for (const GroupContact& k : contacts)
  {
    calm = calm && k.bounce < 0.0;
  }
  scale_ = scale;
  enough_ = tolerance * scale;
  sweep_ = checked_ = 0;
  const int most = calm ? kCalmSweeps * maxSweeps : maxSweeps;
  outcome.settled = this->sweeps(most, true, outcome);
  if (this->correctTurns(bodies, contacts))
  {
    outcome.settled = this->sweeps(most, calm, outcome);
  }
  this->collect();
  this->settle(most, calm, contacts, outcome);
  double missed = 0.0;
  const auto looksOn = [&](int look)
  { return look < kLooks || (look == kLooks && missed > kWorthALook); };
  for (int look = 0; lookAgain && looksOn(look); ++look)
  {
    missed = lookAgain();
    if (missed <= 0.0)
    {
      break;
    }
    // From here it goes on around what was found only.
    for (int& changed : changed_)
    {
      changed = changed < sweep_ ? kNever : changed;
    }
    for (Work& w : work_)
    {
      w.moved = false;
    }
    enough_ = (calm ? 1.0 : kFound) * tolerance * scale;
    this->append(bodies, contacts);
    if (look == kLooks)
    {
      break; // the last one only tells how deep it is
    }
    outcome.settled = this->sweeps(most, calm, outcome);
    if (this->correctTurns(bodies, contacts))
    {
      outcome.settled = this->sweeps(most, calm, outcome);
    }
    this->collect();
    this->settle(most, calm, contacts, outcome);
  }
  bool finite = true;
  for (const Work& w : work_)
  {
    finite = finite && w.way.allFinite() && w.spun.allFinite();
  }
  const bool near = outcome.settled || outcome.residual <= kRough * enough_;
  outcome.rough = !near || missed > kDeepMiss;
  const bool fair = take == Taken::NotRough ? !outcome.rough : outcome.settled;
  outcome.taken = finite && (fair || take == Taken::Any);
  if (outcome.taken)
  {
    this->write(request, bodies, contacts, outcome);
  }
  return outcome;
}

} // namespace rockfall
