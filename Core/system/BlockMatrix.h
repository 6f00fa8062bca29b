#pragma once

/// @file
/// A square matrix of 6 × 6 blocks, most of them empty, with a symmetric pattern: K of an island of
/// rocks. Solved by elimination of blocks in the order of least neighbours.

#include "base/types.h"

#include <vector>

namespace rockfall
{

class BlockMatrix
{
public:
  void reset(int n); ///< n × n empty blocks.
  void copy(const BlockMatrix& other);
  /// A block, zero if it is new. Valid until the next new one.
  Mat6& at(int i, int j);
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;
  Eigen::MatrixXd dense() const;
  /// Replaces the right side by the solution; the matrix is used up. False if a pivot block is
  /// singular.
  bool solve(Eigen::VectorXd& x);

private:
  int size_ = 0, used_ = 0;
  std::vector<int> slots_; ///< Of each block, −1: empty.
  std::vector<Mat6> entries_, pivots_;
  std::vector<int> order_;
  std::vector<char> left_;
  std::vector<std::vector<int>> neighbours_;
};

} // namespace rockfall
