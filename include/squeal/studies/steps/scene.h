// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/elasticity.h>
#include <squeal/sliding/steady_sliding.h>
#include <squeal/studies/steps/run.h>

namespace Squeal
{
  /// The meshed model without a contact state.
  struct Scene
  {
    Mesh                   mesh;
    std::unique_ptr<Model> model;
    ContactInterface       interface; ///< all pairs of contact nodes
    ContactOperators       contact;   ///< operators of all pairs
    std::vector<Term>      bodies;    ///< merged terms of the uncoupled bodies
    SecondOrderSystem      system;    ///< M, C, K: sums of the terms
    BodyTerms              elastic;   ///< stiffness term by term

    /// Sum of the mount stiffnesses on the uncoupled dofs, each scaled to a largest entry of one; null: none.
    std::shared_ptr<const SparseMatrix> mounts;

    unsigned int n_pins() const
    {
      return mesh.body_names.size() - 1;
    }
  };

  /// Contact state at a given friction coefficient, load and speed.
  struct StateOfContact
  {
    std::vector<unsigned int> closed;  ///< indices of the closed pairs: S_0
    ContactDamping            damping; ///< damping of all pairs; zero at open pairs
  };

  /// Contact state from @p sliding. Without it, all nodes are closed, and equal_load_shares() gives the reactions for the contact damping.
  StateOfContact state_of_contact(const Model                       &model,
                                  const ContactInterface            &interface,
                                  const std::optional<SlidingState> &sliding,
                                  const OperationParameters         &operation);

  /// Coefficients of the @p chosen pairs.
  ContactDamping selected(const ContactDamping &damping, const std::vector<unsigned int> &chosen);

  /// A model linearised about a contact state, and the resulting system: only closed contact nodes couple the bodies.
  struct Linearisation
  {
    const Scene                *scene = nullptr; ///< must outlive this object; null for an imported system
    std::optional<SlidingState> sliding;         ///< only for steady sliding
    std::vector<unsigned int>   closed;          ///< indices of the closed pairs: S_0
    ContactInterface            interface;       ///< S_0
    ContactOperators            contact;         ///< operators of S_0
    ContactDamping              damping;         ///< damping of S_0
    CoupledSystem               coupled;
  };

  /// Prints a summary of the input before the computation: sizes, masses, and expected memory. Warns of implausible values. Throws
  /// MeshError if the model exceeds the memory, or if the disc turns about z, but is a body of revolution about another axis.
  void summarise_scene(const Mesh &mesh, Run &run);

  /// Meshes the model, checks the mesh and pairs the contact nodes, without assembly. Throws Error if parameters do not fit the mesh.
  Scene mesh_scene(Run &run);

  /// Assembles the system of the uncoupled bodies; returns the individual terms with their coefficients, before merging.
  BodyTerms assemble_scene(Scene &scene, Run &run);

  /// Data common to all steady sliding states of an assembled model.
  SlidingModel sliding_model(const Scene &scene, const Parameters &parameters);

  /// Solves for the steady sliding state, as a step of the run.
  SlidingState solve_sliding(const Scene &scene, const OperationParameters &operation, const SlidingParameters &sliding, Run &run);

  /// Assembles the model and linearises it about the requested contact state, as steps of the run.
  Linearisation linearised_scene(Scene &scene, Run &run);

  /// Couples the closed nodes of a state or, without a state, all nodes. @p operation determines the contact damping.
  Linearisation linearise(const Scene &scene, const std::optional<SlidingState> &sliding, const OperationParameters &operation);
} // namespace Squeal
