// How the contacts of two rocks last from step to step.

#include "contact/pairTouch.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// A point that has moved by less than this share of the smaller radius on its rock since the last
/// step is the same.
constexpr double kSamePoint = 0.05;
/// What is deeper than reckoned by more than this share of the smaller radius is no compression.
constexpr double kMisreckoned = 1e-4;

/// Whether the point is where an edge is cut, and no vertex.
bool isCut(const Contact& c)
{
  return c.kind == ContactKind::VertexFace
    ? c.rockFeature < 0
    : c.kind == ContactKind::FaceVertex && c.surfaceFeature < 0;
}

/// What a touch was before.
struct Match
{
  int old = -1;        ///< Number of a contact, −1: none.
  bool itself = false; ///< Between the same features.
  bool near = false;   ///< Where it was.
};

/// A contact goes on with its springs at a touch; `turned`: along another axis. What is deeper than
/// reckoned by more than `far` (m) is no compression.
void goOn(const Touch& touch, const PairBody& second, const PairAxis& axis, const Match& match,
  bool turned, double far, Contact& c)
{
  const Vec3 oldPoint = c.point;
  const double oldGap = c.gap();
  putTouch(touch, second, axis, c);
  c.slip = c.slip - c.slip.dot(c.normal) * c.normal;
  c.shearForce = 0.0;
  if (match.itself && match.near && isCut(c))
  {
    // Where an edge leaves a face is no point of a rock: the point that was there stays.
    c.distance +=
      (axis.kind == PairAxis::Kind::FaceOfFirst ? -1.0 : 1.0) * c.normal.dot(oldPoint - c.point);
    c.point = oldPoint;
  }
  else if (c.closed() && (turned || !match.itself || isCut(c)))
  {
    // Seen elsewhere the gap is another one: the spring keeps its compression.
    c.offset = c.distance - oldGap;
  }
  // A step reckons with levers of its middle; where the rocks have turned far they end up deeper
  // than reckoned, and that is no compression.
  const double reckoned = std::min(0.0, oldGap);
  c.offset = c.gap() < reckoned - far ? c.distance - reckoned : c.offset;
}

/// What was in springs that are gone goes into those that are new, or else into those that stay.
void handOver(const std::vector<char>& taken, const std::vector<char>& known,
  const std::vector<Contact>& before, std::vector<Contact>& now)
{
  double energy = 0.0;
  const Contact* strongest = nullptr;
  for (std::size_t k = 0; k < before.size(); ++k)
  {
    const Contact& c = before[k];
    if (!taken[k] && c.closed())
    {
      const double compressed = std::min(0.0, c.gap());
      energy += 0.5 * c.stiffness * compressed * compressed;
      strongest = !strongest || c.normalForce > strongest->normalForce ? &c : strongest;
    }
  }
  if (energy <= 0.0)
  {
    return;
  }
  const auto fresh = std::count(known.begin(), known.end(), char(0));
  const double share =
    energy / double(fresh > 0 ? fresh : std::max<std::ptrdiff_t>(1, known.size()));
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    Contact& c = now[i];
    if (fresh > 0 && known[i])
    {
      continue;
    }
    if (!known[i])
    {
      c.state = strongest->state;
      c.stiffness = strongest->stiffness;
      c.shearStiffness = strongest->shearStiffness;
      c.dashpot = strongest->dashpot;
      c.stopped = strongest->stopped;
      c.shearDashpot = strongest->shearDashpot;
      c.frequency2 = strongest->frequency2;
    }
    const double compressed = std::min(0.0, c.gap());
    if (c.stiffness > 0.0)
    {
      c.offset = c.distance + std::sqrt(compressed * compressed + 2.0 * share / c.stiffness);
      c.state = c.closed() ? c.state : ContactState::Sliding;
    }
  }
}

} // namespace

void updatePair(const PairBody& first, const PairBody& second, double reach, RockPair& pair,
  const ClosingGaps* closing)
{
  const PairAxis last = pair.known || pair.seen ? pair.before : pair.axis;
  const bool stands = pair.seen && (pair.axis.distance <= 0.0 || pair.axis.distance > reach);
  if (!pair.known && !stands)
  {
    pair.axis = findAxis(first, second, pair.axis, reach);
  }
  pair.known = pair.seen = false;
  const bool carries = closedCount(pair.contacts) > 0;
  if (closing && !carries)
  {
    reach = std::min(reach, closing->along(pair.axis.normal));
  }
  if (pair.axis.distance > reach)
  {
    // A spring that is still compressed, as it was found or handed over so, opens by itself.
    if (!carries)
    {
      pair.contacts.clear();
      pair.touched = false;
    }
    return;
  }
  std::span<const Touch> found = touchesAlong(first, second, pair.axis, reach);
  if (found.empty() && carries)
  {
    pair.axis = last; // past the end of a feature, with no other one there
    return;
  }
  found = orAlongBest(found, first, second, pair.axis, reach);
  const bool turned =
    last.kind != pair.axis.kind || last.first != pair.axis.first || last.second != pair.axis.second;
  const double smaller = std::min(first.radius, second.radius);
  const double same = kSamePoint * smaller;
  // Which of the old ones each is: mostly all are there again, in their order.
  thread_local std::vector<Match> matches;
  thread_local std::vector<char> taken, known;
  const std::size_t before = pair.contacts.size();
  matches.resize(found.size());
  known.resize(found.size());
  taken.assign(before, 0);
  bool inOrder = found.size() >= before;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    const TouchFeatures features(found[i], pair.axis);
    Match& match = matches[i];
    match = {};
    double least = same * same;
    for (std::size_t k = 0; k < before; ++k)
    {
      // The old point is where its rock has carried it since (see the solver's write-back).
      const Contact& old = pair.contacts[k];
      const double away = (old.point - found[i].point).squaredNorm();
      const bool equal = features.are(old);
      if (!taken[k] && (equal || (!match.itself && away < least)))
      {
        match.itself = equal;
        least = away;
        match.old = int(k);
      }
    }
    known[i] = match.old >= 0;
    if (match.old >= 0)
    {
      taken[std::size_t(match.old)] = 1;
      match.near = least < same * same;
    }
    inOrder = inOrder && (i < before ? match.old == int(i) : match.old < 0);
  }
  thread_local std::vector<Contact> olds;
  if (!inOrder)
  {
    olds = pair.contacts;
  }
  pair.contacts.resize(found.size());
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    Contact& c = pair.contacts[i];
    if (!inOrder)
    {
      c = known[i] ? olds[std::size_t(matches[i].old)] : Contact();
    }
    if (known[i])
    {
      goOn(found[i], second, pair.axis, matches[i], turned, kMisreckoned * smaller, c);
    }
    else
    {
      putTouch(found[i], second, pair.axis, c);
      // Found overlapping: finding it makes no energy.
      c.offset = std::min(0.0, c.distance);
    }
  }
  if (!inOrder)
  {
    handOver(taken, known, olds, pair.contacts);
  }
  if (closing)
  {
    std::erase_if(pair.contacts,
      [&](const Contact& c) { return !c.closed() && c.gap() > closing->at(c.point, c.normal); });
  }
}

} // namespace rockfall
