#include "shapeFile.h"

#include "base/errors.h"
#include "geometry/shell.h"
#include "plyCheck.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkDataSetReader.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkNew.h"
#include "vtkOBJReader.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkPLYReader.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkSTLReader.h"
#include "vtkSmartPointer.h"
#include "vtkTriangleFilter.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLReader.h"
#include "vtksys/FStream.hxx"
#include "vtksys/SystemTools.hxx"

#include <charconv>
#include <cmath>

namespace rockfall::filters
{

namespace
{

struct PointsAndFaces
{
  std::vector<Vec3> points;
  std::vector<std::vector<int>> faces;
};

/// Hears the warnings that VTK's readers give of no object; a truncated legacy file is one of them.
class Overheard : public vtkOutputWindow
{
public:
  static Overheard* New() { VTK_STANDARD_NEW_BODY(Overheard); }
  void DisplayGenericWarningText(const char* text) override
  {
    this->Complaint = this->Complaint.empty() ? text : this->Complaint;
  }
  void DisplayWarningText(const char* text) override { this->DisplayGenericWarningText(text); }

  std::string Complaint;

protected:
  Overheard() = default;
  ~Overheard() override = default;
};

/// Runs a VTK reader, whose error becomes an exception instead of a message of its own.
void update(vtkAlgorithm* reader, const std::string& fileName)
{
  std::string complaint;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&complaint);
  listener->SetCallback(
    [](vtkObject*, unsigned long, void* clientData, void* text)
    {
      std::string& kept = *static_cast<std::string*>(clientData);
      if (kept.empty() && text)
      {
        kept = static_cast<const char*>(text);
      }
    });
  reader->AddObserver(vtkCommand::ErrorEvent, listener);
  reader->AddObserver(vtkCommand::WarningEvent, listener);
  if (auto* xml = vtkXMLReader::SafeDownCast(reader))
  {
    xml->SetParserErrorObserver(listener); // the parser reports on its own
  }
  reader->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, listener);
  const vtkSmartPointer<vtkOutputWindow> window = vtkOutputWindow::GetInstance();
  vtkNew<Overheard> overheard;
  vtkOutputWindow::SetInstance(overheard);
  reader->Update();
  vtkOutputWindow::SetInstance(window);
  complaint = complaint.empty() ? overheard->Complaint : complaint;
  if (!complaint.empty())
  {
    // "ERROR: In vtkSTLReader.cxx, line 123\nvtkSTLReader (0x...): what is wrong"
    std::string what = complaint.substr(complaint.find('\n') + 1);
    const auto start = what.find("): ");
    what = start == std::string::npos ? what : what.substr(start + 3);
    what.erase(what.find_last_not_of(" \n\r") + 1);
    throw FileError(fileName + ": cannot be read as a mesh: " + what);
  }
  if (reader->GetErrorCode() != vtkErrorCode::NoError)
  {
    throw FileError(fileName + ": cannot be read as a mesh: " +
      vtkErrorCode::GetStringFromErrorCode(reader->GetErrorCode()));
  }
}

template <typename Reader>
vtkSmartPointer<vtkPointSet> readWith(const std::string& fileName)
{
  vtkNew<Reader> reader;
  reader->SetFileName(fileName.c_str());
  update(reader, fileName);
  return vtkPointSet::SafeDownCast(reader->GetOutputDataObject(0));
}

PointsAndFaces readMesh(const std::string& fileName, const std::string& extension)
{
  vtkSmartPointer<vtkPointSet> mesh;
  if (extension == ".stl")
  {
    mesh = readWith<vtkSTLReader>(fileName);
  }
  else if (extension == ".ply")
  {
    checkPly(fileName);
    mesh = readWith<vtkPLYReader>(fileName);
  }
  else if (extension == ".obj")
  {
    mesh = readWith<vtkOBJReader>(fileName);
  }
  else if (extension == ".vtp")
  {
    mesh = readWith<vtkXMLPolyDataReader>(fileName);
  }
  else
  {
    mesh = readWith<vtkDataSetReader>(fileName);
  }
  if (!mesh || mesh->GetNumberOfPoints() == 0)
  {
    throw FileError(fileName + ": has no points, so no shape can be made of it");
  }
  PointsAndFaces result;
  for (vtkIdType id = 0; id < mesh->GetNumberOfPoints(); ++id)
  {
    mesh->GetPoint(id, result.points.emplace_back().data());
  }
  if (auto* surface = vtkPolyData::SafeDownCast(mesh))
  {
    vtkNew<vtkTriangleFilter> unstrip;
    if (surface->GetNumberOfStrips() > 0)
    {
      unstrip->SetInputData(surface);
      unstrip->Update();
      surface = unstrip->GetOutput();
    }
    auto polygons = vtk::TakeSmartPointer(surface->GetPolys()->NewIterator());
    for (polygons->GoToFirstCell(); !polygons->IsDoneWithTraversal(); polygons->GoToNextCell())
    {
      vtkIdType size = 0;
      const vtkIdType* ids = nullptr;
      polygons->GetCurrentCell(size, ids);
      std::vector<int>& face = result.faces.emplace_back();
      for (vtkIdType k = 0; k < size; ++k)
      {
        if (ids[k] < 0 || ids[k] >= mesh->GetNumberOfPoints())
        {
          throw FileError(fileName + ": face " + std::to_string(result.faces.size() - 1) +
            " refers to point " + std::to_string(ids[k]) + ", there are " +
            std::to_string(mesh->GetNumberOfPoints()));
        }
        face.push_back(int(ids[k]));
      }
    }
  }
  return result;
}

/// The numbers of a line, separated by blanks, commas or semicolons; nothing if it holds others.
bool parseNumbers(const std::string& line, std::vector<double>& numbers)
{
  numbers.clear();
  const char* at = line.data();
  const char* const end = at + line.size();
  while (true)
  {
    while (at != end && std::string_view(" \t\r,;").find(*at) != std::string_view::npos)
    {
      ++at;
    }
    if (at == end || *at == '#')
    {
      return true;
    }
    at += *at == '+' ? 1 : 0;
    // from_chars: a decimal point whatever the user's locale.
    const auto [next, error] = std::from_chars(at, end, numbers.emplace_back());
    if (error != std::errc())
    {
      return false;
    }
    at = next;
  }
}

PointsAndFaces readPointTable(const std::string& fileName)
{
  vtksys::ifstream file(fileName.c_str());
  PointsAndFaces result;
  std::vector<double> numbers;
  std::string line;
  for (int row = 1; std::getline(file, line); ++row)
  {
    const bool good = parseNumbers(line, numbers);
    if (!good && row == 1)
    {
      continue; // a line of column names
    }
    if (good && numbers.empty())
    {
      continue;
    }
    if (!good || numbers.size() < 3)
    {
      throw FileError(fileName + ", line " + std::to_string(row) + ": \"" + line.substr(0, 80) +
        "\" is not a point: three numbers x, y, z are");
    }
    result.points.emplace_back(numbers[0], numbers[1], numbers[2]);
  }
  if (result.points.empty())
  {
    throw FileError(fileName + ": has no points, so no shape can be made of it");
  }
  return result;
}

} // namespace

Polyhedron readShape(const std::string& fileName, bool asItIs, std::vector<std::string>& notes)
{
  if (fileName.empty())
  {
    throw FileError(
      "Shape File Name is empty: the shape \"file\" needs a file of points or a mesh");
  }
  if (!vtksys::SystemTools::FileExists(fileName, true))
  {
    throw FileError(fileName + ": there is no such file");
  }
  const std::string extension =
    vtksys::SystemTools::LowerCase(vtksys::SystemTools::GetFilenameLastExtension(fileName));
  PointsAndFaces read;
  if (extension == ".csv" || extension == ".xyz" || extension == ".txt")
  {
    read = readPointTable(fileName);
  }
  else if (extension == ".stl" || extension == ".ply" || extension == ".obj" ||
    extension == ".vtp" || extension == ".vtk")
  {
    read = readMesh(fileName, extension);
  }
  else
  {
    throw FileError(fileName + ": the extension \"" + extension +
      "\" is none of .vtp .vtk .stl .ply .obj (mesh) .csv .xyz .txt (points)");
  }
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

} // namespace rockfall::filters
