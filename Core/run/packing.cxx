#include "run/packing.h"

#include "base/errors.h"

#include <cstring>
#include <type_traits>

namespace rockfall
{

namespace
{

// Numbers only, so that their bytes are all there is to them: a new field goes along by itself.
template <typename T>
constexpr bool isPlain = std::is_trivially_destructible_v<T>;
static_assert(
  isPlain<TrajectorySummary> && isPlain<Sample> && isPlain<ImpactEvent> && isPlain<StructureEvent>);

template <typename T>
void append(const T* values, std::size_t count, std::vector<char>& bytes)
{
  const char* from = reinterpret_cast<const char*>(values);
  bytes.insert(bytes.end(), from, from + count * sizeof(T));
}

template <typename T>
void take(std::span<const char>& bytes, T* values, std::size_t count)
{
  if (bytes.size() / sizeof(T) < count)
  {
    throw DataError("A trajectory from another process is cut off");
  }
  if (count > 0)
  {
    std::memcpy(static_cast<void*>(values), bytes.data(), count * sizeof(T));
    bytes = bytes.subspan(count * sizeof(T));
  }
}

} // namespace

void pack(const Trajectory& trajectory, std::vector<char>& bytes)
{
  const std::uint64_t counts[] = { trajectory.samples.size(), trajectory.impacts.size(),
    trajectory.structures.size() };
  append(counts, 3, bytes);
  append(&trajectory.summary, 1, bytes);
  append(trajectory.samples.data(), trajectory.samples.size(), bytes);
  append(trajectory.impacts.data(), trajectory.impacts.size(), bytes);
  append(trajectory.structures.data(), trajectory.structures.size(), bytes);
}

Trajectory unpack(std::span<const char>& bytes)
{
  std::uint64_t counts[3];
  take(bytes, counts, 3);
  if (counts[0] > bytes.size() / sizeof(Sample) || counts[1] > bytes.size() / sizeof(ImpactEvent) ||
    counts[2] > bytes.size() / sizeof(StructureEvent))
  {
    throw DataError("A trajectory from another process is cut off");
  }
  Trajectory trajectory;
  take(bytes, &trajectory.summary, 1);
  trajectory.samples.resize(counts[0]);
  take(bytes, trajectory.samples.data(), counts[0]);
  trajectory.impacts.resize(counts[1]);
  take(bytes, trajectory.impacts.data(), counts[1]);
  trajectory.structures.resize(counts[2]);
  take(bytes, trajectory.structures.data(), counts[2]);
  return trajectory;
}

} // namespace rockfall
