#include "mesh/meshFile.h"

#include "base/errors.h"
#include "mesh/words.h"

#include <filesystem>
#include <fstream>

namespace rockfall
{

namespace
{

using Parse = Mesh (*)(std::string_view bytes, const std::string& name);

Parse parserOf(std::string_view extension)
{
  const std::pair<std::string_view, Parse> parsers[] = { { ".ply", parsePly }, { ".stl", parseStl },
    { ".obj", parseObj } };
  for (const auto& [of, parse] : parsers)
  {
    if (of == extension)
    {
      return parse;
    }
  }
  return nullptr;
}

} // namespace

std::string readFile(const std::string& fileName)
{
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(fileName, error))
  {
    throw FileError(fileName + ": there is no such file");
  }
  if (!fs::is_regular_file(fileName, error))
  {
    throw FileError(fileName + ": is no file of bytes that could be read");
  }
  const std::uintmax_t size = fs::file_size(fileName, error);
  std::ifstream in(fileName, std::ios::binary);
  std::string bytes;
  if (!error && in)
  {
    bytes.resize(std::size_t(size));
    in.read(bytes.data(), std::streamsize(size));
  }
  if (error || !in)
  {
    throw FileError(fileName + ": cannot be read");
  }
  return bytes;
}

bool isMeshExtension(std::string_view extension)
{
  return parserOf(extension) != nullptr;
}

Mesh parseMesh(std::string_view extension, std::string_view bytes, const std::string& name)
{
  const Parse parse = parserOf(extension);
  if (!parse)
  {
    throw FileError(name + ": the extension " + inQuotes(extension) + " is that of no mesh");
  }
  if (trimmed(bytes).empty())
  {
    throw FileError(name + ": is empty");
  }
  Mesh mesh = parse(bytes, name);
  checkMesh(mesh, name);
  return mesh;
}

void checkMesh(const Mesh& mesh, const std::string& name)
{
  if (mesh.points.empty())
  {
    throw FileError(name + ": has no points, so no shape can be made of it");
  }
  for (std::size_t k = 0; k < mesh.faces.size(); ++k)
  {
    const std::vector<int>& face = mesh.faces[k];
    if (face.size() < 3)
    {
      throw FileError(name + ": face " + std::to_string(k) + " has " + std::to_string(face.size()) +
        " points, at least 3 are needed");
    }
    for (const int point : face)
    {
      if (point < 0 || std::size_t(point) >= mesh.points.size())
      {
        throw FileError(name + ": face " + std::to_string(k) + " refers to point " +
          std::to_string(point) + ", there are " + std::to_string(mesh.points.size()));
      }
    }
  }
}

Mesh readMesh(const std::string& fileName)
{
  const std::string extension = lowerCase(std::filesystem::path(fileName).extension().string());
  return parseMesh(extension, readFile(fileName), fileName);
}

} // namespace rockfall
