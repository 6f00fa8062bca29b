#include "rock/placement.h"
#include "scenes.h"
#include <cstdarg>
#include <cstring>
#include <string>
using namespace rockfall;
using namespace rockfall::testing;
using namespace spike;
Settings base;
const char* G = "";
void say(const char* name, bool pass, const char* fmt, ...)
{
  char t[400];
  va_list a;
  va_start(a, fmt);
  vsnprintf(t, 400, fmt, a);
  va_end(a);
  printf("%-34s %-5s %s\n", name, pass ? "pass" : "FAIL", t);
  fflush(stdout);
}
void cradle(int n, double gap)
{
  Scene s;
  s.w.set = base;
  s.w.set.g = 0;
  s.w.set.e = 1;
  s.w.set.mu = 0.577;
  std::vector<Rock> rocks;
  for (int i = 0; i < n; ++i)
  {
    Rock r;
    r.shape = makeShape(Shape::Cube, 1.0);
    r.position = Vec3(198.0 + (i > 0 ? 1.5 + (1 + gap) * i : 0.0), 200, 0);
    r.velocity = Vec3(i ? 0 : 4, 0, 0);
    rocks.push_back(r);
  }
  s.add(rocks);
  s.run(0.8 + 0.01 * n);
  double e = 0;
  for (auto& b : s.w.bodies)
    e += 0.5 * b.m * b.v.squaredNorm() + 0.5 * b.L.dot(b.Iinv * b.L);
  e /= 0.5 * s.w.bodies[0].m * 16;
  double worst = 0;
  for (int i = 0; i < n; ++i)
    worst = std::max(worst, std::abs(s.w.bodies[i].v.x() - (i == n - 1 ? 4.0 : 0.0)));
  say(("cradle of " + std::to_string(n) + ", gaps " + std::to_string(gap)).c_str(),
    worst < 0.04 && std::abs(e - 1) < 0.01,
    "last leaves at %.3f of 4 m/s, worst off %.3f, energy %.4f, n %.1f", s.w.bodies[n - 1].v.x(),
    worst, e, double(s.w.substeps) / std::max(1L, s.w.islandsSolved));
}
void stand(
  const char* name, std::vector<Rock> rocks, double phi, double ground, double settle, double d)
{
  Scene s;
  s.w.set = base;
  s.w.set.mu = std::tan(radians(phi));
  s.w.set.muGround = std::tan(radians(ground));
  s.w.set.eGround = 0.3;
  s.floor();
  s.add(rocks);
  s.run(settle);
  auto p = s.places();
  s.run(d);
  double dr = s.drift(p), ov = s.overlap();
  say(name, dr < 1e-4 && s.fastest() < 1e-3,
    "drift in %.1f s %.2e m (bar 1e-4), fastest %.1e m/s, overlap %.2e m, n %.1f", d, dr,
    s.fastest(), ov, double(s.w.substeps) / std::max(1L, s.w.islandsSolved));
}
void archFalls()
{
  Scene s;
  s.w.set = base;
  s.w.set.mu = std::tan(radians(5));
  s.w.set.muGround = 1;
  s.floor();
  s.add(arch());
  s.run(1.5);
  say("arch falls at 5 deg", s.w.bodies[5].x.z() < 2, "keystone at %.2f m from 2.5",
    s.w.bodies[5].x.z());
}
void cubeOnCube(double below, double between)
{
  const double angle = radians(24);
  Scene s;
  s.w.set = base;
  s.w.set.dt = 0.005;
  s.w.set.mu = std::tan(radians(between));
  s.w.set.muGround = std::tan(radians(below));
  const Vec3 n(std::sin(angle), 0, std::cos(angle)), down(std::cos(angle), 0, -std::sin(angle));
  s.w.planes.push_back({ n, 0 });
  std::vector<Rock> rocks;
  for (int k = 0; k < 2; ++k)
  {
    Rock r = brick(Vec3(1, 1, 1), Vec3::Zero(), k);
    r.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
    r.position = (0.5 + k) * n;
    rocks.push_back(r);
  }
  s.add(rocks);
  s.run(0.2);
  double v[2] = { down.dot(s.w.bodies[0].v), down.dot(s.w.bodies[1].v) };
  s.run(0.2);
  const double g = 9.81, pull = g * std::sin(angle), press = g * std::cos(angle),
               held = std::tan(radians(below)), rub = std::tan(radians(between));
  double up, lo;
  if (std::tan(angle) <= rub || held <= rub)
    up = lo = std::max(0.0, pull - held * press);
  else
  {
    up = pull - rub * press;
    lo = std::max(0.0, pull - 2 * held * press + rub * press);
  }
  double a0 = (down.dot(s.w.bodies[0].v) - v[0]) / 0.2,
         a1 = (down.dot(s.w.bodies[1].v) - v[1]) / 0.2;
  double off = std::max(std::abs(a0 - lo), std::abs(a1 - up)) / g;
  say(("cube on cube " + std::to_string(int(below)) + "/" + std::to_string(int(between))).c_str(),
    off < 1e-3, "acceleration off by %.1e g (bar 1e-3)", off);
}
double dominoSpeed(double dt)
{
  Scene s;
  s.w.set = base;
  s.w.set.dt = dt;
  s.w.set.e = 0;
  s.w.set.mu = std::tan(radians(30));
  s.w.set.muGround = std::tan(radians(35));
  s.floor();
  std::vector<Rock> rocks;
  const int count = 20, begin = 5, end = 18;
  for (int k = 0; k < count; ++k)
    rocks.push_back(brick(Vec3(0.2, 0.5, 1.0), Vec3(15 + 0.5 * k, 20, 0.5), k));
  const double lean = radians(14);
  rocks[0].orientation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitY()));
  rocks[0].position = Vec3(15, 20, 0.5 * std::cos(lean) + 0.1 * std::sin(lean));
  s.add(rocks);
  double first = 0, last = 0;
  while (s.w.time < 8 && last == 0)
  {
    s.w.step();
    if (!first && s.w.bodies[begin].x.z() < 0.49)
      first = s.w.time;
    if (!last && s.w.bodies[end].x.z() < 0.49)
      last = s.w.time;
  }
  return (end - begin) * 0.5 / (last - first);
}
double engineDominoes(double dt)
{
  Pile pile;
  pile.ground = floorSlope();
  pile.parameters.timeStep = dt;
  pile.parameters.rockRestitution = 0;
  const int count = 20;
  for (int k = 0; k < count; ++k)
    pile.rocks.push_back(brick(Vec3(0.2, 0.5, 1.0), Vec3(15 + 0.5 * k, 20, 0.5), k));
  const double lean = radians(14);
  pile.rocks[0].orientation = Quat(Eigen::AngleAxisd(lean, Vec3::UnitY()));
  pile.rocks[0].position = Vec3(15, 20, 0.5 * std::cos(lean) + 0.1 * std::sin(lean));
  printf(
    "rock friction of the engine's default %.1f deg\n", degrees(pile.parameters.rockFrictionAngle));
  pile.start();
  double first = 0, last = 0;
  while (pile.fall->time() < 8 && last == 0)
  {
    pile.fall->advance();
    auto leans = [&](int k) { return pile.fall->state(k).position.z() < 0.49; };
    if (!first && leans(5))
      first = pile.fall->time();
    if (!last && leans(18))
      last = pile.fall->time();
  }
  return 13 * 0.5 / (last - first);
}
void dominoes()
{
  double o = engineDominoes(0.0025), b = dominoSpeed(0.0025), a = dominoSpeed(0.005);
  say("dominoes", std::abs(a - o) < 0.05 * o, "%.3f m/s, at dt/2 %.3f, engine %.3f (bar 5 %%)", a,
    b, o);
}
Quat any(std::mt19937_64& r)
{
  std::uniform_real_distribution<double> u(-1, 1);
  double w = u(r), x = u(r), y = u(r), z = u(r);
  return Quat(w, x, y, z).normalized();
}
void pinched()
{
  for (double ratio : { 5., 10., 20., 50., 100. })
  {
    double worst = 0, deep = 0, end = 0, way = 0, nmean = 0, inside = 0, insideEnd = 0;
    int runs = 0;
    for (double speed : { 10., 30. })
      for (int seed = 0; seed < 6; ++seed)
      {
        std::mt19937_64 random{ std::uint64_t(seed) };
        std::uniform_real_distribution<double> u(-1, 1);
        Scene s;
        s.w.set = base;
        s.w.set.dt = seed % 2 ? 0.005 : 0.002;
        s.w.set.eGround = 0.4;
        s.w.set.muGround = std::tan(radians(30));
        s.floor();
        Rock stone, boulder;
        boulder.shape = makeShape(Shape::Icosahedron, 30);
        boulder.orientation = any(random);
        stone.shape = makeShape(Shape::Icosahedron, 30 / std::pow(ratio, 3));
        stone.orientation = any(random);
        double r = stone.shape.radius();
        auto low = [](Rock& k)
        {
          double z = 0;
          for (auto& v : k.shape.vertices())
            z = std::min(z, (k.orientation * v).z());
          return -z;
        };
        stone.position = Vec3(0, 0, low(stone));
        double x = 0.3 * u(random), y = 0.3 * u(random);
        boulder.position = Vec3(x, y, low(boulder) + 3 * r);
        boulder.velocity.z() = -speed;
        s.add({ stone, boulder });
        double most = 0;
        while (s.w.time < 1.5)
        {
          s.w.step();
          most = std::max(most, s.w.bodies[0].v.norm());
          double z = 1e9;
          for (auto& v : stone.shape.vertices())
            z = std::min(z, (s.w.bodies[0].x + s.w.bodies[0].q * v).z());
          deep = std::max(deep, -z / r);
          if (s.w.time > 1.49)
            end = std::max(end, -z / r);
          double o = s.overlap() / r;
          inside = std::max(inside, o);
          if (s.w.time > 1.49)
            insideEnd = std::max(insideEnd, o);
        }
        worst = std::max(worst, most / speed);
        way = std::max(way, (s.w.bodies[0].x - stone.position).norm() / speed);
        nmean += double(s.w.substeps) / std::max(1L, s.w.islandsSolved);
        ++runs;
      }
    say(("pinched 1:" + std::to_string(int(ratio))).c_str(), worst < 2 && deep < 0.25 && end < 0.1,
      "fastest %.2f of the boulder's (bar 2), deepest in ground %.2f r (0.25; crowd 1), in the end "
      "%.3f r (0.1), way %.2f s*v (0.4), in the boulder %.2f r, in the end %.2f r",
      worst, deep, end, way, inside, insideEnd);
  }
}
void momentum(int n)
{
  Scene s;
  s.w.set = base;
  s.w.set.g = 0;
  s.w.set.e = 0.3;
  s.w.set.mu = 0.577;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  int side = int(std::ceil(std::cbrt(n) - 1e-9));
  std::vector<Rock> rocks;
  const Shape shapes[] = { Shape::Cube, Shape::Icosahedron, Shape::Eota221, Shape::Tetrahedron };
  Vec3 mid = Vec3::Constant(0.6 * 1.5 * (side - 1));
  if (n <= 4)
    mid = Vec3(0.5, 0.2, 0);
  for (int k = 0; k < n; ++k)
  {
    Rock r;
    r.shape = makeShape(shapes[k % 4], 0.2);
    r.position = 1.5 * Vec3(k % side, k / side % side, k / side / side);
    r.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    r.velocity = 2 * (mid - r.position);
    r.angularVelocity = Vec3(1, -2, 0.5);
    rocks.push_back(r);
  }
  s.add(rocks);
  Vec3 p0, l0, p1, l1;
  double size, k0, z, k1;
  s.totals(mid, p0, l0, size, k0);
  double E0 = s.w.energy();
  s.run(1);
  s.totals(mid, p1, l1, z, k1);
  double lsize = size * 1.5 * side;
  double E1 = s.w.energy();
  auto& b = s.w.books;
  double lost = b.friction + b.dash + b.yield + b.hand - b.gained;
  double num = (E0 - E1 - lost) / k0;
  say(("momentum of " + std::to_string(n)).c_str(),
    (p1 - p0).norm() < 1e-10 * size && (l1 - l0).norm() < 1e-10 * lsize && k1 < k0,
    "dp %.1e dL %.1e (bar 1e-10); energy left %.3f, numerical %.1e of it; largest island %d redone "
    "%ld",
    (p1 - p0).norm() / size, (l1 - l0).norm() / lsize, k1 / k0, num, s.w.largest, s.w.redone);
}
void pour(int n, double T, bool slope)
{
  Scene s;
  s.w.set = base;
  s.w.set.mu = std::tan(radians(slope ? 15 : 30));
  s.w.set.e = 0.2;
  s.w.set.eGround = 0.2;
  s.w.set.muGround = s.w.set.mu;
  const double edge = std::cbrt(0.6);
  std::vector<Rock> rocks;
  if (slope)
  {
    rocks = columns(n);
    const double a = radians(30);
    s.w.planes.push_back({ Vec3(std::sin(a), 0, std::cos(a)), 100 * std::sin(a) });
    s.floor();
  }
  else
  {
    rocks = levelsOfCubes(n, n >= 500 ? 10 : 3, 0.6, 7);
    s.floor();
  }
  s.add(rocks);
  double E0 = s.w.energy(), deep = 0, tAt = 0, top = 0;
  auto pot = [&]
  {
    double e = 0;
    for (auto& b : s.w.bodies)
      e += b.m * 9.81 * b.x.z();
    return e;
  };
  const double P0 = pot();
  long k = 0;
  double fastest = 0, gain = 0, most = 0, last = E0;
  while (s.w.time < T)
  {
    s.w.step();
    fastest = std::max(fastest, s.fastest());
    const double en = s.w.energy();
    if (en > last)
    {
      gain += en - last;
      most = std::max(most, en - last);
    }
    last = en;
    if (++k % 10 == 0)
    {
      double o = s.overlap() / edge;
      if (o > deep)
        deep = o, tAt = s.w.time;
    }
  }
  double E1 = s.w.energy(), rel = P0 - pot();
  auto& b = s.w.books;
  (void)top;
  double lost = b.friction + b.dash + b.yield + b.hand - b.gained;
  double num = (E0 - E1 - lost) / rel;
  say((std::string(slope ? "slope, " : "poured, ") + std::to_string(n) + " cubes").c_str(),
    deep <= 0.01 && std::abs(num) < 1e-3,
    "deepest %.2f %% of the edge at %.2f s; friction %.3f dash %.3f yield %.4f hand %.4f gained "
    "%.4f numerical %.1e; energy that rose %.1e of released, most in a step %.1e; fastest %.1f, "
    "end %.1e m/s; n %.1f redone %.3f rows/rock %.1f",
    100 * deep, tAt, b.friction / rel, b.dash / rel, b.yield / rel, b.hand / rel, b.gained / rel,
    num, gain / rel, most / rel, fastest, s.fastest(),
    double(s.w.substeps) / std::max(1L, s.w.islandsSolved), double(s.w.redone) / n / s.w.steps,
    double(s.w.rowsTotal) / n / s.w.steps);
}
void shapes()
{
  const std::pair<Shape, Shape> all[] = { { Shape::Cube, Shape::Cube },
    { Shape::Cube, Shape::Icosahedron }, { Shape::Tetrahedron, Shape::Octahedron },
    { Shape::Eota221, Shape::Eota221 }, { Shape::Dodecahedron, Shape::Tetrahedron },
    { Shape::Icosahedron, Shape::Icosahedron } };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  double dp = 0, dl = 0, worst = 0, gain = 0, mean = 0;
  int n = 0, met = 0, within = 0;
  for (auto& sh : all)
    for (int k = 0; k < 40; ++k)
    {
      Scene s;
      s.w.set = base;
      s.w.set.g = 0;
      const bool el = k % 2 == 0;
      s.w.set.e = el ? 1 : 0.5;
      s.w.set.mu = el ? 0 : std::tan(radians(30));
      std::vector<Rock> rocks(2);
      for (int i = 0; i < 2; ++i)
      {
        Rock& r = rocks[i];
        r.shape = makeShape(i ? sh.second : sh.first, 1);
        r.position = Vec3(i ? 202 : 198, 200, 0);
        r.velocity = Vec3(i ? -3 : 5, 0, 0);
        r.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
        r.position += 0.3 * Vec3(0, u(random), u(random));
        r.angularVelocity = Vec3(u(random), u(random), u(random));
      }
      s.add(rocks);
      Vec3 p0, l0, p1, l1;
      double z, e0, e1;
      s.totals(Vec3(200, 200, 0), p0, l0, z, e0);
      s.run(1);
      s.totals(Vec3(200, 200, 0), p1, l1, z, e1);
      dp = std::max(dp, (p1 - p0).norm() / 2e4);
      dl = std::max(dl, (l1 - l0).norm() / 4e4);
      met += (s.w.bodies[0].v.x() < 4.99);
      if (el)
      {
        worst = std::max(worst, std::abs(e1 / e0 - 1));
        mean += std::abs(e1 / e0 - 1);
        ++n;
        within += std::abs(e1 / e0 - 1) < 0.01;
      }
      else
        gain = std::max(gain, e1 / e0 - 1);
    }
  say("six shape pairs, 240 meetings",
    dp < 1e-10 && dl < 1e-10 && worst < 0.01 && gain < 1e-9 && met == 240,
    "dp %.1e dL %.1e; elastic: energy off %.2e at worst, %.1e mean, %d of %d within 1 %%; lossy: "
    "gain %.1e; met %d",
    dp, dl, worst, mean / n, within, n, gain, met);
  // flat faces: coefficient
  double off = 0;
  for (double e : { 0.0, 0.5, 0.9 })
  {
    Scene s;
    s.w.set = base;
    s.w.set.g = 0;
    s.w.set.e = e;
    std::vector<Rock> r = { brick(Vec3(1, 1, 1), Vec3(0, 0, 0), 0),
      brick(Vec3(1, 1, 1), Vec3(1.3, 0, 0), 1) };
    r[0].velocity = Vec3(6, 0, 0);
    s.add(r);
    s.run(0.3);
    Vec3 p, l;
    double z, k;
    s.totals(Vec3::Zero(), p, l, z, k);
    double lost = 1 - k / (0.5 * s.w.bodies[0].m * 36);
    off = std::max(off, std::abs(lost - 0.5 * (1 - e * e)));
  }
  say("faces lose what e says", off < 0.01, "loss off by %.4f of what came (bar 0.01)", off);
}
std::vector<Rock> handful(int count, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Rock> rocks;
  const Shape shapes[] = { Shape::Cube, Shape::Icosahedron, Shape::Tetrahedron, Shape::Eota221 };
  for (int k = 0; k < count; ++k)
  {
    Rock rock;
    rock.blockId = k;
    rock.shape = makeShape(shapes[k % 4], 0.3);
    const int level = k / 9, place = k % 9;
    rock.position = Vec3(20.0 + 1.2 * (place % 3 - 1) + 0.1 * u(random),
      20.0 + 1.2 * (place / 3 - 1), 1.0 + 1.2 * level);
    rock.orientation = Quat(u(random), u(random), u(random), u(random)).normalized();
    rocks.push_back(rock);
  }
  return rocks;
}
void energy(const char* name, double e, double phi, double eg, double phig, int n, double T)
{
  Scene s;
  s.w.set = base;
  s.w.set.mu = std::tan(radians(phi));
  s.w.set.muGround = std::tan(radians(phig));
  s.w.set.e = e;
  s.w.set.eGround = eg;
  s.floor();
  s.add(handful(n, 8));
  auto pot = [&]
  {
    double e = 0;
    for (auto& b : s.w.bodies)
      e += b.m * 9.81 * b.x.z();
    return e;
  };
  double P0 = pot(), E0 = s.w.energy(), gain = 0, most = 0, last = E0, worstF = 0, lastF = 0,
         worstD = 0, lastD = 0;
  while (s.w.time < T)
  {
    s.w.step();
    double en = s.w.energy();
    if (en > last)
      gain += en - last, most = std::max(most, en - last);
    last = en;
    worstF = std::min(worstF, s.w.books.friction - lastF);
    lastF = s.w.books.friction;
    worstD = std::min(worstD, s.w.books.dash - lastD);
    lastD = s.w.books.dash;
  }
  double rel = P0 - pot();
  double num = (E0 - last - s.w.books.friction - s.w.books.dash) / rel;
  say(name,
    std::abs(num) < 1e-3 && gain / rel < 1e-3 && worstF > -1e-3 * rel && worstD > -1e-3 * rel,
    "numerical %.1e, energy that rose %.1e (most in a step %.1e) of released; friction %.3f (least "
    "step %.1e) normal %.3f (least step %.1e)",
    num, gain / rel, most / rel, s.w.books.friction / rel, worstF / rel, s.w.books.dash / rel,
    worstD / rel);
}
int main(int c, char** v)
{
  base.design = atoi(v[1]) ? Design::Soft : Design::Resolved;
  std::string what = c > 2 ? v[2] : "all";
  for (int i = 3; i + 1 < c; i += 2)
  {
    std::string k = v[i];
    double x = atof(v[i + 1]);
    if (k == "sub")
      base.softSub = int(x);
    else if (k == "half")
      base.perHalf = x;
    else if (k == "p")
      base.penalty = x;
    else if (k == "max")
      base.maxSub = int(x);
    else if (k == "floor")
      base.floorOmega = x;
    else if (k == "zeta")
      base.zetaSoft = x;
    else if (k == "recover")
      base.recover = x;
    else if (k == "halve")
      base.halve = x;
    else if (k == "deepest")
      base.deepest = x;
    else if (k == "passes")
      base.bouncePasses = int(x);
    else if (k == "speed")
      base.slackSpeed = x;
    else if (k == "slack")
      base.slack = x;
    else if (k == "cap")
      base.hertzCap = x;
    else if (k == "softdeep")
      base.softDeepest = x;
    else if (k == "dt")
      base.dt = x;
    else if (k == "kappa")
      base.kappa = x;
    else if (k == "sigma")
      base.sigma = x;
    else if (k == "look")
      base.look = x;
    else if (k == "far")
      base.far = x;
    else if (k == "depth")
      base.depth = int(x);
    else if (k == "finer")
      base.finer = x;
    else if (k == "firm")
      base.groundFirm = x;
    else if (k == "quiet")
      base.quiet = x;
    else if (k == "tol")
      base.bounceTol = x;
    else if (k == "gen")
      base.generations = int(x);
    else
    {
      printf("? %s\n", k.c_str());
      return 1;
    }
  }
  auto is = [&](const char* n) { return what == "all" || what == n; };
  if (is("cradle"))
  {
    cradle(2, 0.01);
    cradle(5, 0.01);
    cradle(10, 0.01);
    cradle(5, 0.001);
    cradle(41, 0.01);
  }
  if (is("shapes"))
    shapes();
  if (is("stand"))
  {
    stand("column of 10", column(10), 30, 35, 2, 5);
    stand("column of 4", column(4), 30, 35, 2, 5);
    stand("wall 10 x 5", wall(10, 5), 30, 35, 2, 5);
    stand("arch", arch(), 40, 45, 2, 5);
    archFalls();
    stand("wall 10 x 10", wall(10, 10), 30, 35, 2, 2);
  }
  if (is("cubes"))
  {
    cubeOnCube(35, 30);
    cubeOnCube(35, 15);
    cubeOnCube(15, 35);
    cubeOnCube(18, 12);
  }
  if (is("dominoes"))
    dominoes();
  if (is("pinched"))
    pinched();
  if (is("momentum"))
    for (int n : { 2, 4, 10, 41, 100, 1000 })
      momentum(n);
  if (is("energy"))
  {
    energy("108 mixed rocks, e 0.8", 0.8, 30, 0.3, 35, 108, 8);
    energy("108 mixed rocks, e 1, phi 80", 1, 80, 1, 80, 108, 4);
    energy("108, e 0", 0, 30, 0, 35, 108, 8);
    energy("10, e 1, phi 0", 1, 0, 1, 0, 10, 4);
    energy("108, e 1, phi 0", 1, 0, 1, 0, 108, 4);
  }
  if (is("pour"))
  {
    pour(10, 5, false);
    pour(41, 5, false);
    pour(100, 6, false);
    pour(100, 5, true);
  }
  if (what == "pour1000")
  {
    pour(1000, 8, false);
  }
  if (what == "slope1000")
  {
    pour(1000, 5, true);
  }
}
