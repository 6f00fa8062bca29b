#include "base/abort.h"

#include <utility>

namespace rockfall
{

namespace
{

/// Between two questions, s: an answer may take as long as drawing a window.
constexpr std::chrono::milliseconds kPatience(50);

thread_local const AbortScope* innermost = nullptr;

} // namespace

AbortScope::Borrowed::Borrowed(const AbortScope* scope)
  : before_(std::exchange(innermost, scope))
{
}

AbortScope::Borrowed::~Borrowed()
{
  innermost = before_;
}

AbortScope::AbortScope(std::function<bool()> wanted)
  : wanted_(std::move(wanted))
  , owner_(&innermost)
  , asked_(std::chrono::steady_clock::now())
  , stop_(&over_)
  , here_(this)
{
}

AbortScope::AbortScope(const std::atomic<bool>& stop)
  : stop_(&stop)
  , here_(this)
{
}

AbortScope::~AbortScope() = default;

const AbortScope* AbortScope::current()
{
  return innermost;
}

void AbortScope::check() const
{
  if (wanted_ && owner_ == &innermost)
  {
    const auto now = std::chrono::steady_clock::now();
    if (now - asked_ >= kPatience)
    {
      const bool wanted = wanted_();
      asked_ = std::chrono::steady_clock::now();
      over_ = over_ || !wanted;
    }
  }
  if (stop_->load(std::memory_order_relaxed))
  {
    throw Aborted();
  }
}

void stayWanted()
{
  if (innermost)
  {
    innermost->check();
  }
}

} // namespace rockfall
