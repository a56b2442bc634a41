// SPDX-License-Identifier: GPL-3.0-or-later

#pragma once

#include <squeal/model/elasticity.h>
#include <squeal/sliding/steady_sliding.h>
#include <squeal/studies/steps/run.h>

namespace Squeal
{
  /// The bodies before anything is said about their contact.
  struct Scene
  {
    Mesh                   mesh;
    std::unique_ptr<Model> model;
    ContactInterface       interface; ///< all pairs of contact nodes
    ContactOperators       contact;   ///< of all pairs
    std::vector<Term>      bodies;    ///< merged terms of the uncoupled bodies
    SecondOrderSystem      system;    ///< M, C, K: their sum
    BodyTerms              elastic;   ///< stiffness term by term

    /// Sum of the mounts' stiffnesses on the uncoupled dofs, each in units of its largest entry; null: none.
    std::shared_ptr<const SparseMatrix> mounts;

    unsigned int n_pins() const
    {
      return mesh.body_names.size() - 1;
    }
  };

  /// Contact at one friction coefficient, load and speed.
  struct StateOfContact
  {
    std::vector<unsigned int> closed;  ///< numbers of the closed pairs: S_0
    ContactDamping            damping; ///< of all pairs; zeros at open ones
  };

  /// That of @p sliding; where there is none, equal shares of the load on all nodes, which only contact damping needs.
  StateOfContact state_of_contact(const Model                       &model,
                                  const ContactInterface            &interface,
                                  const std::optional<SlidingState> &sliding,
                                  const OperationParameters         &operation);

  /// Coefficients of all pairs @p chosen among them.
  ContactDamping selected(const ContactDamping &damping, const std::vector<unsigned int> &chosen);

  /// The state of contact about which a scene is linearised, and the system that results: only closed contact nodes couple the bodies.
  struct Linearisation
  {
    const Scene                *scene = nullptr; ///< must outlive it; null: of an imported system
    std::optional<SlidingState> sliding;         ///< where the state is steady sliding
    std::vector<unsigned int>   closed;          ///< numbers of the closed pairs: S_0
    ContactInterface            interface;       ///< S_0
    ContactOperators            contact;         ///< of S_0
    ContactDamping              damping;         ///< of S_0
    CoupledSystem               coupled;
  };

  /// Prints, before the work, what the program understood: sizes, masses, and the memory to expect; warns of implausible values; rejects
  /// models that exceed the memory, and a disc that is not round about z but about another axis. Throws MeshError.
  void summarise_scene(const Mesh &mesh, Run &run);

  /// Meshes, checks and pairs; refuses parameters that do not fit the pins. The system is left empty.
  Scene mesh_scene(Run &run);

  /// Assembles the system of the uncoupled bodies; returns its terms with their coefficients, before they are merged.
  BodyTerms assemble_scene(Scene &scene, Run &run);

  /// What serves all steady sliding states of an assembled scene.
  SlidingModel sliding_model(const Scene &scene, const Parameters &parameters);

  /// The quasi-static state that @p sliding asks for, as a step of the run.
  SlidingState solve_sliding(const Scene &scene, const OperationParameters &operation, const SlidingParameters &sliding, Run &run);

  /// Assembles the scene and linearises it about the state of contact that the parameters ask for, as steps of the run.
  Linearisation linearised_scene(Scene &scene, Run &run);

  /// Couples the closed nodes of a state; without one all are closed with equal shares of the load. The contact damping follows
  /// @p operation.
  Linearisation linearise(const Scene &scene, const std::optional<SlidingState> &sliding, const OperationParameters &operation);
} // namespace Squeal
