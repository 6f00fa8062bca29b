#include "gis/base/outputFile.h"

#include "base/errors.h"
#include "base/text/plainText.h"

#include <unistd.h>

#include <filesystem>

namespace rockfall::gis
{

namespace fs = std::filesystem;

namespace
{

fs::path with(const fs::path& path, const std::string& extension)
{
  return fs::path(path).replace_extension(extension);
}

} // namespace

std::string extensionOf(const std::string& fileName)
{
  std::string extension = fs::path(fileName).extension().string();
  if (!extension.empty())
  {
    extension.erase(0, 1);
  }
  return lowerCase(extension);
}

OutputFile::OutputFile(const std::string& fileName, std::vector<std::string> companions)
  : fileName_(fileName)
  , companions_(std::move(companions))
{
  if (fileName.empty())
  {
    throw FileError("No file name was given");
  }
  const fs::path path(fileName);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
  {
    throw FileError(fileName + ": cannot be written, as " + folder.string() + " is no folder");
  }
  if (fs::is_directory(path, error))
  {
    throw FileError(fileName + ": cannot be written, as it is a folder");
  }
  const std::string name =
    path.stem().string() + "." + std::to_string(getpid()) + ".part" + path.extension().string();
  temporary_ = (folder / name).string();
}

OutputFile::~OutputFile()
{
  std::error_code error;
  fs::remove(temporary_, error);
  for (const std::string& extension : companions_)
  {
    fs::remove(with(temporary_, extension), error);
  }
}

void OutputFile::commit()
{
  std::error_code error;
  for (const std::string& extension : companions_)
  {
    // A sidecar of an older file must not stay beside the new one.
    const fs::path made = with(temporary_, extension), final = with(fileName_, extension);
    if (fs::exists(made, error))
    {
      fs::rename(made, final, error);
    }
    else
    {
      fs::remove(final, error);
    }
  }
  fs::rename(temporary_, fileName_, error);
  if (error)
  {
    throw FileError(fileName_ + ": cannot be written: " + error.message());
  }
}

} // namespace rockfall::gis
