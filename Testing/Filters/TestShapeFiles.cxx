// Files that VTK's own writers make, in all of their ways, through the project's reader.

#include "geometry/Polyhedron.h"
#include "helpers.h"
#include "mesh/meshFile.h"

#include "vtkCubeSource.h"
#include "vtkOBJWriter.h"
#include "vtkPLYWriter.h"
#include "vtkPolyDataWriter.h"
#include "vtkSTLWriter.h"
#include "vtkStringArray.h"
#include "vtkStripper.h"
#include "vtkTriangleFilter.h"
#include "vtkXMLPolyDataWriter.h"

namespace
{

class TestShapeFiles : public FilterTest
{
protected:
  void SetUp() override
  {
    this->FilterTest::SetUp();
    vtkNew<vtkCubeSource> box;
    box->SetXLength(1.3);
    box->SetYLength(0.9);
    box->SetZLength(0.7);
    box->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    vtkNew<vtkTriangleFilter> triangles;
    triangles->SetInputConnection(box->GetOutputPort());
    triangles->Update();
    this->Mesh->DeepCopy(triangles->GetOutput());
    // Names beside it, as rock sources have them.
    vtkNew<vtkStringArray> names;
    names->SetName("SourceName");
    names->InsertNextValue("a cliff with blanks");
    names->InsertNextValue("");
    names->InsertNextValue(std::string(300, 'x'));
    this->Mesh->GetFieldData()->AddArray(names);
  }

  void ExpectBox(const std::string& file)
  {
    SCOPED_TRACE(file);
    const rockfall::Mesh mesh = rockfall::readMesh(file);
    EXPECT_NEAR(
      rockfall::Polyhedron::fromFaces(mesh.points, mesh.faces).integrals().volume, 0.819, 1e-6);
  }

  vtkNew<vtkPolyData> Mesh;
};

} // namespace

TEST_F(TestShapeFiles, XmlInAllItsWays)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(this->Mesh);
  int number = 0;
  for (const int mode : { vtkXMLWriter::Ascii, vtkXMLWriter::Binary, vtkXMLWriter::Appended })
  {
    for (const int compressor : { vtkXMLWriter::NONE, vtkXMLWriter::ZLIB })
    {
      for (const bool base64 : { false, true })
      {
        for (const bool wide : { false, true })
        {
          const std::string file = this->WriteFile("box" + std::to_string(number++) + ".vtp", "");
          writer->SetFileName(file.c_str());
          writer->SetDataMode(mode);
          writer->SetCompressorType(compressor);
          writer->SetEncodeAppendedData(base64);
          writer->SetByteOrder(wide ? vtkXMLWriter::BigEndian : vtkXMLWriter::LittleEndian);
          wide ? writer->SetHeaderTypeToUInt64() : writer->SetHeaderTypeToUInt32();
          writer->SetBlockSize(64); // many blocks
          ASSERT_EQ(writer->Write(), 1);
          this->ExpectBox(file);
        }
      }
    }
  }
  const std::string file = this->WriteFile("packed.vtp", "");
  writer->SetFileName(file.c_str());
  writer->SetCompressorType(vtkXMLWriter::LZ4);
  ASSERT_EQ(writer->Write(), 1);
  try
  {
    rockfall::readMesh(file);
    ADD_FAILURE() << "read all the same";
  }
  catch (const std::exception& error)
  {
    EXPECT_NE(std::string(error.what()).find("vtkLZ4DataCompressor; save it with the compressor"),
      std::string::npos)
      << error.what();
  }
}

TEST_F(TestShapeFiles, LegacyInBothVersionsAndStrips)
{
  vtkNew<vtkStripper> strips;
  strips->SetInputData(this->Mesh);
  strips->Update();
  strips->GetOutput()->GetFieldData()->ShallowCopy(this->Mesh->GetFieldData());
  ASSERT_GT(strips->GetOutput()->GetNumberOfStrips(), 0);
  vtkNew<vtkPolyDataWriter> writer;
  int number = 0;
  for (vtkPolyData* mesh : { this->Mesh.Get(), strips->GetOutput() })
  {
    writer->SetInputData(mesh);
    for (const int version : { 42, 51 })
    {
      for (const int type : { VTK_ASCII, VTK_BINARY })
      {
        const std::string file = this->WriteFile("box" + std::to_string(number++) + ".vtk", "");
        writer->SetFileName(file.c_str());
        writer->SetFileVersion(version);
        writer->SetFileType(type);
        ASSERT_EQ(writer->Write(), 1);
        this->ExpectBox(file);
      }
    }
  }
}

TEST_F(TestShapeFiles, OtherFormats)
{
  const std::string ply = this->WriteFile("box.ply", ""), stl = this->WriteFile("box.stl", ""),
                    obj = this->WriteFile("box.obj", "");
  vtkNew<vtkOBJWriter> toObj;
  toObj->SetInputData(this->Mesh);
  toObj->SetFileName(obj.c_str());
  ASSERT_EQ(toObj->Write(), 1);
  this->ExpectBox(obj);
  for (const int type : { VTK_ASCII, VTK_BINARY })
  {
    vtkNew<vtkSTLWriter> toStl;
    toStl->SetInputData(this->Mesh);
    toStl->SetFileName(stl.c_str());
    toStl->SetFileType(type);
    ASSERT_EQ(toStl->Write(), 1);
    this->ExpectBox(stl);
    for (const int order : { VTK_LITTLE_ENDIAN, VTK_BIG_ENDIAN })
    {
      vtkNew<vtkPLYWriter> toPly;
      toPly->SetInputData(this->Mesh);
      toPly->SetFileName(ply.c_str());
      toPly->SetFileType(type);
      toPly->SetDataByteOrder(order);
      ASSERT_EQ(toPly->Write(), 1);
      this->ExpectBox(ply);
    }
  }
}
