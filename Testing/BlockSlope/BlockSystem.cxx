#include "BlockSlope/BlockSystem.h"

#include <algorithm>
#include <cmath>

namespace rockfall
{

namespace
{

/// Open–close has settled when no state changes and gaps move by less than this share of their way.
constexpr double kBlockGapTolerance = 1e-9;

} // namespace

BlockSystem::BlockSystem(const Block& rock, SlopeBlocks slope)
  : rock_(rock)
  , slope_(std::move(slope))
{
}

double BlockSystem::gap(const Contact& contact) const
{
  if (contact.closed())
  {
    return contact.gap(); // carried from step to step, as the slope's part in it is
  }
  const SlopeBlock& block = slope_.blocks[std::size_t(slope_.ofCfe[std::size_t(contact.cfe)])];
  return contact.gap() - block.row(contact.normal, contact.point).dot(block.displacement);
}

double BlockSystem::slopeEnergy() const
{
  double sum = 0.0;
  for (const SlopeBlock& block : slope_.blocks)
  {
    sum += block.energy();
  }
  return sum;
}

double BlockSystem::settleSlope()
{
  const double before = this->slopeEnergy();
  for (SlopeBlock& block : slope_.blocks)
  {
    block.displacement.setZero();
    block.velocity.setZero();
  }
  return before;
}

BlockSystem::Vec24 BlockSystem::pick(const Row& row, const Eigen::VectorXd& d) const
{
  Vec24 both;
  both << d.head<12>(), d.segment<12>(12 * (row.block + 1));
  return both;
}

void BlockSystem::add(int row, int column, const Mat12& part)
{
  for (int j = 0; j < 12; ++j)
  {
    for (int i = 0; i < 12; ++i)
    {
      entries_.emplace_back(12 * row + i, 12 * column + j, part(i, j));
    }
  }
}

void BlockSystem::assembleBlocks(const SystemRequest& request, const BlockState& state)
{
  const double h = request.duration;
  rate_ = request.lasting ? 1.0 / h : 2.0 / h;
  const double stress = request.lasting ? 1.0 : 0.5;
  entries_.clear();
  blockLoad_.setZero(this->unknowns());
  offset_.setZero(this->unknowns());

  Vec12 velocity, offset;
  velocity << rotation_.transpose() * state.velocity, state.spin, state.strainRate;
  offset = -velocity;
  if (request.lasting)
  {
    offset.setZero();
    offset.head<3>() = 0.5 * h * (rotation_.transpose() * request.acceleration);
    offset.segment<3>(kRotation) = 0.5 * h * request.spinAcceleration;
  }
  Mat12 k = (rate_ / h) * rock_.massMatrix();
  k.block<6, 6>(kStrain, kStrain) += stress * rock_.elasticity();
  this->add(0, 0, k);
  Vec12 f = rock_.massMatrix() * (velocity - offset) / h;
  f.head<3>() -= (rock_.mass() * request.gravity) * Vec3(rotation_.transpose() * Vec3::UnitZ());
  f.segment<6>(kStrain) -= rock_.elasticity() * state.strain;
  blockLoad_.head<12>() = f;
  offset_.head<12>() = offset;

  for (std::size_t i = 0; i < slope_.blocks.size(); ++i)
  {
    const SlopeBlock& block = slope_.blocks[i];
    const int at = int(i) + 1;
    this->add(at, at, (rate_ / h) * block.mass + stress * block.stiffness);
    const Vec12 shift = request.lasting ? Vec12(Vec12::Zero()) : Vec12(-block.velocity);
    offset_.segment<12>(12 * at) = shift;
    blockLoad_.segment<12>(12 * at) =
      block.mass * (block.velocity - shift) / h - block.stiffness * block.displacement;
  }
  blockEntries_ = entries_.size();
}

void BlockSystem::assembleContacts(const Eigen::VectorXd& d)
{
  entries_.resize(blockEntries_);
  load_ = blockLoad_;
  std::vector<int> pattern;
  for (const Row& row : rows_)
  {
    if (!row.law.acts())
    {
      continue;
    }
    // Newton: f(D') ≈ f(D) − k r (D' − D), for the normal and, if closed, the two shear directions.
    const Vec24 both = this->pick(row, d);
    Eigen::Matrix<double, 24, 24> k = row.law.stiffness * row.normal * row.normal.transpose();
    Vec24 f = (row.law.force + row.law.stiffness * row.normal.dot(both)) * row.normal;
    for (int a = 0; a < 2 && row.law.state != ContactState::Open; ++a)
    {
      const Vec24 gradient = row.law.shearCoupling[a] * row.normal +
        row.law.shearStiffness(a, 0) * row.shear[0] + row.law.shearStiffness(a, 1) * row.shear[1];
      k += row.shear[a] * gradient.transpose();
      f += (row.law.shearForce[a] + gradient.dot(both)) * row.shear[a];
    }
    const int j = row.block + 1;
    this->add(0, 0, k.topLeftCorner<12, 12>());     // Kii
    this->add(0, j, k.topRightCorner<12, 12>());    // Kij
    this->add(j, 0, k.bottomLeftCorner<12, 12>());  // Kji
    this->add(j, j, k.bottomRightCorner<12, 12>()); // Kjj
    load_.head<12>() += f.head<12>();
    load_.segment<12>(12 * j) += f.tail<12>();
    pattern.push_back(j);
  }
  std::sort(pattern.begin(), pattern.end());
  pattern.erase(std::unique(pattern.begin(), pattern.end()), pattern.end());
  matrix_.resize(this->unknowns(), this->unknowns());
  matrix_.setFromTriplets(entries_.begin(), entries_.end());
  if (pattern != pattern_ || factors_.rows() != matrix_.rows())
  {
    factors_.analyzePattern(matrix_);
    pattern_ = pattern;
  }
}

bool BlockSystem::solve(Eigen::VectorXd& next)
{
  factors_.factorize(matrix_);
  if (factors_.info() != Eigen::Success)
  {
    return false;
  }
  next = factors_.solve(load_);
  return next.allFinite();
}

SystemOutcome BlockSystem::step(
  const SystemRequest& request, std::vector<Contact>& contacts, BlockState& state, bool takeAnyway)
{
  SystemOutcome outcome;
  const double h = request.duration;
  this->prepareRows(request, state, contacts);
  this->assembleBlocks(request, state);

  // First guess: the rock in free flight, the slope at rest.
  Eigen::VectorXd d = Eigen::VectorXd::Zero(this->unknowns()), next = d;
  d.head<3>() = rotation_.transpose() *
    Vec3(h * state.velocity - (0.5 * h * h * request.gravity) * Vec3::UnitZ());
  d.segment<3>(kRotation) = h * state.spin;
  this->levers(d.head<12>());
  this->evaluate(request, d);
  Vec12 last = Vec12::Zero();
  double share = 1.0; // of the correction that is taken
  while (outcome.iterations < request.maxOpenClose && !outcome.settled)
  {
    ++outcome.iterations;
    this->assembleContacts(d);
    // The momentum of rotation is carried to the end of the step (METHOD 10.4).
    const Vec12 velocity = rate_ * d.head<12>() + offset_.head<12>();
    const Vec3 spinMomentum = (rock_.massMatrix() * velocity).segment<3>(kRotation);
    load_.segment<3>(kRotation) -=
      (turnOf(d.segment<3>(kRotation)) * spinMomentum - spinMomentum) / h;
    if (!this->solve(next))
    {
      break;
    }
    // A correction that turns back, from one side of the friction cone's tip to the other, is taken
    // in part only.
    const Vec12 correction = (next - d).head<12>();
    const bool back = outcome.iterations > 2 &&
      correction.head<6>().dot(last.head<6>()) < -0.25 * last.head<6>().squaredNorm();
    share = back ? std::max(0.5 * share, 0.125) : std::min(1.0, 2.0 * share);
    last = correction;
    d += share * (next - d);
    this->levers(d.head<12>());
    std::vector<double> before;
    for (const Row& row : rows_)
    {
      before.push_back(row.law.gap1);
    }
    const bool changed = this->evaluate(request, d);
    double change = 0.0, scale = 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      change = std::max(change, std::abs(rows_[i].law.gap1 - before[i]));
      scale = std::max(scale, std::abs(rows_[i].law.gap1 - rows_[i].law.gap0));
    }
    outcome.settled = share == 1.0 && !changed && change <= kBlockGapTolerance * scale + 1e-15 &&
      correction.segment<3>(kRotation).norm() <= 1e-10 * (1.0 + d.segment<3>(kRotation).norm());
  }
  if (!d.allFinite() || (!outcome.settled && !takeAnyway))
  {
    return outcome;
  }

  this->writeContacts(contacts, outcome);
  const Eigen::VectorXd velocity = rate_ * d + offset_;
  state.time += h;
  state.position += rotation_ * Vec3(d.head<3>());
  state.velocity = rotation_ * Vec3(velocity.head<3>());
  state.orientation = (state.orientation * turnOf(d.segment<3>(kRotation))).normalized();
  state.spin = velocity.segment<3>(kRotation);
  state.strain += d.segment<6>(kStrain);
  state.strainRate = velocity.segment<6>(kStrain);
  for (std::size_t i = 0; i < slope_.blocks.size(); ++i)
  {
    slope_.blocks[i].displacement += d.segment<12>(12 * Eigen::Index(i + 1));
    slope_.blocks[i].velocity = velocity.segment<12>(12 * Eigen::Index(i + 1));
  }
  return outcome;
}

} // namespace rockfall
