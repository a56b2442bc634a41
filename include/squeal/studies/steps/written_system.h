// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/studies/steps/scene.h>
#include <squeal/system/system_file.h>

namespace Squeal
{
  /// μ of a mesh as the parameter of a system file: its range is all that is swept, or its value where contact nodes or damping depend on it.
  FileParameter friction_parameter(const Parameters &parameters);

  /// Positions of the nodes that are not clamped, and their displacements by the free dofs of the bodies. Collective.
  ShapePoints displacements_of_nodes(const Model &model);

  /**
   * The coupled system of a mesh as a system file in a folder of the results, as a step of the run: its terms, the bodies as groups of
   * dofs, and the nodes that move as points.
   *
   * Its parameters are μ and, where the state of contact and modal damping do not depend on them, the numbers of materials, mounts, contact
   * springs and rotation that are factors of terms: those that are not zero, from a hundredth to a hundred times their values.
   *
   * @param friction μ
   */
  void write_scene_system(const Linearisation &linearisation, const FileParameter &friction, const std::string &folder, Run &run);

  /// A system file as it was read.
  void write_system_again(const SystemFile &file, const std::string &folder, Run &run);

  /// Terms of another kind, such as a reduced model, as a step of the run.
  void write_system(const std::vector<Term> &terms,
                    const ParameterValues   &weights,
                    const SystemNotes       &notes,
                    const std::string       &folder,
                    Run                     &run);
} // namespace Squeal
