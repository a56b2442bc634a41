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
  /// Everything a run depends on; a plain value once read.
  struct Parameters
  {
    const Study             *study = studies().front(); ///< the question
    AccuracyGoal             goal  = AccuracyGoal::as_given;
    std::vector<std::string> replaced; ///< parameters that were given other values than those that the goal asks for
    GivenSystemParameters    system;   ///< in the place of geometry, materials and contact
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

    /// Declares every parameter and binds it to its member.
    void declare(Declarations &declarations);

    /**
     * Reads a parameter file, then applies overrides of the form
     * "Section/Name=value", then what Accuracy asks for, then checks every value and combination.
     * Throws FileError, or ParameterError; an unknown name is answered with the
     * nearest known one, a refused value with what the parameter accepts.
     */
    static Parameters read(const std::string &file, const std::vector<std::string> &overrides);

    /// Gives the parameter of a path another value, from the one that it has, without checking how it goes with others. Throws
    /// ParameterError, naming @p where, if there is no such parameter or if it refuses the value.
    void set(const std::string &path, const std::string &where, const std::function<std::string(const std::string &)> &new_value);

    /// Every parameter with its value, and with its documentation and what it accepts, as a parameter file.
    void print(std::ostream &stream, bool with_documentation) const;

    /// Whether the study solves for the steady sliding state.
    bool needs_steady_sliding() const;

    /// Whether the contact damps the modes of some run of the study: radial dissipation, or friction that depends on the speed.
    bool has_contact_damping() const;

    /// Whether the study solves for modes with friction; else the friction coefficient only acts on the steady sliding state.
    bool has_friction() const;

    /// Whether complex modes at Operation/Friction coefficient are those of this solver.
    bool solves_by(ComplexSolver solver) const;

    /// Whether Operation/Load per side presses on anything.
    bool uses_load_per_side() const;

    /// Throws ParameterError where values or their combination make no sense.
    void check() const;

  private:
    void check_contact_state() const;
    void check_damping_in_band() const;
  };
} // namespace Squeal
