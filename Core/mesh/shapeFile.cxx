#include "mesh/shapeFile.h"

#include "base/errors.h"
#include "geometry/shell.h"
#include "mesh/meshFile.h"
#include "mesh/pointTable.h"
#include "mesh/precision.h"
#include "mesh/words.h"

#include <filesystem>

namespace rockfall
{

namespace
{

Mesh readAny(const std::string& fileName)
{
  const std::string extension = lowerCase(std::filesystem::path(fileName).extension().string());
  if (extension == ".csv" || extension == ".xyz" || extension == ".txt")
  {
    return readPointTable(fileName);
  }
  if (isMeshExtension(extension))
  {
    return readMesh(fileName);
  }
  throw FileError(fileName + ": the extension \"" + extension +
    "\" is none of .vtp .vtk .stl .ply .obj (mesh) .csv .xyz .txt (points)");
}

} // namespace

Polyhedron readShape(const std::string& fileName, bool asItIs, std::vector<std::string>& notes)
{
  if (fileName.empty())
  {
    throw FileError(
      "Shape File Name is empty: the shape \"file\" needs a file of points or a mesh");
  }
  const Mesh read = readAny(fileName);
  checkRounding(read.points, read.rounding, fileName, read.stored,
    "Save it with all digits (double precision, or a text of 12 digits), or move it near the "
    "origin");
  notes.insert(notes.end(), read.notes.begin(), read.notes.end());
  if (read.faces.empty())
  {
    return Polyhedron::convexHull(read.points, fileName);
  }
  if (asItIs)
  {
    return Polyhedron::fromFaces(read.points, read.faces, fileName);
  }
  // A hull would hide that the mesh is broken, which is hardly what its maker meant.
  const Shell shell = weldShell(read.points, read.faces, fileName);
  checkClosed(shell, fileName);
  checkVolume(shell, fileName);
  const std::string fault = convexityFault(shell);
  if (!fault.empty())
  {
    notes.push_back(fileName + " " + fault + "; its convex hull is taken");
  }
  return Polyhedron::convexHull(read.points, fileName);
}

} // namespace rockfall
