// Passages in files: the same bits as in memory, whatever they are shared out over files; damage is
// noticed.

#include "hermitePaths.h"

#include "base/errors.h"
#include "gis/base/packing.h"
#include "statistics/HazardRaster.h"
#include "statistics/passageFile.h"
#include "statistics/sourceReach.h"
#include "summarizePassages.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <fstream>

using namespace rockfall;
using namespace rockfall::testing;
using rockfall::testing::wild;

namespace
{

const CellGrid grid{ 20, 20, 5.0, 10.0, 0.0 };
const Vec3 origin(700000.0, 4000000.0, 0.0);

std::string fileName(const std::string& name)
{
  const std::filesystem::path folder =
    std::filesystem::temp_directory_path() / ("passages." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  return (folder / name).string();
}

/// Rocks of 6 iterations, ten each; those for which `chosen` is true.
template <typename Chosen>
HazardRaster rasterOf(Chosen&& chosen)
{
  std::mt19937_64 random(5);
  HazardRaster raster(grid);
  for (int k = 0; k < 60; ++k)
  {
    const std::vector<PathPoint> points = wild(random, 5, 90.0);
    RockPath path;
    path.iteration = k / 10;
    path.rock = k % 10;
    path.mass = 100.0 + k;
    path.rested = k % 3 == 0;
    path.points = points;
    if (chosen(k))
    {
      raster.add(path);
    }
  }
  return raster;
}

/// All numbers of all cells, for a comparison of bits.
std::vector<double> numbers(const std::function<void(const UseCell&)>& summarize)
{
  std::vector<double> all;
  summarize(
    [&all](const CellSummary& c)
    {
      all.insert(all.end(),
        { double(c.cell), double(c.passages), double(c.rocks), double(c.stops), c.reach,
          c.reachError, c.reachErrorOfIterations, c.angleLeast, c.angleMean });
      for (const SampleStatistics& s : c.statistics)
      {
        all.insert(all.end(), { s.mean, s.deviation, s.maximum });
        all.insert(all.end(), s.quantiles.begin(), s.quantiles.end());
      }
    });
  return all;
}

bool sameBits(const std::vector<double>& a, const std::vector<double>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

std::string read(const std::string& name)
{
  std::ifstream in(name, std::ios::binary);
  return { std::istreambuf_iterator<char>(in), {} };
}

/// The bytes of a file with its passages as they are, not packed.
std::string plain(const std::string& name)
{
  const PassageFile file = readPassageFile(name);
  const std::string bytes = read(name);
  const std::size_t parts = file.parts.size() - 1;
  std::string table, passages;
  for (std::size_t k = 0; k < parts; ++k)
  {
    const std::size_t count =
      std::min<std::size_t>(kPassagesOfPart, file.passages - k * kPassagesOfPart);
    std::string records(count * sizeof(Passage), '\0');
    EXPECT_TRUE(gis::unpack({ bytes.data() + file.parts[k], file.parts[k + 1] - file.parts[k] },
      sizeof(Passage), records));
    passages += records;
    const auto length = std::uint32_t(records.size());
    table.append(reinterpret_cast<const char*>(&length), sizeof(length));
  }
  return bytes.substr(0, file.parts[0] - 4 * parts) + table + passages;
}

void expectError(const std::vector<std::string>& names, const char* word)
{
  try
  {
    summarize(PassageFiles(names), [](const CellSummary&) {});
    ADD_FAILURE() << "no error: " << word;
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

class TestPassageFile : public ::testing::Test
{
protected:
  void TearDown() override
  {
    std::filesystem::remove_all(std::filesystem::path(fileName("x")).parent_path());
  }
};

} // namespace

TEST_F(TestPassageFile, AnySharingOutGivesTheSameBits)
{
  HazardRaster whole = rasterOf([](int) { return true; });
  const auto expected = numbers([&](const UseCell& use) { summarize(whole, use); });
  ASSERT_GT(expected.size(), 100u * 37u);
  for (const int parts : { 1, 2, 7, 60 })
  {
    std::vector<std::string> names;
    for (int part = 0; part < parts; ++part)
    {
      // Also iterations of which each file has some rocks only.
      HazardRaster raster = rasterOf([&](int k) { return k % parts == part; });
      names.push_back(fileName(std::to_string(part)));
      writePassages(raster, origin, "EPSG:32616", names.back(), { 5, 0, 1, 0, 2, 0, 60.0 });
    }
    std::reverse(names.begin(), names.end());
    const PassageFiles files(names);
    EXPECT_EQ(files.releases().size(), 6u);
    EXPECT_EQ(files.releases().at(3), 10);
    EXPECT_EQ(files.lost().rocks, 5 * parts);
    EXPECT_EQ(files.lost().inNodata, 2 * parts);
    EXPECT_EQ(files.grid().west, 700010.0);
    EXPECT_EQ(files.grid().south, 4000000.0);
    EXPECT_EQ(files.origin(), origin);
    EXPECT_EQ(files.crs(), "EPSG:32616");
    EXPECT_TRUE(sameBits(numbers([&](const UseCell& use) { summarize(files, use); }), expected))
      << parts;
  }
}

TEST_F(TestPassageFile, TheSameRunMakesTheSameFile)
{
  HazardRaster a = rasterOf([](int) { return true; });
  HazardRaster b = rasterOf([](int k) { return k >= 30; });
  b.merge(rasterOf([](int k) { return k < 30; }));
  writePassages(a, origin, "", fileName("a"));
  writePassages(b, origin, "", fileName("b"));
  EXPECT_EQ(read(fileName("a")), read(fileName("b")));
}

/// Ten thousand rocks: several parts of a file, each of which is packed.
TEST_F(TestPassageFile, ManyPassagesArePacked)
{
  const auto read =
    [](std::int64_t first, std::int64_t count, const std::function<void(const RockPath&)>& use)
  {
    for (std::int64_t k = first; k < first + count; ++k)
    {
      std::mt19937_64 own(static_cast<std::uint64_t>(k));
      const std::vector<PathPoint> points = wild(own, 5, 90.0);
      RockPath path;
      path.iteration = int(k / 100);
      path.rock = int(k % 100);
      path.points = points;
      use(path);
    }
  };
  HazardRaster one(grid), all(grid);
  read(0, 10000, [&one](const RockPath& path) { one.add(path); });
  all.addAll(10000, read);
  EXPECT_EQ(all.released(), 10000);
  EXPECT_EQ(all.releases(), one.releases());
  const auto numbersOf = [](HazardRaster& raster)
  { return numbers([&](const UseCell& use) { summarize(raster, use); }); };
  EXPECT_TRUE(sameBits(numbersOf(one), numbersOf(all)));

  const std::vector<Passage>& kept = all.sorted();
  const std::size_t count = kept.size();
  ASSERT_GT(count, 10 * kPassagesOfPart);
  writePassages(all, origin, "", fileName("many"));
  EXPECT_LT(std::filesystem::file_size(fileName("many")), 26 * count);
  std::size_t at = 0;
  bool same = true;
  PassageFiles({ fileName("many") })
    .forEach([&](const Passage& passage)
      { same = same && std::memcmp(&passage, &kept[at++], sizeof(Passage)) == 0; });
  EXPECT_EQ(at, count);
  EXPECT_TRUE(same);
}

TEST(Packing, KeepsWhatItCannotShorten)
{
  std::mt19937_64 random(3);
  std::vector<char> noise(4000), rest(4000, 7);
  std::generate(noise.begin(), noise.end(), [&random] { return char(random()); });
  for (const std::vector<char>& records : { noise, rest, std::vector<char>() })
  {
    const std::vector<char> packed = gis::pack(records, 40);
    EXPECT_EQ(packed.size() < records.size(), records == rest);
    std::vector<char> back(records.size());
    ASSERT_TRUE(gis::unpack(packed, 40, back));
    EXPECT_EQ(back, records);
  }
  std::vector<char> other(400);
  EXPECT_FALSE(gis::unpack(gis::pack(rest, 40), 40, other)); // of 100 records
}

TEST_F(TestPassageFile, NothingPassed)
{
  HazardRaster raster(grid);
  RockPath path; // without points: released, and nowhere
  raster.add(path);
  writePassages(raster, origin, "", fileName("none"));
  const PassageFiles files({ fileName("none") });
  EXPECT_EQ(files.releases().at(0), 1);
  summarize(files, [](const CellSummary&) { ADD_FAILURE(); });
}

TEST_F(TestPassageFile, OtherRunsAndEndTimesAreTold)
{
  HazardRaster a = rasterOf([](int k) { return k < 10; });
  HazardRaster b = rasterOf([](int k) { return k >= 10; });
  LostRocks twenty, two;
  twenty.add(Loss::Moving, 20.0, 5.0);
  two.add(Loss::Moving, 2.0, 5.0);
  const auto notes = [&](std::uint64_t slope, const std::string& properties)
  {
    writePassages(a, origin, "", fileName("a"), twenty, {}, { 7, "TimeStep 0.005 s\nRigid 0" });
    writePassages(b, origin, "", fileName("b"), two, {}, { slope, properties });
    const PassageFiles files({ fileName("a"), fileName("b") });
    EXPECT_NE(lostNotes(files.lost())
                .at(0)
                .find("2 of 2 rocks were still moving at EndTime (2 to "
                      "20 s)"),
      std::string::npos)
      << lostNotes(files.lost()).at(0);
    return files.notes();
  };
  const std::string same = "TimeStep 0.005 s\nRigid 0";
  EXPECT_TRUE(notes(7, same).empty());
  EXPECT_TRUE(notes(0, "").empty()); // not known
  const std::string start = "1 of 2 runs, first " + fileName("b") + ", fell ";
  ASSERT_EQ(notes(8, same).size(), 1u);
  EXPECT_EQ(notes(8, same)[0].find(start + "on another slope than " + fileName("a")), 0u)
    << notes(8, same)[0];
  const std::string other = "TimeStep 0.01 s\nRigid 0\nGravity 9.81 m/s²";
  ASSERT_EQ(notes(7, other).size(), 1u);
  EXPECT_EQ(notes(7, other)[0],
    start + "with other properties than " + fileName("a") +
      ": TimeStep 0.01 s, not 0.005 s; Gravity 9.81 m/s². Do their rocks belong together?");
  ASSERT_EQ(notes(7, "Rigid 0").size(), 1u);
  EXPECT_NE(notes(7, "Rigid 0")[0].find(": TimeStep 0.005 s there alone."), std::string::npos);
}

/// Two cliffs whose rocks both begin with block 1: each rock would be one with that of the other.
TEST(RunOrigin, ReleasesUnderTheSameNumbers)
{
  const auto notes = [](std::initializer_list<std::pair<std::uint64_t, std::int64_t>> releases)
  {
    std::vector<RunOrigin> runs;
    for (const auto& [content, first] : releases)
    {
      runs.push_back({ 7, "Rigid 0\n" + releaseLine(content, first) });
    }
    runs.push_back({ 7, "Rigid 0" }); // what it released is not known
    return askAfterRuns(runs, [](std::size_t k) { return "run " + std::to_string(k); });
  };
  EXPECT_TRUE(notes({ { 5, 1 }, { 5, 1 } }).empty());   // parts of one study
  EXPECT_TRUE(notes({ { 5, 1 }, { 6, 100 } }).empty()); // numbered apart
  const auto told = notes({ { 5, 1 }, { 6, 100 }, { 7, 100 } });
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].find("1 of 4 runs released other rocks under the same block ids, first run 2, "
                         "not those of run 1: rocks of one number count as one"),
    0u)
    << told[0];
}

TEST_F(TestPassageFile, ARockIsLostOnceWithItsPieces)
{
  HazardRaster a = rasterOf([](int k) { return k < 10; });
  LostRocks lost;
  lost.add(Loss::None, 1.0, 5.0);
  for (int piece = 1; piece <= 3; ++piece)
  {
    lost.add(Loss::Moving, 9.0, 5.0, piece);
  }
  writePassages(a, origin, "", fileName("a"), lost);
  const PassageFiles files({ fileName("a") });
  EXPECT_EQ(files.lost().pieces, 3);
  EXPECT_EQ(lostNotes(files.lost()).at(0).find("1 of 1 rocks were still moving"), 0u);
}

TEST_F(TestPassageFile, BadInput)
{
  HazardRaster raster = rasterOf([](int k) { return k < 10; });
  const std::string good = fileName("good"), bad = fileName("bad");
  writePassages(raster, origin, "EPSG:32616", good);
  expectError({}, "FileNames");
  expectError({ fileName("absent") }, "absent: cannot be opened");
  expectError({ good, good }, "is there twice");
  ASSERT_EQ(mkfifo(fileName("pipe").c_str(), 0600), 0); // no wait for a writer
  expectError({ fileName("pipe") }, "pipe: is a pipe or device, no file");
  std::filesystem::remove(fileName("pipe"));
  const std::string bytes = read(good);
  const auto with = [&](const std::string& content)
  { std::ofstream(bad, std::ios::binary) << content; };
  with("");
  expectError({ bad }, "bad: is no file of passages");
  with("ncols 5\nnrows 5\n");
  expectError({ bad }, "bad: is no file of passages");
  for (std::size_t length = 8; length < bytes.size(); length += length < 300 ? 1 : 1009)
  {
    with(bytes.substr(0, length));
    expectError({ bad }, "bad: is damaged");
  }
  with(bytes + "x");
  expectError({ bad }, "bad: is damaged");
  std::string turned = bytes;
  turned[turned.size() - 20] ^= 1;
  with(turned);
  expectError({ bad }, "bad: is damaged: its passages cannot be unpacked");
  std::string cell = plain(good);
  cell.replace(cell.size() - sizeof(Passage), 4, "\xff\xff\xff\x7f");
  with(cell);
  expectError({ bad }, "bad: is damaged: there is no cell");
  HazardRaster other({ 20, 20, 5.0, 15.0, 0.0 });
  writePassages(other, origin, "EPSG:32616", bad);
  expectError({ good, bad }, "bad: its cells or its CRS are not those of");
  writePassages(raster, origin, "EPSG:32617", bad);
  expectError({ good, bad }, "bad: its cells or its CRS are not those of");
  EXPECT_THROW(writePassages(raster, origin, "", fileName("no/such")), FileError);
}

TEST_F(TestPassageFile, HeadersAndPassagesThatNoRunHasAreDamage)
{
  // Three rocks of iteration 0, which all come into the only cell but one.
  HazardRaster raster({ 4, 3, 5.0, 0.0, 0.0 });
  for (int rock = 0; rock < 3; ++rock)
  {
    PathPoint from, to;
    from.position = Vec3(1.0, 1.0, 0.0);
    to.position = Vec3(2.0, 1.0, 0.0);
    to.time = 1.0;
    const std::vector<PathPoint> points = { from, to };
    RockPath path;
    path.rock = rock;
    path.points = points;
    raster.add(path);
  }
  const std::string bad = fileName("bad");
  writePassages(raster, origin, "", bad);
  const std::string good = plain(bad);
  std::ofstream(bad, std::ios::binary) << good;
  summarize(PassageFiles({ bad }), [](const CellSummary&) {});
  const auto put = [&](std::size_t at, auto value)
  {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    std::ofstream(bad, std::ios::binary) << bytes;
  };
  const double inf = std::numeric_limits<double>::infinity();
  constexpr std::size_t cellSize = 16, west = 24, z = 56, iterations = 88, count = 104, lost = 112,
                        firstPassage = 188;
  put(8, std::int32_t(-4));
  expectError({ bad }, "bad: is damaged: it has -4 x 3 cells");
  put(8, std::int32_t(2147483647));
  expectError({ bad }, "bad: is damaged: it has 2147483647 x 3 cells");
  for (const double size : { inf, std::nan(""), -5.0, 0.0 })
  {
    put(cellSize, size);
    expectError({ bad }, "bad: is damaged: the cell size is");
  }
  put(west, inf);
  expectError({ bad }, "bad: is damaged: a coordinate of the map is inf");
  put(z, std::nan(""));
  expectError({ bad }, "bad: is damaged: a coordinate of the map is nan");
  put(iterations, std::uint64_t(1) << 60);
  expectError({ bad }, "bad: is damaged");
  put(count, std::int64_t(-5));
  expectError({ bad }, "bad: is damaged: in iteration 0 -5 rocks were released");
  put(count, std::int64_t(0));
  expectError({ bad }, "more passages than can be");
  put(count, std::int64_t(2)); // a probability of 1.5
  expectError({ bad }, "more passages than can be");
  put(count - 8, std::int64_t(-1));
  expectError({ bad }, "bad: is damaged: in iteration -1");
  put(count - 8, std::int64_t(1) << 40);
  expectError({ bad }, "bad: is damaged: in iteration 1099511627776");
  put(firstPassage + 4, std::uint32_t(0));
  expectError({ bad }, "came in 0 times");
  put(firstPassage + 12, std::int32_t(-7));
  expectError({ bad }, "rock -7");
  put(lost + 8, std::int64_t(7));
  expectError({ bad }, "bad: is damaged: 7 of 0 rocks were lost");
  put(lost + 40, inf);
  expectError({ bad }, "bad: is damaged: the end time is inf");
  put(lost + 48, std::int64_t(-1));
  expectError({ bad }, "bad: is damaged: rocks broke into -1 pieces");
  put(firstPassage + 24, float(inf));
  expectError({ bad }, "has the value inf");
}

TEST_F(TestPassageFile, FrequenciesAreThoseOfAllFiles)
{
  HazardRaster whole = rasterOf([](int) { return true; });
  std::vector<std::string> names;
  for (int part = 0; part < 3; ++part)
  {
    HazardRaster raster = rasterOf([&](int k) { return k % 3 == part; });
    RockReleases known;
    for (int k = part; k < 60; k += 3)
    {
      known.add(k % 10, 0, { .frequency = 0.25 / (1 + k % 10) });
    }
    names.push_back(fileName(std::to_string(part)));
    writePassages(raster, origin, "", names.back(), {}, known);
  }
  const PassageFiles files(names);
  ASSERT_EQ(files.rocks().all().size(), 10u);
  for (const auto& [rock, release] : files.rocks().all())
  {
    EXPECT_EQ(release.iterations, 6);
    EXPECT_EQ(release.frequency, 0.25 / (1 + rock.first));
    EXPECT_FALSE(release.source);
  }
  EXPECT_EQ(files.rocks().largestWeight(), 0.25 / 6);
  std::size_t passages = 0;
  files.forEach([&passages](const Passage&) { ++passages; });
  EXPECT_EQ(passages, whole.sorted().size());

  // One without, and damage.
  HazardRaster raster = rasterOf([](int k) { return k == 0; });
  writePassages(raster, origin, "", fileName("none"));
  expectError({ names[0], fileName("none") }, "its rocks have no frequencies");
  const std::string good = read(names[0]);
  const std::size_t release = good.find(std::string("\0\0\0\0\0\0\xd0\x3f", 8)); // 0.25
  ASSERT_NE(release, std::string::npos);
  const auto put = [&](std::size_t at, auto bad)
  {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &bad, sizeof bad);
    std::ofstream(names[0], std::ios::binary) << bytes;
  };
  put(release, -0.25);
  expectError({ names[0] }, "has the frequency -0.25");
  put(release, std::numeric_limits<double>::infinity());
  expectError({ names[0] }, "has the frequency inf");
  put(release - 16, std::int64_t(0));
  expectError({ names[0] }, "of 0 iterations");
  put(release, 0.125);
  expectError(names, "per year in one iteration and");
}

TEST_F(TestPassageFile, SourcesAreThoseOfAllFiles)
{
  // Ten rocks; those of even numbers are of source 4.
  std::vector<std::string> names;
  for (int part = 0; part < 3; ++part)
  {
    HazardRaster raster = rasterOf([&](int k) { return k % 3 == part; });
    RockReleases rocks;
    for (int k = part; k < 60; k += 3)
    {
      rocks.add(k % 10, 0, { .source = k % 2 == 0 ? 4 : -1 });
    }
    names.push_back(fileName(std::to_string(part)));
    writePassages(raster, origin, "", names.back(), {}, rocks);
  }
  const RockReleases rocks = PassageFiles(names).rocks();
  ASSERT_EQ(rocks.all().size(), 10u);
  for (const auto& [rock, release] : rocks.all())
  {
    EXPECT_EQ(release.iterations, 6);
    EXPECT_EQ(release.source, rock.first % 2 == 0 ? 4 : -1);
    EXPECT_FALSE(release.frequency);
  }
  // A rock of two sources, and damage.
  HazardRaster raster = rasterOf([](int k) { return k == 0; });
  RockReleases others;
  others.add(0, 0, { .source = 5 });
  writePassages(raster, origin, "", fileName("other"), {}, others);
  const RockReleases two = PassageFiles({ names[0], fileName("other") }).rocks();
  EXPECT_THROW(SourceReach{ two }, DataError);
  EXPECT_THROW(writePassages(raster, origin, "", fileName("both"), {}, two), DataError);
  std::string bytes = read(fileName("other"));
  const std::size_t iterations = bytes.find(std::string("\1\0\0\0\0\0\0\0\5\0\0\0\0\0\0\0", 16));
  ASSERT_NE(iterations, std::string::npos);
  bytes[iterations] = 0;
  std::ofstream(fileName("other"), std::ios::binary) << bytes;
  expectError({ fileName("other") }, "rock 0 of 0 iterations");
}

TEST(SourceReach, IsTheLargestOfASource)
{
  // Source 1 released a rock in each of four iterations, source 2 a hundred.
  RockReleases rocks;
  rocks.add(0, 7, { .iterations = 4, .source = 1 });
  for (int rock = 1; rock <= 100; ++rock)
  {
    rocks.add(rock, 7, { .iterations = 4, .source = 2 });
  }
  SourceReach reach(rocks);
  const auto pass = [&](int iteration, int rock)
  {
    Passage passage;
    passage.iteration = iteration;
    passage.rock = rock;
    passage.blockId = 7;
    reach.add(passage);
  };
  pass(0, 0);
  pass(2, 0);
  pass(0, 5);
  EXPECT_EQ(reach.take(), 0.5);
  pass(3, 9);
  EXPECT_EQ(reach.take(), 1.0 / 400.0); // of this cell alone
  EXPECT_EQ(reach.take(), 0.0);
  EXPECT_THROW(pass(0, 101), DataError);
}
