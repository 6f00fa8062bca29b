/// @file
/// HDF5 (netCDF-4) and Zarr name other files in more ways than one; they are refused unless what
/// they name is beside them.

#include "base/errors.h"
#include "gis/base/externalReferences.h"
#include "gis/base/hdf5References.h"
#include "gis/raster/raster.h"
#include "gisFiles.h"

#include <hdf5.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace rockfall
{

namespace
{

using namespace rockfall::testing;

/// A file of a folder of its own, which `fill` puts something into.
std::string hdf5File(const std::string& name, const std::function<void(hid_t)>& fill)
{
  const std::string folder = pathOf("folder");
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/" + name;
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  fill(file);
  H5Fclose(file);
  return path;
}

/// A dataset z of 4 by 4 heights.
void addHeights(hid_t file, hid_t how = H5P_DEFAULT)
{
  const hsize_t size[] = { 4, 4 };
  const hid_t space = H5Screate_simple(2, size, nullptr);
  const hid_t heights =
    H5Dcreate2(file, "z", H5T_NATIVE_FLOAT, space, H5P_DEFAULT, how, H5P_DEFAULT);
  if (how == H5P_DEFAULT)
  {
    const float values[16] = { 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16 };
    H5Dwrite(heights, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  }
  H5Dclose(heights);
  H5Sclose(space);
}

std::string linked(const std::string& to)
{
  return hdf5File("linked.h5",
    [&](hid_t file)
    {
      const hid_t group = H5Gcreate2(file, "a", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      H5Lcreate_external(to.c_str(), "/z", group, "z", H5P_DEFAULT, H5P_DEFAULT);
      H5Gclose(group);
    });
}

/// Numbers that are stored in another file.
std::string storedIn(const std::string& name)
{
  return hdf5File("stored.h5",
    [&](hid_t file)
    {
      const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
      H5Pset_external(how, name.c_str(), 0, 64);
      addHeights(file, how);
      H5Pclose(how);
    });
}

std::string virtualOf(const std::string& name)
{
  return hdf5File("virtual.h5",
    [&](hid_t file)
    {
      const hsize_t size[] = { 4, 4 };
      const hid_t space = H5Screate_simple(2, size, nullptr);
      const hid_t how = H5Pcreate(H5P_DATASET_CREATE);
      H5Pset_virtual(how, space, name.c_str(), "/z", space);
      addHeights(file, how);
      H5Pclose(how);
      H5Sclose(space);
    });
}

/// Empty if the file is read.
std::string refusalOf(const std::string& name)
{
  try
  {
    readRaster(name);
    return {};
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

TEST(Hdf5References, areFoundInAllTheirForms)
{
  EXPECT_EQ(gis::hdf5References(linked("other.h5")), std::vector<std::string>{ "other.h5" });
  EXPECT_EQ(
    gis::hdf5References(storedIn("numbers.raw")), std::vector<std::string>{ "numbers.raw" });
  EXPECT_EQ(gis::hdf5References(virtualOf("v.h5")), std::vector<std::string>{ "v.h5" });
  const std::string plain = hdf5File("plain.h5", [](hid_t file) { addHeights(file); });
  EXPECT_EQ(gis::hdf5References(plain), std::vector<std::string>{});
  EXPECT_TRUE(gis::isHdf5(plain));
  EXPECT_FALSE(gis::isHdf5(writeFile("a.txt", "\x89HDF but no more")));
  EXPECT_FALSE(gis::isHdf5(pathOf("folder")));
  EXPECT_FALSE(gis::isHdf5("/dev/zero"));
}

TEST(Hdf5References, areRefusedWhereTheyLeadElsewhere)
{
  for (const char* name : { "/etc/hostname", "../../../../../../../../../etc/hostname" })
  {
    for (const std::string& path : { linked(name), storedIn(name), virtualOf(name) })
    {
      EXPECT_TRUE(holds(refusalOf(path), { path, name, "not beside it", "AllowReferences" }));
      // Under the names of what is in the file.
      EXPECT_TRUE(holds(refusalOf("HDF5:\"" + path + "\"://z"), { name, "not beside it" }));
      EXPECT_TRUE(holds(refusalOf("NETCDF:" + path + ":z"), { name, "not beside it" }));
      const AllowReferences allow(true);
      EXPECT_EQ(refusalOf(path).find("AllowReferences"), std::string::npos);
    }
  }
  EXPECT_TRUE(holds(refusalOf(virtualOf("http://127.0.0.1:9/a.h5")), { "not beside it" }));
}

TEST(Hdf5References, areFollowedBesideTheFile)
{
  hdf5File("other.h5", [](hid_t file) { addHeights(file); });
  for (const std::string& path : { linked("other.h5"), virtualOf("other.h5") })
  {
    EXPECT_EQ(refusalOf(path).find("AllowReferences"), std::string::npos) << path;
  }
  // Of what is beside it, too, all must be there.
  hdf5File("other.h5",
    [](hid_t file)
    { H5Lcreate_external("/etc/hostname", "/z", file, "z", H5P_DEFAULT, H5P_DEFAULT); });
  EXPECT_TRUE(holds(refusalOf(linked("other.h5")), { "/etc/hostname", "not beside it" }));
  // A link to elsewhere is elsewhere.
  const std::string link = pathOf("folder") + "/link.h5";
  std::filesystem::remove(link);
  std::filesystem::create_symlink("/etc/hostname", link);
  EXPECT_TRUE(holds(refusalOf(storedIn("link.h5")), { "not beside it" }));
}

TEST(Hdf5References, ofAFileThatCannotBeLookedIntoAreRefused)
{
  const std::string path = hdf5File("plain.h5", [](hid_t file) { addHeights(file); });
  std::filesystem::resize_file(path, 200);
  EXPECT_TRUE(holds(refusalOf(path), { path, "HDF5" }));
}

TEST(ZarrLinks, leadNowhereElse)
{
  const std::string store = pathOf("store.zarr");
  std::filesystem::remove_all(store);
  std::filesystem::create_directories(store + "/z");
  std::ofstream(store + "/.zgroup") << "{\"zarr_format\":2}";
  std::ofstream(store + "/z/.zarray")
    << "{\"zarr_format\":2,\"shape\":[2,2],\"chunks\":[2,2],\"dtype\":\"|u1\",\"compressor\":null,"
       "\"fill_value\":0,\"order\":\"C\",\"filters\":null}";
  std::ofstream(store + "/z/0.0") << "\x01\x02\x03\x04";
  EXPECT_EQ(refusalOf(store).find("AllowReferences"), std::string::npos);
  std::filesystem::remove(store + "/z/0.0");
  std::filesystem::create_symlink("/etc/hostname", store + "/z/0.0");
  EXPECT_TRUE(holds(refusalOf(store), { store, "link 0.0", "AllowReferences" }));
}

} // namespace

} // namespace rockfall
