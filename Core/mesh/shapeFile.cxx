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
  const bool isOfVtk = extension.starts_with(".vt");
  throw FileError(fileName + ": the extension \"" + extension +
    "\" is none of .stl .ply .obj (mesh) .csv .xyz .txt (points)" +
    (isOfVtk ? "; open files of VTK in ParaView and connect them as the mesh" : ""));
}

} // namespace

Polyhedron shapeOf(
  const Mesh& mesh, const std::string& name, bool asItIs, std::vector<std::string>& notes)
{
  checkRounding(mesh.points, mesh.rounding, name, mesh.stored,
    "Save it with all digits (double precision, or a text of 12 digits), or move it near the "
    "origin");
  notes.insert(notes.end(), mesh.notes.begin(), mesh.notes.end());
  if (mesh.faces.empty())
  {
    return Polyhedron::convexHull(mesh.points, name);
  }
  if (asItIs)
  {
    return Polyhedron::fromFaces(mesh.points, mesh.faces, name);
  }
  // A hull would hide that the mesh is broken, which is hardly what its maker meant.
  const Shell shell = weldShell(mesh.points, mesh.faces, name);
  checkClosed(shell, name);
  checkVolume(shell, name);
  const std::string fault = convexityFault(shell);
  if (!fault.empty())
  {
    notes.push_back(name + " " + fault + "; its convex hull is taken");
  }
  return Polyhedron::convexHull(mesh.points, name);
}

Polyhedron readShape(const std::string& fileName, bool asItIs, std::vector<std::string>& notes)
{
  return shapeOf(readAny(fileName), fileName, asItIs, notes);
}

} // namespace rockfall
