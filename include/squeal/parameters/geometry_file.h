// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Path of a geometry. A relative name is searched for in the folder of the parameter file, then in the current directory; a name without
   * a directory is also searched for among the supplied geometries.
   *
   * Throws a MeshError that lists the searched folders if there is no such file.
   */
  std::string find_geometry(const std::string &name, const std::string &parameter_directory);

  bool is_supplied(const std::string &geometry);

  /// True for a Gmsh script (.geo), false for a mesh.
  bool is_script(const std::string &geometry);

  /// A variable that a Gmsh script exports.
  struct GeometryVariable
  {
    std::string name;
    std::string value;       ///< value as written in the script
    std::string onelab_name; ///< option Name of DefineNumber; empty for DefineConstant
  };

  /// Text, without comments, of a Gmsh script and of the scripts that it includes or merges by literal names; nothing is run.
  class GeometryScript
  {
  public:
    /// Reads a script; for an unreadable file, the text is empty.
    explicit GeometryScript(const std::string &file);

    /// Variables in DefineConstant[...], and in DefineNumber[...] with the option Name; strings and lists are skipped.
    std::vector<GeometryVariable> variables() const;

    /// The script itself, then existing files that its Include and Merge commands name, also indirectly.
    std::vector<std::string> files() const;

    /// File, line and text of the first line that contains one of @p words; each entry may contain several words separated by single
    /// blanks.
    std::optional<std::string> find(const std::vector<std::string> &words) const;

  private:
    struct Part
    {
      std::string file, text; ///< name, and text with the same line numbers as the file
    };

    void read(const std::string &file);

    std::vector<Part>        parts;
    std::vector<std::string> merged; ///< merged files that are not scripts
  };

  /// A geometry and its included and merged files, to be stored with results.
  struct GeometryCopy
  {
    struct File
    {
      std::string from, to; ///< path of the file; name of its copy in the results
    };

    std::vector<File> files; ///< empty for a supplied geometry
    std::string       name;  ///< name of the copy or, if there is none, of the geometry itself
  };

  /// Files to copy for a geometry, and their names. If the geometry includes a file from outside its folder, which a copy would not find,
  /// the name is the geometry itself.
  GeometryCopy copy_of(const std::string &geometry);
} // namespace Squeal
