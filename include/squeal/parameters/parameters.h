// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/parameters/accuracy_goal.h>
#include <squeal/parameters/analysis.h>
#include <squeal/parameters/designs.h>
#include <squeal/parameters/geometry.h>
#include <squeal/parameters/given_system.h>
#include <squeal/parameters/materials.h>
#include <squeal/parameters/contact.h>
#include <squeal/parameters/operation.h>
#include <squeal/parameters/reduction.h>
#include <squeal/parameters/robustness.h>
#include <squeal/parameters/sensitivity.h>
#include <squeal/parameters/sliding.h>
#include <squeal/parameters/study.h>
#include <squeal/parameters/sweep.h>
#include <squeal/parameters/updating.h>

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace Squeal
{
  struct Parameters
  {
    const Study             *study = studies().front();
    AccuracyGoal             goal  = AccuracyGoal::as_given;
    std::vector<std::string> replaced; ///< parameters whose values were replaced by the accuracy goal
    GivenSystemParameters    system;   ///< system file that replaces geometry, materials and contact
    GeometryParameters       geometry;
    MaterialParameters       materials;
    DiscretizationParameters discretization;
    ContactParameters        contact;
    OperationParameters      operation;
    SlidingParameters        sliding;
    DampingParameters        damping;
    ReductionParameters      reduction;
    SweepParameters          sweep;
    SensitivityParameters    sensitivity;
    IngredientsParameters    ingredients;
    AccuracyStudyParameters  accuracy;
    DesignParameters         designs;
    SearchParameters         search;
    RobustnessParameters     robustness;
    UpdatingParameters       updating;
    SolverParameters         solvers;
    OutputParameters         output;

    void declare(Declarations &declarations);

    /**
     * Reads a parameter file, applies the overrides "Section/Name=value" and the settings of Accuracy, and checks all values and
     * combinations. Throws FileError or ParameterError. The message suggests the nearest known name for an unknown name, and lists the
     * accepted values for an invalid value.
     */
    static Parameters read(const std::string &file, const std::vector<std::string> &overrides);

    /// Changes the value of a parameter as a function of its current value, without checking combinations. Throws a ParameterError that
    /// names @p where if the parameter does not exist or the value is invalid.
    void set(const std::string &path, const std::string &where, const std::function<std::string(const std::string &)> &new_value);

    /// Writes a parameter file with all values, optionally with documentation and accepted values.
    void print(std::ostream &stream, bool with_documentation) const;

    /// True if the contact state is the steady sliding state.
    bool needs_steady_sliding() const;

    bool has_contact_damping() const;

    /// True if the study computes modes with friction; otherwise the friction coefficient affects only the steady sliding state.
    bool has_friction() const;

    /// True if the rotation terms of the equations of motion vary along the second axis of a map.
    bool maps_rotation() const;

    /// True if this solver computes the complex modes at Operation/Friction coefficient.
    bool solves_by(ComplexSolver solver) const;

    /// True if the contact state or the contact damping requires a positive Operation/Load per side.
    bool uses_load_per_side() const;

    /// Throws ParameterError.
    void check() const;

  private:
    void check_contact_state() const;
    void check_damping_in_band() const;
  };
} // namespace Squeal
