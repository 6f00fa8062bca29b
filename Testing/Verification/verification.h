#pragma once

/// @file
/// What the verification cases share: results that are both asserted and written down, curves for
/// the figures, and the runs themselves.
///
/// Every case hands its figures to `record` and its kin, which assert with GoogleTest and write one
/// line of JSON per figure into `<Suite>.<Test>.jsonl` in the results folder (environment variable
/// ROCKFALL_VERIFICATION_RESULTS, else where the build put it). `makePage.py` makes
/// docs/verification.md of these lines; nothing on that page is typed in by hand.
///
/// With ROCKFALL_VERIFICATION=full the full forms run (hours); otherwise the reduced ones
/// (minutes).

#include "Core/slopes.h"

#include <span>
#include <string>
#include <vector>

namespace rockfall::verification
{

/// Whether the full forms run.
bool full();
/// How many of something: the first number in the reduced form, the second in the full one.
int count(int reduced, int whole);
/// An integer from the environment, `otherwise` if it is not there.
long fromEnvironment(const char* name, long otherwise);

/// One figure of a case: what it is called, its unit ("" if dimensionless) and why the bar is where
/// it is.
struct Figure
{
  std::string subject;  ///< The case, as in the page's headings.
  std::string quantity; ///< What was measured, under which circumstances.
  std::string unit;
  std::string reason; ///< For the tolerance, or a remark.
};

/// |value − expected| ≤ tolerance.
void record(const Figure& figure, double value, double expected, double tolerance);
/// value ≤ bound.
void recordAtMost(const Figure& figure, double value, double bound);
/// value ≥ bound.
void recordAtLeast(const Figure& figure, double value, double bound);
/// No bar: timing, orders of convergence, the paper's figures beside ours. `expected` is only
/// shown.
void report(const Figure& figure, double value);
void report(const Figure& figure, double value, double expected);

/// A curve of a figure of the page. `plot` is the name of the picture.
void addCurve(const std::string& plot, const std::string& label, std::span<const double> x,
  std::span<const double> y);
/// The horizontal projection of trajectories, as curves of one label.
void addPaths(
  const std::string& plot, const std::string& label, std::span<const Trajectory> trajectories);

/// Short text of a number, for labels: "1e+09", "0.005".
std::string text(double number);

/// Every rock alone on the same slope, on all threads; results in the order (iteration, rock).
std::vector<Trajectory> simulateAll(
  const Terrain& terrain, std::span<const Rock> rocks, const SimulationParameters& parameters);

/// A surface material: Rv, φ (degrees) and the way in which impacts lose energy.
SurfaceMaterial surface(
  double restitution, double frictionDegrees, RestitutionModel model = RestitutionModel::Velocity);

/// A horizontal slope at z = 0, `size` m wide, of n × n nodes.
Terrain flatGround(double size, const SurfaceMaterial& material, int n = 2);

/// An icosahedron, its faces cut into four `subdivisions` times, all vertices on a sphere of this
/// radius (m): 20 · 4ⁿ faces. A vertex is straight below the centroid.
Polyhedron makeBall(int subdivisions, double radius);

/// A direction and an attitude, uniform over all, from two and three numbers of 0 … 1.
Vec3 uniformDirection(double u, double v);
Quat uniformAttitude(double u, double v, double w);

/// Translation, rotation and height, J: of a rock in flight, at gravity g (m/s²).
double mechanicalEnergy(const Rock& rock, const Sample& sample, double gravity);
/// About the centroid, world axes, kg m²/s.
Vec3 angularMomentum(const Rock& rock, const Sample& sample);
/// Last sample of the flight after the first contact, nullptr if there is none: samples on both
/// sides of it have to be free as well, so that nothing in contact counts.
const Sample* lastInFlight(const Trajectory& trajectory);

/// Slope of log(error) over log(step): the observed order of convergence, by least squares.
double observedOrder(std::span<const double> steps, std::span<const double> errors);

} // namespace rockfall::verification
