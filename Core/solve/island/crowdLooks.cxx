// Answers to the second look of a crowd's step: where it would end, and contacts that nobody
// reckoned with.

#include "solve/island/CrowdSolver.h"

#include "law/settings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace rockfall
{

void CrowdSolver::noteChange(const IslandContact& contact)
{
  for (const int body : { contact.first, contact.second })
  {
    if (body >= 0)
    {
      changed_[work_[std::size_t(body)].mover] = sweep_;
    }
  }
}

void CrowdSolver::assembleFresh()
{
  forEach(fresh_.size(), 4, [&](std::size_t k) { this->assemble(std::size_t(fresh_[k]), 1); });
}

void CrowdSolver::append()
{
  const std::vector<IslandBody>& bodies = *bodies_;
  std::vector<IslandContact>& contacts = *contacts_;
  // From here it goes on around what was found only.
  for (int& changed : changed_)
  {
    changed = changed < sweep_ ? kNever : changed;
  }
  for (Work& w : work_)
  {
    w.moved = false;
  }
  enough_ = (calm_ ? 1.0 : kFoundTolerance) * tolerance * scale_;
  const std::size_t first = rows_.size();
  rows_.resize(contacts.size());
  std::vector<int> added(rows_.size() - first);
  std::iota(added.begin(), added.end(), int(first));
  this->findLanes(contacts, added);
  for (std::size_t k = first; k < rows_.size(); ++k)
  {
    // The gap at the start from which this displacement leads to the one at the end.
    Row& row = rows_[k];
    Contact& c = *contacts[k].contact;
    this->prepareRow(bodies, contacts[k], row);
    c.distance -= this->opened(row);
    c.offset = std::min(0.0, c.distance);
    row.gap0 = batches_[std::size_t(row.batch)].gap[row.lane] = c.gap();
    this->noteChange(contacts[k]);
  }
  this->assembleFresh();
  for (std::size_t k = first; k < rows_.size(); ++k)
  {
    if (contacts[k].reboundSpeed >= 0.0)
    {
      this->stiffen(contacts[k], rows_[k]);
    }
    if (contacts[k].reboundSpeed > 0.0)
    {
      bouncing_.push_back(k);
    }
  }
}

bool CrowdSolver::closeSpeculative(int sweep)
{
  constexpr std::size_t kBlock = 16; // fours at once
  constexpr std::size_t kCloseGrain = 8;
  const auto look = [&](std::size_t block)
  {
    const std::size_t first = block * kBlock;
    crowd::SpeculativePass pass;
    pass.first = &speculative_[first];
    pass.count = std::min(kBlock, speculative_.size() - first);
    pass.movers = movers_.data();
    pass.changed = changed_.data();
    pass.since = checked_ - 1; // going further counts for the sweep before
    pass.closes = &closes_[first];
    kernel_->findClosing(pass);
  };
  forEach((speculative_.size() + kBlock - 1) / kBlock, 4, look);
  checked_ = sweep;
  closing_.clear();
  for (std::size_t k = 0; k < speculative_.size(); ++k)
  {
    for (int lane = 0; closes_[k] != 0 && lane < crowd::kLanes; ++lane)
    {
      if ((closes_[k] >> lane & 1) != 0)
      {
        closing_.push_back(speculativeContacts_[k * crowd::kLanes + std::size_t(lane)]);
        speculative_[k].gap[lane] = std::numeric_limits<double>::max();
      }
    }
  }
  if (closing_.empty())
  {
    return false;
  }
  this->findLanes(*contacts_, closing_);
  const auto makeReady = [&](std::size_t c)
  {
    const std::size_t k = std::size_t(closing_[c]);
    Row& row = rows_[k];
    const double gap0 = row.gap0; // may have been set right by a look
    const IslandContact& contact = (*contacts_)[k];
    if (contact.bare)
    {
      this->setSprings(contact);
    }
    this->prepareRow(*bodies_, contact, row);
    row.gap0 = batches_[std::size_t(row.batch)].gap[row.lane] = gap0;
  };
  forEach(closing_.size(), kCloseGrain, makeReady);
  for (const int k : closing_)
  {
    this->noteChange((*contacts_)[std::size_t(k)]);
  }
  this->assembleFresh();
  return true;
}

void CrowdSolver::setSprings(const IslandContact& contact) const
{
  const IslandBody& first = (*bodies_)[std::size_t(contact.first)];
  const IslandBody* second =
    contact.second >= 0 ? &(*bodies_)[std::size_t(contact.second)] : nullptr;
  PairSprings(stiffness, contact.damping, *first.block, *first.state,
    second ? second->block : nullptr, second ? second->state : nullptr)
    .set(*contact.contact);
}

BlockState CrowdSolver::end(std::size_t i) const
{
  const Work& w = work_[i];
  BlockState state = *(*bodies_)[i].state;
  state.position += w.displacement;
  state.velocity = w.displacement / h_ + w.offset;
  state.orientation = (w.turn * state.orientation).normalized();
  state.spin = w.rotation.transpose() * (w.spun / h_ + w.spinOffset);
  return state;
}

void CrowdSolver::setAbsent(std::size_t k)
{
  const IslandContact& contact = (*contacts_)[k];
  const Row& row = rows_[k];
  if (row.isSpeculative())
  {
    speculative_[row.fours()].gap[row.lane] = contact.absent ? kAbsent : row.gap0;
  }
  else
  {
    this->askGap(contact, row);
  }
  this->noteChange(contact);
}

double CrowdSolver::gap(std::size_t contact) const
{
  return rows_[contact].gap0 + this->opened(rows_[contact]);
}

bool CrowdSolver::setGap(std::size_t contact, double found)
{
  Row& row = rows_[contact];
  double& asked = row.isSpeculative() ? speculative_[row.fours()].gap[row.lane]
                                      : batches_[std::size_t(row.batch)].gap[row.lane];
  const double change = gapChange(row.gap0, this->gap(contact), found);
  if (std::abs(change) <= kQuiet * enough_)
  {
    return false; // as exact as it is
  }
  asked += asked == row.gap0 ? change : 0.0; // a bounce asks for one of its own
  row.gap0 += change;
  for (int side = 0; side < 2; ++side)
  {
    if (const Work* w = this->workOf(row, side))
    {
      changed_[w->mover] = sweep_;
    }
  }
  return true;
}

} // namespace rockfall
