#include "solve/step/StepSolver.h"

#include "block/cayley.h"
#include "contact/ground/features.h"
#include "geometry/roundBody.h"
#include "law/settings.h"
#include "solve/step/linear.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

template <int N>
Eigen::Matrix<double, N, 1> rowOf(const Vec3& n, const Vec3& lever, const Vec3& x)
{
  Eigen::Matrix<double, N, 1> row;
  row.template head<3>() = n;
  row.template segment<3>(kRotation) = lever.cross(n);
  if constexpr (N == 12)
  {
    row.template tail<6>() = strainRow(n, x);
  }
  return row;
}

/// A moment m about the turned block by the Cayley vector r of its turn: m · δφ = Tᵀ m · δr, where the
/// rotation changes by δφ = T δr = (δr + ½ r × δr) / (1 + ¼ r²).
Vec3 byCayley(const Vec3& m, const Vec3& r)
{
  return (m - 0.5 * r.cross(m)) / (1.0 + 0.25 * r.squaredNorm());
}

/// Inertia, or its inverse, times x: of translation and rotation alone two blocks are not zero.
template <int N>
Eigen::Matrix<double, N, 1> timesInertia(
  const Eigen::Matrix<double, N, N>& inertia, const Eigen::Matrix<double, N, 1>& x)
{
  if constexpr (N == 12)
  {
    return inertia * x;
  }
  const auto turning = inertia.template bottomRightCorner<3, 3>();
  Eigen::Matrix<double, N, 1> y;
  y.template head<3>() = inertia(0, 0) * x.template head<3>();
  y.template tail<3>() = turning.col(0) * x[3] + turning.col(1) * x[4] + turning.col(2) * x[5];
  return y;
}

} // namespace

template <int N>
void BlockStep<N>::prepareInertia(const Block& block, double h, double rate, double stress)
{
  if constexpr (N == 12)
  {
    MatN inert = (rate / h) * block.massMatrix();
    inert.template bottomRightCorner<6, 6>() += stress * block.elasticity();
    if (inert == inert_)
    {
      return;
    }
    mass_ = block.massMatrix();
    inert_ = inert;
    inverse_ = inert_.inverse();
  }
  else
  {
    mass_.setZero();
    mass_.diagonal().template head<3>().setConstant(block.mass());
    mass_.template bottomRightCorner<3, 3>() = block.inertia();
    inert_ = (rate / h) * mass_;
    inverse_.setZero();
    inverse_.diagonal().template head<3>().setConstant(h / (rate * block.mass()));
    inverse_.template bottomRightCorner<3, 3>() = (h / rate) * block.inverseInertia();
  }
}

template <int N>
void BlockStep<N>::prepareRows(const Block& block, const BlockState& state,
  const StepRequest& request, const std::vector<Contact>& contacts)
{
  rotation_ = state.orientation.toRotationMatrix();
  deform_ = Mat3::Identity() + strainTensor(state.strain);
  Mat3 undeform = Mat3::Identity();
  if (N == 12)
  {
    undeform = deform_.inverse();
  }
  rows_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Contact& c = contacts[i];
    Row& row = rows_[i];
    row.n = rotation_.transpose() * c.normal;
    if (c.kind == ContactKind::VertexFace && c.rockFeature >= 0)
    {
      row.x = block.shape().vertices()[c.rockFeature];
      row.y0 = deform_ * row.x;
    }
    else
    {
      row.y0 = rotation_.transpose() * (c.point - state.position);
      row.x = undeform * row.y0;
    }
    if (c.kind == ContactKind::EdgeEdge)
    {
      row.ridge = { rotation_.transpose() * (c.ridge[0] - state.position),
        rotation_.transpose() * c.ridge[1] };
      for (int k = 0; k < 2; ++k)
      {
        const int end = block.shape().edges()[c.rockFeature].vertices[k];
        row.edge[k] = deform_ * block.shape().vertices()[end];
      }
    }
    row.tangent[0] = row.n.unitOrthogonal();
    row.tangent[1] = row.n.cross(row.tangent[0]);
    const Vec3 slip = rotation_.transpose() * c.slip;
    ContactLaw& law = row.law;
    law.slip0 = { row.tangent[0].dot(slip), row.tangent[1].dot(slip) };
    law.gap0 = c.gap();
    law.penalty = c.stiffness > 0.0 ? c.stiffness : request.normalPenalty;
    law.shearPenalty = c.stiffness > 0.0 ? c.shearStiffness : request.shearPenalty;
    const bool impact = request.kind == StepKind::Impact;
    law.dashpot = impact ? dashpotOver(request.duration, c.dashpot, c.stopped) : 0.0;
    law.shearLag = impact ? c.shearDashpot / law.shearPenalty : 0.0;
    law.friction = c.friction >= 0.0 ? c.friction : request.friction;
    law.cohesion = c.cohesion >= 0.0 ? c.cohesion : request.cohesion;
    law.state = c.state;
    law.share = 1.0;
    law.direction.setZero();
    row.held = false;
  }
}

template <int N>
void BlockStep<N>::levers(
  const Block& block, const std::vector<Contact>& contacts, const Quat& rotation, const VecN& d)
{
  const Vec3 u = d.template head<3>();
  const Mat3 turn = rotation.toRotationMatrix();
  /// Place, after strain, of a material point x that was at y.
  const auto strained = [&](const Vec3& y, const Vec3& x) -> Vec3
  {
    if constexpr (N == 12)
    {
      return y + strainTensor(d.template tail<6>()) * x;
    }
    return y;
  };
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    Row& row = rows_[i];
    if (contacts[i].kind == ContactKind::FaceVertex)
    {
      // The slope's node rests, the rock's face turns: Δd = n_m·u + r·(y_m × n_m) + … exactly, with
      // normal and node averaged over the step as the block sees them.
      row.end = turn * row.n;
      const Vec3 n = 0.5 * (row.n + row.end);
      const Vec3 y = row.y0 - 0.5 * u;
      row.normal = rowOf<N>(n, y, row.x);
      for (int k = 0; k < 2; ++k)
      {
        row.shear[k] = rowOf<N>(row.tangent[k], y, row.x);
      }
      continue;
    }
    if (contacts[i].rockFeature < 0)
    {
      // A round body turns under the plane: with its axes A the plane that touches it is |A n| from
      // its centre, n as the block sees it. Δ|A n| = (A n₀ + A n₁) · A (n₁ − n₀) / (|A n₀| + |A n₁|)
      // and n₁ − n₀ = −r × n_m, n_m their mean: Δd = n·u + r·(y × n_m) exactly, y where it touches.
      const Mat3 axes = roundAxes(block.shape().layout());
      const Vec3 end = turn.transpose() * row.n, n = 0.5 * (row.n + end);
      const Vec3 y = -2.0 / ((axes * row.n).norm() + (axes * end).norm()) * (axes * (axes * n));
      row.end = -1.0 / (axes * end).norm() * (turn * Vec3(axes * (axes * end)));
      row.normal = rowOf<N>(row.n, y, row.x);
      row.normal.template segment<3>(kRotation) = y.cross(n);
      for (int k = 0; k < 2; ++k)
      {
        row.shear[k] = rowOf<N>(row.tangent[k], y, row.x);
      }
      continue;
    }
    Vec3 x = row.x, y0 = row.y0;
    row.mean = row.n;
    row.crosses = false;
    if (contacts[i].kind == ContactKind::EdgeEdge)
    {
      // The normal turns with the rock's edge and the crossing moves along it: both as of mid-step,
      // which leaves an error of third order.
      const std::array<int, 2>& ends = block.shape().edges()[contacts[i].rockFeature].vertices;
      const Vec3& x0 = block.shape().vertices()[ends[0]];
      const Vec3& x1 = block.shape().vertices()[ends[1]];
      const auto middle = [&](const Vec3& start, const Vec3& point)
      { return Vec3(0.5 * (start + turn * strained(start, point) + u)); };
      const Vec3 p0 = middle(row.edge[0], x0);
      row.along = middle(row.edge[1], x1) - p0;
      double s, t;
      row.crosses = closestOnLines(p0, row.along, row.ridge[0], row.ridge[1], s, t);
      if (row.crosses)
      {
        const Vec3 cross = row.along.cross(row.ridge[1]).normalized();
        row.mean = cross.dot(row.n) < 0.0 ? Vec3(-cross) : cross;
        x = x0 + s * (x1 - x0);
        y0 = deform_ * x;
      }
    }
    row.start = strained(y0, x);
    row.end = turn * row.start;
    const Vec3 z = 0.5 * (row.start + row.end);
    row.normal = rowOf<N>(row.mean, z, x);
    for (int k = 0; k < 2; ++k)
    {
      row.shear[k] = rowOf<N>(row.tangent[k], z, x);
    }
  }
}

template <int N>
void BlockStep<N>::derive(Row& row, const Contact& contact, const VecN& d) const
{
  const Vec3 u = d.template head<3>(), r = d.template segment<3>(kRotation);
  if (contact.kind == ContactKind::FaceVertex)
  {
    row.gapRate.template head<3>() = row.end;
    row.gapRate.template segment<3>(kRotation) = byCayley(row.end.cross(u - row.y0), r);
    for (int k = 0; k < 2; ++k)
    {
      row.travelRate[k].template head<3>() -= 0.5 * row.tangent[k].cross(r);
    }
    return;
  }
  if (contact.rockFeature < 0)
  {
    row.gapRate.template segment<3>(kRotation) = byCayley(row.end.cross(row.n), r);
    return;
  }
  // An edge that moves and turns crosses the ridge at another of its points, which goes another way.
  Vec3 side = Vec3::Zero(), turning = Vec3::Zero();
  if (row.crosses)
  {
    side = row.ridge[1].cross(row.mean);
    side /= row.along.dot(side);
    turning = row.along - (row.edge[1] - row.edge[0]);
  }
  const auto rateAlong = [&](VecN& rate, const Vec3& direction)
  {
    const Vec3 further = direction.dot(turning) * side;
    rate.template head<3>() -= further;
    rate.template segment<3>(kRotation) = byCayley(row.end.cross(direction - further), r);
  };
  rateAlong(row.gapRate, row.mean);
  for (int k = 0; k < 2; ++k)
  {
    rateAlong(row.travelRate[k], row.tangent[k]);
  }
  if (row.crosses)
  {
    // The normal turns by half of what the edge turns.
    const Vec3 way = u + row.end - row.start, across = way - row.mean.dot(way) * row.mean;
    const Vec3 edge = 2.0 * row.along - (row.edge[1] - row.edge[0]);
    row.gapRate.template segment<3>(kRotation) +=
      byCayley(edge.cross(row.ridge[1].cross(across)), r) /
      (2.0 * row.mean.dot(row.along.cross(row.ridge[1])));
  }
}

template <int N>
typename BlockStep<N>::Change BlockStep<N>::evaluate(const StepRequest& request, const VecN& d)
{
  Change of;
  const bool lasting = request.kind == StepKind::Lasting;
  for (Row& row : rows_)
  {
    const double way = row.normal.dot(d), gap = row.law.gap0 + way;
    of.gap = std::max(of.gap, std::abs(gap - row.law.gap1));
    of.way = std::max(of.way, std::abs(way));
    const Eigen::Vector2d travel(row.shear[0].dot(d), row.shear[1].dot(d));
    if (row.held && gap > 0.0)
    {
      row.law.pull(gap, travel);
      of.state = true;
      continue;
    }
    of.state = row.law.evaluate(lasting, request.duration, gap, travel) || of.state;
  }
  return of;
}

template <int N>
typename BlockStep<N>::VecN BlockStep<N>::solveOne(
  const Row& row, const VecN& load, const VecN& d) const
{
  // In the contact's own directions: (I + F W) f = f(D) + F J (D − A⁻¹ load), W = J A⁻¹ Tᵀ.
  const VecN free = timesInertia<N>(inverse_, load);
  if (row.law.state == ContactState::Open)
  {
    const VecN a = timesInertia<N>(inverse_, row.normal);
    const double f = (row.law.force + row.law.stiffness * row.gapRate.dot(d - free)) /
      (1.0 + row.law.stiffness * row.gapRate.dot(a));
    return free + f * a;
  }
  Eigen::Matrix<double, N, 3> j;
  j << row.gapRate, row.travelRate[0], row.travelRate[1];
  Eigen::Matrix<double, N, 3> a;
  a << timesInertia<N>(inverse_, row.normal), timesInertia<N>(inverse_, row.shear[0]),
    timesInertia<N>(inverse_, row.shear[1]);
  Mat3 tangent = Mat3::Zero();
  tangent(0, 0) = row.law.stiffness;
  tangent.block<2, 1>(1, 0) = row.law.shearCoupling;
  tangent.block<2, 2>(1, 1) = row.law.shearStiffness;
  const Vec3 at(row.law.force, row.law.shearForce[0], row.law.shearForce[1]);
  const Mat3 system = Mat3::Identity() + tangent * (j.transpose() * a);
  const Vec3 f = system.inverse() * (at + tangent * (j.transpose() * (d - free)));
  return free + a * f;
}

template <int N>
typename BlockStep<N>::VecN BlockStep<N>::solve(const VecN& load, const VecN& d)
{
  const Row* only = nullptr;
  int acting = 0;
  for (const Row& row : rows_)
  {
    if (row.law.acts())
    {
      only = &row;
      ++acting;
    }
  }
  if (acting == 0)
  {
    return timesInertia<N>(inverse_, load);
  }
  if (acting == 1)
  {
    return this->solveOne(*only, load, d);
  }
  MatN matrix = inert_;
  VecN right = load;
  for (const Row& row : rows_)
  {
    if (!row.law.acts())
    {
      continue;
    }
    // Newton: f(D') ≈ f(D) − k ∂gap/∂D (D' − D)
    matrix.noalias() += (row.law.stiffness * row.normal) * row.gapRate.transpose();
    right += (row.law.force + row.law.stiffness * row.gapRate.dot(d)) * row.normal;
    if (row.law.state == ContactState::Open)
    {
      continue;
    }
    for (int a = 0; a < 2; ++a)
    {
      VecN gradient = row.law.shearCoupling[a] * row.gapRate;
      gradient += row.law.shearStiffness(a, 0) * row.travelRate[0];
      gradient += row.law.shearStiffness(a, 1) * row.travelRate[1];
      matrix.noalias() += row.shear[a] * gradient.transpose();
      right += (row.law.shearForce[a] + gradient.dot(d)) * row.shear[a];
    }
  }
  return solved<N>(matrix, right);
}

template <int N>
typename BlockStep<N>::Balance BlockStep<N>::balance(
  const Block& block, const BlockState& state, const StepRequest& request) const
{
  const double h = request.duration;
  const bool lasting = request.kind == StepKind::Lasting;
  Balance of;
  of.rate = lasting ? 1.0 / h : 2.0 / h;
  of.velocity0.template head<3>() = rotation_.transpose() * state.velocity;
  of.velocity0.template segment<3>(kRotation) = state.spin;
  of.load.setZero();
  of.load.template head<3>() = block.mass() * Vec3(-request.gravity * rotation_.row(2).transpose());
  if constexpr (N == 12)
  {
    of.velocity0.template tail<6>() = state.strainRate;
    of.load.template tail<6>() -= block.elasticity() * state.strain;
  }
  of.offset = -of.velocity0;
  if (lasting)
  {
    of.offset.setZero();
    of.offset.template head<3>() = 0.5 * h * (rotation_.transpose() * request.acceleration);
    of.offset.template segment<3>(kRotation) = 0.5 * h * request.spinAcceleration;
  }
  of.load += timesInertia<N>(mass_, (of.velocity0 - of.offset) / h);
  return of;
}

template <int N>
typename BlockStep<N>::VecN BlockStep<N>::firstGuess(
  const BlockState& state, const StepRequest& request, const Balance& of) const
{
  const double h = request.duration;
  const bool lasting = request.kind == StepKind::Lasting;
  const Vec3 going = lasting ? Vec3(-request.gravity * rotation_.row(2).transpose())
                             : Vec3(rotation_.transpose() * request.acceleration);
  VecN d = VecN::Zero();
  d.template head<3>() = h * of.velocity0.template head<3>() + (0.5 * h * h) * going;
  d.template segment<3>(kRotation) = h * state.spin;
  if (!lasting)
  {
    d.template segment<3>(kRotation) += (0.5 * h * h) * request.spinAcceleration;
  }
  return d;
}

template <int N>
typename BlockStep<N>::VecN BlockStep<N>::turningLoad(
  const Balance& of, double h, const Quat& turn, const VecN& d, bool whole)
{
  // The momentum of rotation is carried to the end of the step: R₁ p₁ − R₀ p₀ = h τ (METHOD 10.4).
  const VecN velocity1 = of.rate * d + of.offset;
  const Vec3 momentum = mass_.template middleRows<3>(kRotation) * velocity1;
  const Vec3 carried = turn * momentum;
  VecN load = of.load;
  load.template segment<3>(kRotation) -= (carried - momentum) / h;
  if (N == 6 && whole)
  {
    // p₁ grows with D by rate · J, and R₁ turns it.
    const Vec3 r = d.template segment<3>(kRotation);
    const Mat3 rotation = turn.toRotationMatrix();
    const Mat3 inertia = mass_.template bottomRightCorner<3, 3>();
    Mat3 turning;
    for (int k = 0; k < 3; ++k)
    {
      turning.row(k) = byCayley(carried.cross(Vec3::Unit(k)), r); // eₖ · (δφ × R₁ p₁)
    }
    const Mat3 a = (of.rate * (rotation * inertia) + turning) / h;
    load.template segment<3>(kRotation) += a * r - (of.rate / h) * (inertia * r);
    inert_.template bottomRightCorner<3, 3>() = a;
    inverse_.template bottomRightCorner<3, 3>() = a.inverse();
  }
  return load;
}

template <int N>
bool BlockStep<N>::iterate(const Block& block, const StepRequest& request,
  const std::vector<Contact>& contacts, const Balance& of, VecN& d, int& iterations)
{
  // Directions and levers turn by so much over a long step that a stiff spring opens and closes for
  // ever where Newton's matrix leaves that out; a step that resolves an impact has no need of it.
  const bool whole = request.kind == StepKind::Lasting;
  Quat turn = cayley(d.template segment<3>(kRotation));
  this->levers(block, contacts, turn, d);
  this->evaluate(request, d);
  VecN last = VecN::Zero();
  double share = 1.0; // of the correction that is taken
  bool settled = false, changed = false;
  for (; iterations < request.maxOpenClose && !settled; ++iterations)
  {
    const VecN load = this->turningLoad(of, request.duration, turn, d, whole);
    for (std::size_t i = 0; i < contacts.size(); ++i)
    {
      if (rows_[i].law.acts())
      {
        rows_[i].gapRate = rows_[i].normal;
        rows_[i].travelRate = rows_[i].shear;
        if (whole)
        {
          this->derive(rows_[i], contacts[i], d);
        }
      }
    }
    const VecN next = this->solve(load, d);
    if (!next.allFinite())
    {
      break;
    }
    for (Row& row : rows_)
    {
      row.held = whole && row.law.acts() &&
        row.law.force + row.law.stiffness * row.gapRate.dot(d - next) > 0.0;
    }
    // A contact that hardly slips can throw the iteration from one side of the friction cone's tip
    // to the other for ever: when a correction turns back, only part of it is taken. Where a contact
    // has just closed, opened or locked, turning back is what brings it to its place.
    const VecN correction = next - d;
    const double back = correction.template head<6>().dot(last.template head<6>());
    if (iterations > 1 && !changed && back < -kTurnsBack * last.template head<6>().squaredNorm())
    {
      share = std::max(0.5 * share, kLeastCorrection);
    }
    else
    {
      share = std::min(1.0, 2.0 * share);
    }
    last = correction;
    d += share * correction;
    turn = cayley(d.template segment<3>(kRotation));
    this->levers(block, contacts, turn, d);
    const Change change = this->evaluate(request, d);
    changed = change.state;
    // The rotation itself, for the gyroscopic term, converges with the gaps; without contacts it
    // alone decides.
    const double turned = correction.template segment<3>(kRotation).norm();
    settled = share == 1.0 && !changed &&
      change.gap <= kGapTolerance * change.way + kGapRounding * block.radius() &&
      turned <= kGapTolerance * d.template segment<3>(kRotation).norm() + 1e-13;
  }
  return settled;
}

template <int N>
StepOutcome BlockStep<N>::step(const Block& block, const StepRequest& request,
  std::vector<Contact>& contacts, BlockState& state, bool takeAnyway)
{
  StepOutcome outcome;
  const double h = request.duration;
  const bool lasting = request.kind == StepKind::Lasting;
  this->prepareInertia(block, h, lasting ? 1.0 / h : 2.0 / h, lasting ? 1.0 : 0.5);
  this->prepareRows(block, state, request, contacts);
  const Balance of = this->balance(block, state, request);
  VecN d = this->firstGuess(state, request, of);
  outcome.settled = this->iterate(block, request, contacts, of, d, outcome.iterations);
  if (!outcome.settled && !(takeAnyway && d.allFinite()))
  {
    return outcome;
  }
  this->write(d, contacts, outcome);
  const VecN velocity1 = of.rate * d + of.offset;
  state.time += h;
  state.position += rotation_ * Vec3(d.template head<3>());
  state.velocity = rotation_ * Vec3(velocity1.template head<3>());
  state.orientation = (state.orientation * cayley(d.template segment<3>(kRotation))).normalized();
  state.spin = velocity1.template segment<3>(kRotation);
  if constexpr (N == 12)
  {
    state.strain += d.template tail<6>();
    state.strainRate = velocity1.template tail<6>();
  }
  return outcome;
}

template <int N>
void BlockStep<N>::write(const VecN& d, std::vector<Contact>& contacts, StepOutcome& outcome) const
{
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Row& row = rows_[i];
    Contact& c = contacts[i];
    const ContactLaw& law = row.law;
    c.normalForce = law.force;
    c.shearForce = law.shearForce.norm();
    c.distance = law.gap1 + c.offset;
    const Eigen::Vector2d travel(row.shear[0].dot(d), row.shear[1].dot(d));
    outcome.frictionWork += law.frictionWork(travel);
    outcome.dampedWork += law.dampedWork();
    if (law.gap1 < 0.0)
    {
      c.state = law.state == ContactState::Open ? ContactState::Sliding : law.state;
      c.slip = rotation_ * Vec3(row.tangent[0] * law.slip1[0] + row.tangent[1] * law.slip1[1]);
      outcome.normalEnergy += law.normalEnergy();
      outcome.springEnergy += law.normalEnergy() + law.shearEnergy();
    }
    else
    {
      c.state = ContactState::Open;
      c.slip.setZero();
    }
  }
}

template class BlockStep<6>;
template class BlockStep<12>;

} // namespace rockfall
