// What the second look of a crowd's step asks for: where it would end, and contacts that nobody
// reckoned with.

#include "system/CrowdSolver.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

void CrowdSolver::append(const std::vector<GroupBody>& bodies, std::vector<GroupContact>& contacts)
{
  const std::size_t first = rows_.size();
  rows_.resize(contacts.size());
  // They go with what reaches further than to the next part, in the order that is kept there.
  for (const int kind : { 0, 2 })
  {
    std::vector<int> added;
    for (std::size_t k = first; k < contacts.size(); ++k)
    {
      if ((contacts[k].second < 0) == (kind == 2))
      {
        added.push_back(int(k));
      }
    }
    this->appendTo(std::size_t(parts_ * kKinds + kind), contacts, added);
  }
  for (std::size_t k = first; k < rows_.size(); ++k)
  {
    // The gap at the start from which this way leads to the one at the end.
    Row& row = rows_[k];
    Contact& c = *contacts[k].contact;
    this->prepareRow(bodies, contacts[k], row);
    c.distance -= this->travel(row)[0];
    c.offset = std::min(0.0, c.distance);
    row.gap0 = c.gap();
    if (contacts[k].bounce < 0.0)
    {
      batches_[std::size_t(row.batch)].gap[row.lane] = row.gap0;
    }
    for (const int body : { contacts[k].first, contacts[k].second })
    {
      if (body >= 0)
      {
        changed_[work_[std::size_t(body)].mover] = sweep_;
      }
    }
  }
}

void CrowdSolver::appendTo(
  std::size_t key, const std::vector<GroupContact>& contacts, const std::vector<int>& added)
{
  const int slope = int(work_.size()) + parts_;
  const int before = int(batches_.size());
  std::vector<Hand> hands;
  this->deal(contacts, added.data(), added.data() + added.size(), slope, hands);
  for (const Hand& hand : hands)
  {
    batches_.push_back(hand.idle());
    forces_.push_back({});
  }
  for (const int k : added)
  {
    rows_[std::size_t(k)].batch += before;
  }
  const int more = int(batches_.size()) - before, at = starts_[key + 1];
  if (more > 0 && at < before)
  {
    std::rotate(batches_.begin() + at, batches_.begin() + before, batches_.end());
    std::rotate(forces_.begin() + at, forces_.begin() + before, forces_.end());
    for (Row& row : rows_)
    {
      row.batch = row.batch >= before ? row.batch - before + at
                                      : (row.batch >= at ? row.batch + more : row.batch);
    }
  }
  for (std::size_t next = key + 1; next < starts_.size(); ++next)
  {
    starts_[next] += more;
  }
}

BlockState CrowdSolver::end(const std::vector<GroupBody>& bodies, std::size_t i) const
{
  BlockState state = *bodies[i].state;
  state.position += work_[i].way;
  state.orientation = (work_[i].turn * state.orientation).normalized();
  return state;
}

double CrowdSolver::gap(std::size_t contact) const
{
  return rows_[contact].gap0 + this->travel(rows_[contact])[0];
}

bool CrowdSolver::setGap(std::size_t contact, double found)
{
  Row& row = rows_[contact];
  double& asked = batches_[std::size_t(row.batch)].gap[row.lane];
  const double change = gapChange(row.gap0, this->gap(contact), found);
  if (std::abs(change) <= kQuiet * enough_)
  {
    return false; // as exact as it is
  }
  asked += asked == row.gap0 ? change : 0.0; // a bounce asks for one of its own
  row.gap0 += change;
  for (int side = 0; side < 2; ++side)
  {
    const std::size_t i = std::size_t(batches_[std::size_t(row.batch)].body[side][row.lane]);
    changed_[i] = i < work_.size() ? sweep_ : kNever;
  }
  return true;
}

} // namespace rockfall
