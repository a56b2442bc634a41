// SPDX-License-Identifier: GPL-3.0-or-later

#include <squeal/base/installation.h>

#include <system_error>

namespace Squeal
{
  namespace fs = std::filesystem;

  namespace
  {
    Installation found()
    {
      std::error_code    problem;
      const fs::path     folder    = fs::read_symlink("/proc/self/exe", problem).parent_path();
      const Installation installed = {(folder / SQUEAL_INSTALLED_GEOMETRIES).lexically_normal(),
                                      (folder / SQUEAL_INSTALLED_MESHER).lexically_normal()};
      if (!problem && fs::exists(installed.mesher, problem))
        return installed;
      return {SQUEAL_SOURCE_GEOMETRIES, SQUEAL_BUILT_MESHER};
    }
  } // namespace

  const Installation &installation()
  {
    static const Installation ours = found();
    return ours;
  }
} // namespace Squeal
