// What a ground makes of rocks on straight slopes with a flat foot: speeds, jumps and reach angles on
// 450 m of 35° and 150 m of drop at 40°, and run-outs by size under 100 m of drop. Field surveys:
// speeds below 30 m/s, jumps of some metres, reach angles of the farthest 1 % of 27.5° to 32°, and
// blocks of 10 m³ 1.1 to 1.6 times as far as those of 0.1 m³.
//
//   longSlopes [--ground NAME] [--set name=value]… [--mix] [--meadow] [--jumps] [--iterations N]
//     [--seed N]
//
// EOTA 111 rocks; with --mix as many cubes and boxes of 2 : 1 : 1, each of N iterations. The ground is
// the preset Meadow where nothing else is said, and that of the foot the same, or with --meadow
// Meadow. Of --jumps comes another table instead: jumps down 190 m of 35° by size, over those on springs
// of 1e13 N/m.

#include "SlopeFigures.h"

#include <cstdio>

using namespace rockfall;
using namespace rockfall::calibration;

namespace
{

/// A spring that turns a rock late in its scar makes it jump lower.
void printJumps(const Arguments& arguments)
{
  GroundSettings stiff = arguments.settings;
  stiff.simulation.normalPenalty = 1e13;
  std::printf("%7s | %8s %8s %5s\n", "m3", "jump 50%", "stiff", "ratio");
  for (const double volume : { 0.1, 1.0, 10.0, 100.0 })
  {
    const SlopeFall fall{ 35.0, 109.0, volume, false };
    const std::vector shapes{ makeShape(Shape::Eota111, volume) };
    const double own = measure(arguments.settings, fall, shapes).usualJump,
                 limit = measure(stiff, fall, shapes).usualJump;
    std::printf("%7.1f | %8.3f %8.3f %5.3f\n", volume, own, limit, own / limit);
    std::fflush(stdout);
  }
}

int run(int count, char** words)
{
  GroundSettings defaults;
  defaults.setGround("meadow");
  defaults.simulation.normalPenalty = 0.0; // by mass, as in the panel
  defaults.simulation.iterations = 200;
  defaults.simulation.endTime = 300.0;
  defaults.simulation.outputInterval = 0.5;
  const Arguments arguments =
    parseArguments(count, words, defaults, { "--mix", "--meadow", "--jumps" }, false);
  if (arguments.has("--jumps"))
  {
    printJumps(arguments);
    return 0;
  }
  std::printf("%6s %6s %7s | %10s %9s | %8s | %8s %8s | %7s\n", "slope", "drop m", "m3",
    "speed 95 %", "jump 95 %", "run-out", "reach", "1 %", "last s");
  const auto print = [&](double angle, double drop, double volume)
  {
    const SlopeFigures f =
      measure(arguments.settings, { angle, drop, volume, arguments.has("--meadow") },
        arguments.has("--mix") ? mixedShapes(volume)
                               : std::vector{ makeShape(Shape::Eota111, volume) });
    std::printf("%6.0f %6.0f %7.2f | %10.1f %9.1f | %8.1f | %8.1f %8.1f | %7.1f\n", angle, drop,
      volume, f.speed, f.jump, f.runOut, f.reach, f.reachFarthest, f.longest);
    std::fflush(stdout);
    return f.runOut;
  };
  print(35.0, 258.0, 1.0);
  print(40.0, 150.0, 1.0);
  const double small = print(35.0, 100.0, 0.1), large = print(35.0, 100.0, 10.0);
  std::printf("run-out of 10 m3 over that of 0.1 m3: %.3f\n", large / small);
  return 0;
}

} // namespace

int main(int count, char** words)
{
  return runProgram(run, count, words);
}
