#pragma once

/// @file
/// How long work is given up when nobody wants it any more.
///
/// Whoever starts long work says by an AbortScope how to ask whether it is still wanted. The loops
/// of the Core call stayWanted() in each turn, on whatever thread they run. It throws Aborted, and
/// what was under way is gone without a trace.

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>

namespace rockfall
{

/// Work was given up. No Error: nothing is wrong with the input.
class Aborted : public std::exception
{
public:
  const char* what() const noexcept override { return "aborted"; }
};

/// While it lives, stayWanted() asks it, on its own thread and on those that share loops with it
/// (base/parallel.h). The innermost one holds.
class AbortScope
{
public:
  /// `wanted` is asked on this thread only, a few times a second; false gives the work up.
  explicit AbortScope(std::function<bool()> wanted);
  /// Gives up as soon as the flag is set, from wherever. The flag outlives the scope.
  explicit AbortScope(const std::atomic<bool>& stop);
  ~AbortScope();
  AbortScope(const AbortScope&) = delete;
  AbortScope& operator=(const AbortScope&) = delete;

  /// Of this thread; null: nobody can give up.
  static const AbortScope* current();
  void check() const; ///< Throws Aborted.

  /// Another thread's scope on this one.
  class Borrowed
  {
  public:
    explicit Borrowed(const AbortScope* scope);
    ~Borrowed();
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;

  private:
    const AbortScope* before_;
  };

private:
  std::function<bool()> wanted_;
  const void* owner_ = nullptr; ///< Tells its thread from others.
  mutable std::chrono::steady_clock::time_point asked_;
  mutable std::atomic<bool> over_ = false;
  const std::atomic<bool>* stop_ = nullptr;
  Borrowed here_;
};

/// Throws Aborted if the work at hand is no longer wanted. Costs a few nanoseconds.
void stayWanted();

} // namespace rockfall
