// Embankments, trees and barriers from layers, and the message of each bad one.

#include "base/errors.h"
#include "geometry/twins.h"
#include "gis/layers/structureLayers.h"
#include "gisFiles.h"
#include "slopes.h"
#include "terrain/Obstacles.h"
#include "terrain/plausible.h"

#include <algorithm>

using namespace rockfall;
using namespace rockfall::testing;

namespace
{

Terrain site()
{
  return makePlane(21, 100.0, 0.0, 0.0, material(0.5, 20.0));
}

std::string messageOf(const StructureFiles& files)
{
  std::vector<std::string> notes;
  try
  {
    readStructures(files, site(), notes);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

const std::string line = "\"LINESTRING(20 50,80 50)\"";
const std::string area = "\"POLYGON((20 20,80 20,80 80,20 80,20 20))\"";

} // namespace

TEST(StructureLayers, StandsAreGrownFromTheirDensity)
{
  StructureFiles files;
  files.trees = writeFile("stands.csv",
    "WKT,stems_ha,dbh_mean,dbh_dev,height,conifers,spacing,rv\n" + area +
      ",500,30,15,24,100,1.5,0.2\n\"POLYGON((90 40,110 40,110 60,90 60,90 40))\",500,40,,20,0,,\n");
  std::vector<std::string> notes;
  const Structures s = readStructures(files, site(), notes);
  std::size_t first = 0;
  for (const Tree& tree : s.trees)
  {
    first += tree.feature == 1 ? 1 : 0;
    EXPECT_EQ(tree.height, tree.feature == 1 ? 24.0 : 20.0);
    EXPECT_EQ(tree.material, tree.feature == 1 ? 1 : 0);
    EXPECT_DOUBLE_EQ(tree.capacity, stemCapacity(tree.diameter, tree.feature == 1 ? 0.9 : 1.7));
    EXPECT_LE(tree.position.x(), 100.0); // half of the second stand is beside the slope
  }
  EXPECT_NEAR(double(first), 180.0, 4.0 * std::sqrt(180.0));
  EXPECT_NEAR(double(s.trees.size() - first), 10.0, 4.0 * std::sqrt(10.0));
  ASSERT_GE(notes.size(), 2u);
  EXPECT_NE(notes[0].find("were drawn from their density"), std::string::npos);
  for (const std::string& note : notes) // thin stems are chance's, not the row's
  {
    EXPECT_EQ(note.find("implausible"), std::string::npos) << note;
  }
  std::vector<std::string> again;
  const Structures same = readStructures(files, site(), again);
  ASSERT_EQ(same.trees.size(), s.trees.size());
  EXPECT_EQ(same.trees.back().diameter, s.trees.back().diameter);
}

TEST(StructureLayers, AreReadInTheUnitsThatAPersonTypes)
{
  StructureFiles files;
  files.embankments = writeFile("dams.csv",
    "WKT,height,crest,width,slope,slope_up,rv,phi\n" + line + ",3,,1.5,3:2,0.5,,\n" + line +
      ",,104,2,1.25,,0.3,35\n");
  files.trees = writeFile("trees.csv",
    "x,y,diameter,height,capacity,factor\n"
    "50,50,30,20,,\n51,52,40,25,80,\n52,50,30,20,,2\n"
    "500,50,30,20,,\n");
  files.barriers = writeFile("nets.csv",
    "WKT,height,capacity,mode,absorbs,braking,residual,fill\n" + line + ",4,500,stop,,5,60,2.5\n" +
      line + ",3,,record,0,,,\n");
  std::vector<std::string> notes;
  const Structures s = readStructures(files, site(), notes);
  ASSERT_EQ(s.embankments.size(), 2u);
  EXPECT_EQ(s.embankments[0].height, 3.0);
  EXPECT_EQ(s.embankments[0].mountainSlope, 0.5);
  EXPECT_EQ(s.embankments[0].valleySlope, 1.5);
  EXPECT_EQ(s.embankments[0].material, 0);
  EXPECT_TRUE(std::isnan(s.embankments[1].height));
  EXPECT_EQ(s.embankments[1].elevation, 104.0);
  ASSERT_EQ(s.embankments[1].material, 1);
  EXPECT_EQ(s.materials[0].restitution, 0.3);
  EXPECT_DOUBLE_EQ(s.materials[0].frictionAngle, radians(35.0));
  EXPECT_EQ(s.materials[0].restitutionDeviation, 0.0);
  EXPECT_EQ(s.materials[0].frictionAngleDeviation, 0.0);
  ASSERT_EQ(s.trees.size(), 3u); // one stands beside the terrain
  ASSERT_EQ(notes.size(), 3u);   // of the ratio, two embankments in one place, the tree
  EXPECT_NE(notes[0].find("3:2 as 1.5 m across per m down (33.7 degrees)"), std::string::npos);
  EXPECT_NE(notes[2].find("1 trees"), std::string::npos);
  EXPECT_DOUBLE_EQ(s.trees[0].diameter, 0.3);
  EXPECT_DOUBLE_EQ(s.trees[0].capacity, stemCapacity(0.3));
  EXPECT_EQ(s.trees[1].capacity, 80e3);
  EXPECT_DOUBLE_EQ(s.trees[2].capacity, 2.0 * stemCapacity(0.3));
  ASSERT_EQ(s.barriers.size(), 2u);
  EXPECT_EQ(s.barriers[0].capacity, 500e3);
  EXPECT_EQ(s.barriers[0].braking, 5.0);
  EXPECT_EQ(s.barriers[0].residual, 0.6);
  EXPECT_EQ(s.barriers[0].room, 2.5);
  EXPECT_FALSE(isLoaded(s.barriers[1]));
  EXPECT_TRUE(s.barriers[1].records);
  EXPECT_FALSE(s.barriers[1].absorbs);
  EXPECT_TRUE(std::isinf(s.barriers[1].capacity));
}

/// Lines among the trees lie: a stem for each piece.
TEST(StructureLayers, LinesOfTreesLie)
{
  StructureFiles files;
  files.trees = writeFile("logs.csv",
    "WKT,diameter,height,capacity,factor,rv\n\"LINESTRING(20 50,30 50,30 58)\",40,,,2,0.3\n"
    "\"LINESTRING(60 20,60 28)\",50,,80,,\nPOINT(50 50),40,20,,,\n");
  std::vector<std::string> notes;
  const Structures s = readStructures(files, site(), notes);
  EXPECT_TRUE(notes.empty());
  ASSERT_EQ(s.trees.size(), 4u);
  EXPECT_EQ(s.trees[1].position, Eigen::Vector2d(30.0, 50.0));
  EXPECT_EQ(s.trees[1].end, Eigen::Vector2d(30.0, 58.0));
  EXPECT_EQ(s.trees[1].feature, 1);
  EXPECT_EQ(s.trees[1].material, 1);
  EXPECT_DOUBLE_EQ(s.trees[1].capacity, 2.0 * stemCapacity(0.4));
  EXPECT_EQ(s.trees[2].capacity, 80e3);
  EXPECT_TRUE(s.trees[2].lies());
  EXPECT_FALSE(s.trees[3].lies());
}

TEST(StructureLayers, AreBroughtToTheTerrainsCoordinates)
{
  GridGeometry g;
  g.columns = g.rows = 21;
  g.cellSize = 5.0;
  g.xOrigin = 600000.0;
  g.yOrigin = 5100000.0;
  g.crs = "EPSG:32632";
  const Terrain terrain(g, std::vector<double>(441, 100.0));
  StructureFiles files;
  // 600050 5100050 in UTM 32N, as longitude and latitude.
  files.trees = writeFile("trees.geojson",
    R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"Point",)"
    R"("coordinates":[10.2937,46.0457]},"properties":{"diameter":30,"height":20}}]})");
  std::vector<std::string> notes;
  try
  {
    const Structures s = readStructures(files, terrain, notes);
    FAIL() << s.trees[0].position.transpose();
  }
  catch (const DataError& error)
  {
    // About 46° N, 10.3° E; the terrain is a hundred metres wide.
    EXPECT_NE(std::string(error.what()).find("does not overlap the terrain: it spans x 60"),
      std::string::npos)
      << error.what();
  }
}

TEST(StructureLayers, BarriersMayReachOverBothEdges)
{
  std::vector<std::string> notes;
  StructureFiles files;
  files.barriers = writeFile("net.csv", "WKT,height\n\"LINESTRING(-20 -15,120 125)\",4\n");
  EXPECT_EQ(readStructures(files, site(), notes).barriers.size(), 1u);
}

TEST(StructureLayers, LocalCoordinatesInFeetBecomeMetres)
{
  StructureFiles files;
  const std::string table = writeFile("trees.csv", "x,y,diameter,height\n50,50,30,20\n");
  const std::size_t first = table.find_last_of('/') + 1;
  const std::string stem = table.substr(first, table.size() - 4 - first);
  files.trees = writeFile("trees.vrt",
    "<OGRVRTDataSource><OGRVRTLayer name=\"trees\"><SrcDataSource>" + table +
      "</SrcDataSource><SrcLayer>" + stem +
      "</SrcLayer><GeometryType>wkbPoint</GeometryType><LayerSRS>LOCAL_CS[\"site\",UNIT[\"foot\","
      "0.3048],AXIS[\"x\",EAST],AXIS[\"y\",NORTH]]</LayerSRS><GeometryField "
      "encoding=\"PointFromColumns\" x=\"x\" y=\"y\"/></OGRVRTLayer></OGRVRTDataSource>");
  std::vector<std::string> notes;
  const Structures read = readStructures(files, site(), notes);
  EXPECT_DOUBLE_EQ(read.trees.at(0).position.x(), 50.0 * 0.3048);
  EXPECT_EQ(
    notes.at(0), files.trees + ": its local coordinates were multiplied by 0.3048 to be metres.");
}

TEST(StructureLayers, TellWhatIsWrong)
{
  struct Case
  {
    int kind; // embankment, tree, barrier
    std::string content, part;
  };
  const std::string dam = "WKT,height,width,slope\n", tree = "x,y,diameter,height\n",
                    net = "WKT,height,capacity\n";
  const Case cases[] = {
    { 0, "WKT,width,slope\n" + line + ",1,1.5\n", "row 1: has no \"height\"" },
    { 0, "WKT,height,slope\n" + line + ",3,1.5\n", "field \"width\" is missing" },
    { 0, "WKT,height,width\n" + line + ",3,1\n", "has no \"slope\"" },
    { 0, dam + line + ",-3,1,1.5\n", "\"height\" is -3" },
    { 0, dam + line + ",nan,1,1.5\n", "\"height\"" },
    { 0, dam + line + ",\"3,5\",1,1.5\n", "\"height\"" },
    { 0, dam + line + ",3,1,steep\n", "\"slope\"" },
    { 0, dam + line + ",3,1,3:0\n", "\"slope\" is \"3:0\"" },
    { 0, dam + line + ",3,1,90\n", "slope of a side is 90" },
    { 0, dam + "\"LINESTRING(20 50,120 50)\",3,1,1.5\n", "no ground" },
    { 0, dam + "\"LINESTRING(2000 50,2120 50)\",3,1,1.5\n", "does not overlap the terrain" },
    { 0, dam + "\"POINT(20 50)\",3,1,1.5\n", "is a POINT, a LINESTRING is needed" },
    { 0, dam + "\"LINESTRING(20 50,20 50)\",3,1,1.5\n", "is a line of one place only" },
    { 0, dam, "has no row" },
    { 1, "x,y,height\n50,50,20\n", "field \"diameter\" is missing" },
    { 1, tree + "50,50,0,20\n", "\"diameter\" is 0" },
    { 1, tree + "50,50,30,-1\n", "\"height\" is -1" },
    { 1, tree + "50,50,3000,20\n", "is it in millimetres?" },
    { 1, tree + "50,50,0.3,20\n", "\"diameter\" is 0.3 cm: is it in metres?" },
    { 1, tree + "50,50,30,2000\n", "height of the tree is 2000" },
    { 1, "diameter,height\n30,20\n", "has no point" },
    { 1, "WKT,diameter,height\n" + area + ",30,20\n", "is a POLYGON, a POINT is needed" },
    { 1, "WKT,diameter\n" + line + ",3000\n", "is it in millimetres?" },
    { 1, "WKT,diameter\n\"LINESTRING(1 1,1 1)\",30\n", "is a line of one place only" },
    { 1, "WKT,diameter\n\"LINESTRING(-5 1,9 1)\",30\n", "none of its 1 trees" },
    { 1, "WKT,height\n" + line + ",20\n", "field \"diameter\" is missing" },
    { 1, "WKT,stems_ha,dbh_mean,dbh_dev,height\n" + area + ",400,30,31,20\n",
      "field \"dbh_dev\" is 31 cm, it must be at most the mean" },
    { 1, "WKT,stems_ha,dbh_mean,height\n" + area + ",400,,20\n", "dbh_mean" },
    { 1, "WKT,stems_ha,dbh_mean,height,spacing\n" + area + ",400,30,20,20\n", "has no room" },
    { 1, "WKT,stems_ha,dbh_mean,height,conifers\n" + area + ",400,30,20,101\n", "0 to 100 %" },
    { 1, tree + "50,50,30;5,20\n", "\"diameter\"" },
    { 1, tree + "-50,50,30,20\n150,50,30,20\n", "none of its 2 trees stands where" },
    { 2, "WKT,capacity\n" + line + ",100\n", "field \"height\" is missing" },
    { 2, net + line + ",4,-5\n", "\"capacity\" is -5" },
    { 2, net + line + ",400,500\n", "\"height\" is 400 m" },
    { 2, net + line + ",4,300000\n", "\"capacity\" is 300000 kJ" },
    { 2, "WKT,height,mode\n" + line + ",4,hold\n", "\"mode\" is \"hold\"" },
    { 2, "WKT,height,capacity_kJ\n" + line + ",4,1000\n",
      "its column \"capacity_kJ\" is not read, and there is none \"capacity\"" },
    { 2, "WKT,height,capcity\n" + line + ",4,1000\n",
      "its column \"capcity\" is not read, and there is none \"capacity\"" },
    { 2, "WKT,height,capaicty\n" + line + ",4,1000\n", "\"capaicty\"" },
    { 2, "WKT,height,capazity\n" + line + ",4,1000\n", "\"capazity\"" },
    { 2, "WKT,height,capacityy\n" + line + ",4,1000\n", "\"capacityy\"" },
    { 2, "WKT,height,cap\n" + line + ",4,1000\n", "\"cap\" is not read" },
    { 2, "WKT,height,Height,capacity\n" + line + ",4,5,1000\n", "two columns \"height\"" },
    { 1, tree.substr(0, tree.size() - 1) + ",Factor [-]\n50,50,30,20,0.5\n", "\"Factor [-]\"" },
    { 2, "WKT,height,absorbs\n" + line + ",4,0.5\n", "\"absorbs\" is 0.5, it must be 1 or 0" },
    { 2, net + "\"LINESTRING(2000 50,2120 50)\",4,100\n", "does not overlap the terrain" },
  };
  for (const Case& c : cases)
  {
    StructureFiles files;
    const std::string path = writeFile("layer.csv", c.content);
    (c.kind == 0 ? files.embankments : c.kind == 1 ? files.trees : files.barriers) = path;
    const std::string message = messageOf(files);
    EXPECT_NE(message.find(c.part), std::string::npos) << c.content << message;
    EXPECT_EQ(message.find(path), 0u) << message;
  }
  StructureFiles files;
  files.trees = "no such file.gpkg";
  EXPECT_NE(messageOf(files).find("no such file.gpkg"), std::string::npos);
}

TEST(StructureLayers, TellColumnsThatAreNotRead)
{
  const std::string line = "\"LINESTRING(20 50,80 50)\"";
  const auto notesOf = [](std::string StructureFiles::*layer, const std::string& content)
  {
    StructureFiles files;
    files.*layer = writeFile("layer.csv", content);
    std::vector<std::string> notes;
    readStructures(files, site(), notes);
    std::string all;
    for (const std::string& note : notes)
    {
      all += note + "\n";
    }
    return all;
  };
  const std::string net = "WKT,height,capacity", dam = "WKT,height,width,slope",
                    tree = "x,y,diameter,height";
  const auto told = [](const std::string& notes, const std::string& list)
  { EXPECT_NE(notes.find("not read " + list + "."), std::string::npos) << notes; };
  told(notesOf(&StructureFiles::barriers,
         net + ",capacity_kj,Energie,MEL (kJ),length\n" + line + ",4,1000,500,500,500,60\n"),
    "are its columns \"capacity_kj\", \"Energie\", \"MEL (kJ)\"");
  told(notesOf(&StructureFiles::embankments, dam + ",Neigung,owner\n" + line + ",3,2,1.5,45,a\n"),
    "is its column \"Neigung\"");
  told(notesOf(&StructureFiles::trees, tree + ",Höhe,species,z\n50,50,35,24,30,oak,800\n"),
    "are its columns \"Höhe\", \"species\"");
  EXPECT_EQ(notesOf(&StructureFiles::trees, tree + ",owner,z\n50,50,35,24,me,800\n"), "");
}

namespace
{

struct Read
{
  Structures structures;
  std::vector<std::string> notes;

  /// How many notes have these words.
  int told(const std::string& words) const
  {
    return int(std::count_if(notes.begin(), notes.end(),
      [&](const std::string& note) { return note.find(words) != std::string::npos; }));
  }
};

Read readTrees(const std::string& rows, const std::string& header = "x,y,diameter,height\n")
{
  Read read;
  StructureFiles files;
  files.trees = writeFile("trees.csv", header + rows);
  read.structures = readStructures(files, site(), read.notes);
  return read;
}

Read readNets(const std::string& rows)
{
  Read read;
  StructureFiles files;
  files.barriers = writeFile("nets.csv", "WKT,height,capacity,mode\n" + rows);
  read.structures = readStructures(files, site(), read.notes);
  return read;
}

Read readDams(const std::string& rows)
{
  Read read;
  StructureFiles files;
  files.embankments = writeFile("dams.csv", "WKT,height,width,slope\n" + rows);
  read.structures = readStructures(files, site(), read.notes);
  return read;
}

} // namespace

TEST(StructureDoubts, TreesThatDoNotGrow)
{
  EXPECT_TRUE(readTrees("50,50,35,24\n60,50,110,24\n").notes.empty()); // slenderness 69 and 22
  // Millimetres, as 3.5 m and 2.8 m; told once.
  const Read thick = readTrees("50,50,350,24\n60,50,280,18\n");
  ASSERT_EQ(thick.notes.size(), 1u);
  EXPECT_EQ(thick.told("2 of 2 diameters of trees look implausible, first feature 1 with 350 cm. "
                       "Stems have 2 to 200 cm: are diameters in cm?"),
    1)
    << thick.notes[0];
  // Inches and feet, heights in decimetres, diameters in decimetres.
  EXPECT_EQ(readTrees("50,50,14,79\n60,50,30,20\n").told("1 of 2 trees look implausible"), 1);
  EXPECT_EQ(readTrees("50,50,12,1.8\n").told("1.8 m high and 12 cm thick"), 1);
  EXPECT_EQ(readTrees("50,50,4,22\n").told("22 m high and 4 cm thick"), 1);
  // Capacities in J and in MJ, beside 194 kJ of 40 cm.
  const std::string own = "x,y,diameter,height,capacity\n";
  EXPECT_TRUE(readTrees("50,50,40,20,300\n", own).notes.empty());
  EXPECT_EQ(readTrees("50,50,40,20,194000\n", own).told("capacities of trees"), 1);
  EXPECT_EQ(readTrees("50,50,40,20,0.194\n", own).told("capacities of trees"), 1);
}

TEST(StructureDoubts, NetsThatNobodySells)
{
  EXPECT_TRUE(readNets(line + ",5,100,\n\"LINESTRING(20 60,80 60)\",6,10000,\n").notes.empty());
  EXPECT_EQ(readNets(line + ",5,3,\n").told("first feature 1 with 3 kJ. Nets are sold for 100"), 1);
  EXPECT_EQ(readNets(line + ",5,30000,\n").told("with 30000 kJ"), 1);
  EXPECT_EQ(readNets(line + ",16,500,\n").told("with 16 m. Nets stand 1 to 12 m high"), 1);
  EXPECT_TRUE(readNets(line + ",25,,record\n").notes.empty());
  // Or that stands no more, or not yet: by its name or a word of it.
  for (const char* column : { "Status", "is_planned", "DateRemoved", "SEL", "rest capacity" })
  {
    Read gone;
    StructureFiles files;
    files.barriers = writeFile("gone.csv",
      std::string("WKT,height,capacity,fid,Shape_Length,") + column + "\n" + line +
        ",5,300,1,60,2031\n");
    gone.structures = readStructures(files, site(), gone.notes);
    EXPECT_EQ(gone.told("not read is its column \"" + std::string(column) + "\"."), 1);
    EXPECT_EQ(gone.notes.size(), 1u) << column;
  }
}

TEST(StructureDoubts, EmbankmentsThatNobodyBuilds)
{
  EXPECT_TRUE(readDams(line + ",5,2,1.5\n").notes.empty());
  EXPECT_EQ(readDams(line + ",0.05,2,1.5\n").told("heights of embankments"), 1);
  // In feet, or of another height reference: 40 m over the ground.
  const auto crest = [](const char* elevation)
  {
    Read read;
    StructureFiles files;
    files.embankments =
      writeFile("crest.csv", "WKT,crest,width,slope\n" + line + "," + elevation + ",2,0.1\n");
    read.structures = readStructures(files, site(), read.notes);
    EXPECT_TRUE(std::isnan(read.structures.embankments[0].height));
    return read.told("heights of embankments");
  };
  EXPECT_EQ(crest("104"), 0);
  EXPECT_EQ(crest("140"), 1);
  EXPECT_EQ(readDams(line + ",0.6,0.02,1.5\n").told("widths of crests"), 1);
  EXPECT_EQ(readDams(line + ",0.6,2,15\n").told("sides of embankments"), 1);
}

TEST(StructureDoubts, RatiosAreNoSteeperThan45Degrees)
{
  for (const char* text : { "1:1.5", "2:3", "3:2", "1.5:1", " 4 : 6 " })
  {
    const Read read = readDams(line + ",5,2," + text + "\n");
    ASSERT_EQ(read.structures.embankments.size(), 1u);
    EXPECT_DOUBLE_EQ(read.structures.embankments[0].mountainSlope, 1.5) << text;
    EXPECT_EQ(read.told("as 1.5 m across per m down (33.7 degrees)"), 1) << text;
    EXPECT_EQ(read.notes.size(), 1u) << text;
  }
  EXPECT_DOUBLE_EQ(readDams(line + ",5,2,1:2\n").structures.embankments.at(0).valleySlope, 2.0);
  EXPECT_DOUBLE_EQ(readDams(line + ",5,2,0.5\n").structures.embankments.at(0).valleySlope, 0.5);
}

TEST(StructureDoubts, LyingStemsThatNoTreeLeaves)
{
  const auto read = [](const std::string& rows) { return readTrees(rows, "WKT,diameter\n"); };
  const std::string stem = "\"LINESTRING(20 50,28 50)\",40\n";
  EXPECT_TRUE(read(stem + "\"LINESTRING(20 51,28 51)\",40\n").notes.empty());
  EXPECT_EQ(read(stem + "\"LINESTRING(28.05 50,20 50)\",40\n")
              .told("1 of 2 lying stems stand within 0.1 m of another one, first features 1 and 2"),
    1);
  EXPECT_EQ(read("\"LINESTRING(20 50,28 50)\",300\n").told("1 of 1 diameters of trees"), 1);
  EXPECT_EQ(read("\"LINESTRING(10 50,90 50)\",40\n").told("are 0.5 to 60 m long"), 1);
  EXPECT_EQ(read("\"LINESTRING(20 50,20.2 50)\",40\n").told("feature 1 with 0.2 m"), 1);
}

TEST(StructureDoubts, TheSameTwice)
{
  const Read stems = readTrees("50,50,40,20\n50.05,50,40,20\n50.1,50,40,20\n60,50,40,20\n");
  EXPECT_EQ(
    stems.told("2 of 4 trees stand within 0.1 m of another one, first features 1 and 2"), 1);
  EXPECT_EQ(readTrees("49.99,49.99,40,20\n50.01,50.01,40,20\n").notes.size(), 1u); // other cells
  EXPECT_TRUE(readTrees("50,50,40,20\n50.11,50,40,20\n").notes.empty());

  const std::string words = "1 of 2 barriers stand within 0.1 m of another one, first features 1 "
                            "and 2";
  EXPECT_EQ(readNets(line + ",5,300,\n" + line + ",4,500,\n").told(words), 1);
  // Backwards, with another corner, beside by 5 cm.
  EXPECT_EQ(
    readNets(line + ",5,300,\n\"LINESTRING(80 50.05,45 50.05,20 50)\",5,300,\n").told(words), 1);
  // Beside by 0.5 m; a line that only records; one that crosses; one that goes on from its end.
  for (const char* other : { "20 50.5,80 50.5)\",5,300,", "20 50,80 50)\",5,300,record",
         "40 20,44 80)\",5,300,", "80 50,99 50)\",5,300," })
  {
    EXPECT_TRUE(readNets(line + ",5,300,\n\"LINESTRING(" + other + "\n").notes.empty()) << other;
  }
  EXPECT_EQ(readDams(line + ",5,2,1.5\n" + line + ",5,2,1.5\n").told("1 of 2 embankments"), 1);
}

TEST(StructureDoubts, ThePartsOfALineThatAreThereTwice)
{
  const auto nets = [](const std::string& second, const std::string& first = line)
  { return readNets(first + ",5,300,\n\"" + second + "\",5,300,\n"); };
  const std::string part = "1 of 2 barriers stand within 0.1 m of another one over a part of their "
                           "length, first feature 2 on feature 1 over ";
  const std::string effect = ". Each takes its capacity there: was something given twice?";
  // Half of it, in reverse, and on beside its end; within it; a longer one that it lies within.
  EXPECT_EQ(nets("LINESTRING(50 50,80 50,80 90)")
              .told(part + "30.1 m, from (50, 50) to (80, 50.1)" + effect),
    1);
  EXPECT_EQ(nets("LINESTRING(50.05 50.05,80 50,80 90)").told("over 30"), 1);
  EXPECT_EQ(nets("LINESTRING(80 20,80 50,50 50,50 20)").told("first feature 2 on feature 1"), 1);
  EXPECT_EQ(
    nets("LINESTRING(65 50,35 50)").told(part + "30 m, from (65, 50) to (35, 50)" + effect), 1);
  EXPECT_EQ(nets("LINESTRING(10 50,90 50)").told("over 60.2 m, from (19.9, 50) to (80.1, 50)"), 1);
  // Of three, the longest; by many short pieces; parts of one feature.
  const std::string half = "\"LINESTRING(20 50,30 50)\",5,300,\n";
  EXPECT_EQ(readNets(half + "\"LINESTRING(45 50,85 50)\",5,300,\n" + line + ",5,300,\n")
              .told("1 of 3 barriers"),
    1);
  EXPECT_EQ(nets("LINESTRING(35 50,36 50.05,37 50,39 49.96,42 50,50 50,65 50)").told("over 30"), 1);
  const std::string parts = "\"MULTILINESTRING((20 50,80 50),(20 60,80 60),(40 60,80 60))\"";
  EXPECT_EQ(
    readNets(parts + ",5,300,\n")
      .told("1 of 3 barriers stand within 0.1 m of another one over a part of their length, "
            "first feature 1 on another part of feature 1 over 40 m"),
    1);
  const std::string same = "\"MULTILINESTRING((20 50,80 50),(80 50,20 50))\"";
  EXPECT_EQ(readNets(same + ",5,300,\n").told("first two parts of feature 1"), 1);
  // Back on itself; a ring and a bend are none.
  EXPECT_EQ(readNets("\"LINESTRING(20 50,80 50,50 50)\",5,300,\n")
              .told("1 of 1 barriers go back on their own line, first feature 1 over 29 m"),
    1);
  for (const char* other : { "20 20,40 20,40 40,20 20", "20 20,20.5 20,20.5 20.5,20.05 20.4" })
  {
    EXPECT_TRUE(readNets("\"LINESTRING(" + std::string(other) + ")\",5,300,\n").notes.empty())
      << other;
  }
  // Points in the wrong order; a corner that is met twice; a loop that a hand draws in passing is none.
  const std::string crossed = "1 of 1 barriers cross their own line, first feature 1 at (50, 50)";
  for (const char* other : { "20 20,80 80,80 20,20 80", "20 20,50 50,80 50,80 80,50 50,40 80" })
  {
    EXPECT_EQ(readNets("\"LINESTRING(" + std::string(other) + ")\",5,300,\n").told(crossed), 1)
      << other;
  }
  for (const char* other :
    { "20 50,50 50,50.5 50.5,50 50.5,50.5 49,80 50", "20 50,80 50,80 80,50 50" })
  {
    EXPECT_EQ(readNets("\"LINESTRING(" + std::string(other) + ")\",5,300,\n").told("cross"), 0)
      << other;
  }
  EXPECT_EQ(
    readDams(line + ",5,2,1.5\n\"LINESTRING(20 50,50 50)\",5,2,1.5\n")
      .told("1 of 2 embankments stand within 0.1 m of another one over a part of their "
            "length, first feature 2 on feature 1 over 30 m, from (20, 50) to (50, 50). The "
            "higher one counts there"),
    1);
}

TEST(StructureDoubts, WhatGoesOnBesideTheSlope)
{
  const auto net = [](const std::string& to, const std::string& mode = "")
  { return readNets("\"LINESTRING(20 50," + to + ")\",5,300," + mode + "\n"); };
  for (const char* mode : { "", "record" })
  {
    EXPECT_EQ(net("180 50", mode)
                .told("1 of 1 barriers go on where the slope has no ground, first "
                      "feature 1 on 80 of 160 m. They hold and record nothing"),
      1);
    EXPECT_TRUE(net("108 50", mode).notes.empty()) << mode; // a border drawn by eye
  }
}

TEST(StructureDoubts, StandsThatCrossThemselves)
{
  StructureFiles files;
  files.trees = writeFile("stands.csv",
    "WKT,stems_ha,dbh_mean,height\n" + area +
      ",500,30,20\n\"POLYGON((20 0,80 19,80 0,20 19,20 0))\",500,30,20\n");
  std::vector<std::string> notes;
  EXPECT_EQ(messageOf<DataError>([&] { readStructures(files, site(), notes); }),
    files.trees +
      ", row 2: geometry is a POLYGON that is not valid: its outline crosses or touches itself");
  files.trees = writeFile("dense.csv", "WKT,stems_ha,dbh_mean,height\n" + area + ",1e9,30,20\n");
  EXPECT_TRUE(messageOf<DataError>(
    [&] {
      readStructures(files, site(), notes);
    }).starts_with(files.trees + ", row 1: the stand has some"));
}

TEST(StructureDoubts, ALargeSurveyTakesNoTime)
{
  // All at one place, and all on one line: a search of pairs would take hours.
  std::vector<Eigen::Vector2d> points(300000, Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(earlierPoints(points).back(), 0);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i].y() = 0.2 * double(i);
  }
  EXPECT_EQ(earlierPoints(points).back(), -1);
  const std::vector<PlanLine> lines(100000, { { 0.0, 0.0 }, { 5.0, 5.0 } });
  EXPECT_EQ(earlierLines(lines).back(), 0);
  // Each within the one before it.
  std::vector<PlanLines> nested;
  for (int k = 0; k < 30000; ++k)
  {
    nested.push_back({ { { 0.0, 0.0 }, { 10000.0 - 0.2 * k, 0.0 } } });
  }
  EXPECT_EQ(sharedStretches(nested).back().earlier, 0);
}

TEST(StructureLayers, TreesBreakUnlessToldNotTo)
{
  EXPECT_DOUBLE_EQ(readTrees("50,50,20,20\n").structures.trees.at(0).capacity, stemCapacity(0.2));
  StructureFiles files;
  files.trees = writeFile("trees.csv", "x,y,diameter,height\n50,50,20,20\n");
  files.treesBreak = false;
  std::vector<std::string> notes;
  EXPECT_TRUE(std::isinf(readStructures(files, site(), notes).trees.at(0).capacity));
}

TEST(StructureLayers, WhatANetHeldNeedsItsCapacity)
{
  const auto expect =
    [](const std::string& columns, const std::string& values, const std::string& words)
  {
    StructureFiles files;
    files.barriers =
      writeFile("loaded.csv", "WKT,height," + columns + "\n" + line + ",4," + values + "\n");
    const std::string message = messageOf(files);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  expect("braking", "5", "\"capacity\"");
  expect("capacity,residual", ",50", "\"residual\"");
  expect("capacity,residual", "500,120", "0 to 100 %");
  expect("fill", "0", "\"fill\"");
}
