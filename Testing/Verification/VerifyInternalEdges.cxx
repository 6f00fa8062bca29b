// METHOD 10.5: a smooth plane cut into many CFEs is crossed as one pair of CFEs is.

#include "verification.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace rockfall;
using namespace rockfall::verification;

namespace
{

constexpr double kSide = 256.0; // m

/// A plane with z = 100 − (x − y/4)/2: heights, differences and normals are exact in binary, so
/// that the two planes differ in nothing but their edges.
Terrain plane(int nodes, const SurfaceMaterial& material)
{
  return rockfall::testing::makeSlope(
    nodes, kSide / (nodes - 1), [](double x, double y) { return 100.0 - 0.5 * (x - 0.25 * y); },
    material);
}

const Vec3 kNormal = Vec3(0.5, -0.125, 1.0).normalized();

struct Crossing
{
  const char* name;
  bool slides;
  Rock rock;
};

std::vector<Crossing> crossings()
{
  const Vec3 start(60.0, 130.0, 100.0 - 0.5 * (60.0 - 32.5));
  std::vector<Crossing> all;
  const auto add = [&](const char* name, const Polyhedron& shape, bool slides, double halfHeight)
  {
    Rock rock;
    rock.shape = shape;
    if (slides)
    {
      rock.orientation = rockfall::testing::turnBetween(Vec3::UnitZ(), kNormal) *
        Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
      rock.position = start + halfHeight * kNormal;
      rock.angularVelocity = 1.5 * kNormal; // turns as it slides: all edges at all angles
    }
    else
    {
      rock.orientation = uniformAttitude(0.3, 0.7, 0.2);
      rock.position = start + 2.0 * Vec3::UnitZ();
      rock.velocity = Vec3(4.0, 1.0, 0.0);
      rock.angularVelocity = Vec3(0.5, 3.0, 0.2);
    }
    all.push_back({ name, slides, rock });
  };
  const Polyhedron cube = makeShape(Shape::Cube, 1.0), plate = makeBox({ 2.0, 1.5, 0.3 });
  add("cube that slides and turns", cube, true, 0.5);
  add("plate that slides and turns", plate, true, 0.15);
  add("cube that tumbles", cube, false, 0.0);
  add("icosahedron that tumbles", makeShape(Shape::Icosahedron, 1.0), false, 0.0);
  add("plate that tumbles", plate, false, 0.0);
  return all;
}

} // namespace

TEST(InternalEdges, AreNotFelt)
{
  for (const Crossing& crossing : crossings())
  {
    SimulationParameters p;
    p.endTime = crossing.slides ? 5.0 : 2.5;
    p.outputInterval = 0.02;
    const SurfaceMaterial m = surface(0.8, crossing.slides ? 15.0 : 30.0);
    const Trajectory one = rockfall::testing::simulate(plane(2, m), crossing.rock, p);
    const Trajectory many = rockfall::testing::simulate(plane(129, m), crossing.rock, p);
    ASSERT_EQ(one.samples.size(), many.samples.size());
    double worst = 0.0, turned = 0.0;
    for (std::size_t k = 0; k < one.samples.size(); ++k)
    {
      worst = std::max(worst, (one.samples[k].position - many.samples[k].position).norm());
      turned =
        std::max(turned, one.samples[k].orientation.angularDistance(many.samples[k].orientation));
    }
    const std::string head = std::string(crossing.name) + ", " + text(p.endTime) + " s, " +
      text((one.summary.stop - one.summary.start).norm()) + " m of way, 2 CFEs against 32,768: ";
    const std::string reason = crossing.slides
      ? "the planes are the same to the last digit but for where they are cut"
      : "the same; tumbling multiplies rounding by some 10 at every impact, of which there are " +
        std::to_string(one.summary.impacts);
    recordAtMost({ "Internal edges", head + "largest distance", "m", reason }, worst,
      crossing.slides ? 1e-6 : 1e-4);
    recordAtMost({ "Internal edges", head + "largest difference of attitude", "rad", reason },
      turned, crossing.slides ? 1e-6 : 1e-3);
  }
}
