#include "statistics/passageFile.h"

#include "base/errors.h"
#include "gis/outputFile.h"
#include "statistics/HazardRaster.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <queue>
#include <tuple>

namespace rockfall
{

namespace
{

static_assert(std::endian::native == std::endian::little && sizeof(Passage) == 48);

constexpr char magic[8] = { 'R', 'F', 'P', 'A', 'S', 'S', '0', '1' };
constexpr std::uint64_t memory = 64'000'000;    ///< For the passages of all files at once, bytes.
constexpr std::uint64_t longestCrs = 1'000'000; ///< Bytes; more is no CRS but a damaged file.

template <typename T>
void put(std::ostream& out, const T& value)
{
  out.write(reinterpret_cast<const char*>(&value), sizeof(T));
}

template <typename T>
T get(std::istream& in)
{
  T value{};
  in.read(reinterpret_cast<char*>(&value), sizeof(T));
  return value;
}

/// The passages of one file, some at a time. No file stays open: there may be more than a process
/// may have open.
class PassageStream
{
public:
  PassageStream(const PassageFile& file, std::size_t atOnce)
    : file_(file)
    , atOnce_(atOnce)
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
    buffer_.resize(std::min<std::uint64_t>(atOnce_, file_.passages - read_));
    at_ = 0;
    if (buffer_.empty())
    {
      return;
    }
    std::ifstream in(file_.fileName, std::ios::binary);
    in.seekg(std::streamoff(file_.begin + read_ * sizeof(Passage)));
    in.read(
      reinterpret_cast<char*>(buffer_.data()), std::streamsize(buffer_.size() * sizeof(Passage)));
    if (!in)
    {
      throw FileError(file_.fileName + ": cannot be read to its end");
    }
    read_ += buffer_.size();
    const std::int64_t cells = file_.grid.cellCount();
    for (const Passage& passage : buffer_)
    {
      if (passage.cell >= cells)
      {
        throw FileError(file_.fileName + ": is damaged: there is no cell " +
          std::to_string(passage.cell) + " in a map of " + std::to_string(cells));
      }
    }
  }

  const PassageFile& file_;
  std::size_t atOnce_;
  std::uint64_t read_ = 0;
  std::vector<Passage> buffer_;
  std::size_t at_ = 0;
};

} // namespace

void writePassages(
  HazardRaster& raster, const Vec3& origin, const std::string& crs, const std::string& fileName)
{
  gis::OutputFile file(fileName);
  std::ofstream out(file.temporary(), std::ios::binary);
  const CellGrid& grid = raster.grid();
  out.write(magic, sizeof(magic));
  put(out, std::int32_t(grid.columns));
  put(out, std::int32_t(grid.rows));
  for (const double value : { grid.cellSize, origin.x() + grid.west, origin.y() + grid.south,
         origin.x(), origin.y(), origin.z() })
  {
    put(out, value);
  }
  put(out, std::uint64_t(crs.size()));
  out.write(crs.data(), std::streamsize(crs.size()));
  put(out, std::uint64_t(raster.releases().size()));
  for (const auto& [iteration, count] : raster.releases())
  {
    put(out, std::int64_t(iteration));
    put(out, count);
  }
  const std::vector<Passage>& passages = raster.sorted();
  put(out, std::uint64_t(passages.size()));
  out.write(reinterpret_cast<const char*>(passages.data()),
    std::streamsize(passages.size() * sizeof(Passage)));
  out.close();
  if (!out)
  {
    throw FileError(fileName + ": cannot be written: " + std::strerror(errno));
  }
  file.commit();
}

PassageFile readPassageFile(const std::string& fileName)
{
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(fileName, error);
  std::ifstream in(fileName, std::ios::binary);
  if (error || !in)
  {
    throw FileError(fileName + ": cannot be opened");
  }
  char start[sizeof(magic)] = {};
  in.read(start, sizeof(start));
  if (!in || std::memcmp(start, magic, sizeof(magic)) != 0)
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
  const auto length = get<std::uint64_t>(in);
  if (in && length <= longestCrs)
  {
    file.crs.resize(length);
    in.read(file.crs.data(), std::streamsize(length));
  }
  const auto iterations = get<std::uint64_t>(in);
  for (std::uint64_t k = 0; k < iterations && in; ++k)
  {
    const auto iteration = get<std::int64_t>(in);
    file.releases[int(iteration)] = get<std::int64_t>(in);
  }
  file.passages = get<std::uint64_t>(in);
  file.begin = in ? std::uint64_t(in.tellg()) : 0;
  if (!in || length > longestCrs || file.grid.columns < 1 || file.grid.rows < 1 ||
    !(file.grid.cellSize > 0.0) || file.passages > size ||
    size != file.begin + file.passages * sizeof(Passage))
  {
    throw FileError(fileName + ": is damaged: it is not as long as it must be");
  }
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
    for (const auto& [iteration, count] : file.releases)
    {
      releases_[iteration] += count;
    }
  }
}

std::int64_t PassageFiles::released() const
{
  std::int64_t all = 0;
  for (const auto& [iteration, count] : releases_)
  {
    all += count;
  }
  return all;
}

void PassageFiles::summarize(const UseCell& use) const
{
  const std::size_t atOnce = std::max<std::size_t>(16, memory / sizeof(Passage) / files_.size());
  std::vector<PassageStream> streams;
  for (const PassageFile& file : files_)
  {
    streams.emplace_back(file, atOnce);
  }
  const auto later = [](PassageStream* a, PassageStream* b) { return *b->next() < *a->next(); };
  std::priority_queue<PassageStream*, std::vector<PassageStream*>, decltype(later)> first(later);
  for (PassageStream& stream : streams)
  {
    if (stream.next())
    {
      first.push(&stream);
    }
  }
  CellSummarizer summarizer(releases_, use);
  while (!first.empty())
  {
    PassageStream* stream = first.top();
    first.pop();
    summarizer.add(*stream->next());
    stream->advance();
    if (stream->next())
    {
      first.push(stream);
    }
  }
  summarizer.finish();
}

} // namespace rockfall
