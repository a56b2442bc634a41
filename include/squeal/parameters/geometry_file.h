// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Path of a geometry. A relative name is searched for in the folder of the parameter file, then in the current directory; a name without
   * a directory also among the supplied geometries.
   *
   * Throws MeshError with the searched folders.
   */
  std::string find_geometry(const std::string &name, const std::string &parameter_directory);

  /// True if the geometry is supplied with the program.
  bool is_supplied(const std::string &geometry);

  /// True if the file name is that of a Gmsh script, not of a mesh.
  bool is_script(const std::string &geometry);

  /// A variable that a Gmsh script exports.
  struct GeometryVariable
  {
    std::string name;        ///< name in the script
    std::string value;       ///< value as written in the script
    std::string onelab_name; ///< Name option of DefineNumber; empty if the script uses this name for another value
  };

  /// Text of a Gmsh script, without running it, and of the scripts that it includes by literal names; comments are removed.
  class GeometryScript
  {
  public:
    /// Reads a script; for an unreadable file, the text is empty.
    explicit GeometryScript(const std::string &file);

    /// Variables in DefineConstant[...], and in DefineNumber[...] with the option Name; strings and lists are skipped.
    std::vector<GeometryVariable> variables() const;

    /// The script itself, then existing files in its Include and Merge commands.
    std::vector<std::string> files() const;

    /// File, line and text of the first line that contains one of @p words; an entry may be several words separated by single blanks.
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

  /// A geometry and all included files, to be stored with results.
  struct GeometryCopy
  {
    struct File
    {
      std::string from, to; ///< current path; name in the folder of the copy
    };

    std::vector<File> files; ///< empty for a supplied geometry
    std::string       name;  ///< name of the copy or, if there is none, of the geometry itself
  };

  /// Files to copy for a geometry, and their names. If the geometry includes a file from outside its folder, nothing is copied, because the
  /// copy would not find that file; @p name is then the geometry itself.
  GeometryCopy copy_of(const std::string &geometry);
} // namespace Squeal
