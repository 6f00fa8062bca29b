#include "solve/island/CrowdSolver.h"

#include "block/cayley.h"
#include "law/settings.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

void CrowdSolver::turnAs(Work& w, const Vec3& spun) const
{
  w.turn = cayley(spun);
  w.turned = w.turn.toRotationMatrix();
  w.mean = 0.5 * w.turned;
  w.mean.diagonal().array() += 0.5;
}

std::array<Vec3, 2> CrowdSolver::freeMotion(const IslandBody& body, const Work& w) const
{
  Vec3 displacement = h_ * (w.velocity0 - w.offset);
  displacement.z() -= h_ * h_ * gravity_;
  const Vec3 steady = h_ * (w.spin0 - w.spinOffset);
  if (body.block->isotropic())
  {
    return { displacement, steady };
  }
  // The momentum of rotation is carried to the end of the step: R₁ p₁ − R₀ p₀ = h τ (METHOD 10.4).
  const Mat3 back = w.rotation.transpose();
  const Vec3 spin = w.spun / h_ + w.spinOffset;
  const Vec3 momentum = w.rotation * (body.block->inertia() * (back * spin));
  const Vec3 gained = back * (w.turned * momentum - momentum);
  return { displacement, steady - h_ * (w.rotation * (body.block->inverseInertia() * gained)) };
}

void CrowdSolver::prepareBodies(const StepRequest& request, const std::vector<IslandBody>& bodies)
{
  const double h = h_ = request.duration;
  gravity_ = request.gravity;
  work_.resize(bodies.size());
  seen_.resize(bodies.size());
  const auto prepareBody = [&](std::size_t i)
  {
    const IslandBody& body = bodies[i];
    const Block& block = *body.block;
    const BlockState& state = *body.state;
    Work& w = work_[i];
    w.moved = true;
    seen_[i].radius = block.radius();
    w.rotation = state.orientation.toRotationMatrix();
    const Mat3 back = w.rotation.transpose();
    w.position = state.position;
    w.velocity0 = state.velocity;
    w.spin0 = w.rotation * state.spin;
    const Vec3 spinAcceleration = w.rotation * body.spinAcceleration;
    w.offset = 0.5 * h * body.acceleration;
    w.spinOffset = 0.5 * h * spinAcceleration;
    w.inverseMass = h * h / block.mass();
    w.inverseInertia = block.isotropic()
      ? Mat3((h * h) * block.inverseInertia())
      : Mat3(w.rotation * ((h * h) * block.inverseInertia()) * back);
    // First guess: as the last step went.
    w.displacement = h * w.velocity0 + (0.5 * h * h) * body.acceleration;
    w.spun = h * w.spin0 + (0.5 * h * h) * spinAcceleration;
    const bool gyrates = !block.isotropic() && body.spinAcceleration.isZero(0.0);
    for (int k = 0; k < kFreeTurns && gyrates; ++k)
    {
      // … but turning as a free body does, that keeps its angular momentum: taken for constant, its
      // spin would gain energy from the gyroscopic moment.
      this->turnAs(w, w.spun);
      w.spun = this->freeMotion(body, w)[1];
    }
    this->turnAs(w, w.spun);
  };
  forEach(bodies.size(), kBodyGrain, prepareBody);
}

void CrowdSolver::startMover(const IslandBody& body, std::size_t i)
{
  const Work& w = work_[i];
  crowd::Mover& m = movers_[w.mover];
  const std::array<Vec3, 2> free = this->freeMotion(body, w);
  const Mat3& inertia = w.inverseInertia;
  for (int k = 0; k < 3; ++k)
  {
    m.displacement[k] = free[0][k];
    m.turn[k] = free[1][k];
    m.inertia[k] = inertia(k, k);
  }
  m.displacement[3] = w.inverseMass;
  m.inertia[3] = inertia(0, 1);
  m.inertia[4] = inertia(0, 2);
  m.inertia[5] = inertia(1, 2);
}

void CrowdSolver::startMovers(const std::vector<IslandBody>& bodies)
{
  movers_.assign(work_.size() + std::size_t(strips_) + 1, crowd::Mover{});
  changed_.assign(movers_.size(), 0);
  std::fill(changed_.begin() + std::ptrdiff_t(work_.size()), changed_.end(), kNever);
  forEach(work_.size(), kBodyGrain, [&](std::size_t i) { this->startMover(bodies[i], i); });
}

bool CrowdSolver::correctTurns(
  const std::vector<IslandBody>& bodies, const std::vector<IslandContact>& contacts)
{
  bool any = false;
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const Vec3 spun = Eigen::Map<const Vec3>(movers_[work_[i].mover].turn);
    if ((spun - work_[i].spun).squaredNorm() > kTurnGuessed * kTurnGuessed)
    {
      any = true;
      changed_[work_[i].mover] = sweep_;
      work_[i].moved = true;
      work_[i].spun = spun;
    }
  }
  if (!any)
  {
    return false;
  }
  // Levers lie between places that are of one kind, guessed or solved.
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    this->goTo(work_[i], Eigen::Map<const Vec3>(movers_[work_[i].mover].displacement));
  }
  const auto wrong = [&](int i)
  { return i >= 0 && changed_[work_[std::size_t(i)].mover] == sweep_; };
  wrong_.resize(rows_.size());
  forEach(rows_.size(), kRowGrain,
    [&](std::size_t k) { wrong_[k] = wrong(contacts[k].first) || wrong(contacts[k].second); });
  const auto forTheirRows = [&](auto&& change)
  {
    const auto ifWrong = [&](std::size_t k)
    {
      if (wrong_[k])
      {
        change(k);
      }
    };
    this->forStrips(false, [&](int strip) { this->forRows(strip, ifWrong); });
    for (std::size_t k = order_.size(); k < rows_.size(); ++k)
    {
      ifWrong(k);
    }
  };
  forTheirRows([&](std::size_t k) { this->pushed(rows_[k], -1.0); });
  const auto turn = [&](std::size_t i)
  {
    if (wrong(int(i)))
    {
      this->turnAs(work_[i], work_[i].spun);
      this->startMover(bodies[i], i);
    }
  };
  forEach(work_.size(), kBodyGrain, turn);
  forTheirRows(
    [&](std::size_t k)
    {
      this->lever(bodies, contacts[k], rows_[k]);
      this->pushed(rows_[k], 1.0);
    });
  turned_.assign(batches_.size(), 0);
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    if (wrong_[k] && !rows_[k].isSpeculative())
    {
      turned_[std::size_t(rows_[k].batch)] = 1;
    }
  }
  const auto assembleTurned = [&](std::size_t k)
  {
    if (turned_[k])
    {
      this->assemble(k, 1);
    }
  };
  forEach(turned_.size(), kRowGrain, assembleTurned);
  // Rocks that others press on have been moved with them.
  touched_.clear();
  for (std::size_t k = 0; k < rows_.size(); ++k)
  {
    for (const int i : { contacts[k].first, contacts[k].second })
    {
      if (wrong_[k] && i >= 0 && !wrong(i))
      {
        touched_.push_back(i);
      }
    }
  }
  for (const int i : touched_)
  {
    changed_[work_[std::size_t(i)].mover] = sweep_;
  }
  return true;
}

} // namespace rockfall
