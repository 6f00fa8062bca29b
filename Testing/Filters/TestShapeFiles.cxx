// Shapes: files that VTK's writers make, through the project's reader, and what comes by pipeline.

#include "geometry/Polyhedron.h"
#include "helpers.h"
#include "mesh/meshFile.h"

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkOBJWriter.h"
#include "vtkPLYWriter.h"
#include "vtkRockBlockSource.h"
#include "vtkSTLWriter.h"
#include "vtkStripper.h"
#include "vtkTransform.h"
#include "vtkTransformPolyDataFilter.h"
#include "vtkTriangleFilter.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVertexGlyphFilter.h"

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

TEST_F(TestShapeFiles, SurfacesGridsStripsAndPointsByPipeline)
{
  vtkNew<vtkStripper> strips;
  strips->SetInputData(this->Mesh);
  strips->Update();
  ASSERT_GT(strips->GetOutput()->GetNumberOfStrips(), 0);
  vtkNew<vtkAppendFilter> grid;
  grid->SetInputData(this->Mesh);
  grid->Update();
  vtkNew<vtkVertexGlyphFilter> points;
  points->SetInputData(this->Mesh);
  points->Update();
  vtkNew<vtkRockBlockSource> rocks;
  rocks->SetShape(vtkRockBlockSource::FROM_FILE);
  rocks->SetScaleToVolume(false);
  for (vtkDataObject* shape : std::initializer_list<vtkDataObject*>{
         this->Mesh, strips->GetOutput(), grid->GetOutput(), points->GetOutput() })
  {
    SCOPED_TRACE(shape->GetClassName());
    rocks->SetInputDataObject(2, shape);
    rocks->Update();
    ASSERT_EQ(rocks->GetOutput()->GetNumberOfCells(), 6); // triangles make rectangles
    EXPECT_NEAR(value(rocks->GetOutput()->GetCellData(), "Volume"), 0.819, 1e-6);
  }
}

TEST_F(TestShapeFiles, WhatNoRockCanBeMadeOfByPipelineIsOneError)
{
  vtkNew<vtkRockBlockSource> rocks;
  rocks->SetShape(vtkRockBlockSource::FROM_FILE);
  const auto expect = [&](vtkDataObject* shape, const std::vector<std::string>& words)
  {
    rocks->SetInputDataObject(2, shape);
    rocks->Update();
    EXPECT_EQ(rocks->GetOutput()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  vtkNew<vtkPolyData> open, empty;
  open->DeepCopy(this->Mesh);
  open->BuildCells();
  open->DeleteCell(0);
  open->RemoveDeletedCells();
  expect(open, { "The Shape input", "open" });
  expect(empty, { "The Shape input", "no points" });
  vtkNew<vtkTransform> toMap;
  toMap->Translate(500123.0, 5200456.0, 0.0);
  vtkNew<vtkTransformPolyDataFilter> away;
  away->SetInputData(this->Mesh);
  away->SetTransform(toMap);
  away->SetOutputPointsPrecision(vtkAlgorithm::SINGLE_PRECISION);
  away->Update();
  expect(away->GetOutput(), { "The Shape input", "in single precision" });
  rocks->SetShapeFileName("rock.stl");
  expect(this->Mesh, { "ShapeFileName is rock.stl", "the Shape input is connected" });
  rocks->SetShapeFileName("");
  rocks->SetShape(vtkRockBlockSource::CUBE);
  rocks->Update();
  EXPECT_EQ(rocks->GetOutput()->GetNumberOfCells(), 6);
  ASSERT_EQ(this->Heard->Notes.size(), 1u);
  EXPECT_NE(this->Heard->Notes[0].find("The Shape input is connected, but has no effect"),
    std::string::npos);
}
