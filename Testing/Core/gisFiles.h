#pragma once

/// @file
/// Small rasters and tables, written as text and raw numbers without any help from GDAL, so that
/// what the readers make of them can be told beforehand.

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <locale>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

namespace rockfall::testing
{

/// A folder of this process in the temporary one, which goes with it.
class ScratchFolder
{
public:
  ScratchFolder()
    : path_(::testing::TempDir() + "rockfall.XXXXXX")
  {
    EXPECT_NE(mkdtemp(path_.data()), nullptr) << path_;
    path_ += "/";
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder()
  {
    std::error_code stays;
    std::filesystem::remove_all(path_, stays);
  }
  const std::string& path() const { return path_; }

private:
  std::string path_; ///< Ends in a slash.
};

/// A file of this test; its name holds the test's.
inline std::string pathOf(const std::string& name)
{
  static const ScratchFolder folder;
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  return folder.path() + info->test_suite_name() + "_" + info->name() + "_" + name;
}

constexpr double foot = 0.3048, surveyFoot = 1200.0 / 3937.0; // m

inline std::string joined(const std::vector<std::string>& notes)
{
  std::string all;
  for (const std::string& note : notes)
  {
    all += note + "\n";
  }
  return all;
}

inline std::string writeFile(const std::string& name, const std::string& content)
{
  const std::string path = pathOf(name);
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

/// Without its folder, as a file beside it has to name it: GDAL 3.13 reads raw numbers no other way.
inline std::string nameOf(const std::string& path)
{
  return path.substr(path.find_last_of('/') + 1);
}

/// Text of a number that no locale changes.
inline std::string exactText(double value)
{
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(17);
  text << value;
  return text.str();
}

/// A raster of any geotransform: raw numbers and a VRT header beside them.
struct RawRaster
{
  int columns = 0;
  int rows = 0;
  std::array<double, 6> affine{}; ///< GDAL's order.
  std::string crs;                ///< "EPSG:32632", WKT; empty for none.
  std::vector<double> values;     ///< In the order of the file.
  std::string type = "Float64";   ///< Float64, Float32, Int16, Byte or CFloat32.
  std::string band = "";          ///< More XML elements of the band, e.g. <Scale>.
  std::string dataset = "";       ///< More XML elements of the dataset, e.g. a mask.
  bool georeferenced = true;

  /// Values of a function of the pixel centres' coordinates.
  void fill(const std::function<double(double, double)>& height)
  {
    values.clear();
    for (int row = 0; row < rows; ++row)
    {
      for (int column = 0; column < columns; ++column)
      {
        values.push_back(height(affine[0] + (column + 0.5) * affine[1] + (row + 0.5) * affine[2],
          affine[3] + (column + 0.5) * affine[4] + (row + 0.5) * affine[5]));
      }
    }
  }

  std::string write(const std::string& name = "raster") const
  {
    std::string bytes;
    const auto put = [&bytes](auto value)
    { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    for (const double value : values)
    {
      type == "Float64"   ? put(value)
        : type == "Int16" ? put(std::int16_t(value))
        : type == "Byte"  ? put(std::uint8_t(value))
                          : put(float(value));
      if (type == "CFloat32")
      {
        put(0.0f);
      }
    }
    const std::size_t size = bytes.size() / values.size();
    const std::string raw = writeFile(name + ".raw", bytes);

    std::string xml = "<VRTDataset rasterXSize=\"" + std::to_string(columns) + "\" rasterYSize=\"" +
      std::to_string(rows) + "\">";
    xml += crs.empty() ? "" : "<SRS dataAxisToSRSAxisMapping=\"1,2\">" + crs + "</SRS>";
    if (georeferenced)
    {
      xml += "<GeoTransform>";
      for (int i = 0; i < 6; ++i)
      {
        xml += (i ? ", " : "") + exactText(affine[i]);
      }
      xml += "</GeoTransform>";
    }
    xml += "<VRTRasterBand dataType=\"" + type +
      "\" band=\"1\" subClass=\"VRTRawRasterBand\"><SourceFilename relativetoVRT=\"1\">" +
      nameOf(raw) + "</SourceFilename><PixelOffset>" + std::to_string(size) +
      "</PixelOffset><LineOffset>" + std::to_string(size * columns) +
      "</LineOffset><ByteOrder>LSB</ByteOrder>" + band + "</VRTRasterBand>" + dataset +
      "</VRTDataset>";
    return writeFile(name + ".vrt", xml);
  }
};

/// 3 columns, 2 rows, cells of 10 m, in UTM zone 32.
inline RawRaster smallRaster()
{
  RawRaster raster;
  raster.columns = 3;
  raster.rows = 2;
  raster.affine = { 600000.0, 10.0, 0.0, 5100020.0, 0.0, -10.0 };
  raster.crs = "EPSG:32632";
  raster.values = { 1.0, 2.0, 3.0, 4.0, 5.0, 6.0 };
  return raster;
}

/// An ESRI ASCII grid of 10 m cells; `rows` are lines of numbers, the northern one first.
inline std::string writeAscii(const std::vector<std::string>& rows, int columns,
  const std::string& corner = "xllcorner 600000\nyllcorner 5100000\n",
  const std::string& cell = "10", const std::string& nodata = "NODATA_value -9999\n")
{
  std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows.size()) +
    "\n" + corner + "cellsize " + cell + "\n" + nodata;
  for (const std::string& row : rows)
  {
    text += row + "\n";
  }
  return writeFile("grid.asc", text);
}

/// The message of the exception that is expected; also that nothing is printed beside it.
template <class Expected, class Function>
std::string messageOf(Function&& function)
{
  ::testing::internal::CaptureStderr();
  std::string message;
  try
  {
    function();
    ADD_FAILURE() << "nothing was thrown";
  }
  catch (const Expected& error)
  {
    message = error.what();
  }
  catch (const std::exception& error)
  {
    ADD_FAILURE() << "another exception was thrown: " << error.what();
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  return message;
}

inline ::testing::AssertionResult holds(
  const std::string& text, const std::vector<std::string>& parts)
{
  for (const std::string& part : parts)
  {
    if (text.find(part) == std::string::npos)
    {
      return ::testing::AssertionFailure() << "\"" << part << "\" is not in \"" << text << "\"";
    }
  }
  return ::testing::AssertionSuccess();
}

/// Decimal commas, for C++ streams in any case and for the C library if such a locale is installed.
class CommaLocale
{
public:
  CommaLocale()
    : before_(std::locale::global(std::locale(std::locale(), new Comma)))
  {
    for (const char* name : { "de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "it_IT.UTF-8" })
    {
      if (std::setlocale(LC_ALL, name))
      {
        break;
      }
    }
  }
  ~CommaLocale()
  {
    std::setlocale(LC_ALL, "C");
    std::locale::global(before_);
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

private:
  struct Comma : std::numpunct<char>
  {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale before_;
};

} // namespace rockfall::testing
