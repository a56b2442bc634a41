#include <squeal/studies/paper_scene.h>
#include <squeal/studies/parameter_usage.h>

#include <filesystem>

namespace Squeal
{
  namespace
  {
    /// Parameters that differ from their defaults among those that the @p paths name, "Section/Name" or "Section/".
    std::vector<std::string> changed(const Parameters &parameters, const std::vector<std::string> &paths)
    {
      std::vector<std::string> result;
      for (const std::string &parameter : changed_parameters(parameters))
        for (const std::string &path : paths)
          if (concerns(path, parameter))
            result.push_back(parameter);
      return result;
    }
  } // namespace

  std::vector<std::string> differences_from_paper_scene(const Parameters &parameters)
  {
    std::vector<std::string> result =
      changed(parameters, {"Geometry/Disc inner radius", "Geometry/Disc outer radius", "Geometry/Disc thickness", "Geometry/Pin diameter",
                           "Geometry/Pin height", "Geometry/Top pin radii", "Geometry/Top pin angles", "Geometry/Bottom pin radii",
                           "Geometry/Bottom pin angles", "Disc material/", "Pin material/", "Mounts/"});
    // The shipped geometry, wherever it lies
    if (std::filesystem::path(parameters.geometry.file).filename() != Parameters().geometry.file)
      result.insert(result.begin(), "Geometry/File");
    if (!parameters.sliding.gaps.empty() && parameters.needs_steady_sliding())
      result.emplace_back("Steady sliding/Gaps");
    return result;
  }

  std::vector<std::string> differences_from_paper_operation(const Parameters &parameters)
  {
    // The sense of rotation changes nothing here, and Table 1 has modes both without and with radial dissipation.
    std::vector<std::string> paths = {"Operation/Friction coefficient", "Operation/Rotation speed", "Operation/Gyroscopic forces",
                                      "Operation/Load per side",        "Operation/Friction slope", "Damping/"};
    if (parameters.needs_steady_sliding())
      paths.emplace_back("Steady sliding/Control");
    return changed(parameters, paths);
  }
} // namespace Squeal
