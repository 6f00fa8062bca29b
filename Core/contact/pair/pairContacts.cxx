// How the contacts of two rocks last from step to step.

#include "contact/pair/pairClip.h"
#include "contact/pair/pairTouch.h"
#include "law/settings.h"

#include <algorithm>
#include <optional>

namespace rockfall
{

namespace
{

/// Whether the point is where an edge is cut, and no vertex.
bool isCut(const Contact& c)
{
  return c.kind == ContactKind::VertexFace
    ? c.rockFeature < 0
    : c.kind == ContactKind::FaceVertex && c.surfaceFeature < 0;
}

/// The contact of a touch in the last step.
struct Match
{
  int old;     ///< Number of a contact, −1: none.
  bool itself; ///< Between the same features.
  bool near;   ///< The place is where the contact was.
};

/// Finds for each touch which of the old contacts it is; points nearer than `same` (m) may be one.
void match(std::span<const Touch> found, const PairAxis& axis, std::span<const Contact> olds,
  double same, Match* matches, char* taken)
{
  std::fill_n(taken, olds.size(), char(0));
  const double same2 = same * same;
  for (std::size_t i = 0; i < found.size(); ++i)
  {
    const TouchFeatures features(found[i], axis);
    // The old point is where its rock has carried it since (see the solver's write-back).
    const auto away = [&](std::size_t k) { return (olds[k].point - found[i].point).squaredNorm(); };
    Match match = { -1, false, false };
    // Mostly all are there again, in their order.
    std::size_t k = i < olds.size() && !taken[i] && features.are(olds[i]) ? i : 0;
    while (k < olds.size() && (taken[k] || !features.are(olds[k])))
    {
      ++k;
    }
    if (k < olds.size())
    {
      match.itself = true;
      match.old = int(k);
      match.near = away(k) < same2;
    }
    else
    {
      double least = same2;
      for (k = 0; k < olds.size(); ++k)
      {
        const double distance = taken[k] ? least : away(k);
        if (distance < least)
        {
          least = distance;
          match.old = int(k);
          match.near = true;
        }
      }
    }
    if (match.old >= 0)
    {
      taken[match.old] = 1;
    }
    matches[i] = match;
  }
}

/// Depth beyond the reckoned one is no compression: a step reckons with levers of its middle, and
/// where the rocks have turned they end up deeper. A stiff spring would make an impulse of that.
void letGo(double oldGap, Contact& c)
{
  c.offset = std::min(c.offset, c.distance - std::min(0.0, oldGap));
}

/// A contact goes on with its springs at a touch; `turned`: along another axis.
void goOn(const Touch& touch, const PairBody& second, const PairAxis& axis, const Match& match,
  bool turned, Contact& c)
{
  const Vec3 oldPoint = c.point;
  const double oldGap = c.gap();
  putTouch(touch, second, axis, c);
  if (!c.slip.isZero(0.0))
  {
    c.slip = c.slip - c.slip.dot(c.normal) * c.normal;
  }
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
  letGo(oldGap, c);
}

/// Force of a contact along the normal, N.
double carried(const Contact& c)
{
  return c.closed() ? c.stiffness * std::max(0.0, -c.gap()) : 0.0;
}

/// What a contact that is gone carried, the nearest one carries.
void handOverAll(
  std::span<const char> taken, std::span<const Contact> before, std::span<Contact> now)
{
  for (std::size_t k = 0; k < before.size(); ++k)
  {
    const Contact& old = before[k];
    if (taken[k] || !(carried(old) > 0.0))
    {
      continue;
    }
    const auto nearer = [&](const Contact& a, const Contact& b)
    { return (a.point - old.point).squaredNorm() < (b.point - old.point).squaredNorm(); };
    Contact& c = *std::min_element(now.begin(), now.end(), nearer);
    if (!(c.stiffness > 0.0)) // open so far, and without springs
    {
      c.stiffness = old.stiffness;
      c.shearStiffness = old.shearStiffness;
      c.dashpot = old.dashpot;
      c.stopped = old.stopped;
      c.shearDashpot = old.shearDashpot;
      c.frequency2 = old.frequency2;
    }
    c.slip = c.closed() ? c.slip : Vec3::Zero();
    c.slip += (old.shearStiffness / c.shearStiffness) * old.slip;
    c.offset = c.distance + (carried(c) + carried(old)) / c.stiffness;
    c.state = c.closed() ? c.state : ContactState::Sliding;
  }
}

bool mayClose(const Contact& c, const ClosingGaps::AtPoints& closing)
{
  return c.closed() || !(c.gap() > closing.at(c.point));
}

/// Contacts of touches as they are found where a step begins.
struct Renewal
{
  const PairBody& second;
  std::span<const Touch> found;
  bool turned;                                ///< The axis is another one than in the last step.
  double same;                                ///< Points no farther apart are one, m.
  std::optional<ClosingGaps::AtPoints> sieve; ///< What cannot close is left out.

  void replaceAll(RockPair& pair);
};

void Renewal::replaceAll(RockPair& pair)
{
  const std::size_t touches = found.size(), olds = pair.contacts.size();
  Room<Match, 16> matchRoom;
  Room<char, 16> takenRoom;
  Match* const matches = matchRoom.of(touches);
  char* const taken = takenRoom.of(olds);
  match(found, pair.axis, pair.contacts, same, matches, taken);
  bool hands = false;
  for (std::size_t k = 0; k < olds; ++k)
  {
    hands = hands || (!taken[k] && carried(pair.contacts[k]) > 0.0);
  }
  const std::optional<ClosingGaps::AtPoints> all = sieve;
  if (hands)
  {
    sieve.reset(); // what springs are handed to may be any
  }
  thread_local std::vector<Contact> renewed;
  renewed.clear();
  for (std::size_t i = 0; i < touches; ++i)
  {
    const Match& match = matches[i];
    if (match.old >= 0)
    {
      Contact& c = renewed.emplace_back(pair.contacts[std::size_t(match.old)]);
      goOn(found[i], second, pair.axis, match, turned, c);
      if (sieve && !mayClose(c, *sieve))
      {
        renewed.pop_back();
      }
    }
    else if (!sieve || !(std::max(0.0, found[i].distance) > sieve->at(found[i].point)))
    {
      Contact& c = renewed.emplace_back();
      putTouch(found[i], second, pair.axis, c);
      // Found overlapping: finding it makes no energy.
      c.offset = std::min(0.0, c.distance);
    }
  }
  if (hands)
  {
    handOverAll({ taken, olds }, pair.contacts, renewed);
    if (all)
    {
      std::erase_if(renewed, [&](const Contact& c) { return !mayClose(c, *all); });
    }
  }
  pair.keep(renewed);
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
  const bool carries = anyClosed(pair.contacts);
  if (closing && !carries)
  {
    reach = std::min(reach, closing->along(pair.axis.normal));
  }
  if (pair.axis.distance > reach)
  {
    // A spring that is still compressed, as it was found or handed over so, opens by itself.
    if (!carries)
    {
      pair.keep({});
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
  const double smaller = std::min(first.radius, second.radius);
  const bool turned =
    last.kind != pair.axis.kind || last.first != pair.axis.first || last.second != pair.axis.second;
  Renewal renewal = { second, found, turned, kSamePoint * smaller, {} };
  if (closing && !found.empty())
  {
    renewal.sieve = closing->atPoints(pair.axis.normal);
  }
  renewal.replaceAll(pair);
}

} // namespace rockfall
