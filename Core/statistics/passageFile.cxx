#include "statistics/passageFile.h"

#include "base/errors.h"
#include "base/noFile.h"
#include "base/text/numberText.h"
#include "gis/base/packing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <queue>
#include <tuple>

namespace rockfall
{

namespace
{

static_assert(std::endian::native == std::endian::little && sizeof(Passage) == 40);

constexpr std::uint64_t longestText = 1'000'000; ///< Bytes; more is a damaged file.

template <typename T>
T get(std::istream& in)
{
  T value{};
  in.read(reinterpret_cast<char*>(&value), sizeof(T));
  return value;
}

/// Left empty where the file ends or is damaged before.
std::string getText(std::istream& in)
{
  const auto length = get<std::uint64_t>(in);
  std::string text;
  if (in && length <= longestText)
  {
    text.resize(length);
    in.read(text.data(), std::streamsize(length));
  }
  else
  {
    in.setstate(std::ios::failbit); // told by the length
  }
  return text;
}

[[noreturn]] void failDamaged(const std::string& fileName, const std::string& what)
{
  throw FileError(fileName + ": is damaged: " + what);
}

/// The header must state what a run can have.
void checkHeader(const PassageFile& file)
{
  const CellGrid& g = file.grid;
  const auto finite = [&](double value, const char* what)
  {
    if (!std::isfinite(value))
    {
      failDamaged(file.fileName, std::string(what) + " is " + numberText(value));
    }
  };
  if (g.columns < 1 || g.rows < 1 || g.cellCount() > std::int64_t(UINT32_MAX))
  {
    failDamaged(file.fileName,
      "it has " + std::to_string(g.columns) + " x " + std::to_string(g.rows) + " cells");
  }
  finite(g.cellSize, "the cell size");
  if (g.cellSize <= 0.0)
  {
    failDamaged(file.fileName, "the cell size is " + numberText(g.cellSize));
  }
  for (const double place : { g.west, g.south, file.origin.x(), file.origin.y(), file.origin.z() })
  {
    finite(place, "a coordinate of the map");
  }
}

/// Iterations and how many rocks were released in each.
void readReleases(std::istream& in, PassageFile& file)
{
  const auto iterations = get<std::uint64_t>(in);
  for (std::uint64_t k = 0; k < iterations && in; ++k)
  {
    const auto iteration = get<std::int64_t>(in);
    const auto count = get<std::int64_t>(in);
    if (!in)
    {
      return; // told by the length
    }
    if (iteration < 0 || iteration > std::numeric_limits<int>::max() || count < 0 ||
      count > std::numeric_limits<int>::max())
    {
      failDamaged(file.fileName,
        "in iteration " + std::to_string(iteration) + " " + std::to_string(count) +
          " rocks were released");
    }
    if (!file.releases.emplace(int(iteration), count).second)
    {
      failDamaged(file.fileName, "iteration " + std::to_string(iteration) + " is there twice");
    }
  }
}

void readLost(std::istream& in, PassageFile& file)
{
  LostRocks& lost = file.lost;
  std::int64_t* const counts[] = { &lost.moving, &lost.overEdge, &lost.inNodata, &lost.unmoved };
  lost.rocks = get<std::int64_t>(in);
  for (std::int64_t* count : counts)
  {
    *count = get<std::int64_t>(in);
  }
  lost.endTime = get<double>(in);
  lost.pieces = get<std::int64_t>(in);
  if (!in)
  {
    return; // told by the length
  }
  if (lost.pieces < 0)
  {
    failDamaged(file.fileName, "rocks broke into " + std::to_string(lost.pieces) + " pieces");
  }
  for (const std::int64_t* count : counts)
  {
    if (*count < 0 || *count - lost.pieces > lost.rocks)
    {
      failDamaged(file.fileName,
        std::to_string(*count) + " of " + std::to_string(lost.rocks) + " rocks were lost");
    }
  }
  if (!std::isfinite(lost.endTime))
  {
    failDamaged(file.fileName, "the end time is " + numberText(lost.endTime));
  }
}

void readRocks(std::istream& in, PassageFile& file)
{
  const auto rocks = get<std::uint64_t>(in);
  for (std::uint64_t k = 0; k < rocks && in; ++k)
  {
    const auto rock = get<std::int64_t>(in);
    const auto block = get<std::int64_t>(in);
    RockRelease release{ get<std::int64_t>(in) };
    const auto source = get<std::int64_t>(in);
    const auto frequency = get<double>(in);
    if (!in)
    {
      return; // told by the length
    }
    if (rock < 0 || rock > std::numeric_limits<int>::max() || release.iterations < 1 ||
      release.iterations > std::numeric_limits<int>::max() || frequency < 0.0 ||
      std::isinf(frequency) || file.rocks.all().contains({ int(rock), block }))
    {
      failDamaged(file.fileName,
        "rock " + std::to_string(rock) + " of " + std::to_string(release.iterations) +
          " iterations has the frequency " + numberText(frequency));
    }
    if (source != kSourceNotKnown)
    {
      release.source = source;
    }
    if (!std::isnan(frequency))
    {
      release.frequency = frequency;
    }
    file.rocks.add(int(rock), block, release);
  }
}

/// Where the parts of `size` bytes of file begin; false if they do not end where it does.
bool readParts(std::istream& in, std::uint64_t size, PassageFile& file)
{
  const std::uint64_t parts =
    file.passages / kPassagesOfPart + (file.passages % kPassagesOfPart > 0 ? 1 : 0);
  if (!in || parts > size / sizeof(std::uint32_t))
  {
    return false;
  }
  std::uint64_t at = std::uint64_t(in.tellg()) + parts * sizeof(std::uint32_t);
  file.parts = { at };
  for (std::uint64_t k = 0; k < parts; ++k)
  {
    file.parts.push_back(at += get<std::uint32_t>(in));
  }
  return in && at == size;
}

/// The passages of one file, a part at a time. No file stays open: there may be
/// more than a process may have open.
class PassageStream
{
public:
  explicit PassageStream(const PassageFile& file)
    : file_(file)
  {
  }

  /// The one to come; null behind the last.
  const Passage* next()
  {
    if (at_ == buffer_.size())
    {
      this->refill();
    }
    return buffer_.empty() ? nullptr : &buffer_[at_];
  }
  void advance() { ++at_; }

private:
  void refill()
  {
    buffer_.clear();
    at_ = 0;
    if (part_ + 1 == file_.parts.size())
    {
      return;
    }
    buffer_.resize(
      std::min<std::uint64_t>(kPassagesOfPart, file_.passages - part_ * kPassagesOfPart));
    const std::uint64_t length = file_.parts[part_ + 1] - file_.parts[part_];
    if (length > buffer_.size() * sizeof(Passage))
    {
      failDamaged(file_.fileName, "a part of it is too long");
    }
    std::vector<char> packed(length);
    std::ifstream in(file_.fileName, std::ios::binary);
    in.seekg(std::streamoff(file_.parts[part_]));
    in.read(packed.data(), std::streamsize(length));
    if (!in)
    {
      throw FileError(file_.fileName + ": cannot be read to its end");
    }
    if (!gis::unpack(packed, sizeof(Passage),
          { reinterpret_cast<char*>(buffer_.data()), buffer_.size() * sizeof(Passage) }))
    {
      failDamaged(file_.fileName, "its passages cannot be unpacked");
    }
    part_ += 1;
    for (const Passage& passage : buffer_)
    {
      this->check(passage);
    }
  }

  void check(const Passage& passage) const
  {
    const std::int64_t cells = file_.grid.cellCount();
    if (passage.cell >= cells)
    {
      failDamaged(file_.fileName,
        "there is no cell " + std::to_string(passage.cell) + " in a map of " +
          std::to_string(cells));
    }
    for (const float maximum : passage.maxima)
    {
      if (std::isnan(maximum) || maximum == std::numeric_limits<float>::infinity())
      {
        failDamaged(file_.fileName,
          "a rock in cell " + std::to_string(passage.cell) + " has the value " +
            numberText(maximum));
      }
    }
    if (passage.entries == 0 || passage.iteration < 0 || passage.rock < 0)
    {
      failDamaged(file_.fileName,
        "in cell " + std::to_string(passage.cell) + " rock " + std::to_string(passage.rock) +
          " of iteration " + std::to_string(passage.iteration) + " came in " +
          std::to_string(passage.entries) + " times");
    }
  }

  const PassageFile& file_;
  std::uint64_t part_ = 0; ///< The one to come.
  std::vector<Passage> buffer_;
  std::size_t at_ = 0;
};

} // namespace

PassageFile readPassageFile(const std::string& fileName)
{
  if (const std::string there = noFile(fileName); !there.empty())
  {
    throw FileError(fileName + ": is " + there + ", no file");
  }
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(fileName, error);
  std::ifstream in(fileName, std::ios::binary);
  if (error || !in)
  {
    throw FileError(fileName + ": cannot be opened");
  }
  char start[sizeof(passageMagic)] = {};
  in.read(start, sizeof(start));
  if (!in || std::memcmp(start, passageMagic, sizeof(passageMagic)) != 0)
  {
    throw FileError(fileName + ": is no file of passages of this version");
  }
  PassageFile file;
  file.fileName = fileName;
  file.grid.columns = get<std::int32_t>(in);
  file.grid.rows = get<std::int32_t>(in);
  for (double* value : { &file.grid.cellSize, &file.grid.west, &file.grid.south, &file.origin.x(),
         &file.origin.y(), &file.origin.z() })
  {
    *value = get<double>(in);
  }
  file.crs = getText(in);
  file.run.slope = get<std::uint64_t>(in);
  file.run.properties = getText(in);
  readReleases(in, file);
  readLost(in, file);
  readRocks(in, file);
  file.passages = get<std::uint64_t>(in);
  if (!in || !readParts(in, size, file))
  {
    failDamaged(fileName, "it is not as long as it must be");
  }
  checkHeader(file);
  return file;
}

PassageFiles::PassageFiles(const std::vector<std::string>& fileNames)
{
  if (fileNames.empty())
  {
    throw ParameterError("There is no file of passages: give FileNames");
  }
  const auto place = [](const PassageFile& f)
  {
    const CellGrid& g = f.grid;
    return std::tie(g.columns, g.rows, g.cellSize, g.west, g.south, f.crs);
  };
  for (const std::string& fileName : fileNames)
  {
    const PassageFile& file = files_.emplace_back(readPassageFile(fileName));
    if (place(file) != place(files_.front()))
    {
      throw DataError(fileName + ": its cells or its CRS are not those of " + fileNames.front());
    }
    if (!file.releases.empty() && !releases_.empty() &&
      file.rocks.haveFrequencies() != rocks_.haveFrequencies())
    {
      throw DataError(fileName + ": its rocks have " +
        (file.rocks.haveFrequencies() ? "frequencies, those of other files have none"
                                      : "no frequencies, those of other files have"));
    }
    for (const auto& [iteration, count] : file.releases)
    {
      releases_[iteration] += count;
    }
    lost_.add(file.lost);
    rocks_.add(file.rocks);
  }
  std::vector<RunOrigin> runs;
  for (const PassageFile& file : files_)
  {
    runs.push_back(file.run);
  }
  notes_ = askAfterRuns(runs, [this](std::size_t k) { return files_[k].fileName; });
}

void PassageFiles::forEach(const std::function<void(const Passage&)>& use) const
{
  std::vector<PassageStream> streams(files_.begin(), files_.end());
  const auto later = [](PassageStream* a, PassageStream* b) { return *b->next() < *a->next(); };
  std::priority_queue<PassageStream*, std::vector<PassageStream*>, decltype(later)> first(later);
  for (PassageStream& stream : streams)
  {
    if (stream.next())
    {
      first.push(&stream);
    }
  }
  while (!first.empty())
  {
    PassageStream* stream = first.top();
    first.pop();
    do // a file of some iterations has several passages in a row
    {
      use(*stream->next());
      stream->advance();
    } while (stream->next() && (first.empty() || *stream->next() < *first.top()->next()));
    if (stream->next())
    {
      first.push(stream);
    }
  }
}

} // namespace rockfall
