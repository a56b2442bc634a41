// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/output/table.h>
#include <squeal/reduction/reduced_model.h>
#include <squeal/studies/steps/scene.h>
#include <squeal/system/system_file.h>

namespace Squeal
{
  /// μ of a meshed model as a parameter of a system file, with a range from 0 to 10; fixed if contact nodes or damping depend on μ.
  FileParameter friction_parameter(const Parameters &parameters);

  /// Parameters of the system file of a meshed model; `names` maps parameters of the terms to them.
  struct NamedParameters
  {
    std::vector<FileParameter>         parameters;
    std::map<std::string, std::string> names;

    /// Adds a parameter of the terms under a unique name; parameters with the same description are merged.
    void name(const std::string &of_terms, FileParameter parameter);
  };

  /// μ and, without steady sliding and modal damping, the nonzero constants of materials, mounts, contact springs and rotation that are
  /// factors of terms, with ranges of 0.01 to 100 times their values. With contact damping, the rotation speed is fixed.
  NamedParameters named_parameters(const Linearisation &linearisation, const FileParameter &friction, const Parameters &parameters);

  /// Parameters fixed at these values.
  std::vector<FileParameter> fixed(std::vector<FileParameter> parameters, const ParameterValues &values);

  /// A monomial with renamed parameters; parameters with an empty new name are replaced by one.
  Coefficient in_names(const Coefficient &monomial, const std::map<std::string, std::string> &names);

  /// Positions of the nodes that are not clamped, and their displacements by the free dofs of the bodies. Collective.
  ShapePoints displacements_of_nodes(const Model &model);

  /// Writes the coupled system of a mesh as a system file in a folder of the results, as a step of the run: its terms with
  /// named_parameters(), the bodies as groups of dofs, and the nodes that are not clamped as points. Does nothing unless
  /// `Output/Write system = full`.
  void write_scene_system(const Linearisation &linearisation, const FileParameter &friction, const std::string &folder, Run &run);

  /// Assembles the model at the given operation and writes its system like the function above, as steps of the run.
  void write_scene_system(Scene &scene, Run &run);

  /// Writes a system file unchanged. Does nothing unless `Output/Write system = full`.
  void write_system_again(const SystemFile &file, const std::string &folder, Run &run);

  /// Data of a reduced model in a system file.
  struct ReductionNotes
  {
    std::vector<FileParameter> parameters; ///< parameters with the ranges in which the model is valid
    std::string                description;
    double                     tolerance; ///< tolerance for relative errors of λ [-]
    Table                      points;    ///< points at which the model was evaluated, with the largest errors of λ
  };

  /// Writes a reduced model with its basis on the dofs of the bodies or of the file, as a step of the run. Collective.
  ///
  /// @param rename replaces the coefficients of the terms; null: keeps them
  void write_reduced_system(const ReducedModel                                    &model,
                            const ReductionNotes                                  &notes,
                            const std::function<Coefficient(const Coefficient &)> &rename,
                            const std::string                                     &folder,
                            Run                                                   &run);
} // namespace Squeal
