#include "scenes.h"
#include <cstdarg>
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
int main(int c, char** v)
{
  const int rocks = 40, runs = atoi(v[1]);
  const auto height = [](double x, double y)
  { return (x < 100.0 ? 0.9 * (100.0 - x) : 0.0) + 0.05 * std::sin(0.9 * x) * std::cos(0.7 * y); };
  double mean[3] = {}, sq[3] = {}, lead[3] = {}, sec[3] = {};
  for (int seed = 1; seed <= runs; ++seed)
    for (int who = 0; who < 3; ++who)
    {
      Pile pile;
      SurfaceMaterial mat = material(0.7, 12.0);
      mat.restitutionModel = RestitutionModel::NormalTangential;
      pile.ground = makeSlope(151, 2.0, height, mat);
      pile.awake = false;
      pile.parameters.timeStep = 0.005;
      pile.parameters.endTime = 40;
      pile.parameters.seed = seed;
      pile.parameters.threads = 1;
      std::mt19937_64 random(seed);
      std::uniform_real_distribution<double> u(-1, 1);
      const int side = 4;
      double start = 0;
      for (int k = 0; k < rocks; ++k)
      {
        const int a = k % side, b = k / side % side, cc = k / side / side;
        const double x = 20 + 1.7 * a, y = 150 + 1.7 * b, size = 0.6 + 0.3 * u(random);
        Rock rock =
          brick(size * Vec3(1, 0.8, 1.2), Vec3(x, y, height(x, y) + 2 + 1.7 * cc + 1.2 * a), k);
        rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
        pile.rocks.push_back(rock);
        start += x / rocks;
      }
      std::vector<double> stops;
      double t = cpu();
      if (who == 0)
      {
        Scene s;
        s.w.set.design = Design::Soft;
        s.w.set.e = pile.parameters.rockRestitution;
        s.w.set.mu = std::tan(pile.parameters.rockFrictionAngle);
        s.w.set.eGround = 0.7;
        s.w.set.muGround = std::tan(radians(12));
        std::vector<double> h(pile.ground.heights().begin(), pile.ground.heights().end());
        s.w.field.make(h, 151, 2.0);
        s.add(pile.rocks);
        while (s.w.time < 40)
        {
          s.w.step();
          if (s.fastest() < 5e-3)
            break;
        }
        for (auto& b : s.w.bodies)
          stops.push_back(std::min(b.x.x(), 300.0) - start);
      }
      else
      {
        pile.make();
        pile.fall->resolved = who == 1 ? rocks : 0;
        for (auto& tr : pile.fall->run())
          stops.push_back(tr.summary.stop.x() - start);
      }
      sec[who] += cpu() - t;
      double m = 0;
      for (double s : stops)
        m += s / rocks;
      mean[who] += m / runs;
      sq[who] += m * m / runs;
      std::sort(stops.begin(), stops.end(), std::greater<>());
      for (int k = 0; k < 4; ++k)
        lead[who] += stops[k] / 4 / runs;
    }
  const char* n[] = { "spike", "resolved", "crowds" };
  for (int w = 0; w < 3; ++w)
    printf("%s: mean way %.2f +- %.2f m, leading tenth %.2f m, %.1f s\n", n[w], mean[w],
      std::sqrt(std::max(0.0, sq[w] - mean[w] * mean[w]) / (runs - 1)), lead[w], sec[w]);
}
