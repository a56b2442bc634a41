// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/scene.h>
#include <squeal/system/system_file.h>

namespace Squeal
{
  /// μ of a meshed model as a parameter of a system file, with the range of the sweep; a fixed value if contact nodes or damping depend on
  /// it.
  FileParameter friction_parameter(const Parameters &parameters);

  /// Positions of the nodes that are not clamped, and their displacements by the free dofs of the bodies. Collective.
  ShapePoints displacements_of_nodes(const Model &model);

  /**
   * Writes the coupled system of a mesh as a system file in a folder of the results, as a step of the run: its terms, the bodies as groups
   * of dofs, and the free nodes as points.
   *
   * Parameters are μ and, if the contact state and modal damping do not depend on them, the nonzero constants of materials, mounts, contact
   * springs and rotation that are factors of terms, with a range of 0.01 to 100 times their values.
   *
   * @param friction μ
   */
  void write_scene_system(const Linearisation &linearisation, const FileParameter &friction, const std::string &folder, Run &run);

  /// Writes a system file unchanged.
  void write_system_again(const SystemFile &file, const std::string &folder, Run &run);

  /// Writes other terms, such as those of a reduced model, as a step of the run.
  void write_system(const std::vector<Term> &terms,
                    const ParameterValues   &weights,
                    const SystemNotes       &notes,
                    const std::string       &folder,
                    Run                     &run);
} // namespace Squeal
