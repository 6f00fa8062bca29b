#pragma once

/// @file
/// The one reader of mesh files: PLY, STL and OBJ. Whatever the bytes are, it gives a mesh or throws
/// FileError that names the file and the place; it never takes memory out of proportion to the file.

#include "mesh/Mesh.h"

#include <string>
#include <string_view>

namespace rockfall
{

/// The bytes of a regular file. Throws FileError.
std::string readFile(const std::string& fileName);

/// Of an extension in small letters with its point: .ply .stl .obj.
bool isMeshExtension(std::string_view extension);

/// Reads a mesh by the extension of its name. Throws FileError, also if there are no points.
Mesh readMesh(const std::string& fileName);
/// The same of bytes in memory; `name` is for messages.
Mesh parseMesh(std::string_view extension, std::string_view bytes, const std::string& name);

/// Throws FileError unless there are points, and faces of at least three of them each.
void checkMesh(const Mesh& mesh, const std::string& name);

/// A reader for each format. Faces may still point at points that are not there.
///@{
Mesh parsePly(std::string_view bytes, const std::string& name);
Mesh parseStl(std::string_view bytes, const std::string& name);
Mesh parseObj(std::string_view bytes, const std::string& name);
///@}

} // namespace rockfall
