// K D = F of a group: assembled from the contacts' springs, solved directly.

#include "system/GroupSolver.h"

#include <Eigen/LU>
#include <Eigen/SparseLU>

namespace rockfall
{

template <class Add>
void GroupSolver::assemble(Eigen::VectorXd& right, Add&& add) const
{
  right.resize(6 * Eigen::Index(work_.size()));
  for (std::size_t i = 0; i < work_.size(); ++i)
  {
    const Work& w = work_[i];
    Mat6 a = Mat6::Zero();
    a.diagonal().head<3>().setConstant(1.0 / w.inverseMass);
    a.bottomRightCorner<3, 3>() = w.inertia;
    add(int(i), int(i), a);
    right.segment<6>(6 * Eigen::Index(i)) = w.load;
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
    f += t * Vec3(this->along(row, 0), this->along(row, 1), this->along(row, 2));
    for (const Side& i : row.sides)
    {
      if (i.body < 0)
      {
        continue;
      }
      Eigen::Matrix<double, 6, 3> ji;
      ji << i.row[0], i.row[1], i.row[2];
      right.segment<6>(6 * i.body) += ji * f;
      const Eigen::Matrix<double, 6, 3> jt = ji * t;
      for (const Side& j : row.sides)
      {
        if (j.body >= 0)
        {
          Eigen::Matrix<double, 6, 3> jj;
          jj << j.row[0], j.row[1], j.row[2];
          add(i.body, j.body, Mat6(jt * jj.transpose()));
        }
      }
    }
  }
}

bool GroupSolver::solveDense(Eigen::VectorXd& next)
{
  const Eigen::Index n = 6 * Eigen::Index(work_.size());
  dense_.setZero(n, n);
  Eigen::VectorXd right;
  this->assemble(
    right, [&](int i, int j, const Mat6& k) { dense_.block<6, 6>(6 * i, 6 * j) += k; });
  next = dense_.partialPivLu().solve(right);
  return next.allFinite();
}

bool GroupSolver::solveSparse(Eigen::VectorXd& next)
{
  triplets_.clear();
  Eigen::VectorXd right;
  this->assemble(right,
    [&](int i, int j, const Mat6& k)
    {
      for (int c = 0; c < 6; ++c)
      {
        for (int r = 0; r < 6; ++r)
        {
          triplets_.emplace_back(6 * i + r, 6 * j + c, k(r, c));
        }
      }
    });
  Eigen::SparseMatrix<double> matrix(right.size(), right.size());
  matrix.setFromTriplets(triplets_.begin(), triplets_.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
  if (lu.info() != Eigen::Success)
  {
    return false;
  }
  next = lu.solve(right);
  return next.allFinite();
}

} // namespace rockfall
