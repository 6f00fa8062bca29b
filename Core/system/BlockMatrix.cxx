#include "system/BlockMatrix.h"

#include "law/settings.h"
#include "solver/linear.h"

#include <algorithm>

namespace rockfall
{

void BlockMatrix::reset(int n)
{
  size_ = n;
  slots_.assign(std::size_t(n) * n, -1);
  used_ = 0;
}

void BlockMatrix::copy(const BlockMatrix& other)
{
  size_ = other.size_;
  used_ = other.used_;
  slots_ = other.slots_;
  entries_.resize(std::max(entries_.size(), std::size_t(used_)));
  std::copy_n(other.entries_.begin(), used_, entries_.begin());
}

Mat6& BlockMatrix::at(int i, int j)
{
  int& slot = slots_[std::size_t(i) * size_ + j];
  if (slot < 0)
  {
    slot = used_++;
    if (std::size_t(used_) > entries_.size())
    {
      entries_.resize(2 * std::size_t(used_));
    }
    entries_[slot].setZero();
  }
  return entries_[slot];
}

Eigen::VectorXd BlockMatrix::times(const Eigen::VectorXd& x) const
{
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (int i = 0; i < size_; ++i)
  {
    for (int j = 0; j < size_; ++j)
    {
      const int slot = slots_[std::size_t(i) * size_ + j];
      if (slot >= 0)
      {
        y.segment<6>(6 * i).noalias() += entries_[slot] * x.segment<6>(6 * j);
      }
    }
  }
  return y;
}

Eigen::MatrixXd BlockMatrix::dense() const
{
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(6 * size_, 6 * size_);
  for (int i = 0; i < size_; ++i)
  {
    for (int j = 0; j < size_; ++j)
    {
      const int slot = slots_[std::size_t(i) * size_ + j];
      if (slot >= 0)
      {
        full.block<6, 6>(6 * i, 6 * j) = entries_[slot];
      }
    }
  }
  return full;
}

bool BlockMatrix::solve(Eigen::VectorXd& x)
{
  // The pattern is symmetric. Whichever row has the fewest neighbours left goes first.
  order_.clear();
  left_.assign(std::size_t(size_), 1);
  neighbours_.resize(std::size_t(size_));
  pivots_.resize(std::size_t(size_));
  for (int i = 0; i < size_; ++i)
  {
    neighbours_[i].clear();
    for (int j = 0; j < size_; ++j)
    {
      if (j != i && slots_[std::size_t(i) * size_ + j] >= 0)
      {
        neighbours_[i].push_back(j);
      }
    }
  }
  for (int step = 0; step < size_; ++step)
  {
    int pivot = -1;
    for (int i = 0; i < size_; ++i)
    {
      if (left_[i] && (pivot < 0 || neighbours_[i].size() < neighbours_[pivot].size()))
      {
        pivot = i;
      }
    }
    left_[pivot] = 0;
    order_.push_back(pivot);
    const std::vector<int>& near = neighbours_[pivot];
    Mat6& inverse = pivots_[pivot];
    inverse = this->at(pivot, pivot);
    if (!invertInPlace<6>(inverse, kSingularPivot))
    {
      return false;
    }
    for (int i : near)
    {
      const Mat6 factor = this->at(i, pivot) * inverse;
      x.segment<6>(6 * i).noalias() -= factor * x.segment<6>(6 * pivot);
      for (int j : near)
      {
        // A copy: `at` may move the entries.
        const Mat6 row = this->at(pivot, j);
        this->at(i, j).noalias() -= factor * row;
      }
    }
    for (int i : near)
    {
      std::vector<int>& own = neighbours_[i];
      own.erase(std::find(own.begin(), own.end(), pivot));
      for (int j : near)
      {
        if (j != i && std::find(own.begin(), own.end(), j) == own.end())
        {
          own.push_back(j);
        }
      }
    }
  }
  for (auto pivot = order_.rbegin(); pivot != order_.rend(); ++pivot)
  {
    Vec6 sum = x.segment<6>(6 * *pivot);
    for (int j : neighbours_[*pivot])
    {
      sum.noalias() -= this->at(*pivot, j) * x.segment<6>(6 * j);
    }
    x.segment<6>(6 * *pivot) = pivots_[*pivot] * sum;
  }
  return x.allFinite();
}

} // namespace rockfall
