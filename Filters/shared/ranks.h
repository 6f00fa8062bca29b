#pragma once

/// @file
/// The processes that run one pipeline together (MPI ranks of pvbatch or pvserver), and what they
/// tell each other. Without MPI there is one. Everything here but `count` and `rank` is collective:
/// every rank calls it, in the same order.

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkAbstractArray;
class vtkFieldData;
class vtkMultiProcessController;
class vtkPolyData;

namespace rockfall::filters
{

class Ranks
{
public:
  Ranks();
  /// The processes of this controller; null: one.
  explicit Ranks(vtkMultiProcessController* controller);
  int count() const { return count_; }
  int rank() const { return rank_; }

  /// Every rank's value, by rank.
  std::vector<int> gather(int value) const;
  std::vector<double> gather(double value) const;

  /// If any rank has a problem all of them throw Error, with the text of the lowest such rank.
  void agree(const std::string& problem) const
  {
    this->settle(problem.empty() ? State::Well : State::Failed, problem);
  }
  /// Does the work on every rank and agrees on how it went. Error and bad_alloc are problems;
  /// `noMemory` is the text for the latter. If any rank gives up, all throw Aborted. Some ranks may
  /// call `agree` instead: both send the same messages.
  void together(const std::function<void()>& work, const std::string& noMemory) const;

  /// `text` as on rank 0.
  void share(std::string& text) const { this->broadcastText(text, 0); }

  /// Threads that a rank should take when its user takes all: those that it may run on, shared out
  /// over the ranks of this machine where they are bound to none.
  int threads() const;

  /// Makes `data` on every rank what it is on `root`: points, cells, all arrays.
  void broadcast(vtkPolyData* data, int root) const;

  /// On rank 0 the bytes of every rank, by rank; empty on the others.
  std::vector<std::vector<char>> collect(
    std::vector<char>&& bytes, const std::string& noMemory) const;

private:
  /// Outcome of a rank's work, for the others. The worst counts for all.
  enum class State
  {
    Well,
    Failed,
    GivenUp
  };
  /// The one gather in which ranks agree. Throws on all ranks alike.
  void settle(State own, const std::string& problem) const;
  void broadcastBytes(void* bytes, std::size_t count, int root) const;
  void broadcastText(std::string& text, int root) const;
  vtkSmartPointer<vtkAbstractArray> broadcast(vtkAbstractArray* array, int root) const;
  void broadcast(vtkFieldData* data, int root) const;

  vtkMultiProcessController* controller_;
  int count_ = 1;
  int rank_ = 0;
};

/// On every rank an error's text if more than one of them has lines of trajectories, which filters
/// that look at their own part alone would take for all; else empty. Collective. May be null.
std::string spreadOf(vtkPolyData* trajectories);

} // namespace rockfall::filters
