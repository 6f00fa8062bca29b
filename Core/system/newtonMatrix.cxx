// K D = F of an island: assembled from the contacts' springs, solved directly.

#include "system/NewtonSolver.h"

#include "law/settings.h"

#include <Eigen/LU>

namespace rockfall
{

template <class Add>
void NewtonSolver::assemble(const std::vector<int>& places, Eigen::VectorXd& right, Add&& add) const
{
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    if (places[i] < 0)
    {
      continue;
    }
    const Work& w = work_[i];
    Mat6 a = Mat6::Zero();
    a.diagonal().head<3>().setConstant(1.0 / w.inverseMass);
    a.bottomRightCorner<3, 3>() = w.inertia;
    add(places[i], places[i], a);
    right.segment<6>(6 * Eigen::Index(places[i])) = w.load;
  }
  for (const Row& row : rows_)
  {
    const ContactLaw& law = row.law;
    if (!law.acts())
    {
      continue;
    }
    // Newton: f(D') ≈ f(D) − T J (D' − D)
    Mat3 t = Mat3::Zero();
    Vec3 f = Vec3(law.force, 0.0, 0.0);
    t(0, 0) = law.stiffness;
    if (law.state != ContactState::Open)
    {
      t.block<2, 1>(1, 0) = law.shearCoupling;
      t.block<2, 2>(1, 1) = law.shearStiffness;
      f.tail<2>() = law.shearForce;
    }
    f += t * this->travel(row);
    const auto jacobian = [&](int s)
    {
      Eigen::Matrix<double, 6, 3> j;
      for (int k = 0; k < 3; ++k)
      {
        j.col(k) << row.directions[k], row.sides[s].lever.cross(row.directions[k]);
      }
      return s == 0 ? j : Eigen::Matrix<double, 6, 3>(-j);
    };
    const std::array<Eigen::Matrix<double, 6, 3>, 2> j = { jacobian(0), jacobian(1) };
    for (int s = 0; s < 2; ++s)
    {
      if (row.sides[s].body < 0)
      {
        continue;
      }
      const int i = places[std::size_t(row.sides[s].body)];
      right.segment<6>(6 * Eigen::Index(i)) += j[s] * f;
      const Eigen::Matrix<double, 6, 3> jt = j[s] * t;
      for (int other = 0; other < 2; ++other)
      {
        if (row.sides[other].body >= 0)
        {
          add(i, places[std::size_t(row.sides[other].body)], Mat6(jt * j[other].transpose()));
        }
      }
    }
  }
}

bool NewtonSolver::solveDirect(Eigen::VectorXd& next)
{
  // Most of an island do not touch: what no contact acts on goes as if it were alone.
  thread_local std::vector<int> places;
  places.assign(work_.size(), -1);
  for (const Row& row : rows_)
  {
    for (const Side& side : row.sides)
    {
      if (side.body >= 0 && row.law.acts())
      {
        places[std::size_t(side.body)] = 0;
      }
    }
  }
  int n = 0;
  next.resize(6 * Eigen::Index(work_.size()));
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    if (places[i] < 0)
    {
      next.segment<6>(6 * Eigen::Index(i)) = work_[i].free;
    }
    else
    {
      places[i] = n++;
    }
  }
  if (n == 0)
  {
    return next.allFinite();
  }
  thread_local Eigen::VectorXd right, found;
  right.resize(6 * Eigen::Index(n));
  blocks_.reset(n);
  this->assemble(places, right, [&](int i, int j, const Mat6& k) { blocks_.at(i, j) += k; });
  kept_.copy(blocks_);
  found = right;
  bool solved = blocks_.solve(found);
  if (solved)
  {
    const double left = (right - kept_.times(found)).cwiseAbs().maxCoeff();
    solved = left <= kDirectResidual * right.cwiseAbs().maxCoeff();
  }
  if (!solved)
  {
    // Friction makes K unsymmetric: where elimination by blocks does not hold, pivots are sought
    // everywhere.
    found = kept_.dense().partialPivLu().solve(right);
  }
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    if (places[i] >= 0)
    {
      next.segment<6>(6 * Eigen::Index(i)) = found.segment<6>(6 * Eigen::Index(places[i]));
    }
  }
  return next.allFinite();
}

} // namespace rockfall
