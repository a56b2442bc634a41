// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <optional>
#include <string>
#include <vector>

namespace Squeal
{
  /**
   * Where a geometry is. A relative name is looked for beside the parameter file,
   * then in the current directory; one without a directory also among the
   * geometries that come with the program.
   *
   * Throws MeshError saying where it was looked for.
   */
  std::string find_geometry(const std::string &name, const std::string &parameter_directory);

  /// Whether a geometry comes with the program.
  bool is_supplied(const std::string &geometry);

  /// Whether a file name is that of a Gmsh script rather than a mesh.
  bool is_script(const std::string &geometry);

  /// A number that a Gmsh script lets others set.
  struct GeometryVariable
  {
    std::string name;        ///< in the script
    std::string value;       ///< as the script writes it
    std::string onelab_name; ///< of DefineNumber[..., Name "..."]; empty if another value is set by its name
  };

  /// What a Gmsh script says, without running it: the text of the script and of the scripts that it includes by literal names, comments
  /// left out.
  class GeometryScript
  {
  public:
    /// Reads a script; one that cannot be read is empty.
    explicit GeometryScript(const std::string &file);

    /// Variables of DefineConstant[...] and DefineNumber[...], lists and texts left out.
    std::vector<GeometryVariable> variables() const;

    /// The script itself, then the files that it names in Include and Merge and that exist.
    std::vector<std::string> files() const;

    /// File, line and text of the first line with one of the words, or several words one blank apart.
    std::optional<std::string> find(const std::vector<std::string> &words) const;

  private:
    struct Part
    {
      std::string file, text; ///< lines as in the file
    };

    void read(const std::string &file);

    std::vector<Part>        parts;
    std::vector<std::string> merged; ///< files other than scripts
  };

  /// A geometry with all that it includes, to be kept beside results.
  struct GeometryCopy
  {
    struct File
    {
      std::string from, to; ///< path now; name in the copy's folder
    };

    std::vector<File> files; ///< none of a geometry that comes with the program
    std::string       name;  ///< with which the copy, or where there is none the geometry itself, is found again
  };

  /// What to copy of a geometry, and where to. A file that is included from outside the geometry's own folder would not be found from the
  /// copy; then @p name is the geometry itself.
  GeometryCopy copy_of(const std::string &geometry);
} // namespace Squeal
