#include "solver/StepSolver.h"

#include "contact/features.h"
#include "solver/springs.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// The Cayley map of a rotation vector, as a unit quaternion.
Quat cayley(const Vec3& r)
{
  return Quat(1.0, 0.5 * r.x(), 0.5 * r.y(), 0.5 * r.z()).normalized();
}

/// Open–close has settled when no state changes and the gaps move by less than this share of their
/// change over the step: the energy error of a step is then below 1e-8 of the work done in it.
constexpr double kGapTolerance = 1e-9;

} // namespace

void StepSolver::prepareRows(
  const Block& block, const BlockState& state, const std::vector<Contact>& contacts)
{
  rotation_ = state.orientation.toRotationMatrix();
  deform_ = Mat3::Identity() + strainTensor(state.strain);
  const Mat3 undeform = deform_.inverse();
  rows_.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Contact& c = contacts[i];
    Row& row = rows_[i];
    row.n = rotation_.transpose() * c.normal;
    if (c.kind == ContactKind::VertexFace)
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
    }
    row.tangent[0] = row.n.unitOrthogonal();
    row.tangent[1] = row.n.cross(row.tangent[0]);
    const Vec3 slip = rotation_.transpose() * c.slip;
    row.slip0 = { row.tangent[0].dot(slip), row.tangent[1].dot(slip) };
    row.gap0 = c.gap();
    row.state = c.state;
    row.share = 1.0;
    row.direction.setZero();
  }
}

void StepSolver::levers(const Block& block, const std::vector<Contact>& contacts, const Vec12& d)
{
  const Vec3 u = d.head<3>();
  const Vec3 r = d.segment<3>(kRotation);
  const Mat3 turn = cayley(r).toRotationMatrix();
  const Mat3 strain = strainTensor(d.segment<6>(kStrain));
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    Row& row = rows_[i];
    if (contacts[i].kind == ContactKind::FaceVertex)
    {
      // The slope's node rests, the rock's face turns: Δd = n_m·u + r·(y_m × n_m) + … exactly, with
      // normal and node averaged over the step as the block sees them.
      const Vec3 n = 0.5 * (row.n + turn * row.n);
      const Vec3 y = row.y0 - 0.5 * u;
      row.normal = displacementRow(n, y, row.x);
      for (int k = 0; k < 2; ++k)
      {
        row.shear[k] = displacementRow(row.tangent[k], y, row.x);
      }
      continue;
    }
    Vec3 n = row.n, x = row.x, y0 = row.y0;
    if (contacts[i].kind == ContactKind::EdgeEdge)
    {
      // The normal turns with the rock's edge and the crossing moves along it: both as of mid-step,
      // which leaves an error of third order.
      const std::array<int, 2>& ends = block.shape().edges()[contacts[i].rockFeature].vertices;
      const Vec3& x0 = block.shape().vertices()[ends[0]];
      const Vec3& x1 = block.shape().vertices()[ends[1]];
      const auto middle = [&](const Vec3& point)
      {
        const Vec3 start = deform_ * point;
        return Vec3(0.5 * (start + turn * (start + strain * point) + u));
      };
      const Vec3 p0 = middle(x0), along = middle(x1) - p0;
      double s, t;
      if (closestOnLines(p0, along, row.ridge[0], row.ridge[1], s, t))
      {
        const Vec3 cross = along.cross(row.ridge[1]).normalized();
        n = cross.dot(row.n) < 0.0 ? Vec3(-cross) : cross;
        x = x0 + s * (x1 - x0);
        y0 = deform_ * x;
      }
    }
    const Vec3 y1 = y0 + strain * x;
    const Vec3 z = 0.5 * (y1 + turn * y1);
    row.normal = displacementRow(n, z, x);
    for (int k = 0; k < 2; ++k)
    {
      row.shear[k] = displacementRow(row.tangent[k], z, x);
    }
  }
}

bool StepSolver::evaluate(const StepRequest& request, const Vec12& d)
{
  bool changed = false;
  const double damped = request.kind == StepKind::Lasting ? 1.0 : 0.0;
  for (Row& row : rows_)
  {
    row.gap1 = row.gap0 + row.normal.dot(d);
    const NormalSpring normal = normalSpring(request.normalPenalty, row.gap0, row.gap1, damped);
    row.force = normal.force;
    row.stiffness = normal.stiffness;
    row.share = normal.share;
    row.shearForce.setZero();
    row.shearStiffness.setZero();
    row.shearCoupling.setZero();
    ContactState state = ContactState::Open;
    if (row.force > 0.0)
    {
      const Eigen::Vector2d travel(row.shear[0].dot(d), row.shear[1].dot(d));
      const double limit = request.friction * row.force + request.cohesion;
      const double weight = (0.5 + 0.5 * damped) * row.share;
      const Eigen::Vector2d stretch = row.slip0 + weight * travel;
      const double length = stretch.norm();
      // A slip that has reversed from one iteration to the next has passed through rest: it locks
      // and is judged again, or the two directions would alternate for ever.
      const bool reversed = row.direction.dot(stretch) < 0.0;
      row.direction.setZero();
      if (reversed || request.shearPenalty * length <= limit)
      {
        changed = changed || reversed;
        state = ContactState::Locked;
        row.shearForce = -request.shearPenalty * stretch;
        row.shearStiffness = request.shearPenalty * weight * Eigen::Matrix2d::Identity();
        row.slip1 = row.slip0 + row.share * travel;
      }
      else
      {
        // Radial return onto the Coulomb cone.
        state = ContactState::Sliding;
        const Eigen::Vector2d direction = stretch / length;
        row.direction = direction;
        row.shearForce = -limit * direction;
        row.shearStiffness = (limit * weight / length) *
          (Eigen::Matrix2d::Identity() - direction * direction.transpose());
        row.shearCoupling = -request.friction * row.stiffness * direction;
        row.slip1 = direction * (limit / request.shearPenalty);
      }
    }
    changed = changed || state != row.state;
    row.state = state;
  }
  return changed;
}

StepOutcome StepSolver::step(const Block& block, const StepRequest& request,
  std::vector<Contact>& contacts, BlockState& state, bool takeAnyway)
{
  StepOutcome outcome;
  const double h = request.duration;
  const bool lasting = request.kind == StepKind::Lasting;
  this->prepareRows(block, state, contacts);

  Vec12 velocity0;
  velocity0 << rotation_.transpose() * state.velocity, state.spin, state.strainRate;
  // Ḋ¹ = rate·D + offset
  const double rate = lasting ? 1.0 / h : 2.0 / h;
  Vec12 offset = -velocity0;
  if (lasting)
  {
    offset.setZero();
    offset.head<3>() = 0.5 * h * (rotation_.transpose() * request.acceleration);
    offset.segment<3>(kRotation) = 0.5 * h * request.spinAcceleration;
  }
  const Mat12& mass = block.massMatrix();
  const double stress = lasting ? 1.0 : 0.5;
  Mat12 inert = (rate / h) * mass;
  inert.block<6, 6>(kStrain, kStrain) += stress * block.elasticity();
  Vec12 force = mass * (velocity0 - offset) / h;
  force.head<3>() -= (block.mass() * request.gravity) * Vec3(rotation_.transpose() * Vec3::UnitZ());
  force.segment<6>(kStrain) -= block.elasticity() * state.strain;

  // First guess: free flight.
  Vec12 d = Vec12::Zero();
  d.head<6>() = h * velocity0.head<6>();
  d.head<3>() -= (0.5 * h * h * request.gravity) * Vec3(rotation_.transpose() * Vec3::UnitZ());
  this->levers(block, contacts, d);
  this->evaluate(request, d);
  Quat turn = cayley(d.segment<3>(kRotation));
  Vec12 last = Vec12::Zero();
  double share = 1.0; // of the correction that is taken
  bool settled = false;
  int iteration = 0;
  for (; iteration < request.maxOpenClose && !settled; ++iteration)
  {
    matrix_ = inert;
    load_ = force;
    // The momentum of rotation is carried to the end of the step: R₁ p₁ − R₀ p₀ = h τ
    // (METHOD 10.4).
    const Vec12 velocity1 = rate * d + offset;
    const Vec3 spinMomentum = (mass * velocity1).segment<3>(kRotation);
    load_.segment<3>(kRotation) -= (turn * spinMomentum - spinMomentum) / h;
    for (const Row& row : rows_)
    {
      if (row.force <= 0.0 && row.stiffness <= 0.0)
      {
        continue;
      }
      // Newton: f(D') ≈ f(D) − k nᵀT (D' − D)
      const Vec12& n = row.normal;
      const double atZero = row.force + row.stiffness * n.dot(d);
      matrix_.noalias() += (row.stiffness * n) * n.transpose();
      load_ += atZero * n;
      if (row.state == ContactState::Open)
      {
        continue;
      }
      const Eigen::Vector2d travel(row.shear[0].dot(d), row.shear[1].dot(d));
      for (int a = 0; a < 2; ++a)
      {
        Vec12 gradient = row.shearCoupling[a] * n;
        gradient += row.shearStiffness(a, 0) * row.shear[0];
        gradient += row.shearStiffness(a, 1) * row.shear[1];
        const double shearAtZero = row.shearForce[a] + gradient.dot(d);
        matrix_.noalias() += row.shear[a] * gradient.transpose();
        load_ += shearAtZero * row.shear[a];
      }
    }
    Vec12 next = Vec12::Zero();
    if (request.rigid)
    {
      const Eigen::Matrix<double, 6, 6> k = matrix_.topLeftCorner<6, 6>();
      next.head<6>() = k.partialPivLu().solve(load_.head<6>());
    }
    else
    {
      next = matrix_.partialPivLu().solve(load_);
    }
    if (!next.allFinite())
    {
      break;
    }
    // A contact that hardly slips can throw the iteration from one side of the friction cone's tip
    // to the other for ever: when a correction turns back, only part of it is taken.
    const Vec12 correction = next - d;
    const double back = correction.head<6>().dot(last.head<6>());
    if (iteration > 1 && back < -0.25 * last.head<6>().squaredNorm())
    {
      share = std::max(0.5 * share, 0.125);
    }
    else
    {
      share = std::min(1.0, 2.0 * share);
    }
    last = correction;
    const Vec3 turnChange = correction.segment<3>(kRotation);
    d += share * correction;
    turn = cayley(d.segment<3>(kRotation));
    this->levers(block, contacts, d);
    double change = 0.0, scale = 0.0;
    for (const Row& row : rows_)
    {
      change = std::max(change, std::abs(row.gap0 + row.normal.dot(d) - row.gap1));
      scale = std::max(scale, std::abs(row.normal.dot(d)));
    }
    const bool changed = this->evaluate(request, d);
    // The rotation itself, for the gyroscopic term, converges with the gaps; without contacts it
    // alone decides.
    const double turned = turnChange.norm();
    settled = share == 1.0 && !changed && change <= kGapTolerance * scale + 1e-15 &&
      turned <= 1e-10 * (1.0 + d.segment<3>(kRotation).norm());
  }
  outcome.iterations = iteration;
  outcome.settled = settled;
  if (!settled && !(takeAnyway && d.allFinite()))
  {
    return outcome;
  }

  const Vec12 velocity1 = rate * d + offset;
  for (std::size_t i = 0; i < contacts.size(); ++i)
  {
    const Row& row = rows_[i];
    Contact& c = contacts[i];
    const Vec3 slip1 = row.tangent[0] * row.slip1[0] + row.tangent[1] * row.slip1[1];
    c.normalForce = row.force;
    c.shearForce = row.shearForce.norm();
    c.distance = row.gap1 + c.offset;
    const bool closedAtEnd = row.force > 0.0 && row.gap1 < 0.0;
    if (row.force > 0.0)
    {
      const Eigen::Vector2d travel(row.shear[0].dot(d), row.shear[1].dot(d));
      const double before = 0.5 * request.shearPenalty * row.slip0.squaredNorm();
      const double after = closedAtEnd ? 0.5 * request.shearPenalty * row.slip1.squaredNorm() : 0.0;
      outcome.frictionWork += -row.shearForce.dot(travel) - (after - before);
    }
    if (closedAtEnd)
    {
      outcome.anyClosed = true;
      c.state = row.state;
      c.slip = rotation_ * slip1;
      const double normal = 0.5 * request.normalPenalty * row.gap1 * row.gap1;
      outcome.normalEnergy += normal;
      outcome.springEnergy += normal + 0.5 * request.shearPenalty * row.slip1.squaredNorm();
    }
    else
    {
      c.state = ContactState::Open;
      c.slip.setZero();
    }
  }
  state.time += h;
  state.position += rotation_ * Vec3(d.head<3>());
  state.velocity = rotation_ * Vec3(velocity1.head<3>());
  state.orientation = (state.orientation * turn).normalized();
  state.spin = velocity1.segment<3>(kRotation);
  if (!request.rigid)
  {
    state.strain += d.segment<6>(kStrain);
    state.strainRate = velocity1.segment<6>(kStrain);
  }
  return outcome;
}

} // namespace rockfall
