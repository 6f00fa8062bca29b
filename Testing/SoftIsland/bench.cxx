#include "scenes.h"
#include <cstdarg>
#include <immintrin.h>
#include <string>
#include <sys/resource.h>
using namespace rockfall;
using namespace rockfall::testing;
using namespace spike;
double cpu()
{
  rusage u;
  getrusage(RUSAGE_SELF, &u);
  return u.ru_utime.tv_sec + 1e-6 * u.ru_utime.tv_usec;
}
// bench who scene n T [key value]: who 0 resolved, 1 soft, 2 engine, 3 engine as crowds
int main(int c, char** v)
{
  _mm_setcsr(_mm_getcsr() | 0x8040);
  int who = atoi(v[1]);
  std::string scene = v[2];
  int n = atoi(v[3]);
  double T = atof(v[4]);
  const double e = 0.2, phi = 15, edge = std::cbrt(0.6);
  const bool slope = scene != "pour";
  auto rocks = slope ? columns(n) : levelsOfCubes(n, n >= 500 ? 10 : n >= 100 ? 5 : 3, 0.6, 7);
  if (scene == "eota")
  {
    std::mt19937_64 rnd(3);
    std::uniform_real_distribution<double> u(0, 1);
    auto any = [&]
    {
      double w = u(rnd) - 0.5, x = u(rnd) - 0.5, y = u(rnd) - 0.5, z = u(rnd) - 0.5;
      return Quat(w, x, y, z).normalized();
    };
    int k = 0;
    for (auto& r : rocks)
    {
      r.shape =
        makeShape(k % 2 ? Shape::Eota111 : Shape::Eota221, 0.17 * std::pow(1.33 / 0.17, u(rnd)));
      r.orientation = any();
      r.position = Vec3(8 + (r.position.x() - 8) * 1.7, 100 + (r.position.y() - 100) * 1.7, 0);
      r.position.z() = (100 - r.position.x()) * std::tan(radians(30)) + 2.0 + (k / 100) * 1.9;
      ++k;
    }
  }
  bool look = false;
  Settings base;
  for (int i = 5; i + 1 < c; i += 2)
  {
    std::string k = v[i];
    double x = atof(v[i + 1]);
    if (k == "sub")
      base.softSub = int(x);
    else if (k == "look")
      base.look = x;
    else if (k == "far")
      base.far = x;
    else if (k == "halve")
      base.halve = x;
    else if (k == "overlap")
      look = x;
    else if (k == "passes")
      base.bouncePasses = int(x);
    else if (k == "quiet")
      base.quiet = x;
    else if (k == "tol")
      base.bounceTol = x;
    else if (k == "gen")
      base.generations = int(x);
    else if (k == "speed")
      base.slackSpeed = x;
    else if (k == "finer")
      base.finer = x;
    else if (k == "depth")
      base.depth = int(x);
    else if (k == "half")
      base.perHalf = x;
    else if (k == "p")
      base.penalty = x;
    else
      return 1;
  }
  if (who == 1)
  {
    Scene s;
    s.w.set = base;
    s.w.set.design = who ? Design::Soft : Design::Resolved;
    s.w.set.e = s.w.set.eGround = e;
    s.w.set.mu = s.w.set.muGround = std::tan(radians(slope ? phi : 30));
    if (slope)
    {
      Terrain t = benchSlope(0.2, RestitutionModel::NormalTangential);
      std::vector<double> h(t.heights().begin(), t.heights().end());
      s.w.field.make(h, kNodes, 1.0);
    }
    else
      s.floor();
    s.add(rocks);
    double deep = 0;
    double t0 = cpu(), spent = 0;
    int k = 0;
    while (s.w.time < T - 1e-9)
    {
      s.w.step();
      if (look && ++k % 10 == 0)
      {
        double a = cpu();
        deep = std::max(deep, s.overlap() / edge);
        spent += cpu() - a;
      }
    }
    double t = cpu() - t0 - spent;
    auto& q = s.w.t;
    double N = double(n) * s.w.steps;
    double mx = 0;
    for (auto& b : s.w.bodies)
      mx += b.x.x() / n;
    auto us = [&](double x) { return 1e6 * x / N; };
    printf(
      "%s %s %d: %.1f k rock-steps/s (%.2f us); place %.2f broad %.2f axis %.2f touch %.2f rows "
      "%.2f solve %.2f rest %.2f; axes/rs %.2f rows/rs %.2f rowSub/rs %.1f bounceRows/rs %.1f "
      "redone %.3f n %.1f; solved bodies %.2f ns/rowSub %.1f; mean x %.2f deepest %.2f %%\n",
      who ? "soft" : "resolved", scene.c_str(), n, N / t / 1e3, 1e6 * t / N, us(q.place),
      us(q.broad), us(q.axis), us(q.touch), us(q.rows), us(q.solve), us(q.rest), s.w.axes / N,
      s.w.rowsTotal / N, s.w.rowSub / N, s.w.bounceRows / N, s.w.redone / N,
      double(s.w.substeps) / std::max(1L, s.w.islandsSolved), s.w.solvedBodies / N,
      1e9 * q.solve / s.w.rowSub, mx, 100 * deep);
    printf("  per step: bad pairs %.2f: without rows %.2f, same axis %.2f, other axis %.2f; fast "
           "%.2f spinning %.2f overlapping before %.2f spin at end %.2f, spin changed %.2f; bad "
           "ground %.2f; generations/step %.1f\n",
      s.w.st[0] / (double)s.w.steps, s.w.st[1] / (double)s.w.steps, s.w.st[2] / (double)s.w.steps,
      s.w.st[3] / (double)s.w.steps, s.w.st[4] / (double)s.w.steps, s.w.st[5] / (double)s.w.steps,
      s.w.st[6] / (double)s.w.steps, s.w.st[7] / (double)s.w.steps, s.w.st[8] / (double)s.w.steps,
      s.w.st[9] / (double)s.w.steps, s.w.generationsRun / (double)s.w.steps);
    return 0;
  }
  Pile pile;
  pile.awake = true;
  pile.ground = slope ? benchSlope(0.2, RestitutionModel::NormalTangential)
                      : makeSlope(
                          41, 5.0, [](double, double) { return 0.0; }, material(0.2, 30));
  pile.rocks = rocks;
  if (!slope)
    for (auto& r : pile.rocks)
      r.position += Vec3(50, 50, 0) * 0;
  pile.parameters.timeStep = 0.005;
  pile.parameters.endTime = T;
  pile.parameters.outputInterval = T;
  pile.parameters.threads = 1;
  pile.parameters.rockRestitution = e;
  pile.parameters.rockFrictionAngle = radians(slope ? phi : 30);
  pile.make();
  if (who == 3)
    pile.fall->resolved = 0;
  pile.fall->awake = !slope;
  double deep = 0, spent = 0;
  int k = 0;
  double t0 = cpu();
  auto tr = pile.fall->run(
    [&](double)
    {
      if (look && ++k % 10 == 0)
      {
        double a = cpu();
        deep = std::max(deep, pile.overlap() / edge);
        spent += cpu() - a;
      }
      return true;
    });
  double t = cpu() - t0 - spent, mx = 0;
  for (auto& q : tr)
    mx += q.summary.stop.x() / n;
  double N = n * T / 0.005;
  printf("engine%s %s %d: %.1f k rock-steps/s (%.2f us); mean x %.2f deepest %.2f %%\n",
    who == 3 ? " (crowds)" : "", scene.c_str(), n, N / t / 1e3, 1e6 * t / N, mx, 100 * deep);
}
