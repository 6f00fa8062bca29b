// Classes of ground that cannot be read, or not on this slope: what the message says.
#include "base/errors.h"
#include "groundLayers.h"

using namespace rockfall;
using namespace rockfall::testing;
using namespace rockfall::testing::ground;

TEST(GroundErrors, LayersAndTablesBelongTogether)
{
  const Terrain terrain = slope();
  const std::string layer = halves().write(), rows = table();
  EXPECT_EQ(read({}, terrain).count(), 0);
  EXPECT_TRUE(holds(messageOf<ParameterError>(
                      [&] {
                        read({ layer, "", "" }, terrain);
                      }),
    { "RestitutionLayer", layer, "no RestitutionTable" }));
  EXPECT_TRUE(holds(messageOf<ParameterError>(
                      [&] {
                        read({ "", rows, "" }, terrain, GroundKind::Joint);
                      }),
    { "JointTable", rows, "no JointLayer" }));
  EXPECT_TRUE(holds(messageOf<FileError>(
                      [&] {
                        read({ "/no/such.tif", rows, "" }, terrain);
                      }),
    { "/no/such.tif" }));
  EXPECT_TRUE(holds(messageOf<FileError>(
                      [&] {
                        read({ layer, "/no/such.csv", "" }, terrain);
                      }),
    { "/no/such.csv" }));
}

TEST(GroundErrors, ClassesWithoutARow)
{
  const std::string rows = table();
  std::string layer = halves(1.0, 3.0).write();
  EXPECT_TRUE(
    holds(failure({ layer, rows, "" }), { layer, "class 3", "600045, 5100055", rows, "\"1\"" }));
  layer = polygons(box(west, south, west + 80, south + 60, "\"class\":\"ice\""));
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "row 1", "ice", "class", rows }));
  layer = polygons(box(west, south, west + 80, south + 60, "\"class\":null"));
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "row 1", "class", "empty" }));
}

TEST(GroundErrors, ClassesThatAreOnlyAlike)
{
  const std::string rows = table("class,rv\n20230000001,0.9\n1500,0.5\n1,0.4\n");
  const auto layer = [](const std::string& value)
  { return polygons(box(west, south, west + 80, south + 60, "\"class\":" + value)); };
  EXPECT_TRUE(holds(failure({ layer("20230000002"), rows, "" }), { "20230000002", "no row" }));
  EXPECT_TRUE(holds(failure({ layer("\"15E2\""), rows, "" }), { "15E2", "no row" }));
  const Terrain terrain = slope();
  EXPECT_NO_THROW(read({ layer("20230000001"), rows, "" }, terrain));
  EXPECT_NO_THROW(read({ layer("\" 01.0\""), rows, "" }, terrain));
  // A polygon that nobody could read is no polygon less.
  const std::string broken =
    writeFile("broken.csv", "WKT,class\n\"POLYGON((600000 5100000,600080 5100000\",1\n");
  EXPECT_TRUE(holds(failure({ broken, rows, "" }), { broken, "row 1", "no geometry" }));
}

TEST(GroundErrors, ColumnsThatMustFitEachOther)
{
  const std::string layer = halves().write();
  std::string rows = table("class,rv,ground_deviation,ground_length\n1,0.9,0,0\n2,0.8,0.4,0\n");
  EXPECT_TRUE(holds(failure({ layer, rows, "" }),
    { rows + ", row 2", "\"ground_length\" is 0 m", "where \"ground_deviation\" is 0.4" }));
  rows = table("class,rv,me,mu_min,mu_max\n1,0.9,15,0.9,0.6\n2,0.8,15,0.5,2\n");
  EXPECT_TRUE(holds(failure({ layer, rows, "" }),
    { rows + ", row 1", "\"mu_min\" is 0.9", "\"mu_max\", which is 0.6" }));
}

TEST(GroundErrors, LayersElsewhere)
{
  const std::string rows = table();
  RawRaster raster = halves();
  raster.affine[3] += 1000.0;
  std::string layer = raster.write();
  EXPECT_TRUE(holds(failure({ layer, rows, "" }),
    { layer, "does not overlap", "5101000 ... ", "5100000 ... 5100060", "EPSG:32632" }));
  layer = polygons(box(west + 500, south, west + 580, south + 60, "\"class\":1"));
  EXPECT_TRUE(
    holds(failure({ layer, rows, "" }), { layer, "does not overlap", "600500 ... 600580" }));
}

TEST(GroundErrors, TextGridsThatGdalFillsWithZeros)
{
  const std::string corner = "xllcorner 600000\nyllcorner 5100000\n";
  const std::string rows = table("class,rv\n0,0.1\n1,0.5\n2,0.9\n");
  std::string layer = textClasses(corner, "1 1 rock 1 2 2 2 2");
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "\"rock\" in row 1, column 3" }));
  layer = writeAscii({ "1 1 1 1 2 2 2 2", "1 1 1 1 2" }, 8, corner);
  EXPECT_TRUE(holds(messageOf<FileError>(
                      [&] {
                        read({ layer, rows, "" }, slope());
                      }),
    { layer, "13 numbers", "8 x 2 = 16" }));
  layer =
    writeAscii({ "NA 1 1 1 2 2 2 2", "1 1 1 1 2 2 2 2" }, 8, corner, "10", "NODATA_value NA\n");
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "word for nodata" }));
}

TEST(GroundErrors, LayersOfTheWrongKind)
{
  const std::string rows = table();
  std::string layer =
    polygons("{\"type\":\"Feature\",\"properties\":{\"class\":1},\"geometry\":{\"type\":\"Point\","
             "\"coordinates\":[600010,5100010]}}");
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "row 1", "POINT", "polygons" }));
  layer = polygons(box(west, south, west + 80, south + 60, "\"geology\":1"));
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "class", "geology" }));
  EXPECT_TRUE(holds(failure({ layer, rows, "soil" }), { layer, "soil", "geology" }));
  RawRaster raster = halves();
  raster.georeferenced = false;
  layer = raster.write();
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "georeferencing" }));
  layer = polygons(box(west, south, west + 80, south + 60, "\"class\":1,\"Class\":2"));
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "two columns \"class\"", "\"Class\"" }));
  EXPECT_TRUE(holds(failure({ layer, rows, "CLASS" }), { layer, "two columns" }));
  layer = polygons("");
  EXPECT_TRUE(holds(failure({ layer, rows, "" }), { layer, "no polygon" }));
}

TEST(GroundErrors, TablesNameRowFieldAndValue)
{
  const std::string layer = halves().write();
  const struct
  {
    const char* rows;
    std::vector<std::string> parts;
    GroundKind kind = GroundKind::Restitution;
  } cases[] = {
    { "class,rv\n", { "no row" } },
    { "kind,rv\n1,0.5\n", { "class", "kind" } },
    { "class,rv\n1,1.5\n2,0.5\n", { "row 1", "rv", "1.5", "0 to 1" } },
    { "class,rv\n1,0.5\n2,-0.1\n", { "row 2", "rv", "-0.1" } },
    { "class,rv\n1,0.5\n2,nan\n", { "row 2", "rv", "nan" } },
    { "class,rv\n1,0.5\n2,hard\n", { "row 2", "rv", "hard", "not a number" } },
    { "class;rv\n1;0,5\n2;0,6\n", { "row 1", "rv", "0,5", "decimal sign is a point" } },
    { "class,rv\n1,0,5\n2,0,6\n", { "row 1", "3 fields" } },
    { "class,rv\n1,0.5\n2,\n", { "row 2", "rv", "empty", "preset" } },
    { "class,name\n1,rock\n2,talus\n", { "row 1", "rv", "missing" } },
    { "class,rv\n1,0.5\n1.0,0.6\n", { "row 2", "class \"1\"", "row 1" } },
    { "class,rv\n1,0.5\n,0.6\n", { "row 2", "class", "empty" } },
    { "class,rv,rv_deviation\n1,0.5,2\n2,0.5,0\n", { "row 1", "rv_deviation", "2" } },
    { "class,rv,model\n1,0.5,bouncy\n2,0.5,0\n", { "row 1", "model", "bouncy" } },
    { "class,rv,rt\n1,0.5,1.2\n2,0.5,0\n", { "row 1", "rt", "1.2" } },
    { "class,rv,speed\n1,0.5,0\n2,0.5,1\n", { "row 1", "speed", "0" } },
    { "class,rv,preset\n1,0.5,cheese\n2,0.5,\n", { "row 1", "preset", "cheese", "talus" } },
    { "class,phi\n1,30\n2,90\n", { "row 2", "phi", "90", "0 to 89" }, GroundKind::Joint },
    { "class,phi\n1,30\n2,\n", { "row 2", "phi", "empty" }, GroundKind::Joint },
    { "class,phi,phi_deviation\n1,30,-1\n2,30,0\n", { "row 1", "phi_deviation", "-1" },
      GroundKind::Joint },
    { "class,phi,cohesoin\n1,30,5\n2,30,0\n", { "\"cohesoin\"", "\"cohesion\"" },
      GroundKind::Joint },
    { "class,rv,rv_deviatoin\n1,0.5,0\n2,0.5,0\n", { "\"rv_deviatoin\"", "\"rv_deviation\"" } },
    { "class,phi,coh\n1,30,5\n2,30,0\n", { "\"coh\" is not read", "\"cohesion\"" },
      GroundKind::Joint },
    { "class,rv,me_mn\n1,0.5,10\n2,0.5,0\n", { "\"me_mn\" is not read", "\"me\"" } },
    { "class,rv,scar_faktor\n1,0.5,1\n2,0.5,0\n", { "\"scar_faktor\"", "\"scar_factor\"" } },
    { "class,rv,RV\n1,0.5,0.6\n2,0.5,0.6\n", { "two columns \"rv\"", "\"RV\"" } },
    { "class,rv,class\n1,0.5,2\n2,0.5,1\n", { "two columns \"class\"" } },
    { "class,rv,rn\n1,0.5,0.5\n2,0.5,0.6\n", { "row 2", "\"rv\" is 0.5", "\"rn\"", "0.6" } },
    { "class,phi,cohesion\n1,30,-5\n2,30,0\n", { "row 1", "cohesion", "-5" }, GroundKind::Joint },
  };
  for (const auto& c : cases)
  {
    const std::string rows = table(c.rows);
    const std::string message = failure({ layer, rows, "" }, c.kind);
    EXPECT_TRUE(holds(message, { rows })) << c.rows;
    EXPECT_TRUE(holds(message, c.parts)) << c.rows;
  }
  std::string many = "class,rv\n";
  for (int k = 1; k <= 256; ++k)
  {
    many += std::to_string(k) + ",0.5\n";
  }
  EXPECT_TRUE(holds(failure({ layer, table(many), "" }), { "row 256", "255" }));
}

TEST(GroundErrors, TerrainRefusesWhatIsNotItsOwn)
{
  Terrain terrain = slope();
  MaterialClasses classes;
  classes.names = { "rock" };
  classes.materials = { {} };
  auto cells = std::make_shared<std::vector<std::uint8_t>>(47, 1);
  classes.cells = *cells;
  classes.owner = cells;
  EXPECT_TRUE(holds(
    messageOf<DataError>([&] { terrain.setJointClasses(classes); }), { "joint", "47", "48" }));
  cells->assign(48, 2);
  classes.cells = *cells;
  EXPECT_TRUE(
    holds(messageOf<DataError>([&] { terrain.setJointClasses(classes); }), { "number 2", "1" }));
  cells->assign(48, 1);
  classes.materials[0].frictionAngle = 2.0;
  EXPECT_TRUE(holds(messageOf<ParameterError>([&] { terrain.setJointClasses(classes); }),
    { "rock", "FrictionAngle" }));
}
