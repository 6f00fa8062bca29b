#include "verification.h"

#include "form.h"
#include "runEnsemble.h"

#include "block/Block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>

namespace rockfall::verification
{

namespace
{

/// JSON has no infinities and no NaN: they become null, which the page shows as such.
std::string json(double number)
{
  if (!std::isfinite(number))
  {
    return "null";
  }
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(12) << number;
  return out.str();
}

std::string json(const std::string& words)
{
  std::string out = "\"";
  for (char c : words)
  {
    switch (c)
    {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      default:
        out += c;
    }
  }
  return out + "\"";
}

std::string json(std::span<const double> numbers)
{
  std::string out = "[";
  for (double number : numbers)
  {
    out += (out.size() > 1 ? "," : "") + json(number);
  }
  return out + "]";
}

/// The file of the test that runs now: tests run as processes of their own, at the same time.
std::filesystem::path resultsFile(const ::testing::TestInfo& test)
{
  const char* folder = std::getenv("ROCKFALL_VERIFICATION_RESULTS");
  std::filesystem::path path = folder ? folder : ROCKFALL_VERIFICATION_RESULTS;
  path /= full() ? "full" : "reduced";
  std::filesystem::create_directories(path);
  std::string name = std::string(test.test_suite_name()) + "." + test.name() + ".jsonl";
  std::replace(name.begin(), name.end(), '/', '-');
  return path / name;
}

void write(const std::string& line)
{
  const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
  if (test)
  {
    std::ofstream(resultsFile(*test), std::ios::app) << line << '\n';
  }
}

/// Begins a test's file and closes it: without the closing line the test was cut off.
class Scribe : public ::testing::EmptyTestEventListener
{
  void OnTestStart(const ::testing::TestInfo& test) override
  {
    std::ofstream(resultsFile(test), std::ios::trunc)
      << "{\"kind\":\"begin\",\"test\":"
      << json(std::string(test.test_suite_name()) + "." + test.name()) << "}\n";
  }
  void OnTestEnd(const ::testing::TestInfo& test) override
  {
    std::string message;
    for (int k = 0; k < test.result()->total_part_count(); ++k)
    {
      const ::testing::TestPartResult& part = test.result()->GetTestPartResult(k);
      // The figures tell of themselves; what remains are assertions beside them.
      const std::string words = part.message();
      if (part.failed() && words.find("figure:") == std::string::npos && message.size() < 400)
      {
        message += words.substr(0, 200) + "\n";
      }
    }
    std::ofstream(resultsFile(test), std::ios::app)
      << "{\"kind\":\"end\",\"passed\":" << (test.result()->Failed() ? "false" : "true")
      << ",\"seconds\":" << json(1e-3 * double(test.result()->elapsed_time()))
      << ",\"message\":" << json(message) << "}\n";
  }
};

void writeFigure(const char* kind, const Figure& f, double value, const std::string& expected,
  double tolerance, bool passed)
{
  write(std::string("{\"kind\":\"") + kind + "\",\"subject\":" + json(f.subject) +
    ",\"quantity\":" + json(f.quantity) + ",\"unit\":" + json(f.unit) + ",\"value\":" +
    json(value) + ",\"expected\":" + expected + ",\"tolerance\":" + json(tolerance) +
    ",\"reason\":" + json(f.reason) + ",\"passed\":" + (passed ? "true" : "false") + "}");
}

} // namespace

bool full()
{
  return rockfall::testing::isFullForm();
}

int count(int reduced, int whole)
{
  return full() ? whole : reduced;
}

long fromEnvironment(const char* name, long otherwise)
{
  const char* value = std::getenv(name);
  return value && *value ? std::atol(value) : otherwise;
}

void record(const Figure& f, double value, double expected, double tolerance)
{
  const bool passed = std::abs(value - expected) <= tolerance;
  writeFigure("within", f, value, json(expected), tolerance, passed);
  EXPECT_TRUE(passed) << "figure: " << f.subject << ", " << f.quantity << ": " << value << " "
                      << f.unit << ", expected " << expected << " ± " << tolerance;
}

void recordAtMost(const Figure& f, double value, double bound)
{
  const bool passed = value <= bound;
  writeFigure("atMost", f, value, json(bound), 0.0, passed);
  EXPECT_TRUE(passed) << "figure: " << f.subject << ", " << f.quantity << ": " << value << " "
                      << f.unit << ", expected at most " << bound;
}

void recordAtLeast(const Figure& f, double value, double bound)
{
  const bool passed = value >= bound;
  writeFigure("atLeast", f, value, json(bound), 0.0, passed);
  EXPECT_TRUE(passed) << "figure: " << f.subject << ", " << f.quantity << ": " << value << " "
                      << f.unit << ", expected at least " << bound;
}

void report(const Figure& f, double value)
{
  writeFigure("report", f, value, "null", 0.0, true);
}

void report(const Figure& f, double value, double expected)
{
  writeFigure("report", f, value, json(expected), 0.0, true);
}

void addCurve(const std::string& plot, const std::string& label, std::span<const double> x,
  std::span<const double> y)
{
  write("{\"kind\":\"curve\",\"plot\":" + json(plot) + ",\"label\":" + json(label) +
    ",\"x\":" + json(x) + ",\"y\":" + json(y) + "}");
}

void addPaths(
  const std::string& plot, const std::string& label, std::span<const Trajectory> trajectories)
{
  for (const Trajectory& t : trajectories)
  {
    std::vector<double> x, y;
    for (const Sample& s : t.samples)
    {
      x.push_back(s.position.x());
      y.push_back(s.position.y());
    }
    addCurve(plot, label, x, y);
  }
}

std::string text(double number)
{
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::setprecision(4) << number;
  return out.str();
}

std::vector<Trajectory> simulateAll(
  const Terrain& terrain, std::span<const Rock> rocks, const SimulationParameters& parameters)
{
  TrajectoryStore store(int(rocks.size()), parameters.iterations);
  testing::runEnsemble(terrain, rocks, parameters, store);
  return store.trajectories();
}

SurfaceMaterial surface(double restitution, double frictionDegrees, RestitutionModel model)
{
  SurfaceMaterial m = rockfall::testing::material(restitution, frictionDegrees);
  m.restitutionModel = model;
  return m;
}

Terrain flatGround(double size, const SurfaceMaterial& material, int n)
{
  return rockfall::testing::makeSlope(
    n, size / (n - 1), [](double, double) { return 0.0; }, material);
}

Polyhedron makeBall(int subdivisions, double radius)
{
  const Polyhedron start = makeShape(Shape::Icosahedron, 1.0);
  std::vector<Vec3> points;
  for (const Vec3& v : start.vertices())
  {
    points.push_back(v.normalized());
  }
  std::vector<std::array<int, 3>> faces;
  for (const std::vector<int>& f : start.faces())
  {
    faces.push_back({ f[0], f[1], f[2] });
  }
  for (int level = 0; level < subdivisions; ++level)
  {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b)
    {
      const auto [place, fresh] =
        middles.try_emplace({ std::min(a, b), std::max(a, b) }, int(points.size()));
      if (fresh)
      {
        points.push_back((points[a] + points[b]).normalized());
      }
      return place->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : faces)
    {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), { { a, ab, ca }, { ab, b, bc }, { ca, bc, c }, { ab, bc, ca } });
    }
    faces = std::move(finer);
  }
  const Quat turn = testing::turnBetween(points.front(), -Vec3::UnitZ());
  for (Vec3& p : points)
  {
    p = radius * (turn * p);
  }
  return Polyhedron::convexHull(points, "ball").centred();
}

Vec3 uniformDirection(double u, double v)
{
  const double z = 2.0 * u - 1.0, a = 2.0 * std::numbers::pi * v;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return { r * std::cos(a), r * std::sin(a), z };
}

Quat uniformAttitude(double u, double v, double w)
{
  // Shoemake 1992.
  const double a = 2.0 * std::numbers::pi * v, b = 2.0 * std::numbers::pi * w;
  const double s = std::sqrt(1.0 - u), t = std::sqrt(u);
  return Quat(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b));
}

double mechanicalEnergy(const Rock& rock, const Sample& sample, double gravity)
{
  const double mass = rock.density * rock.shape.integrals().volume;
  return sample.kineticEnergy + mass * gravity * sample.position.z();
}

Vec3 angularMomentum(const Rock& rock, const Sample& sample)
{
  const Block block(rock.shape, rock.density, rock.youngModulus, rock.poissonRatio);
  return sample.orientation *
    (block.inertia() * (sample.orientation.conjugate() * sample.angularVelocity));
}

const Sample* lastInFlight(const Trajectory& trajectory)
{
  const std::vector<Sample>& s = trajectory.samples;
  const auto touched =
    !trajectory.impacts.empty() ? trajectory.impacts.front().time : trajectory.summary.endTime;
  for (std::size_t k = s.size(); k-- > 1;)
  {
    if (s[k].time <= touched)
    {
      return nullptr;
    }
    if (!s[k].contact && !s[k - 1].contact && s[k].heightOverGround > 0.01)
    {
      return &s[k];
    }
  }
  return nullptr;
}

double observedOrder(std::span<const double> steps, std::span<const double> errors)
{
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  const double n = double(steps.size());
  for (std::size_t k = 0; k < steps.size(); ++k)
  {
    const double x = std::log(steps[k]), y = std::log(std::max(errors[k], 1e-16));
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

} // namespace rockfall::verification

int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  ::testing::UnitTest::GetInstance()->listeners().Append(new rockfall::verification::Scribe);
  return RUN_ALL_TESTS();
}
