// The mass fall of BenchmarkMassFall by the Open Dynamics Engine, to compare with: the same slope
// and cubes, as boxes or as convex polyhedra, with its quick solver. Built where ODE is found
// (Debian: libode-dev). Counters: rock-steps per second, how far the rocks got, and the deepest
// overlap of two of them, of their edge.
//
// Run: BenchmarkOde [--benchmark_filter=boxes/rocks:1000/dt:0.005]

#include "manyCubes.h"

#include <ode/ode.h>

#include <benchmark/benchmark.h>

#include <array>
#include <sstream>
#include <string>

using namespace rockfall;

namespace
{

constexpr int kMostContacts = 16; // of two bodies
constexpr int kLooks = 100;       // at the overlap, in a run

struct OdeFall
{
  dWorldID world;
  dSpaceID ground, rocks;
  dJointGroupID joints;
  dHeightfieldDataID heights;
  std::vector<dBodyID> bodies;
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;
  double friction = 0.0;

  OdeFall(const Terrain& slope, const std::vector<Rock>& blocks, const Block& block, bool boxes)
  {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    world = dWorldCreate();
    dWorldSetGravity(world, 0.0, 0.0, -9.81);
    dWorldSetAutoDisableFlag(world, 0);
    dWorldSetContactSurfaceLayer(world, 0.001);
    dWorldSetContactMaxCorrectingVel(world, 10.0);
    dWorldSetERP(world, 0.2);
    dWorldSetCFM(world, 1e-9);
    ground = dSimpleSpaceCreate(nullptr);
    rocks = dHashSpaceCreate(nullptr);
    dHashSpaceSetLevels(rocks, -1, 3);
    joints = dJointGroupCreate(0);
    friction = std::tan(radians(kRockFriction));
    // ODE's height fields have y upwards; rows go against the y of the world.
    heights = dGeomHeightfieldDataCreate();
    dGeomHeightfieldDataBuildDouble(heights, slope.heights().data(), 1, slope.width(),
      slope.height(), kNodes, kNodes, 1.0, 0.0, 1.0, 0);
    const dGeomID field = dCreateHeightfield(ground, heights, 1);
    dMatrix3 upright;
    dRFromAxisAndAngle(upright, 1.0, 0.0, 0.0, radians(90.0));
    dGeomSetRotation(field, upright);
    dGeomSetPosition(field, 0.5 * slope.width(), 0.5 * slope.height(), 0.0);
    const Polyhedron& cube = block.shape();
    for (std::size_t f = 0; f < cube.normals().size(); ++f)
    {
      const Vec3& n = cube.normals()[f];
      planes.insert(planes.end(), { n.x(), n.y(), n.z(), cube.offsets()[f] });
      polygons.push_back(unsigned(cube.faces()[f].size()));
      polygons.insert(polygons.end(), cube.faces()[f].begin(), cube.faces()[f].end());
    }
    for (const Vec3& v : cube.vertices())
    {
      points.insert(points.end(), { v.x(), v.y(), v.z() });
    }
    const double edge = std::cbrt(kCubeVolume);
    for (const Rock& rock : blocks)
    {
      const dBodyID body = dBodyCreate(world);
      dMass mass;
      dMassSetBoxTotal(&mass, block.mass(), edge, edge, edge);
      dBodySetMass(body, &mass);
      const dGeomID geometry = boxes
        ? dCreateBox(rocks, edge, edge, edge)
        : dCreateConvex(rocks, planes.data(), unsigned(planes.size() / 4), points.data(),
            unsigned(points.size() / 3), polygons.data());
      dGeomSetBody(geometry, body);
      dBodySetPosition(body, rock.position.x(), rock.position.y(), rock.position.z());
      dBodySetGyroscopicMode(body, 1);
      bodies.push_back(body);
    }
  }
  ~OdeFall()
  {
    dJointGroupDestroy(joints);
    dSpaceDestroy(rocks);
    dSpaceDestroy(ground);
    dGeomHeightfieldDataDestroy(heights);
    dWorldDestroy(world);
    dCloseODE();
  }
  static void meet(void* data, dGeomID a, dGeomID b)
  {
    if (dGeomIsSpace(a) || dGeomIsSpace(b))
    {
      dSpaceCollide2(a, b, data, &meet);
      return;
    }
    const OdeFall& fall = *static_cast<const OdeFall*>(data);
    std::array<dContact, kMostContacts> contacts;
    const int count = dCollide(a, b, kMostContacts, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i)
    {
      dSurfaceParameters& surface = contacts[std::size_t(i)].surface;
      surface.mode = dContactBounce | dContactApprox1;
      surface.mu = fall.friction;
      surface.bounce = kRockRestitution;
      surface.bounce_vel = 0.2;
      dJointAttach(dJointCreateContact(fall.world, fall.joints, &contacts[std::size_t(i)]),
        dGeomGetBody(a), dGeomGetBody(b));
    }
  }
  void step(double h)
  {
    dSpaceCollide2(
      reinterpret_cast<dGeomID>(ground), reinterpret_cast<dGeomID>(rocks), this, &meet);
    dSpaceCollide(rocks, this, &meet);
    dWorldQuickStep(world, h);
    dJointGroupEmpty(joints);
  }
  BlockState state(int i) const
  {
    const dReal* p = dBodyGetPosition(bodies[std::size_t(i)]);
    const dReal* q = dBodyGetQuaternion(bodies[std::size_t(i)]);
    BlockState at;
    at.position = { p[0], p[1], p[2] };
    at.orientation = Quat(q[0], q[1], q[2], q[3]);
    return at;
  }
};

void odeFall(benchmark::State& state, int count, double h, bool boxes)
{
  const Terrain slope = benchSlope(kRockRestitution, RestitutionModel::NormalTangential);
  const std::vector<Rock> rocks = columns(count);
  const Rock& first = rocks.front();
  const Block block(first.shape, first.density, first.youngModulus, first.poissonRatio);
  const int steps = int(std::lround(fallTime(count) / h));
  double meanX = 0.0, overlap = 0.0;
  for (auto _ : state)
  {
    OdeFall fall(slope, rocks, block, boxes);
    const auto stateOf = [&](int i) { return fall.state(i); };
    for (int k = 1; k <= steps; ++k)
    {
      fall.step(h);
      if (k % std::max(1, steps / kLooks) == 0)
      {
        state.PauseTiming();
        overlap = std::max(overlap, deepestOverlap(block, count, stateOf));
        state.ResumeTiming();
      }
    }
    state.PauseTiming();
    meanX = 0.0;
    for (int i = 0; i < count; ++i)
    {
      meanX += fall.state(i).position.x() / count;
    }
    state.ResumeTiming();
  }
  state.counters["rocksteps/s"] =
    benchmark::Counter(double(state.iterations()) * count * steps, benchmark::Counter::kIsRate);
  state.counters["mean_x"] = meanX;
  state.counters["overlap"] = overlap;
}

} // namespace

int main(int argc, char** argv)
{
  benchmark::Initialize(&argc, argv);
  for (int count : { 41, 100, 1000, 10000 })
  {
    for (const bool boxes : { true, false })
    {
      for (const double h : { 0.005, 0.002, 0.001, 0.0005 })
      {
        std::ostringstream name;
        name << (boxes ? "boxes" : "polyhedra") << "/rocks:" << count << "/dt:" << h;
        benchmark::RegisterBenchmark(name.str().c_str(), odeFall, count, h, boxes)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime()
          ->Iterations(1);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
