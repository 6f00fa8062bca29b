#include "helpers.h"

#include "vtkCellData.h"
#include "vtkDEMToCFESource.h"
#include "vtkFieldData.h"
#include "vtkMassProperties.h"
#include "vtkPolyData.h"
#include "vtkRockBlockSource.h"
#include "vtkStringArray.h"
#include "vtkTransform.h"
#include "vtkTriangleFilter.h"

#include <algorithm>
#include <cmath>

namespace
{

class TestRockBlockSource : public FilterTest
{
protected:
  vtkPolyData* Update()
  {
    this->Source->Update();
    return this->Source->GetOutput();
  }

  /// Volume that the polygons enclose, m³.
  double EnclosedVolume(vtkPolyData* mesh)
  {
    vtkNew<vtkTriangleFilter> triangles;
    triangles->SetInputData(mesh);
    vtkNew<vtkMassProperties> mass;
    mass->SetInputConnection(triangles->GetOutputPort());
    return mass->GetVolume();
  }

  vtkNew<vtkRockBlockSource> Source;
};

/// An ASCII STL cube of edge 2 m, whole or without its last facet, with its faces out- or inward.
std::string stlCube(bool whole, bool outward)
{
  const int quads[6][4] = { { 0, 4, 6, 2 }, { 1, 3, 7, 5 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 },
    { 0, 2, 3, 1 }, { 4, 5, 7, 6 } };
  std::ostringstream stl;
  stl << "solid cube\n";
  for (int face = 0; face < 6; ++face)
  {
    for (int half = 0; half < (whole || face < 5 ? 2 : 1); ++half)
    {
      const int* q = quads[face];
      int corners[3] = { q[0], q[1 + half], q[2 + half] };
      if (!outward)
      {
        std::swap(corners[1], corners[2]);
      }
      stl << "facet normal 0 0 0\nouter loop\n";
      for (int c : corners)
      {
        stl << "vertex " << (c & 1 ? 2 : 0) << " " << (c & 2 ? 2 : 0) << " " << (c & 4 ? 2 : 0)
            << "\n";
      }
      stl << "endloop\nendfacet\n";
    }
  }
  stl << "endsolid\n";
  return stl.str();
}

} // namespace

TEST_F(TestRockBlockSource, ShapesHaveTheirFacesAndVolume)
{
  const struct
  {
    int shape;
    int points, faces;
  } shapes[] = { { vtkRockBlockSource::CUBE, 8, 6 }, { vtkRockBlockSource::TETRAHEDRON, 4, 4 },
    { vtkRockBlockSource::OCTAHEDRON, 6, 8 }, { vtkRockBlockSource::DODECAHEDRON, 20, 12 },
    { vtkRockBlockSource::ICOSAHEDRON, 12, 20 }, { vtkRockBlockSource::EOTA_111, 24, 26 },
    { vtkRockBlockSource::EOTA_221, 24, 26 } };
  for (const auto& expected : shapes)
  {
    this->Source->SetShape(expected.shape);
    this->Source->SetVolume(0.7);
    vtkPolyData* block = this->Update();
    EXPECT_EQ(block->GetNumberOfPoints(), expected.points) << expected.shape;
    EXPECT_EQ(block->GetNumberOfCells(), expected.faces) << expected.shape;
    EXPECT_EQ(block->GetPoints()->GetDataType(), VTK_DOUBLE);
    EXPECT_NEAR(this->EnclosedVolume(block), 0.7, 1e-9) << expected.shape;
    EXPECT_NEAR(value(block->GetCellData(), "Volume"), 0.7, 1e-12);
    EXPECT_EQ(value(block->GetCellData(), "Shape"), expected.shape);
  }
}

TEST_F(TestRockBlockSource, CubeStandsAlongTheAxes)
{
  this->Source->SetVolume(8.0);
  this->Source->SetCenter(10, 20, 30);
  double bounds[6];
  this->Update()->GetBounds(bounds);
  const double expected[6] = { 9, 11, 19, 21, 29, 31 };
  for (int k = 0; k < 6; ++k)
  {
    EXPECT_NEAR(bounds[k], expected[k], 1e-12);
  }
}

TEST_F(TestRockBlockSource, OrientationIsThatOfVtkTransform)
{
  this->Source->SetShape(vtkRockBlockSource::BOX);
  this->Source->SetLengths(1, 2, 3);
  this->Source->SetCenter(0, 0, 0);
  vtkNew<vtkPolyData> straight;
  straight->DeepCopy(this->Update());
  this->Source->SetOrientation(20, -50, 110);
  vtkPolyData* turned = this->Update();
  vtkNew<vtkTransform> transform;
  transform->RotateZ(110);
  transform->RotateX(20);
  transform->RotateY(-50);
  for (vtkIdType id = 0; id < 8; ++id)
  {
    double expected[3];
    transform->TransformPoint(straight->GetPoint(id), expected);
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(turned->GetPoint(id)[k], expected[k], 1e-12);
    }
  }
}

TEST_F(TestRockBlockSource, BoxHasTheVolumeOfItsLengths)
{
  this->Source->SetShape(vtkRockBlockSource::BOX);
  this->Source->SetLengths(1, 2, 3);
  this->Source->SetVolume(0.0); // not a box's
  EXPECT_NEAR(this->EnclosedVolume(this->Update()), 6.0, 1e-12);
}

TEST_F(TestRockBlockSource, EveryCellHasTheBlocksProperties)
{
  this->Source->SetDensity(2700);
  this->Source->SetYoungModulus(2e9);
  this->Source->SetPoissonRatio(0.2);
  this->Source->SetVelocity(1, 2, 3);
  this->Source->SetAngularVelocity(4, 5, 6);
  this->Source->SetFirstBlockId(7);
  vtkPolyData* block = this->Update();
  for (vtkIdType cell = 0; cell < block->GetNumberOfCells(); ++cell)
  {
    vtkCellData* data = block->GetCellData();
    EXPECT_EQ(value(data, "BlockId", cell), 7);
    EXPECT_EQ(value(data, "Density", cell), 2700);
    EXPECT_EQ(value(data, "YoungModulus", cell), 2e9);
    EXPECT_EQ(value(data, "PoissonRatio", cell), 0.2);
    EXPECT_EQ(value(data, "Velocity", cell, 1), 2);
    EXPECT_EQ(value(data, "AngularVelocity", cell, 2), 6);
  }
}

TEST_F(TestRockBlockSource, TableRowsOverrideProperties)
{
  this->Source->SetDensity(2600);
  this->Source->SetFileName(this
                              ->WriteFile("sources.csv",
                                "x,y,z,shape,volume,density\n"
                                "1,2,3,octahedron,0.5,\n"
                                "4,5,6,,,3000\n")
                              .c_str());
  vtkPolyData* blocks = this->Update();
  ASSERT_EQ(blocks->GetNumberOfCells(), 8 + 6);
  vtkCellData* data = blocks->GetCellData();
  EXPECT_EQ(value(data, "BlockId", 0), 1);
  EXPECT_NEAR(value(data, "Volume", 0), 0.5, 1e-12);
  EXPECT_EQ(value(data, "Density", 0), 2600);
  EXPECT_EQ(value(data, "BlockId", 8), 2);
  EXPECT_NEAR(value(data, "Volume", 8), 1.0, 1e-12);
  EXPECT_EQ(value(data, "Density", 8), 3000);
  auto* names = vtkStringArray::SafeDownCast(blocks->GetFieldData()->GetAbstractArray("ShapeName"));
  ASSERT_TRUE(names);
  EXPECT_EQ(names->GetValue(vtkIdType(value(data, "Shape", 0))), "octahedron");
  EXPECT_EQ(names->GetValue(vtkIdType(value(data, "Shape", 8))), "cube");
}

TEST_F(TestRockBlockSource, ShapeFromPointsIsTheirHull)
{
  this->Source->SetShape(vtkRockBlockSource::FROM_FILE);
  this->Source->SetScaleToVolume(false);
  // A cube of edge 2 and its middle.
  this->Source->SetShapeFileName(this
                                   ->WriteFile("points.csv",
                                     "x,y,z\n0,0,0\n2,0,0\n0,2,0\n2,2,0\n0,0,2\n2,0,2\n0,2,2\n"
                                     "2,2,2\n1,1,1\n")
                                   .c_str());
  vtkPolyData* block = this->Update();
  EXPECT_EQ(block->GetNumberOfPoints(), 8);
  EXPECT_EQ(block->GetNumberOfCells(), 6);
  EXPECT_NEAR(this->EnclosedVolume(block), 8.0, 1e-9);
  this->Source->SetScaleToVolume(true);
  EXPECT_NEAR(this->EnclosedVolume(this->Update()), 1.0, 1e-9);
}

TEST_F(TestRockBlockSource, ShapeFromMesh)
{
  this->Source->SetShape(vtkRockBlockSource::FROM_FILE);
  this->Source->SetScaleToVolume(false);
  this->Source->SetShapeFileName(this->WriteFile("cube.stl", stlCube(true, true)).c_str());
  for (int mode : { vtkRockBlockSource::CONVEX_HULL, vtkRockBlockSource::AS_IT_IS })
  {
    this->Source->SetShapeFileMode(mode);
    vtkPolyData* block = this->Update();
    EXPECT_EQ(block->GetNumberOfCells(), 6); // its triangles make squares
    EXPECT_NEAR(this->EnclosedVolume(block), 8.0, 1e-6);
  }
}

TEST_F(TestRockBlockSource, BrokenMeshesAreErrorsInEitherMode)
{
  this->Source->SetShape(vtkRockBlockSource::FROM_FILE);
  for (int mode : { vtkRockBlockSource::CONVEX_HULL, vtkRockBlockSource::AS_IT_IS })
  {
    this->Source->SetShapeFileMode(mode);
    this->Source->SetShapeFileName(this->WriteFile("open.stl", stlCube(false, true)).c_str());
    EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
    this->ExpectOneError({ "open.stl", "open" });
    this->Source->SetShapeFileName(this->WriteFile("inverted.stl", stlCube(true, false)).c_str());
    EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
    this->ExpectOneError({ "inverted.stl", "inward" });
  }
}

TEST_F(TestRockBlockSource, BadShapeFiles)
{
  this->Source->SetShape(vtkRockBlockSource::FROM_FILE);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "ShapeFileName is empty", "Shape input" });
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n";
  const std::pair<std::string, std::string> files[] = {
    { "flat.csv", "0,0,0\n1,0,0\n0,1,0\n1,1,0\n" },
    { "words.csv", "x,y,z\n0,0,0\n1,two,3\n" },
    { "none.xyz", "" },
    { "rock.doc", "0 0 0\n" },
    { "rock.vtp", "whatever it is: ParaView reads it" },
    { "empty.stl", "solid s\nendsolid s\n" },
    { "words.obj", "v a b c\nf x y z\n" },
    { "range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 9\n" },
    { "header.ply", ply.substr(0, 60) },
    { "truncated.ply", ply + "0 0 0\n1 0 0\n" },
    { "binary.ply",
      std::string(ply).replace(ply.find("ascii"), 5, "binary_little_endian") + "abc" },
  };
  for (const auto& [name, content] : files)
  {
    SCOPED_TRACE(name);
    this->Source->SetShapeFileName(this->WriteFile(name, content).c_str());
    EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
    this->ExpectOneError({ name });
  }
  this->Source->SetShapeFileName("/no/such/rock.stl");
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "/no/such/rock.stl" });
}

TEST_F(TestRockBlockSource, BadValuesAreOneErrorAndNothingElse)
{
  for (double volume : { 0.0, -1.0, std::nan("") })
  {
    this->Source->SetVolume(volume);
    EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
    this->ExpectOneError({ "Volume" });
  }
  this->Source->SetVolume(1.0);
  this->Source->SetDensity(0.0);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "Density", "0" });
  this->Source->SetDensity(2500.0);
  this->Source->SetPoissonRatio(0.5);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "PoissonRatio", "0.5" });
  this->Source->SetPoissonRatio(0.1);
  this->Source->SetShape(17);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "Shape", "17" });
  this->Source->SetShape(0);
  this->Source->SetShapeFileMode(2); // whatever the shape
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "ShapeFileMode", "2" });
  this->Source->SetShapeFileMode(vtkRockBlockSource::CONVEX_HULL);
  this->Source->SetTargetCRS("EPSG:nowhere");
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "EPSG:nowhere" });
  this->Source->SetTargetCRS("");
  this->Source->SetFileName("/no/such/sources.csv");
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "/no/such/sources.csv" });
  const std::string table = this->WriteFile("bad.csv", "x,y,z,volume\n1,2,3,1\n4,5,6,-2\n");
  this->Source->SetFileName(table.c_str());
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ table, "row 2", "-2" });
}

TEST_F(TestRockBlockSource, SaysInWhichCrsTheBlocksAre)
{
  const auto crs = [this]() -> std::string
  {
    auto* array =
      vtkStringArray::SafeDownCast(this->Update()->GetFieldData()->GetAbstractArray("TerrainCRS"));
    return array && array->GetNumberOfValues() == 1 ? std::string(array->GetValue(0)) : "";
  };
  EXPECT_EQ(crs(), ""); // nothing says it
  this->Source->SetTargetCRS("EPSG:32632");
  EXPECT_NE(crs().find("UTM zone 32N"), std::string::npos);
  const std::string points = this->WriteFile("points.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
    R"("geometry":{"type":"Point","coordinates":[9,45,700]}}]})");
  this->Source->SetFileName(points.c_str());
  EXPECT_NE(crs().find("UTM zone 32N"), std::string::npos);
  this->Source->SetTargetCRS("");
  EXPECT_EQ(crs().find("GEOGCRS[\"WGS 84\""), 0u) << crs();
  const std::string table = this->WriteFile("table.csv", "x,y,z\n1,2,3\n");
  this->Source->SetFileName(table.c_str());
  EXPECT_EQ(crs(), "");
}

TEST_F(TestRockBlockSource, SourcesOnTheGround)
{
  // The test slope: 57.7 m high, 30° down over 100 m, then flat.
  vtkNew<vtkDEMToCFESource> slope;
  this->Source->SetInputConnection(1, slope->GetOutputPort());
  const std::string layer = this->WriteFile("cliff.geojson",
    R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":)"
    R"("urn:ogc:def:crs:EPSG::32632"}},"features":[)"
    R"({"type":"Feature","properties":{"amount":40,"height":0.5,"source":"cliff",)"
    R"("shape":"cube:1;octahedron:3","volume":0.5,"material":"basalt","dev_att":"random"},)"
    R"("geometry":{"type":"Polygon","coordinates":[[[10,10],[30,10],[30,90],[10,90],[10,10]]]}},)"
    R"({"type":"Feature","properties":{"amount":5,"source_id":9,"dev_xy":2,"dev_z":0.5},)"
    R"("geometry":{"type":"LineString","coordinates":[[150,10],[150,90]]}}]})");
  this->Source->SetFileName(layer.c_str());
  vtkPolyData* blocks = this->Update();
  vtkCellData* data = blocks->GetCellData();
  vtkFieldData* field = blocks->GetFieldData();
  auto* names = vtkStringArray::SafeDownCast(data->GetAbstractArray("SourceName"));
  auto* shapes = vtkStringArray::SafeDownCast(field->GetAbstractArray("ShapeName"));
  ASSERT_TRUE(names && shapes);
  ASSERT_EQ(names->GetNumberOfValues(), blocks->GetNumberOfCells());
  EXPECT_EQ(names->GetValue(0), "cliff");
  EXPECT_EQ(names->GetValue(blocks->GetNumberOfCells() - 1), "source 9");
  int octahedra = 0;
  for (vtkIdType cell = 0; cell < blocks->GetNumberOfCells(); ++cell)
  {
    const bool begins =
      cell == 0 || value(data, "BlockId", cell) != value(data, "BlockId", cell - 1);
    octahedra += begins && shapes->GetValue(vtkIdType(value(data, "Shape", cell))) == "octahedron";
  }
  EXPECT_NEAR(octahedra, 30, 11); // four standard deviations of √(40 · ¾ · ¼)
  EXPECT_EQ(value(data, "SourceId", 0), 1);
  EXPECT_NEAR(value(data, "Volume", 0), 0.5, 1e-12);
  EXPECT_EQ(value(data, "Density", 0), 2990);
  EXPECT_EQ(value(data, "YoungModulus", 0), 6.1e10);
  EXPECT_EQ(value(data, "AttitudeLaw", 0), vtkRockBlockSource::RANDOM);
  EXPECT_EQ(value(data, "PositionDeviation", 0), 0);
  // The line's are the last: five cubes of 1 m³ on the flat part.
  const vtkIdType last = blocks->GetNumberOfCells() - 1;
  EXPECT_EQ(value(data, "SourceId", last), 9);
  EXPECT_EQ(value(data, "PositionDeviation", last, 0), 2);
  EXPECT_EQ(value(data, "PositionDeviation", last, 1), 0.5);
  EXPECT_EQ(value(data, "Density", last), 2500);
  for (vtkIdType id = blocks->GetNumberOfPoints() - 40; id < blocks->GetNumberOfPoints(); ++id)
  {
    const double* p = blocks->GetPoint(id);
    EXPECT_NEAR(std::abs(p[0] - 150.0), 0.5, 1e-9);
    EXPECT_NEAR(std::abs(p[2] - 0.5), 0.5, 1e-9);
  }
  // The cliff's are 0.5 m over the slope at their lowest, and so clear of it everywhere.
  double least = 1e9;
  for (vtkIdType id = 0; id < blocks->GetNumberOfPoints() - 40; ++id)
  {
    const double* p = blocks->GetPoint(id);
    least = std::min(least, p[2] - 57.7 * (1.0 - p[0] / 100.0));
  }
  EXPECT_NEAR(least, 0.5, 1e-9);
}

TEST_F(TestRockBlockSource, SteepGroundAndVolumeLaws)
{
  vtkNew<vtkDEMToCFESource> slope;
  this->Source->SetInputConnection(1, slope->GetOutputPort());
  this->Source->SetSlopeThreshold(29.0);
  this->Source->SetAmount(50);
  this->Source->SetVolumeLaw(vtkRockBlockSource::POWER_LAW);
  vtkPolyData* blocks = this->Update();
  ASSERT_EQ(blocks->GetNumberOfCells(), 50 * 6);
  EXPECT_LT(blocks->GetBounds()[1], 102.0); // the incline ends at 100 m
  double before = 0.0;
  int different = 0;
  for (vtkIdType cell = 0; cell < blocks->GetNumberOfCells(); cell += 6)
  {
    const double volume = value(blocks->GetCellData(), "Volume", cell);
    EXPECT_GE(volume, 0.1 * (1 - 1e-12));
    EXPECT_LE(volume, 10.0 * (1 + 1e-12));
    different += volume != before;
    before = volume;
  }
  EXPECT_EQ(different, 50);
  // Drawn once: the simulation draws again only if it is told to.
  EXPECT_EQ(value(blocks->GetCellData(), "VolumeLaw"), 0);
  this->Source->RedrawVolumeOn();
  vtkCellData* data = this->Update()->GetCellData();
  EXPECT_EQ(value(data, "VolumeLaw"), vtkRockBlockSource::POWER_LAW);
  EXPECT_EQ(value(data, "VolumeParameters", 0, 2), 0.1);
  EXPECT_EQ(value(data, "VolumeParameters", 0, 4), 0.5);
  this->Source->SetMaximumRocks(49);
  EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
  this->ExpectOneError({ "50 rocks", "MaximumRocks", "49" });
}

TEST_F(TestRockBlockSource, HeightsWithoutAUnitOnASlopeInFeetAreNoted)
{
  vtkNew<vtkDEMToCFESource> slope;
  slope->SetFileName(this
                       ->WriteFile("slope.txt",
                         "north: 30\nsouth: 0\neast: 30\nwest: 0\nrows: 3\ncols: 3\nmultiplier: "
                         "0.3048\n300 300 300\n200 200 200\n100 100 100\n")
                       .c_str());
  this->Source->SetInputConnection(1, slope->GetOutputPort());
  this->Source->SetFileName(this->WriteFile("rocks.csv", "x,y,z\n15,15,230\n").c_str());
  vtkPolyData* blocks = this->Update();
  ASSERT_GT(blocks->GetNumberOfCells(), 0);
  auto* notes = vtkStringArray::SafeDownCast(blocks->GetFieldData()->GetAbstractArray("Notes"));
  ASSERT_TRUE(notes);
  std::string all;
  for (vtkIdType k = 0; k < notes->GetNumberOfValues(); ++k)
  {
    all += std::string(notes->GetValue(k)) + "\n";
  }
  EXPECT_NE(all.find("rocks.csv, row 1: its field \"z\" of 230 says no unit"), std::string::npos)
    << all;
}

TEST_F(TestRockBlockSource, BadValuesOfSources)
{
  const auto refused = [this](const std::vector<std::string>& words)
  {
    EXPECT_EQ(this->Update()->GetNumberOfCells(), 0);
    this->ExpectOneError(words);
  };
  this->Source->SetAmount(0);
  refused({ "Amount is 0" });
  this->Source->SetAmount(1);
  this->Source->SetIntensity(-1.0);
  refused({ "Intensity is -1" });
  this->Source->SetIntensity(0.0);
  this->Source->SetSlopeThreshold(30.0);
  refused({ "SlopeThreshold is 30", "Terrain" });
  this->Source->SetSlopeThreshold(90.0);
  refused({ "SlopeThreshold is 90" });
  this->Source->SetSlopeThreshold(0.0);
  this->Source->SetReleaseHeight(-1.0);
  refused({ "ReleaseHeight is -1" });
  this->Source->SetReleaseHeight(0.0);
  this->Source->PlaceOnGroundOn();
  refused({ "PlaceOnGround", "Terrain" });
  this->Source->PlaceOnGroundOff();
  this->Source->SetShapeMix("cube;ball");
  refused({ "\"ball\"" });
  this->Source->SetShapeMix("");
  this->Source->SetVolumeLaw(5);
  refused({ "VolumeLaw is 5" });
  this->Source->SetVolumeLaw(vtkRockBlockSource::UNIFORM);
  this->Source->SetVolumeMaximum(0.05);
  refused({ "VolumeMaximum is 0.05", "0.1" });
  this->Source->SetVolumeMaximum(10.0);
  this->Source->SetMaterial(8);
  refused({ "Material is 8" });
  this->Source->SetMaterial(0);
  this->Source->SetAttitudeLaw(4);
  refused({ "AttitudeLaw is 4" });
  this->Source->SetAttitudeLaw(0);
  this->Source->SetHorizontalDeviation(std::nan(""));
  refused({ "HorizontalDeviation is nan" });
  this->Source->SetHorizontalDeviation(0.0);
  this->Source->SetSeed(-1);
  refused({ "Seed is -1" });
}

TEST_F(TestRockBlockSource, PrintSelfNamesEveryProperty)
{
  std::ostringstream text;
  this->Source->Print(text);
  for (const char* name :
    { "Shape", "Volume", "Lengths", "ShapeFileName", "ShapeFileMode", "ScaleToVolume", "Center",
      "Orientation", "Velocity", "AngularVelocity", "Density", "YoungModulus", "PoissonRatio",
      "FileName", "TargetCRS", "FirstBlockId", "ShapeMix", "VolumeLaw", "VolumeDeviation",
      "VolumeMinimum", "VolumeMaximum", "VolumeExponent", "Material", "MaterialName", "Amount",
      "Intensity", "SlopeThreshold", "PlaceOnGround", "ReleaseHeight", "HorizontalDeviation",
      "VerticalDeviation", "AttitudeLaw", "AttitudeDeviation", "RedrawVolume", "Seed",
      "MaximumRocks", "SourceName", "FirstSourceId" })
  {
    EXPECT_NE(text.str().find(std::string(name) + ":"), std::string::npos) << name;
  }
}
